"""How late a thread wakes, as a histogram."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from ebac._util.arrays import Values
from ebac.plot.style import Picture, dress, legend, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.realtime import Cyclictest, Jitter

_OWN, _OTHER = "#009e73", "#0072b2"
#: Edges of the bins in a decade.
_BINS = 25


@takes_its_class("ebac.realtime")
def plot_jitter(found: Jitter, other: Cyclictest | None = None) -> Picture:
    """Draw how many wake-ups were how late, both axes logarithmic.

    Parameters
    ----------
    found : Jitter
        What `ebac.realtime.measure` returned.
    other : Cyclictest, optional
        The same of cyclictest.
    """
    figure = new_figure(8, 4.2)
    ax = figure.subplots()
    own: Values = 1e6 * np.maximum(found.lateness, 1e-7)
    most = max(own.max(), 1e6 * other.most if other else 0, 100)
    edges: Values = np.logspace(
        -1, np.ceil(np.log10(most)), round(_BINS * (np.ceil(np.log10(most)) + 1))
    )
    _bars(ax, own, np.ones(len(own)), edges, "ebac", found.row(), _OWN)
    if other is not None:
        micro = np.arange(len(other.counts), dtype=np.float64) + 0.5
        _bars(ax, micro, other.counts.astype(float), edges, "cyclictest", other.row(), _OTHER)
    ax.axvline(1e6 * found.dt, color="0.35", lw=1, ls=(0, (5, 3)), label="one tick")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_ylim(bottom=0.7)
    dress(ax, "wake-ups")
    ax.set_xlabel("lateness [µs]")
    legend(ax, 1)
    figure.suptitle(
        f"Lateness of wake-ups, measured on this machine: ticks of {1e3 * found.dt:g} ms",
        fontsize="medium",
    )
    return figure


def _bars(
    ax: Axes,
    values: Values,
    weights: Values,
    edges: Values,
    name: str,
    row: dict[str, float],
    colour: str,
) -> None:
    text = (
        f"{name}: {row['wakeups']:,} wake-ups, p50 {_micro(row['p50_s'])}, "
        f"p99.9 {_micro(row['p99_9_s'])}, latest {_micro(row['most_s'])}"
    )
    ax.hist(
        values, edges.tolist(), weights=weights, histtype="step", lw=1.6, color=colour, label=text
    )


def _micro(seconds: float) -> str:
    return f"{1e6 * seconds:,.0f} µs"
