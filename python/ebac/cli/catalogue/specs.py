"""`ebac specs`: the spec sheet of a device."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac.cli import options, output, setting


def specs(
    device: Annotated[
        str,
        typer.Option(
            help="A device by name, see `ebac presets`.", autocompletion=options.complete_devices
        ),
    ] = "joystick",
    as_json: output.AsJson = False,
) -> None:
    """Print the data sheet of a device, beside the paper's numbers.

    **Examples**

    * `ebac specs`: resolution, forces and workspace of the paper's joystick

    * `ebac specs --device reference`: one straight axis
    """
    from ebac import presets
    from ebac._util import formatting
    from ebac.specs import spec_sheet

    with output.refusing():
        sheet = spec_sheet(setting.known_device(device))
    if as_json:
        typer.echo(output.document("specs", [spec.row() for spec in sheet], device=device))
        return
    grid = output.table(["", "here", "paper", "how"], numbers=(1, 2))
    for spec in sheet:
        how = f"{spec.how}; {spec.remark}" if spec.remark else spec.how
        value, paper = (formatting.quantity(v, spec.unit) for v in (spec.value, spec.paper))
        grid.add_row(spec.name, value, paper, how)
    output.show(grid)
    output.say(f"Device: {device}, {presets.DEVICES[device.lower()].source}.")
