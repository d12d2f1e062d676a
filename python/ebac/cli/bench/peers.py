"""`ebac bench --peers`: the same plant, step and wall in other programs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from ebac.cli import output
from ebac.cli.bench import table

if TYPE_CHECKING:
    from ebac.peers import PeerRow


def run(repeats: int, side: int, *, as_json: bool) -> None:
    """Compare and print the results."""
    from ebac.peers.compare import STEPS, compare

    try:
        with output.progress(STEPS, quiet=as_json) as step:
            rows = compare(repeats=repeats, side=side, step=step)
    except ImportError as error:
        output.fail(str(error))
    if as_json:
        typer.echo(output.document("bench", [row.row() for row in rows]))
    else:
        _show(rows)


def _show(rows: list[PeerRow]) -> None:
    from ebac.peers import NOTES

    table.show(rows, _quantity, digits=1)
    output.say("What each program does in a step:", style="bold")
    output.indented("\n".join(f"{name}: {note}" for name, note in NOTES.items()))
    others = {row.subject: row.note for row in rows if row.note not in NOTES.values()}
    output.say("And the rest:", style="bold")
    output.indented("\n".join(f"{subject}: {note}" for subject, note in others.items()))
    output.say("The quickest of several runs of each, all in this one run of the command.")


def _quantity(row: PeerRow) -> str:
    if row.unit == "s":
        return f"{row.value:.2f} s" if row.value > 0.1 else f"{1e9 * row.value:,.1f} ns"
    if row.unit == "m":
        return f"{1e3 * row.value:.4g} mm"
    if row.unit == "B":
        return f"{row.value / 1e6:,.1f} MB" if row.value > 1e6 else f"{row.value:g} bytes"
    return f"{row.value:.2f}"
