"""`ebac drive zero`: read where the axes stand, and take that for the zero of their encoders."""

from __future__ import annotations

from functools import partial
from typing import Annotated

import typer

from ebac.cli import output
from ebac.cli.drive import positions
from ebac.cli.drive.options import ConfigurationFile, Simulated, Yes, reporting, sure

#: The handle stands still: no axis goes further while somebody answers [m].
STILL = 5e-4


def zero(
    configuration: ConfigurationFile,
    simulated: Simulated = False,
    write: Annotated[
        bool,
        typer.Option(
            "--write",
            help="Write the counts to the file as its zero and leave the rest of it unchanged.",
        ),
    ] = False,
    yes: Yes = False,
    as_json: output.AsJson = False,
) -> None:
    """Read the position of each axis and use it as the zero of its encoder.

    No motor has power and nothing is written to a drive. An incremental encoder counts from the position at which its
    drive was switched on: put the handle at its mark and use `--write` after every power-on. For an absolute encoder
    do it once, and set `absolute = true` in the table `[zero]`: then `ebac run` does not ask.

    Exit code 1 when the handle moved before the zero was confirmed; nothing is written then.

    **Examples**

    * `ebac demo joystick`, then `ebac drive zero joystick.toml --simulated`: the present position of the axes

    * `ebac drive zero my-joystick.toml --write`
    """
    from ebac.hardware import Configuration, Zero, axis_positions, distances
    from ebac.hardware.axis_positions import axis_name, positions_at_zero
    from ebac.hardware.toml_table import rewrite

    with reporting():
        known = Configuration.load(configuration)
        found = axis_positions(known, simulate=simulated)
    surfaces = distances(known, found)
    if not as_json:
        if write:
            output.say("By the old zero:", style="bold")
        positions.show(found, surfaces)
    if write:
        if not simulated:
            where = ", ".join(f"{one.counts}" for one in found)
            sure(f"Is the handle at its mark, so that {where} counts are its zero?", yes)
        with reporting():
            now = axis_positions(known, simulate=simulated)
        for one, before in zip(now, found, strict=True):
            if abs(one.position_m - before.position_m) > STILL:
                output.fail(
                    f"{axis_name(one.axis, one.node)} moved by {1e3 * (one.position_m - before.position_m):+.2f} mm "
                    "meanwhile; nothing was written. Hold the handle at its mark and try again",
                    code=output.FAILED,
                )
        found, right = now, Zero(counts=tuple(one.counts for one in now))
        with output.refusing():
            rewrite(configuration, partial(right.written_into, simulated=simulated))
        if simulated:
            output.note(
                f"{configuration}: [zero] is of the simulated device; find it again on yours"
            )
        by_new_zero = known.replace(zero=right)
    if as_json:
        rows = [one.row() for one in found]
        typer.echo(output.document("drive zero", rows, written=write, surfaces_m=surfaces))
    elif write:
        output.say(f"Written to {configuration}: zero.counts = {[one.counts for one in found]}.")
        output.say("By the new zero:", style="bold")
        at_zero = positions_at_zero(by_new_zero)
        positions.show(at_zero, distances(by_new_zero, at_zero))
    else:
        output.say("Nothing was written; --write writes these counts into the file as its zero.")
