"""The stiffest walls: which share of the hands each law holds, over the stiffness."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ebac._util import descriptions
from ebac._util.plural import plural
from ebac.plot.style import Picture, colours, dress, figure_legend, new_figure, plain_decades
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies.stiffest_result import Stiffest

#: Panels abreast, and in one column of a journal.
ABREAST, NARROW = 5, 2
#: How the share of each criterion is drawn, and what it is called.
LINES: dict[str, tuple[str, dict[str, Any]]] = {
    "exact_and_still": ("exact and still", {"ls": (0, (1, 2)), "lw": 1.4}),
    "good": ("good: quiet in force, too", {"lw": 1.8, "marker": "o", "ms": 3.5}),
    "good_in_time": ("good and in time: settled soon, too", {"ls": (0, (5, 3)), "lw": 1.4}),
}
#: How the share that a law needs is drawn.
NEEDED: dict[str, Any] = {"color": "0.6", "lw": 0.8}


@takes_its_class("ebac.studies.stiffest_result")
def plot_stiffest(found: Stiffest) -> Picture:
    """Draw a panel for each law, the best first: the share of the hands that meet each criterion over the stiffness.

    Parameters
    ----------
    found : Stiffest
        What `ebac.stiffest` returned.

    Returns
    -------
    Figure
        Behind the name of a law stands the stiffest wall up to which it is good for enough hands.
    """
    return _draw(found, ABREAST)


def _draw(found: Stiffest, abreast: int) -> Picture:
    columns = min(abreast, len(found.rows))
    lines = -(-len(found.rows) // columns)
    width = 5.0 if abreast == NARROW else 1.0 + 2.7 * max(columns, 2)
    figure = new_figure(width, 1.4 + 1.9 * lines)
    figure.narrow = partial(_draw, found, NARROW)
    grid = figure.subplots(lines, columns, squeeze=False, sharex=True, sharey=True)
    laws = list(found.study.laws)
    shades = colours(laws)
    for place, ax in enumerate(grid.flat):
        if place >= len(laws):
            ax.remove()
            continue
        row = found.rows[place]
        _panel(ax, found, laws.index(row.law), shades[row.law])
        dress(ax, "share of hands [%]" if place % columns == 0 else "")
        limit = row.good_N_per_m
        more = " or more" if limit == found.stiffnesses[-1] else ""
        good = "none good" if limit is None else f"good to {1e-3 * limit:g} kN/m{more}"
        ax.set_title(f"{row.law}\n{good}", fontsize="small", color=shades[row.law])
        if place + columns >= len(laws):
            ax.set_xlabel("stiffness of the wall [kN/m]")
            ax.tick_params(which="both", labelbottom=True)
    ax = grid[0, 0]
    ax.set_ylim(-4, 104)
    ax.set_xscale("log")
    plain_decades(ax.xaxis)
    known = [LINES[name] for name in LINES if name in found.counts]
    handles = [Line2D([], [], color="0.3", **style) for _, style in known]
    handles.append(Line2D([], [], **NEEDED))
    needed = f"needed: {plural(found.needed, 'hand')} of {found.hands}"
    figure_legend(figure, handles, [*(name for name, _ in known), needed])
    device, _, *others = descriptions.describe(found.base).split("; ")
    figure.suptitle(
        f"Which walls each law holds for {found.hands} hands, simulated: {device}; {others[-2]}",
        fontsize="medium",
    )
    return figure


def _panel(ax: Axes, found: Stiffest, law: int, shade: str) -> None:
    for name, counts in found.counts.items():
        share = 100 * counts[law] / found.hands
        ax.plot(1e-3 * found.stiffnesses, share, color=shade, clip_on=False, **LINES[name][1])
    ax.axhline(100 * found.needed / found.hands, **NEEDED, zorder=0)
    if len(found.stiffnesses) == 1:
        ax.set_xlim(*(1e-3 * found.stiffnesses[0] * np.array([0.5, 2])))
