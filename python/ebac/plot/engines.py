"""Laws before a slow engine: how the handle moves with its force held and with its local model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ebac.metrics import ideal_rest
from ebac.plot.marks import mark_cut
from ebac.plot.style import IDEAL, Picture, dress, figure_legend, line, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies.engines import Engines

#: Colour, width, order and label of each way to render.
STYLES = {
    "force held": ("#d55e00", 0.9, 1, "engine, its force held"),
    "every tick": ("0.55", 2.6, 2, "computed in every tick"),
    "local model": ("#0072b2", 1.1, 3, "engine, its local model"),
}
#: Seconds shown, and millimetres about the rest.
SHOWN, ABOUT = 1.5, 20.0


@takes_its_class("ebac.studies.engines")
def plot_engines(found: Engines) -> Picture:
    """Draw the position under each law, a column for each rate of the engine.

    Parameters
    ----------
    found : Engines
        What `ebac.studies.engines` returned.

    Returns
    -------
    Figure
        Where a held force shakes by more than a panel shows, the panel gives its range.
    """
    laws = list(dict.fromkeys(row.law for row in found.rows))
    rates = list(dict.fromkeys(row.rate_Hz for row in found.rows if row.rate_Hz is not None))
    figure = new_figure(1.6 + 4.0 * len(rates), 1.4 + 1.7 * len(laws))
    grid = figure.subplots(len(laws), len(rates), squeeze=False, sharex=True, sharey=True)
    ideal = ideal_rest(found.base)
    middle = 1e3 * (ideal if ideal is not None else float(np.median(found.traces[0]["x"])))
    for row, trace in zip(found.rows, found.traces, strict=True):
        tint, width, order, label = STYLES[row.rendered]
        shown = trace["t"] <= SHOWN
        for ax, rate in zip(grid[laws.index(row.law)], rates, strict=True):
            if row.rate_Hz in (None, rate):
                x = 1e3 * trace.axis("true.x" if "true.x" in trace else "x", 0)[shown]
                line(ax, trace["t"][shown], x, color=tint, lw=width, zorder=order, label=label)
    for ax, law in zip(grid[:, 0], laws, strict=True):
        dress(ax, f"{law}\nposition [mm]")
    jitter = next(row.jitter_s for row in found.rows if row.rate_Hz is not None) or 0.0
    for ax, rate in zip(grid[0], rates, strict=True):
        ax.set_title(f"engine at {rate:g} Hz, {1e3 * jitter:g} ms of jitter", fontsize="medium")
        ax.set_ylim(middle - ABOUT, middle + ABOUT)
        ax.set_xlim(0, SHOWN)
    for ax in grid.flat:
        dress(ax, ax.get_ylabel())
        drawn = np.concatenate([one.get_ydata() for one in ax.get_lines()])
        mark_cut(ax, drawn.min(), drawn.max(), "mm")
        if ideal is not None:
            ax.axhline(middle, **IDEAL, zorder=4, label=f"ideal rest, {middle:.3f} mm")
    for ax in grid[-1]:
        ax.set_xlabel("time [s]")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure_legend(figure, handles, labels)
    from ebac._util import descriptions

    parts = descriptions.describe(found.base).split("; ")
    figure.suptitle(f"A slow engine, simulated: {'; '.join(parts[:3])}", fontsize="medium")
    return figure
