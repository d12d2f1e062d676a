"""Titles that say what a figure shows, and marks for the end of a run: the ramp to zero, a fault; and for changes."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from ebac._core import Fault
from ebac._util import descriptions
from ebac.laws import LAWS
from ebac.metrics import observer_use
from ebac.scenario import Scenario
from ebac.trace import Trace

if TYPE_CHECKING:
    from ebac.logs import Event

#: The state of the loop in which it ramps the force to zero.
_STOP = 3
#: What a scenario in words says of its observer.
_OBSERVER = ", state observer(?: that learns the scale)? for (every law|laws made for it)"
FAULT_COLOUR, RAMP_COLOUR = "#aa0044", "0.88"


def title(trace: Trace) -> str:
    """Return law, origin and scenario of a trace, and the fault that ended it.

    Parameters
    ----------
    trace : Trace
        Of a simulation, a device, or a log played again.
    """
    name = f"law {trace.law}" if trace.law else "a run"
    fault = fault_name(trace)
    end = f"\nended by {fault} at {_fault_time(trace):.3f} s" if fault else ""
    if "log.f_cmd" in trace:
        return (
            f"{name}, over a recorded log: the handle moved as recorded, whatever is commanded{end}"
        )
    if trace.scenario is None:
        return f"{name}, {trace.origin}{end}"
    parts = for_laws(descriptions.describe(trace.scenario), [trace]).split("; ")
    if "true.x" in trace:
        return f"{name}, {trace.origin}: {parts[0]}; {parts[1]}\n{'; '.join(parts[2:])}{end}"
    if "f_env" not in trace:  # no loop's: of a gastroscopy, whose world is the patient
        return f"{name}, {trace.origin}: {parts[0]}{end}"
    # a person's hand is not that of the scenario
    return f"{name}, {trace.origin}: {parts[0]}\n{'; '.join(parts[2:-1])}{end}"


def acts_on_observer(trace: Trace) -> bool:
    """Whether the law of a run acts on the estimate of a state observer."""
    use = observer_use(trace)
    return use is not None and use.fallback.get("off", 0.0) < 1


def no_beta(trace: Trace) -> str:
    """Return why beta has no numbers in a run whose law records it."""
    own = hasattr(LAWS.get(trace.law.partition(" ")[0]), "observer")
    if own and acts_on_observer(trace):
        return f"with the state observer {trace.law} does not limit beta"
    return "no numbers"


def for_laws(described: str, traces: Sequence[Trace]) -> str:
    """Return a scenario in words, of whose state observer it says which of the laws use it."""
    if not all("est.bound" in trace for trace in traces):
        return described  # of another program: who knows
    users = [trace.law for trace in traces if acts_on_observer(trace)]
    by = ""
    if users:
        by = ", state observer"
        by += f" used by {', '.join(dict.fromkeys(users))} only" if len(users) < len(traces) else ""
    return re.sub(_OBSERVER, by, described)


def for_law(described: str, law: str) -> str:
    """Return a scenario in words for a law by its name: nothing of a state observer that it does not use."""
    found = re.search(_OBSERVER, described)
    every = found is not None and found[1] == "every law"
    if law not in LAWS and not every:
        return described  # a law of a user's: who knows
    uses = hasattr(LAWS.get(law), "observer") or every
    return re.sub(_OBSERVER, ", state observer" if uses else "", described)


def heading(scenario: Scenario, source: str = "simulated") -> str:
    """Return two lines for a figure of several runs of one scenario: device and hand, wall and time."""
    parts = descriptions.describe(scenario).split("; ")
    return f"{source}: {parts[0]}; {parts[1]}\n{'; '.join(parts[2:])}"


def fault_name(trace: Trace) -> str:
    """Return the fault that ended a run, "fault 4 (law not finite)"; empty without one."""
    if "fault" not in trace or not trace["fault"].any():
        return ""
    number = int(trace["fault"][trace["fault"].nonzero()[0][0]])
    try:
        return f"fault {number} ({Fault(number).name.lower().replace('_', ' ')})"
    except ValueError:
        return f"fault {number}"


def _fault_time(trace: Trace) -> float:
    return float(trace["t"][trace["fault"].nonzero()[0][0]])


def mark_end(ax: Axes, trace: Trace, *, label: bool = True) -> None:
    """Mark the time over which the force is ramped to zero, and the instant of a fault."""
    t = trace["t"]
    if "state" in trace:
        ramp = t[trace["state"] == _STOP]
        if len(ramp) > 1:
            text = "force ramped to zero" if label else "_"
            ax.axvspan(ramp[0], ramp[-1], color=RAMP_COLOUR, lw=0, zorder=0, label=text)
    if fault := fault_name(trace):
        ax.axvline(
            _fault_time(trace),
            color=FAULT_COLOUR,
            lw=1.2,
            ls=(0, (4, 2)),
            label=fault if label else "_",
        )


def mark_changes(panels: Sequence[Axes], changes: Sequence[Event]) -> None:
    """Mark changes in every panel that shows their time, with their numbers along the upper edge."""
    numbers: dict[float, list[str]] = {}
    for number, change in enumerate(changes, start=1):
        numbers.setdefault(change.t, []).append(str(number))
    for ax in panels:
        low, high = ax.dataLim.x0, ax.dataLim.x1
        for t, those in numbers.items():
            if low <= t <= high:
                ax.axvline(t, color="0.35", lw=0.9, ls="--", zorder=1.8)
                ax.annotate(
                    ", ".join(those), (t, 1), xycoords=ax.get_xaxis_transform(), xytext=(2, -2),
                    textcoords="offset points", va="top", fontsize="small", color="0.25",
                )  # fmt: skip


def mark_cut(ax: Axes, least: float, most: float, unit: str) -> None:
    """Name the range of what is drawn where it goes beyond the panel."""
    low, high = ax.get_ylim()
    if least < low or most > high:
        ax.text(
            0.98, 0.97, f"cut: {least:.3g} to {most:.3g} {unit}", ha="right", va="top",
            transform=ax.transAxes, fontsize="small",
            bbox={"color": "white", "alpha": 0.8, "pad": 1},
        )  # fmt: skip


def used_axes(trace: Trace) -> list[int]:
    """Return the axes on which something moved or acted; the first one where nothing did."""
    names = [n for n in ("x", "f_env", "f_cmd", "f_applied") if n in trace]
    used = [i for i in range(trace.axes) if any(trace.axis(n, i).any() for n in names)]
    return used or [0]
