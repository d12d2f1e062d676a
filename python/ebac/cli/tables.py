"""Tables that lose nothing: one wider than the screen is printed in parts, each with the names of its rows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Column, Table
    from rich.text import Text

#: A column with longer cells is prose, which may wrap; it gets at least so many characters.
PROSE = 26
#: Characters between two columns, and where a table would not fit otherwise.
GAP, NARROW = 2, 1


def table(headings: Sequence[str], *, numbers: Sequence[int] = ()) -> Table:
    """Return an empty table; the columns `numbers` stand flush right."""
    from rich import box
    from rich.table import Table

    padding = (0, GAP - NARROW, 0, 0)
    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=padding, header_style="bold")
    for i, heading in enumerate(headings):
        justify = "right" if i in numbers else "left"
        grid.add_column(heading, justify=justify, overflow="fold")  # type: ignore[arg-type]
    return grid


def filled(grid: Table) -> Table:
    """Return a table without the columns that are empty, or "-", in every row."""
    return _part(
        grid, [i for i, c in enumerate(grid.columns) if any(x not in ("", "-") for x in c.cells)]
    )


def show(grid: Table) -> None:
    """Print a table; one wider than the screen with narrow gaps, and in parts where that is not enough."""
    from rich.console import Console

    screen = Console(highlight=False, emoji=False)
    every = list(range(len(grid.columns)))
    least = [_least(column) for column in grid.columns]
    gap, parts = GAP, _parts(grid, least, screen.width, GAP)
    narrow = _parts(grid, least, screen.width, NARROW)
    if len(narrow) < len(parts):
        gap, parts = NARROW, narrow
        grid.padding = 0
    for part in parts:
        shown = grid if part == every else _part(grid, part)
        _spread(shown, [least[i] for i in part], screen.width, gap)
        screen.print(shown)


def _spread(grid: Table, least: list[int], room: int, gap: int) -> None:
    """Set the widths of the columns: as wide as their cells where there is room, prose last."""
    spare = max(0, room - _width(least, gap))
    order = sorted(range(len(least)), key=lambda i: _widest(grid.columns[i]) > PROSE)
    for left, i in zip(range(len(order), 0, -1), order, strict=True):
        column = grid.columns[i]
        wanted = max(_widest(column), _text(column.header).cell_len, least[i])
        share = spare // left if _widest(column) > PROSE else spare
        more = min(wanted - least[i], share)
        column.width = least[i] + more
        spare -= more


def _parts(grid: Table, least: list[int], room: int, gap: int) -> list[list[int]]:
    """Return the columns of each part: those that name a row, and as many others as fit."""
    if _width(least, gap) <= room:
        return [list(range(len(least)))]
    names = _names(grid)
    if _width([*least[:names], max(least[names:], default=0)], gap) > room:
        names = 1
    parts = [list(range(names))]
    for i in range(names, len(least)):
        if len(parts[-1]) > names and _width([least[j] for j in (*parts[-1], i)], gap) > room:
            parts.append(list(range(names)))
        parts[-1].append(i)
    return parts


def _names(grid: Table) -> int:
    """Return how many columns name a row: those before the first number; without numbers, the first."""
    numbers = [i for i, column in enumerate(grid.columns) if column.justify == "right"]
    return max(1, numbers[0]) if numbers else 1


def _part(grid: Table, part: list[int]) -> Table:
    """Return a table of some columns; a name that stands for several rows is repeated in each."""
    numbers = [i for i, place in enumerate(part) if grid.columns[place].justify == "right"]
    new = table([str(grid.columns[i].header) for i in part], numbers=numbers)
    new.padding = grid.padding
    cells = [list(grid.columns[i].cells) for i in part]
    for y, row in enumerate(grid.rows):
        if y and not _text(cells[0][y]).plain:
            cells[0][y] = cells[0][y - 1]
        new.add_row(*(column[y] for column in cells), style=row.style, end_section=row.end_section)
    return new


def _width(columns: Sequence[int], gap: int) -> int:
    """Return the width of a table whose columns have these widths."""
    return sum(columns) + gap * (len(columns) - 1) + 2  # an empty column at either side


def _least(column: Column) -> int:
    """Return the least width of a column: prose may wrap, but no word of it breaks."""
    wide = _widest(column)
    if wide > PROSE:
        wide = max(PROSE, *(_word(cell) for cell in column.cells))
    return max(wide, _word(column.header))


def _widest(column: Column) -> int:
    lines = (line for cell in column.cells for line in _text(cell).split())
    return max((line.cell_len for line in lines), default=0)


def _word(cell: object) -> int:
    return max(map(len, _text(cell).plain.split()), default=0)


def _text(cell: object) -> Text:
    from rich.text import Text

    return Text.from_markup(cell) if isinstance(cell, str) else Text(str(cell))
