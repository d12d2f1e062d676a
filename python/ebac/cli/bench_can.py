"""`ebac bench --can`: the bus in numbers."""

from __future__ import annotations

import typer

from ebac.cli import output


def run(repeats: int, *, as_json: bool) -> None:
    """Time and tell."""
    from ebac.peers.can_bus import STEPS, compare

    with output.progress(STEPS, quiet=as_json) as step:
        rows = compare(repeats=repeats, step=step)
    if as_json:
        typer.echo(output.document("bench", [row.row() for row in rows]))
        return
    grid = output.table(["what", "program", "", "aim"], numbers=(2,))
    for row in rows:
        grid.add_row(row.subject, row.program, f"{1e9 * row.value:,.1f} ns", row.target)
    output.console().print(grid)
    for row in rows:
        output.indented(f"{row.program}: {row.note}")
    output.say("The quickest of several runs of each, all in this one run of the command.")
