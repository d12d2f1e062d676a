"""`ebac bench --worlds`: what a contact with a mesh costs, and how exact it is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from ebac.cli import output
from ebac.cli.bench import table

if TYPE_CHECKING:
    from ebac.peers import PeerRow


def run(repeats: int, chai3d: Path | None, *, as_json: bool) -> None:
    """Measure and print the results."""
    from ebac._util.background import Background
    from ebac.peers import worlds

    try:
        with output.progress(worlds.STEPS, quiet=as_json) as step:
            # The grid of a million triangles takes a minute; this thread receives Ctrl-C meanwhile.
            rows, missing = Background(
                lambda: worlds.compare_worlds(chai3d=chai3d, repeats=repeats, step=step)
            ).result()
    except (ImportError, RuntimeError) as error:
        output.fail(str(error))
    if as_json:
        typer.echo(output.document("bench", [row.row() for row in rows], missing=missing))
        return
    how = "The quickest of several runs of each, all in this one run of the command."
    table.show_with_notes(rows, _quantity, how, digits=2)
    for sentence in missing:
        output.say(sentence)


def _quantity(row: PeerRow) -> str:
    if row.unit == "s":
        return f"{1e9 * row.value:,.1f} ns"
    if row.unit == "m":
        return f"{1e6 * row.value:.2f} µm"
    return f"{row.value:.3f}°"
