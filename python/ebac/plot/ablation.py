"""An ablation as one table: rows are pieces, columns measures, colours what differs from the law as it is."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch, Rectangle

from ebac._util import formatting
from ebac.plot.style import BETTER, SAME, WORSE, Picture, figure_legend, new_figure

if TYPE_CHECKING:
    from ebac.studies import Ablation, AblationRow


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
    rows = found.rows
    figure = new_figure(2.2 + 0.98 * len(found.measures), 2.7 + 0.34 * len(rows))
    ax = figure.subplots()
    for y, row in enumerate(rows):
        for x, measure in enumerate(found.measures):
            _cell(ax, x, y, row, measure.key)
            text = formatting.cell(row.values[measure.key], measure.unit)
            ax.text(x, y, text, ha="center", va="center", fontsize="small")
    ax.set_xlim(-0.5, len(found.measures) - 0.5)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    names = [f"{fill(m.heading, 13)}\n[{formatting.shown(m.unit)}]" for m in found.measures]
    ax.set_xticks(range(len(found.measures)), names, fontsize="x-small")
    ax.xaxis.tick_top()
    ax.set_yticks(range(len(rows)), [row.label for row in rows])
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)
    for border in (0.5, 0.5 + len(found.pieces)):
        ax.axhline(border, color="black", lw=1)
    hands = len(found.study.operators)
    figure.suptitle(
        f"Ablation of {found.law}, simulated with {hands} hands: each row is one change of the law\n"
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


def _cell(ax: Axes, x: int, y: int, row: AblationRow, key: str) -> None:
    colour = WORSE if key in row.worse else BETTER if key in row.better else SAME
    corner = np.array([x, y]) - 0.48
    ax.add_patch(Rectangle((corner[0], corner[1]), 0.96, 0.96, color=colour, lw=0))
