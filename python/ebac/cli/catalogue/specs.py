"""`ebac specs`: the spec sheet of a device."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ebac.cli import completion, files, output, setting


def specs(
    device: Annotated[
        str,
        typer.Option(
            help="A device by name, see `ebac presets`.", autocompletion=completion.devices
        ),
    ] = "joystick",
    figure: Annotated[
        Path | None,
        typer.Option(help="Draw the workspace to this file: png, pdf or svg.", show_default=False),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Print the data sheet of a device, beside the paper's numbers.

    **Examples**

    * `ebac specs`: resolution, forces and workspace of the paper's joystick

    * `ebac specs --device reference`: one straight axis

    * `ebac specs --device joystick-3 --figure workspace.png`: three axes, and a figure of the workspace
    """
    from ebac import presets
    from ebac._util import formatting
    from ebac.specs import spec_sheet

    with output.refusing():
        sheet = spec_sheet(setting.known_device(device))
        drawn = _draw(device, figure)
    if as_json:
        rows = [spec.row() for spec in sheet]
        typer.echo(output.document("specs", rows, device=device, written=drawn))
        return
    grid = output.table(["", "here", "paper", "how"], numbers=(1, 2))
    for spec in sheet:
        how = f"{spec.how}; {spec.remark}" if spec.remark else spec.how
        value, paper = (formatting.quantity(v, spec.unit) for v in (spec.value, spec.paper))
        grid.add_row(spec.name, value, paper, how)
    output.show(grid)
    output.say(f"Device: {device}, {presets.DEVICES[device.lower()].source}.")
    for file in drawn:
        output.say(f"Its workspace: {file}.")


def _draw(device: str, figure: Path | None) -> list[str]:
    """Draw the workspace, if asked to; return the names of the files."""
    if figure is None:
        return []
    from ebac.plot import plot_workspace, save

    drawn = plot_workspace(setting.known_device(device))
    file = files.free_file(figure)
    with output.writing(f"--figure {file}"):
        save(drawn, file)
    return [str(file)]
