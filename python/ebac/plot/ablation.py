"""An ablation as one table: rows are pieces, columns measures, colours what differs from the law as it is."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch, Rectangle

from ebac._util import formatting
from ebac._util.plural import plural
from ebac.plot.style import BETTER, SAME, WORSE, Picture, figure_legend, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies import Ablation, AblationRow
    from ebac.studies.measures import Measure

#: Measures abreast in one column of a journal.
ABREAST = 5


@takes_its_class("ebac.studies")
def plot_ablation(found: Ablation) -> Picture:
    """Draw an ablation: the law as it is, the law without each piece, other laws.

    Parameters
    ----------
    found : Ablation
        What `ebac.ablation` returned.

    Returns
    -------
    Figure
        Orange is worse than the law as it is, blue better, grey no difference that matters.
    """
    return _draw(found, len(found.measures))


def _draw(found: Ablation, abreast: int) -> Picture:
    """Draw this many measures abreast, and the others below them."""
    measures, rows = found.measures, found.rows
    bands = [measures[i : i + abreast] for i in range(0, len(measures), abreast)]
    high = 1.4 * len(bands) + 1.3 + 0.34 * len(rows) * len(bands)
    figure = new_figure(2.2 + 0.98 * abreast, high)
    figure.narrow = partial(_draw, found, ABREAST)
    for ax, band in zip(figure.subplots(len(bands), 1, squeeze=False)[:, 0], bands, strict=True):
        _band(ax, found, band, abreast)
    hands = len(found.study.operators)
    figure.suptitle(
        f"Ablation of {found.law}, simulated with {plural(hands, 'hand')}: each row is one change of the law\n"
        f"{found.study.conditions[0].summary}, where a heading has no other",
        fontsize="medium",
    )
    marks = (
        (WORSE, f"worse than {found.law} as it is"),
        (BETTER, "better"),
        (SAME, "no difference that matters"),
    )
    patches = [Patch(color=shade) for shade, _ in marks]
    figure_legend(figure, patches, [label for _, label in marks])
    return figure


def _band(ax: Axes, found: Ablation, measures: Sequence[Measure], abreast: int) -> None:
    rows = found.rows
    for y, row in enumerate(rows):
        for x, measure in enumerate(measures):
            _cell(ax, x, y, row, measure.key)
            ax.text(
                x,
                y,
                _text(row.values[measure.key], measure.unit),
                ha="center",
                va="center",
                fontsize="small",
            )
    ax.set_xlim(-0.5, abreast - 0.5)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    wide = 13 if abreast == len(found.measures) else 10
    names = [f"{fill(m.heading, wide)}\n[{formatting.shown(m.unit)}]" for m in measures]
    ax.set_xticks(range(len(measures)), names, fontsize="x-small")
    ax.xaxis.tick_top()
    ax.set_yticks(range(len(rows)), [row.label for row in rows])
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    for border in (0.5, 0.5 + len(found.pieces)):
        ax.hlines(border, -0.5, len(measures) - 0.5, color="black", lw=1)


def _text(value: float | None, unit: str) -> str:
    """Return a number in the unit of its column; an energy from 1 J on in J, as elsewhere."""
    if unit == "J" and value is not None and abs(value) >= 1:
        return f"{value:.1f} J"
    return formatting.cell(value, unit)


def _cell(ax: Axes, x: int, y: int, row: AblationRow, key: str) -> None:
    colour = WORSE if key in row.worse else BETTER if key in row.better else SAME
    corner = np.array([x, y]) - 0.48
    ax.add_patch(Rectangle((corner[0], corner[1]), 0.96, 0.96, color=colour, lw=0))
