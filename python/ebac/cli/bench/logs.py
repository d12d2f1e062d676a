"""`ebac bench --logs`: how quickly logs are written and read."""

from __future__ import annotations

import typer

from ebac.cli import output


def run(*, as_json: bool) -> None:
    """Measure and print the results."""
    from ebac.peers import logs

    with output.progress(logs.STEPS, quiet=as_json) as step:
        rows = logs.compare_logs(step=step)
    if as_json:
        typer.echo(output.document("bench", [row.row() for row in rows]))
        return
    grid = output.table(["what", "program", "", "aim"], numbers=(2,))
    for row in rows:
        grid.add_row(row.subject, row.program, f"{row.value:,.0f} rows/s", row.target)
    output.show(grid)
    output.indented("\n".join({f"{row.program}: {row.note}": None for row in rows}))
