"""`ebac identify scale`: the scale of the force sensor against that of the motor."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output
from ebac.cli.identify import options as given

if TYPE_CHECKING:
    from ebac.identify import ForceScale


def scale(
    log: given.Log,
    reading: given.Reading,
    mass: Annotated[
        float | None,
        typer.Option(
            help="Mass of the device at the handle [kg], known to 10 %.",
            show_default="of the trace",
            min=1e-3,
            max=100,
            rich_help_panel=given.FIT,
        ),
    ] = None,
    damping: Annotated[
        float | None,
        typer.Option(
            help="Viscous damping of the device [N s/m], known to 20 %.",
            show_default="of the trace",
            min=0,
            max=500,
            rich_help_panel=given.FIT,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Compare the scale of the force sensor with that of the motor.

    The log must contain position, force of the hand and force of the motor, of a hand that presses on a wall of 1 to 3
    kN/m to and fro for 15 s, by 5 to 20 N, about once a second.

    **Examples**

    * `ebac demo sway`, then `ebac identify scale sway.mcap`

    * `ebac identify scale sway.mcap --mass 0.25 --damping 2`: a log of another program has no mass and damping

    Exit code 1 when the log does not determine the scale to 0.5 %.
    """
    from ebac.identify import force_scale

    with output.refusing():
        recording = reading.load(log)
        found = force_scale(recording, mass=mass, damping=damping)
    if as_json:
        remarks = list(recording.remarks)
        typer.echo(output.document("identify scale", [found.to_dict()], remarks=remarks))
    else:
        for text in recording.remarks:
            output.say(text, style="dim")
        grid = output.table(["", "estimate", "95 % interval", "unit"], numbers=(1, 2))
        span = f"{found.low:.4f} to {found.high:.4f}"
        grid.add_row("reading for 1 N of the motor", f"{found.scale:.4f}", span, "N")
        grid.add_row("friction of the device", f"{found.friction:.3f}", "", "N")
        grid.add_row("offset: bias of the sensor, weight", f"{found.offset:.3f}", "", "N")
        grid.add_row("force that is not explained", f"{found.left:.3f}", "", "N")
        output.show(output.filled(grid))
        output.say(_advice(found))
    if not found.determined:
        raise typer.Exit(output.FAILED)


def _advice(found: ForceScale) -> str:
    if not found.determined:
        return (
            "Not determined to 0.5 %: press for longer, by 5 to 20 N, on a wall of 1 to 3 kN/m, to and fro about once "
            "a second."
        )
    if found.low <= 1 <= found.high:
        return "Sensor and motor agree."
    less = f"{100 * abs(found.scale - 1):.1f} % {'less' if found.scale < 1 else 'more'}"
    return (
        f"The sensor shows {less} than the motor gives. Multiply torque_constant of [device.motor] by "
        f"{found.scale:.4f} if you trust the sensor, or counts_per_force of [sensor] if you trust the motor: the log "
        "does not show which is wrong."
    )
