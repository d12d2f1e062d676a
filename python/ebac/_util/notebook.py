"""How results show themselves in a notebook: a small picture, and a table with units."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from ebac._util.report import cell, heading

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from ebac.trace.columns import ColumnInfo

#: Longer tables are cut in the middle, with a row that counts the rest.
MOST_ROWS = 40
#: Dots an inch of a small picture.
DPI = 72


def table(rows: Sequence[Mapping[str, Any]], *, most: int = MOST_ROWS) -> str:
    """Return rows as an HTML table: headings with units, numbers as people read them.

    Parameters
    ----------
    rows : sequence of mappings
        With the same keys, whose endings give the SI unit: `rest_m`, `least_energy_J`.
    most : int
        Show at most this many, first and last ones.
    """
    if not rows:
        return "<p>no rows</p>"
    head = "".join(f"<th>{escape(heading(key))}</th>" for key in rows[0])
    shown = list(rows)
    left_out = len(rows) - most
    if left_out > 0:
        shown = shown[: most // 2] + shown[len(rows) - most // 2 :]
    lines = [
        f"<tr>{''.join(f'<td>{escape(cell(key, value))}</td>' for key, value in row.items())}</tr>"
        for row in shown
    ]
    if left_out > 0:
        gap = f'<tr><td colspan="{len(rows[0])}">... {left_out} more ...</td></tr>'
        lines.insert(most // 2, gap)
    return f"<table><tr>{head}</tr>{''.join(lines)}</table>"


def table_of_columns(columns: Iterable[tuple[str, ColumnInfo, NDArray[Any]]]) -> str:
    """Return a folded table of columns: name, unit, first, last, least and largest value, meaning."""
    titles = ("column", "unit", "first", "last", "least", "most", "meaning")
    head = "<tr>" + "".join(f"<th>{title}</th>" for title in titles) + "</tr>"
    lines = [head, *(_column(*column) for column in columns)]
    return f"<details><summary>columns</summary><table>{''.join(lines)}</table></details>"


def _column(name: str, info: ColumnInfo, values: NDArray[Any]) -> str:
    numbers = values.astype(float)
    known = numbers[np.isfinite(numbers)]
    nan = float("nan")
    shown = [numbers[0], numbers[-1], known.min(), known.max()] if len(known) else [nan] * 4
    cells = "".join(f"<td>{number:.6g}</td>" for number in shown)
    return f"<tr><th>{escape(name)}</th><td>{info.unit}</td>{cells}<td>{escape(info.meaning)}</td></tr>"


def picture(draw: Callable[[], Figure]) -> str:
    """Return a figure as a small image inside the page.

    Parameters
    ----------
    draw : function
        Makes the figure; what it cannot draw (`ValueError`) is left out, as the table has the numbers too.
    """
    try:
        figure = draw()
    except ValueError:
        return ""
    file = BytesIO()
    figure.savefig(file, format="png", dpi=DPI)
    data = b64encode(file.getvalue()).decode("ascii")
    return f'<img alt="figure" style="max-width:100%" src="data:image/png;base64,{data}">'


def result(
    title: str, rows: Sequence[Mapping[str, Any]], draw: Callable[[], Figure] | None = None
) -> str:
    """Return what a result shows in a notebook: a line, a picture, a table."""
    image = picture(draw) if draw else ""
    return f"<p>{escape(title)}</p>{image}{table(rows)}"
