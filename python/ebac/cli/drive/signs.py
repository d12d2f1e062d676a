"""`ebac drive signs`: push every axis a little, and find which signs are right."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output
from ebac.cli.drive.options import ConfigurationFile, Simulated, Yes, reporting, sure

if TYPE_CHECKING:
    from ebac.hardware import AxisSigns


def signs(
    configuration: ConfigurationFile,
    simulated: Simulated = False,
    current: Annotated[
        float, typer.Option(help="Current of each push [A].", min=0.02, max=0.3)
    ] = 0.1,
    write: Annotated[
        bool,
        typer.Option(
            "--write", help="Write the signs to the file and leave the rest of it unchanged."
        ),
    ] = False,
    yes: Yes = False,
    as_json: output.AsJson = False,
) -> None:
    """Find which motor and which encoder has a wrong sign.

    **The motors get power and the handle moves by some millimetres.** Each axis is pushed to and fro with a tenth of
    an ampere that is ramped up slowly; any key stops it. Put the handle in the middle and let go of it. With a force
    sensor, hold it loosely instead: the force of your hand against the motor distinguishes a wrong motor from a wrong
    encoder.

    Without a force sensor the command first asks you to push the handle towards +x, +y, +z by hand, while no motor has
    power, and reads from the encoders which of them are wrong. With `--yes` and `--simulated` it does not, and takes
    the motor to be wrong when the two contradict each other.

    Exit code 1 when a sign is wrong and was not written, or an axis did not move.

    **Examples**

    * `ebac demo joystick`, then `ebac drive signs joystick.toml --simulated`

    * `ebac drive signs my-joystick.toml --write`
    """
    from ebac.cli.run.any_key import any_key
    from ebac.hardware import Configuration, Signs, find_encoder_signs, find_signs
    from ebac.hardware.axis_positions import axis_name
    from ebac.hardware.lateness import explained
    from ebac.hardware.toml_table import SIMULATED, rewrite
    from ebac.simulation import LoopFault

    with reporting():
        known = Configuration.load(configuration)
        by_hand = None
        if known.sensor is None and not (simulated or yes):
            by_hand = find_encoder_signs(known, lambda request: sure(f"{request} Done?", yes))
    if not simulated:
        nodes = [node.id for node in known.drives.nodes]
        names = ", ".join(axis_name(axis, node) for axis, node in enumerate(nodes))
        sure(
            f"The motors of {names} get power and the handle moves. Is it in the middle, and free?",
            yes,
        )
    try:
        with reporting(), any_key() as key:
            rows = find_signs(known, simulate=simulated, current=current, encoder=by_hand, look=key)
    except LoopFault as error:
        output.fail(f"{explained(error)}; nothing was written", code=output.FAILED)
    except typer.Exit:  # a RuntimeError of its own, of an end that was reported
        raise
    except RuntimeError as error:
        output.fail(str(error), code=output.FAILED)
    motor = [row.motor for row in rows if row.motor is not None]
    encoder = [row.encoder for row in rows if row.encoder is not None]
    found = len(motor) == len(rows)
    rehearsed = not simulated and bool(known.signs.motor) and SIMULATED in known.text
    written = write and found and (rehearsed or not all(row.right for row in rows))
    if written:
        with output.refusing():
            right = Signs(motor=tuple(motor), encoder=tuple(encoder))
            rewrite(configuration, partial(right.written_into, simulated=simulated))
        if simulated:
            output.note(
                f"{configuration}: [signs] is of the simulated device; find it again on yours"
            )
    if as_json:
        typer.echo(output.document("drive signs", [asdict(row) for row in rows], written=written))
    else:
        show(rows)
        if written:
            output.say(f"Written to {configuration}: motor = {motor}, encoder = {encoder}.")
        elif found and not all(row.right for row in rows):
            output.say(
                f"Nothing was written; --write writes motor = {motor}, encoder = {encoder} into [signs] of the file."
            )
    if not found or not (written or all(row.right for row in rows)):
        raise typer.Exit(output.FAILED)


def show(rows: list[AxisSigns]) -> None:
    """Print the signs of each axis."""
    heads = ["axis", "node", "motor", "encoder", "moved", "force", "what"]
    grid = output.table(heads, numbers=range(6))
    for row in rows:
        grid.add_row(
            str(row.axis),
            str(row.node),
            _change(row.configured_motor, row.motor),
            _change(row.configured_encoder, row.encoder),
            f"{1e3 * row.moved_m:.2f} mm",
            "-" if row.force_N is None else f"{row.force_N:.2f} N",
            row.remark,
        )
    output.show(grid)


def _change(configured: int, found: int | None) -> str:
    if found is None:
        return f"{configured}, not known"
    return str(found) if found == configured else f"{configured} -> {found}"
