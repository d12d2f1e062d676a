"""How late a loop was, and the faults that come of it."""

from __future__ import annotations

from collections.abc import Sequence

from ebac._core import Fault
from ebac.simulation import LoopFault
from ebac.trace import Trace

#: Faults that a machine brings about which is too late or too busy.
BY_TIME = frozenset(
    {
        Fault.DRIVE_SILENT,
        Fault.HEARTBEAT_LOST,
        Fault.ENCODER_JUMP,
        Fault.OVERSPEED,
        Fault.FORCE_STALE,
        Fault.OVERRUNS,
    }
)
#: Keys of a configuration that make a loop patient with a machine without real time.
PATIENT = {
    Fault.DRIVE_SILENT: "bus.silent = 50 or more",
    Fault.FORCE_STALE: "limits.force_age = 0.2 or more",
    Fault.OVERRUNS: "limits.overruns = 100 and limits.pause = 0.5 or more",
}
#: Those of motion, which a late loop sees only where it skips ticks.
BY_MOTION = frozenset({Fault.ENCODER_JUMP, Fault.OVERSPEED})


def loop_fault(trace: Trace, nodes: Sequence[int] = ()) -> LoopFault | None:
    """Return the error of a loop that ended by a fault, with a note where it was late; None without a fault.

    `nodes` are the node ids of the drives by axis, where they are known.
    """
    fault = Fault(int(trace["fault"][-1])) if len(trace) else Fault.NONE
    if fault is Fault.NONE:
        return None
    error = LoopFault(fault, trace, nodes=nodes)
    if late := lateness_of(fault, trace):
        error.add_note(f"the loop {late}; {remedy(fault)}")
    return error


def explained(fault: LoopFault, instead: str = "", file: str = "") -> str:
    """Return what a command says of a fault: what happened, how late the loop was, and what to do first.

    Parameters
    ----------
    fault : LoopFault
        The fault.
    instead : str
        Another way to run the same, named where the loop was late.
    file : str
        Name of the configuration, where it is known; the remedy then names it.
    """
    notes: list[str] = getattr(fault, "__notes__", [])
    text = str(fault).partition("; see")[0]
    then = fault.remedy.replace(" FILE`", f" {file}`") if file else fault.remedy
    if "`ebac doctor`" in then and lateness_of(fault.fault, fault.trace):
        then = ""  # the note on the lateness says so
    late = [*notes, instead if notes else ""]
    if fault.fault is Fault.OVERSPEED and not instead:  # on hardware a wrong sign is more probable
        return "; ".join(filter(None, [text, then, *late]))
    return "; ".join(filter(None, [text, *late, then]))


def lateness_of(fault: Fault, trace: Trace) -> str:
    """Return how late the loop was, where that may have led to a fault; else nothing."""
    if fault not in BY_TIME or (fault in BY_MOTION and not trace["skipped"].any()):
        return ""
    return lateness(trace)


def lateness(trace: Trace) -> str:
    """Return how late the loop was: "woke up to 12.3 ms late and skipped 14 ticks"; empty on a virtual clock."""
    most = 1e3 * float(trace["lateness"].max(initial=0.0))
    skipped = int(trace["skipped"].sum())
    if most == 0 and skipped == 0:
        return ""
    return (
        f"woke up to {most:.3g} ms late and skipped {skipped:,} tick{'' if skipped == 1 else 's'}"
    )


def remedy(fault: Fault) -> str:
    """Return what to do first about a fault of a loop that was late."""
    first = "`ebac doctor` says what this machine lacks for real time"
    patient = PATIENT.get(fault)
    more = (
        f"; without hardware, or with nobody at the handle, let the loop be late: {patient}"
        if patient
        else ""
    )
    last = {
        Fault.DRIVE_SILENT: "; only then look at `bus.missing`, `bus.late`, cables and termination",
        Fault.OVERRUNS: "; end other load on the machine, `ebac jitter` measures what is left",
    }
    return f"{first}{more}{last.get(fault, '')}"
