"""`ebac demo`: sample data to try the other commands with."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac._util.arguments import unknown
from ebac.cli import completion, output

if TYPE_CHECKING:
    from ebac.datasets import Dataset


def demo(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            help="Data sets to write, or `all`; without a name, list them.",
            metavar="[NAME]...",
            autocompletion=completion.data_sets,
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path, typer.Option("--out", "-o", help="Folder to write to.", show_default="this one")
    ] = Path(),
    force: Annotated[
        bool, typer.Option("--force", help="Replace a file of the same name.")
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Write sample data for trying out the other commands.

    Everything is simulated, nothing was measured.

    **Examples**

    * `ebac demo`: list the data sets.

    * `ebac demo arm`: write arm.csv, a log of a hand that holds the handle while the motor pushes it.

    * `ebac demo line circle --out data`: write two recorded paths to the folder data.
    """
    from ebac.datasets import DATASETS

    chosen = list(DATASETS) if names == ["all"] else names or []
    for name in chosen:
        if name not in DATASETS:
            output.fail(unknown(f"NAME {name}", name, [*DATASETS, "all"], "data set"))
    paths = [_write(name, out, force) for name in chosen]
    shown = [DATASETS[name] for name in chosen] or list(DATASETS.values())
    if as_json:
        typer.echo(output.document("demo", [_row(one) for one in shown], written=paths))
    elif chosen:
        for one, path in zip(shown, paths, strict=True):
            output.say(path, style="bold")
            output.indented(one.note)
            for command in one.commands:
                output.indented(command)
    else:
        _list(shown)


def _write(name: str, folder: Path, force: bool) -> str:
    from ebac.datasets import write

    if folder.is_file():
        output.fail(f"--out {folder}: is a file; give the name of a folder")
    with output.writing(f"--out {folder}", "folder"):
        try:
            return str(write(name, folder, force=force))
        except FileExistsError as error:
            output.fail(f"{error.filename} exists; --force replaces it, --out writes elsewhere")


def _row(one: Dataset) -> dict[str, Any]:
    return {
        "name": one.name,
        "file": one.file,
        "about": one.about,
        "truth": one.truth or None,
        "commands": list(one.commands),
    }


def _list(shown: list[Dataset]) -> None:
    grid = output.table(["name", "what it contains, and what to try next"])
    for one in shown:
        grid.add_row(one.name, "\n".join([one.about, *(f"[dim]{c}[/]" for c in one.commands)]))
    output.show(grid)
    output.say(
        "Write one by its name: ebac demo arm. Everything is simulated, nothing was measured."
    )
