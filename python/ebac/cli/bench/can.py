"""`ebac bench --can`: the bus in numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from ebac.cli import output
from ebac.cli.bench import table

if TYPE_CHECKING:
    from ebac.peers import PeerRow


def run(repeats: int, *, as_json: bool) -> None:
    """Measure and print the results."""
    from ebac._util.background import Background
    from ebac.peers import bus, exchange, sdo

    with output.progress(exchange.STEPS + bus.STEPS + sdo.STEPS, quiet=as_json) as step:

        def compare() -> list[PeerRow]:
            rows = exchange.compare(repeats=repeats, step=step)
            rows += bus.compare_buses(repeats=max(3, repeats // 10), step=step)
            return rows + sdo.compare_reads(step=step)

        # A call into the core takes seconds; this thread receives Ctrl-C meanwhile.
        rows = Background(compare).result()
    if as_json:
        typer.echo(output.document("bench", [row.row() for row in rows]))
        return
    how = "The quickest of several runs of each, answers of one run, all in this one run of the command."
    table.show_with_notes(rows, _quantity, how, digits=2)


def _quantity(row: PeerRow) -> str:
    if row.unit == "1/s":
        return f"{row.value:,.0f} frames/s"
    return f"{1e6 * row.value:,.2f} µs"
