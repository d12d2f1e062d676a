"""`ebac specs`: the spec sheet of a device."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac._util.toml import parsed
from ebac.cli import completion, files, output, setting

if TYPE_CHECKING:
    from ebac._core import Device
    from ebac.specs import Spec

_DEFAULT = "joystick"


def specs(
    device: Annotated[
        str | None,
        typer.Option(
            help="A device by name, see `ebac presets`.",
            show_default=_DEFAULT,
            autocompletion=completion.devices,
        ),
    ] = None,
    scenario: Annotated[
        Path | None,
        typer.Option(
            help="The device of a scenario, or of a configuration of `ebac run`, in TOML.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="Draw the workspace to this file: png, pdf or svg.",
            show_default=False,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Print the data sheet of a device; that of a built-in one beside the paper's numbers.

    **Examples**

    * `ebac specs`: resolution, forces and workspace of the paper's joystick

    * `ebac specs --device reference`: one straight axis

    * `ebac presets reference > device.toml`, then `ebac specs --scenario device.toml`: the device of a file

    * `ebac demo joystick`, then `ebac specs --scenario joystick.toml`: that of the configuration of a run

    * `ebac specs --device joystick-3 --out workspace.png`: three axes, and a figure of the workspace
    """
    from ebac.specs import spec_sheet

    with output.refusing():
        name, chosen, source = _chosen(device, scenario)
        sheet = spec_sheet(chosen)
        drawn = _draw(chosen, out)
    if as_json:
        rows = [spec.row() if scenario is None else _of_own(spec) for spec in sheet]
        typer.echo(output.document("specs", rows, device=name, written=drawn))
        return
    if scenario is None:
        _show_beside_paper(sheet)
    else:
        _show(sheet)
    output.say(f"Device: {name}, {source}.")
    for file in drawn:
        output.say(f"Its workspace: {file}.")


def _chosen(name: str | None, scenario: Path | None) -> tuple[str, Device, str]:
    """Return what the device that is asked for is called, the device, and where its numbers come from."""
    if scenario is None:
        from ebac import presets

        name = name or _DEFAULT
        return name, setting.known_device(name), presets.DEVICES[name.lower()].source
    if name is not None:
        raise ValueError(
            f"--device {name}: the device of --scenario {scenario} is printed; give one of the two"
        )
    return str(scenario), *_of_file(scenario)


def _of_file(file: Path) -> tuple[Device, str]:
    from ebac.cli import doubtful
    from ebac.scenario_text import is_configuration

    try:
        configuration = is_configuration(file)
    except (OSError, ValueError):
        configuration = False  # refused as a scenario is
    if not configuration:
        device, base = setting.base_scenario(file).device, "reference device"
    else:
        from ebac.hardware import Configuration

        known = Configuration.load(file, device_alone=True)
        doubtful.note_configuration(file, known)
        preset = parsed(known.text).get("device", {}).get("preset", "joystick")
        device, base = known.device, f"device preset {preset}"
    return device, f"what it leaves out is that of the {base}"


def _of_own(spec: Spec) -> dict[str, str | float | None]:
    """Return a row of a device that is not the paper's: its number is none to compare with, nor is a remark on it."""
    return {**spec.row(), "paper": None, "remark": None}


def _show_beside_paper(sheet: list[Spec]) -> None:
    from ebac._util import formatting

    grid = output.table(["", "here", "paper", "how"], numbers=(1, 2))
    for spec in sheet:
        how = f"{spec.how}; {spec.remark}" if spec.remark else spec.how
        value, paper = (formatting.quantity(v, spec.unit) for v in (spec.value, spec.paper))
        grid.add_row(spec.name, value, paper, how)
    output.show(grid)


def _show(sheet: list[Spec]) -> None:
    """Print the sheet of a device that is not the paper's: remarks compare it with the paper."""
    from ebac._util import formatting

    grid = output.table(["", "here", "how"], numbers=(1,))
    for spec in sheet:
        grid.add_row(spec.name, formatting.quantity(spec.value, spec.unit), spec.how)
    output.show(grid)


def _draw(device: Device, out: Path | None) -> list[str]:
    """Draw the workspace, if asked to; return the names of the files."""
    if out is None:
        return []
    from ebac.plot import plot_workspace, save

    if device.axes == 1:
        raise ValueError(
            f"--out {out}: one axis moves along a line, and has no workspace to draw; leave --out out"
        )
    drawn = plot_workspace(device)
    file = files.free_file(out)
    with output.writing(f"--out {file}"):
        save(drawn, file)
    return [str(file)]
