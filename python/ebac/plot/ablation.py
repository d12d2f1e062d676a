"""An ablation as one table: rows are pieces, columns measures, colours what differs from the law as it is."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from ebac import wording
from ebac.plot.style import Picture, new_figure

if TYPE_CHECKING:
    from ebac.studies import Ablation, AblationRow

WORSE, BETTER, SAME = "#f4a582", "#a6d8a8", "0.95"


def plot_ablation(found: Ablation) -> Picture:
    """Draw an ablation: the law as it is, the law without each piece, other laws.

    Parameters
    ----------
    found : Ablation
        What `ebac.ablation` returned.

    Returns
    -------
    Figure
        Orange is worse than the law as it is, green better, grey no difference that matters.
    """
    rows = found.rows
    figure = new_figure(2.2 + 0.98 * len(found.measures), 2.1 + 0.34 * len(rows))
    ax = figure.subplots()
    for y, row in enumerate(rows):
        for x, measure in enumerate(found.measures):
            _cell(ax, x, y, row, measure.key)
            text = wording.cell(row.values[measure.key], measure.unit)
            ax.text(x, y, text, ha="center", va="center", fontsize="small")
    ax.set_xlim(-0.5, len(found.measures) - 0.5)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    names = [f"{fill(m.heading, 13)}\n[{wording.shown(m.unit)}]" for m in found.measures]
    ax.set_xticks(range(len(found.measures)), names, fontsize="x-small")
    ax.xaxis.tick_top()
    ax.set_yticks(range(len(rows)), [row.label for row in rows])
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    for border in (0.5, 0.5 + len(found.pieces)):
        ax.axhline(border, color="black", lw=1)
    hands = len(found.study.operators)
    ax.set_xlabel(
        f"{hands} hands, simulated. Beside {found.law} as it is: orange worse, green better, grey no difference that "
        "matters.",
        fontsize="small",
    )
    return figure


def _cell(ax: Axes, x: int, y: int, row: AblationRow, key: str) -> None:
    colour = WORSE if key in row.worse else BETTER if key in row.better else SAME
    corner = np.array([x, y]) - 0.48
    ax.add_patch(Rectangle((corner[0], corner[1]), 0.96, 0.96, color=colour, lw=0))
