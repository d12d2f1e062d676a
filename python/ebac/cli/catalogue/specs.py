"""`ebac specs`: the spec sheet of a device."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac.cli import output


def specs(
    device: Annotated[str, typer.Option(help="A device by name, see `ebac presets`.")] = "joystick",
    as_json: output.AsJson = False,
) -> None:
    """Compute the spec sheet of a device from its parts, beside the paper's figures.

    **Example**

    * `ebac specs`: resolution, forces and workspace of the paper's joystick.
    """
    from ebac import presets, wording
    from ebac.specs import spec_sheet

    with output.refusing():
        sheet = spec_sheet(presets.device(device))
    if as_json:
        typer.echo(output.document("specs", [spec.row() for spec in sheet], device=device))
        return
    grid = output.table(["", "here", "paper", "how"], numbers=(1, 2))
    for spec in sheet:
        how = f"{spec.how}; {spec.remark}" if spec.remark else spec.how
        value, paper = (wording.quantity(v, spec.unit) for v in (spec.value, spec.paper))
        grid.add_row(spec.name, value, paper, how)
    output.console().print(grid)
    output.say(f"Device: {device}, {presets.DEVICES[device].source}.")
