"""The worst hand of a search over time: depth, force, its pull, and the energy it drew."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from ebac._util import descriptions, formatting
from ebac.plot.marks import for_law, mark_cut
from ebac.plot.style import QUANTITIES, Picture, colour, dress, legend, line, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies import Worst, WorstHand
    from ebac.trace import Trace

#: What the right column shows around the instant of least energy [s].
NEAR = 0.15


@takes_its_class("ebac.studies")
def plot_worst(found: Worst, hand: WorstHand | None = None) -> Picture:
    """Draw a hand of a search, by default the worst: the whole run, and the instant at which most is drawn.

    Parameters
    ----------
    found : Worst
        What `ebac.worst` returned.
    hand : WorstHand, optional
        One of its hands.

    Returns
    -------
    Figure
    """
    chosen = hand or found.hands[0]
    trace = found.trace(chosen)
    figure = new_figure(13, 9.5)
    grid = figure.subplots(4, 2, sharex="col", width_ratios=(3, 2))
    least = float(
        trace["t"][int(trace["true.energy"].reshape(len(trace), -1).sum(axis=1).argmin())]
    )
    for column in grid.T:
        _depth(column[0], trace)
        _force(column[1], trace, found.law)
        _pull(column[2], trace, found)
        _energy(column[3], trace, found)
        for ax in column:
            ax.axvline(least, color="0.6", lw=0.8, ls=":")
        column[-1].set_xlabel("time [s]")
    for ax in grid[:, 0]:
        legend(ax, columns=5)
    grid[0, 1].set_title("around the least energy (dotted line)", fontsize="medium")
    for ax in grid[:, 1]:
        ax.set_ylabel("")
    from_, to = max(0.0, least - NEAR), min(float(trace["t"][-1]), least + NEAR)
    grid[0, 1].set_xlim(from_, to)
    shown = trace.axis("true.x", 0)[(trace["t"] >= from_) & (trace["t"] <= to)] - _surface(trace)
    room = 0.1e3 * max(float(np.ptp(shown)), 1e-5)
    grid[0, 1].set_ylim(1e3 * float(shown.min()) - room, 1e3 * float(shown.max()) + room)
    figure.align_ylabels()
    figure.suptitle(_title(found, chosen), fontsize="medium")
    return figure


def _title(found: Worst, hand: WorstHand) -> str:
    reserve = (
        f" (reserve: {formatting.quantity(found.reserve, 'J')})"
        if found.reserve is not None
        else ""
    )
    values = ", ".join(
        f"{p.name} {formatting.quantity(hand.values[p.name], p.unit)}"
        for p in hand.family.parameters
    )
    device, _, wall, timing, *_ = for_law(descriptions.describe(hand.scenario), found.law).split(
        "; "
    )
    world = f"{device}; {wall}; {timing}"
    quick = found.pull_rate
    if quick is not None:
        values += f"; own force at most {formatting.quantity(quick, 'N/s')}"
    return (
        f"law {found.law}, {found.condition.name}, simulated: {world}\nthe worst hand of the family "
        f"{hand.family.name} draws {formatting.quantity(hand.energy_J, 'J')}{reserve}\n{values}"
    )


def _surface(trace: Trace) -> float:
    assert trace.scenario is not None
    return float(getattr(trace.scenario.environment, "position", 0.0))


def _depth(ax: Axes, trace: Trace) -> None:
    depth = 1e3 * (trace.axis("true.x", 0) - _surface(trace))
    line(ax, trace["t"], depth, color=colour(trace.law), label="depth in the wall")
    ax.axhline(0, color="0.35", lw=1)
    dress(ax, "depth [mm]")


def _force(ax: Axes, trace: Trace, law: str) -> None:
    t = trace["t"]
    commanded, applied = trace.axis("f_cmd", 0), trace.axis("f_applied", 0)
    asked = trace.axis("f_env", 0)
    line(ax, t, asked, color="black", lw=0.6, label="environment, $F_e$")
    line(ax, t, commanded, color=QUANTITIES["f_cmd"], lw=2.2, label="commanded")
    line(ax, t, applied, color=colour(law), lw=1.0, label="applied")
    low, high = float(commanded.min()), float(commanded.max())
    room = 0.15 * max(high - low, 1.0)
    ax.set_ylim(low - room, high + room)  # what is asked may go far beyond
    mark_cut(ax, float(asked.min()), float(asked.max()), "N")
    dress(ax, "force [N]")


def _pull(ax: Axes, trace: Trace, found: Worst) -> None:
    scenario, t = trace.scenario, trace["t"]
    assert scenario is not None
    acts = np.any([trace.axis(n, 0) != 0 for n in ("f_env", "f_cmd", "f_applied")], axis=0)
    pull = np.where(acts, scenario.hand.pull(t, trace.axis("true.x", 0)), np.nan)
    ax.plot(t, pull, color="#d55e00", lw=1.2, label="pull of the hand, in contact")
    ax.axhline(found.pull, color="0.35", lw=1, ls="--", label=f"allowed, {found.pull:g} N")
    ax.set_ylim(0, 1.15 * found.pull)
    dress(ax, "pull [N]")


def _energy(ax: Axes, trace: Trace, found: Worst) -> None:
    t = trace["t"]
    true = trace["true.energy"].reshape(len(trace), -1).sum(axis=1)
    deepest, most = min(float(true.min()), -(found.reserve or 0.0), -0.5e-3), float(true.max())
    factor, unit = (1e3, "mJ") if deepest > -1 else (1.0, "J")
    line(ax, t, factor * true, color=colour(found.law), lw=1.6, label="port energy")
    for name in ("law.energy", "law.account"):
        if name in trace:
            account = trace.axis(name, 0)
            line(ax, t, factor * account, color="black", lw=0.8, label="account of the law")
            most = max(most, float(account.max()))
    if found.reserve is not None:
        ax.axhline(-factor * found.reserve, color="#d55e00", lw=1, ls="--", label="reserve")
    ax.axhline(0, color="0.35", lw=1)
    # what is drawn is judged: what else flows in or is held may go far beyond
    ax.set_ylim(factor * 1.2 * deepest, factor * (-0.15 * deepest + min(most, -2 * deepest)))
    dress(ax, f"energy [{unit}]")
