"""Tables that lose nothing: where a row is too wide for the screen, its cells stand below one another."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Column, Table
    from rich.text import Text

#: A column with longer cells is prose, which may wrap; it gets at least so many characters.
PROSE = 26


def table(headings: Sequence[str], *, numbers: Sequence[int] = ()) -> Table:
    """Return an empty table; the columns `numbers` stand flush right."""
    from rich import box
    from rich.table import Table

    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    for i, heading in enumerate(headings):
        justify = "right" if i in numbers else "left"
        grid.add_column(heading, justify=justify, overflow="fold")  # type: ignore[arg-type]
    return grid


def show(grid: Table) -> None:
    """Print a table as wide as the screen, or every row as a block of lines."""
    from rich.console import Console

    screen = Console(highlight=False)
    columns = [[_text(cell) for cell in column.cells] for column in grid.columns]
    room = screen.width - 2 - 2 * len(columns)
    if (
        sum(max(_widest(cells), _word(c)) for c, cells in zip(grid.columns, columns, strict=True))
        > room
    ):
        least, prose = 0, 0
        for column, cells in zip(grid.columns, columns, strict=True):
            wide = _widest(cells)
            if wide > PROSE:
                prose += 1
                least += PROSE
            else:
                column.min_width = max(wide, _word(column))
                least += column.min_width
        if least > room:
            _stack(screen, grid, columns)
            return
    screen.print(grid)


def _stack(screen: Console, grid: Table, columns: list[list[Text]]) -> None:
    from rich.padding import Padding
    from rich.text import Text

    screen.print()
    headings = [_text(column.header) for column in grid.columns]
    for first, *cells in zip(*columns, strict=True):
        title = Text.assemble(headings[0], " ", first, style="bold") if headings[0] else first
        title.stylize("bold")
        screen.print(title)
        short, long = Text(), []
        for heading, cell in zip(headings[1:], cells, strict=True):
            if not cell.plain.strip():
                continue
            told = Text.assemble(heading, " " if heading else "", cell)
            if cell.cell_len > PROSE:
                long.append(told)
            else:
                short.append_text(Text(", ") if short else Text()).append_text(told)
        for text in [short, *long] if short else long:
            screen.print(Padding(text, (0, 0, 0, 2)))
    screen.print()


def _text(cell: object) -> Text:
    from rich.text import Text

    return Text.from_markup(cell) if isinstance(cell, str) else Text(str(cell))


def _widest(cells: Sequence[Text]) -> int:
    return max((cell.cell_len for cell in cells), default=0)


def _word(column: Column) -> int:
    words = _text(column.header).plain.split()
    return max(map(len, words), default=0)
