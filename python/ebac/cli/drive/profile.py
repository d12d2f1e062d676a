"""`ebac drive profile`: the profiles and network files that come with ebac, to start your own from."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac._util.arguments import unknown
from ebac.cli import doubtful, output, setting
from ebac.cli.drive.options import profiles, reporting

if TYPE_CHECKING:
    from ebac._core import Device

#: What a profile takes from a file at least.
_OF_FILE = (("motor", "torque_constant"), ("motor", "rated_torque"), ("encoder", "counts_per_turn"))


def profile(
    name: Annotated[
        str | None,
        typer.Argument(
            help="Which one to print; without a name, list them.",
            show_default=False,
            autocompletion=profiles,
        ),
    ] = None,
    motor: Annotated[
        Path | None,
        typer.Option(
            help="Configuration or scenario whose device.motor, device.encoder and device.drive.peak_ratio it is for.",
            show_default="the paper's motor",
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Print a drive profile or network file that comes with ebac, to start your own from.

    With `--motor` the keys that describe the motor are those of a device: torque constant, continuous and peak
    torque, counts per turn, rated and largest torque and current. In a network file they stand beside the profile of
    each node. Numbers that contradict each other, or that the drive cannot hold, are refused.

    A profile says what a drive is to be set to; a network file which drives are on a bus, and the profile of each. For
    a drive that is not in the list start from generic-cia402: replace its limits by those of your motor, and compare
    it with the data sheet of the drive's maker (`ebac drive plan FILE --eds SHEET`), which names all that the drive
    lacks.

    **Examples**

    * `ebac drive profile`: list them.

    * `ebac drive profile maxon-epos4 > my-drive.toml`

    * `ebac drive profile joystick > my-network.toml`: a network file with two drives.

    * `ebac demo joystick`, then `ebac drive profile joystick --motor joystick.toml`: the same for the motor of a file.
    """
    from ebac.drives.profile import builtin, read_source
    from ebac.drives.toml_positions import Source

    names = builtin()
    if name is not None and name not in names:
        output.fail(unknown(f"NAME {name}", name, names, "profile or network file"))
    if motor is not None and name is None:
        output.fail(f"--motor {motor}: give the NAME of the profile or network file to print")
    found = {one: read_source(one) for one in names if name in (None, one)}
    if motor is not None and name is not None:
        from ebac.hardware import profile_for

        with output.refusing(), reporting():
            text = profile_for(name, _device(motor), file=motor.name)
        found[name] = Source(name=name, text=text)
    rows = [
        {
            "name": one,
            "kind": "network file" if "node" in source.table else "profile",
            "about": source.table.get("about", ""),
            "text": source.text,
        }
        for one, source in found.items()
    ]
    if as_json:
        typer.echo(output.document("drive profile", rows))
    elif name is not None:
        typer.echo(rows[0]["text"], nl=False)
    else:
        grid = output.table(["name", "kind", "about"])
        for row in rows:
            grid.add_row(row["name"], row["kind"], row["about"])
        output.show(grid)


def _device(file: Path) -> Device:
    """Return the device of a configuration or scenario; a note names the numbers that are not in the file."""
    from ebac._util.file_kinds import CONFIGURATION, kind_of
    from ebac._util.text_file import read_text
    from ebac.drives.toml_positions import Source
    from ebac.hardware.reading import read_device

    try:
        text = read_text(file)
    except ValueError as error:
        raise ValueError(f"--motor {file}: {error}") from None
    source = Source(name=str(file), text=text)
    if kind_of(source.table) == CONFIGURATION:
        device = read_device(source)
        doubtful.note_device(file, device)
    else:
        device = setting.base_scenario(file).device
    table = source.table.get("device", {})
    left = [(part, key) for part, key in _OF_FILE if key not in table.get(part, {})]
    if 0 < len(left) < len(_OF_FILE):
        for part, key in left:
            made = getattr(device, part)
            unit = next(one.unit for one in made.fields() if one.name == key)
            output.note(
                f"{file}: does not give device.{part}.{key}, so {getattr(made, key):g} {unit} of the device from which "
                "[device] starts is taken: give that of your motor"
            )
    return device
