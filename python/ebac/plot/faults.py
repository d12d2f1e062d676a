"""One case of a fault campaign: what the loop did about it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from ebac._util.arrays import Values
from ebac.plot.marks import FAULT_COLOUR, fault_name
from ebac.plot.style import Picture, dress, legend, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.faults import FaultCase

_STATES = {0: "idle", 1: "arm", 2: "run", 3: "stop", 4: "fault"}
_AXES = ("#0072b2", "#d55e00")


@takes_its_class("ebac.faults")
def plot_fault(case: FaultCase) -> Picture:
    """Draw position, current asked and applied, and state of a case, with the injected fault marked.

    Parameters
    ----------
    case : FaultCase
        What `ebac.faults.run_case` returned. All of it is simulation.
    """
    trace = case.trace
    t = 1e3 * trace["t"]
    figure = new_figure(8.5, 6.5)
    position, current, state = figure.subplots(3, 1, sharex=True, height_ratios=[2, 2, 1])
    for i in range(trace.axes):
        position.plot(t, 1e3 * trace.axis("true.x", i), color=_AXES[i], lw=1.4, label=f"axis {i}")
        current.plot(
            t, trace.axis("current", i), color=_AXES[i], lw=1.4, label=f"commanded, axis {i}"
        )
        applied = trace.axis("current_applied", i)
        current.plot(t, applied, color=_AXES[i], lw=1, ls=":", label=f"reported, axis {i}")
    state.step(t, trace["state"], where="post", color="black", lw=1.4)
    state.set_yticks(list(_STATES), list(_STATES.values()))
    state.set_ylim(-0.3, 4.3)
    for ax in (position, current, state):
        _mark(ax, case, t)
    dress(position, "position [mm]")
    dress(current, "current [A]")
    dress(state, "state")
    legend(position)
    legend(current)
    state.set_xlabel("time [ms]")
    figure.suptitle(_title(case), fontsize="medium", fontweight="bold")
    return figure


def _mark(ax: Axes, case: FaultCase, t: Values) -> None:
    last = len(t) - 1
    begin, end = min(case.at, last), min(case.at + case.ticks, last)
    ax.axvspan(t[begin], t[end], color="#e6ab02", alpha=0.25, lw=0, label="fault injected")
    faults = case.trace["fault"].nonzero()[0]
    if len(faults):
        ax.axvline(t[faults[0]], color=FAULT_COLOUR, lw=1.2, ls=(0, (5, 3)), label="fault found")


def _title(case: FaultCase) -> str:
    name = fault_name(case.trace) or "no fault found"
    ticks = "1 tick" if case.ticks == 1 else f"{case.ticks} ticks"
    lasts = ticks if case.ticks < len(case.trace) else "to the end"
    kind = case.kind.replace("_", " ")
    return f"Simulated fault: {kind} on axis {case.axis}, {lasts}: {name}\nlaw ebac, two simulated drives, 1 kHz"
