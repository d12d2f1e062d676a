"""The table of a benchmark: what was timed, in which program, and how many times what ebac takes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.peers import PeerRow


def show(rows: Sequence[PeerRow], quantity: Callable[[PeerRow], str], *, digits: int) -> None:
    """Print rows in sections of one subject; ratios with so many digits after the point."""
    grid = output.table(["what", "program", "", "times ebac", "aim"], numbers=(2, 3))
    last = ""
    for row in rows:
        if last and row.subject != last:
            grid.add_section()
        subject = "" if row.subject == last else row.subject
        times = "" if row.times_ebac is None else f"{row.times_ebac:,.{digits}f}"
        grid.add_row(subject, row.program, quantity(row), times, row.target)
        last = row.subject
    output.show(grid)


def show_with_notes(
    rows: Sequence[PeerRow], quantity: Callable[[PeerRow], str], how: str, *, digits: int
) -> None:
    """Print the table, what each program does, and how it was timed."""
    show(rows, quantity, digits=digits)
    output.say("What each program does:", style="bold")
    output.indented("\n".join({f"{row.program}: {row.note}": None for row in rows}))
    output.say(how)
