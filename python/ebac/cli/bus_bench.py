"""`ebac bench --can`: frames per second of the buses inside a process."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.peers import PeerRow


def run(repeats: int, *, as_json: bool) -> None:
    """Compare and tell."""
    from ebac.peers.bus import STEPS, compare_buses

    with output.progress(STEPS, quiet=as_json) as step:
        rows = compare_buses(repeats=max(3, repeats // 10), step=step)
    if as_json:
        typer.echo(output.document("bench", [row.row() for row in rows]))
    else:
        _show(rows)


def _show(rows: list[PeerRow]) -> None:
    from ebac.peers.bus import NOTES

    grid = output.table(["what", "program", "", "times ebac"], numbers=(2, 3))
    last = ""
    for row in rows:
        if last and row.subject != last:
            grid.add_section()
        subject = "" if row.subject == last else row.subject
        grid.add_row(subject, row.program, _quantity(row), f"{row.times_ebac:,.2f}")
        last = row.subject
    output.console().print(grid)
    output.say("What each program does:", style="bold")
    output.indented("\n".join(f"{name}: {note}" for name, note in NOTES.items()))
    output.say(
        "The quickest of several runs of each, answers of one run, all in this one run of the command."
    )


def _quantity(row: PeerRow) -> str:
    if row.unit == "1/s":
        return f"{row.value:,.0f} frames/s"
    return f"{1e6 * row.value:,.1f} µs"
