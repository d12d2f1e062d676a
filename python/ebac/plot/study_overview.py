"""The overview of a study: good hands and energy drawn, law by law and condition by condition."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from ebac._util import descriptions
from ebac._util.plural import plural
from ebac.plot.style import Picture, new_figure

if TYPE_CHECKING:
    from ebac.studies import Study

#: How opaque the colours of a table are, and below which luminance its text is white.
OPAQUE, DARK = 0.75, 0.45
#: Room for a letter and for a line of a name in a table [inch], the letters of a line, and the least width of a cell
#: [inch].
LETTER, LINE, LETTERS, CELL = 0.08, 0.14, 12, 1.0
#: Laws that stand side by side below each of two tables.
BELOW = 7
#: Letters of a line of a name above a panel, or beside a table.
LONG = 20


def overview(study: Study, *, narrow: bool) -> Picture:
    """Draw two tables beside each other, or one below the other where it is `narrow`."""
    laws, names = list(study.laws), [c.name for c in study.conditions]
    rows = {(row.condition, row.law): row for row in study.rows}
    every = [[rows[name, law] for law in laws] for name in names]
    good = [[_percent(r.good, r.hands) for r in line] for line in every]
    still = [[_percent(r.exact_and_still, r.hands) for r in line] for line in every]
    drawn = [
        [None if r.most_drawn_J is None else 1e3 * r.most_drawn_J for r in line] for line in every
    ]
    across, down = [wrapped(law) for law in laws], names
    if _turned(laws, names, narrow=narrow):
        across, down = names, [wrapped(law, LONG) for law in laws] if narrow else laws
        good, still, drawn = ([*map(list, zip(*one, strict=True))] for one in (good, still, drawn))
    room = (5 - _wide(down)) / len(across)
    upright, stacked = narrow and room < _wide(across), narrow and room < CELL
    below = _wide(across) if upright else _high(across)
    if narrow:
        row = max(0.44 if stacked else 0.24, LINE + _high(down))
        figure = new_figure(5, 2.2 + 2 * (below + row * len(down)))
        left, right = figure.subplots(2, 1)
    else:
        panel = max(3.2, max(CELL, _wide(across)) * len(across))  # a title has room
        figure = new_figure(_wide(down) + 2 * panel, 1.3 + below + 0.24 * len(down))
        left, right = figure.subplots(1, 2, sharey=True)
    figure.narrow = partial(overview, study, narrow=True)
    _table(left, good, {"cmap": "RdYlBu", "vmin": 0, "vmax": 100}, _short, still, stacked=stacked)
    left.set_title("good hands [%]; in brackets: exact and still", fontsize="medium")
    log: dict[str, Any] = {"cmap": "YlOrRd", "norm": LogNorm(1e-2, 1e5, clip=True)}
    _table(right, drawn, log, _energy, stacked=stacked)
    right.set_title("most energy drawn in any window", fontsize="medium")
    figure.suptitle(
        f"Study, simulated with {plural(len(study.operators), 'hand')}\n"
        f"{descriptions.describe(study.scenarios[0]).split('; ')[0]}, changed as each condition says",
        fontsize="medium",
    )
    for ax in (left, right):
        ax.set_xticks(range(len(across)), across, fontsize="small", rotation=90 * upright)
        ax.set_yticks(range(len(down)), down)
        ax.tick_params(length=0)
        ax.spines[:].set_visible(False)
    return figure


def _turned(laws: list[str], names: list[str], *, narrow: bool) -> bool:
    """Return whether laws stand beside the tables, since their names have no room below.

    Below two tables there is room for `BELOW` laws, in one column of a journal for as many as have the letters.
    """
    if len(names) > len(laws):
        return False
    room = (5 - _wide(names)) / len(laws)
    return room < _wide([wrapped(law) for law in laws]) if narrow else len(laws) > BELOW


def _wide(names: list[str]) -> float:
    """Return the room that names take beside a table [inch]."""
    return LETTER * max(len(line) for name in names for line in name.split("\n"))


def _high(names: list[str]) -> float:
    """Return the room that names take below a table [inch]."""
    return LINE * max(1 + name.count("\n") for name in names)


def _percent(count: int | None, hands: int) -> float | None:
    return None if count is None else 100 * count / hands


def _table(
    ax: Axes,
    cells: list[list[float | None]],
    style: dict[str, Any],
    words: Callable[[float], str],
    beside: list[list[float | None]] | None = None,
    *,
    stacked: bool,
) -> None:
    """Draw a table in colours; numbers of `beside` stand in brackets where they are larger.

    `stacked`: unit and brackets stand in a line of their own.
    """
    values = np.array([[np.nan if cell is None else cell for cell in line] for line in cells])
    shown = np.where(values == 0, 1e-9, values) if "norm" in style else values
    image = ax.imshow(shown, aspect="auto", alpha=OPAQUE, **style)
    for (row, column), value in np.ndenumerate(values):
        known = "-" if np.isnan(value) else words(value)
        more = None if beside is None else beside[row][column]
        if more is not None and more > value:
            known += f" ({words(more)})"
        known = known.replace(" ", "\n") if stacked else known
        red, green, blue = OPAQUE * np.array(image.to_rgba(shown[row, column])[:3]) + 1 - OPAQUE
        dark = 0.2126 * red + 0.7152 * green + 0.0722 * blue < DARK
        ax.text(
            column, row, known, ha="center", va="center", fontsize="small",
            color="white" if dark else "black",
        )  # fmt: skip


def wrapped(law: str, letters: int = LETTERS) -> str:
    """Return the name of a law in lines of few letters, broken behind hyphens and between words."""
    lines = [""]
    for part in re.findall(r"[^-_ ]+[-_ ]*|[-_ ]+", law):
        if lines[-1] and len(lines[-1]) + len(part.rstrip()) > letters:
            lines.append("")
        lines[-1] += part
    return "\n".join(line.rstrip() for line in lines)


def _short(value: float) -> str:
    """Return a share [%] in few characters."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}" if value >= 0.1 else f"{value:.1g}"


def _energy(value: float) -> str:
    """Return an energy [mJ] in few characters, from 1 J on in J."""
    if value >= 999.5:
        return f"{value / 1e3:.1f} J" if value < 99.95e3 else f"{value / 1e3:.0f} J"
    if 0 < value < 1e-3:
        return "<0.001 mJ"
    return f"{value:.0f} mJ" if value >= 99.5 or value == 0 else f"{value:.2g} mJ"
