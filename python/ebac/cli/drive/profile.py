"""`ebac drive profile`: the profiles and network files that come with ebac, to start your own from."""

from __future__ import annotations

from typing import Annotated

import typer

from ebac._util.arguments import unknown
from ebac.cli import output
from ebac.cli.drive.options import profiles


def profile(
    name: Annotated[
        str | None,
        typer.Argument(
            help="Which one to print; without a name, list them.",
            show_default=False,
            autocompletion=profiles,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Print a drive profile or network file that comes with ebac, to start your own from.

    A profile says what a drive is to be set to; a network file which drives are on a bus, and the profile of each. For
    a drive that is not in the list start from generic-cia402: replace its limits by those of your motor, and compare
    it with the data sheet of the drive's maker (`ebac drive plan FILE --eds SHEET`), which names all that the drive
    lacks.

    **Examples**

    * `ebac drive profile`: list them.

    * `ebac drive profile maxon-epos4 > my-drive.toml`

    * `ebac drive profile joystick > my-network.toml`: a network file with two drives.
    """
    from ebac.drives.profile import builtin, read_source

    names = builtin()
    if name is not None and name not in names:
        output.fail(unknown(f"NAME {name}", name, names, "profile or network file"))
    found = {one: read_source(one) for one in names if name in (None, one)}
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
