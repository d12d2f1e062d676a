"""A recorded log as hardware: yesterday's session for a new law."""

from __future__ import annotations

import warnings
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._util.arguments import require
from ebac._util.kept_law import KeptLaw, law_error
from ebac.laws import AnyLaw, design, law_name
from ebac.laws.protocols import is_core_law
from ebac.laws.tuned_laws import on_its_observer
from ebac.laws.variant import law_text
from ebac.logs.log import Log
from ebac.logs.sensor_rows import force_age, force_status
from ebac.scenario import Scenario

if TYPE_CHECKING:
    from ebac._core import Device
    from ebac.trace import Trace

#: The state of a loop in which the law acts, in the column `state` of a log that has one.
RUN = 2

#: How the events of a log begin that change what a replay computes.
_CHANGES = ("law ", "environment")
#: What a replay reads of each axis: the name of the argument, the column.
_EACH = {
    "counts": "counts",
    "current_applied": "current_applied",
    "force": "f_meas",
    "f_env": "f_env",
    "f_cmd": "f_cmd",
    "current": "current",
}


def replay(
    log: Trace | Log | str | Path,
    law: AnyLaw = "ebac",
    *,
    scenario: Scenario | None = None,
    **changes: Any,
) -> Trace:
    """Drive a law with a recorded log, open loop: what it would have commanded had the handle moved as it did.

    Encoder counts, currents applied, measured forces and the time of each tick come from the log; estimation,
    kinematics, virtual world, law and limits are those of the loop. The law that was recorded, with its parameters,
    gives the recorded commands to the bit, for a log from its first tick on without gaps (to rounding where static
    compensation has a soft start). At a gap the time of the tick is that since the row before. The age of a
    simulated force is computed from the sensor's `period` and stops.

    **Limits of a replay**: nothing the law commands reaches hand or device. Whether a contact is stable, where
    it would rest, and how the hand would have answered stay unknown; energies are those of the recorded force along
    the recorded path. A law that seems calm here may swing on the device. Use it to see what a law does with real
    noise, real timing and real encoder steps, and to check a law for errors.

    Parameters
    ----------
    log : Trace, Log, str or Path
        A log of at least one row, or the file of one.
    law : str, law class, Variant, law or PythonLaw
        As for `simulate`: a name is designed for the scenario's device and timing.
    scenario : Scenario, optional
        Device, virtual world and timing; that of the log, if not given. Its hand is not used.
    **changes
        Parameters to set on top of the design, in their SI units.

    Returns
    -------
    Trace
        The rows in which the law ran, with the new law's `f_env`, `f_cmd`, `current`, `law.*`, and what was recorded
        beside them: `log.f_env`, `log.f_cmd`, `log.current`. It ends early where the log ends in a fault.

    Raises
    ------
    ValueError
        When the log has no rows, lacks a column, has no scenario, or has other axes than the device.
    LoopFault
        When a stage of the replay gave no finite number, or a law in Python raised an error; carries the trace.

    Warns
    -----
    UserWarning
        For a log whose law or virtual world was changed while it ran: a replay keeps those of the start.
    """
    from ebac.trace import Trace

    recorded = _ran(_trace_of(log))
    require(scenario, (Scenario, NoneType), "ebac.replay", "a Scenario")
    scenario = recorded.scenario if scenario is None else scenario
    if scenario is None:
        raise ValueError(
            "replay: the log has no scenario, so device and virtual world are unknown; give scenario=..."
        )
    _check(recorded)
    scenario = on_its_observer(scenario, law)
    source = _source(recorded, scenario.device)
    source.observer = scenario.designed_observer()
    finished = design(law, scenario.device, scenario.known_timing, **changes)
    errors: list[BaseException] = []
    if is_core_law(finished):
        rows = finished._replay(source, scenario.device, scenario.environment)
    else:
        kept = KeptLaw(finished, errors)
        rows = _core._replay_python(source, kept, scenario.device, scenario.environment)
    trace = Trace.from_rows(
        rows, scenario=scenario, law=law_name(finished), law_repr=law_text(finished)
    )
    trace = trace.with_column("tick", recorded["tick"][: len(trace)])
    return _unless_faulty(trace, law_error(errors))


def _trace_of(log: Trace | Log | str | Path) -> Trace:
    from ebac.logs import read
    from ebac.logs.files import load
    from ebac.trace import Trace

    if isinstance(log, (str, Path)) and Path(log).suffix.lower() == ".mcap":
        log = read(log)
    if isinstance(log, Log):
        _warn_of_changes(log)
        return log.trace
    require(log, (Trace, str, Path), "ebac.replay", "a Trace, a Log or the path of one")
    trace = log if isinstance(log, Trace) else load(log)
    if trace.changed:
        _warn("")
    return trace


def _warn_of_changes(log: Log) -> None:
    """Warn where law or world were changed while the log was recorded, or before the part of it."""
    made = [e for e in log.events if e.kind == "parameter" and e.message.startswith(_CHANGES)]
    if made:
        shown = f"{made[0].message} at {made[0].t:g} s"
        more = f" and {len(made) - 1} more" if len(made) > 1 else ""
        _warn(f" ({shown}{more})")
    elif log.trace.changed:
        _warn("")


def _warn(when: str) -> None:
    warnings.warn(
        f"replay: law or world were changed while this log was recorded{when}; the replay keeps those of the start, so "
        "from there on it is no longer what ran",
        stacklevel=5,
    )


def _ran(recorded: Trace) -> Trace:
    """Return the rows in which the law ran: not those before the drives were enabled, nor those of a stop."""
    if "state" not in recorded:
        return recorded
    ran = np.flatnonzero(recorded["state"] == RUN)
    if len(recorded) and not len(ran):
        raise ValueError("replay: the log has no row in which the law ran (state 2)")
    return recorded.rows(int(ran[0]), int(ran[-1]) + 1) if len(ran) else recorded


def _check(recorded: Trace) -> None:
    missing = [
        name
        for name in ("tick", "dt", "lateness", "fault", *_EACH.values())
        if name not in recorded
    ]
    if missing:
        raise ValueError(f"replay: the log has no column {', '.join(missing)}")
    if len(recorded) == 0:
        raise ValueError("replay: the log has no rows")


def _source(recorded: Trace, device: Device) -> _core.ReplayLog:
    t = recorded["t"]
    dt = recorded.axis("dt").copy()
    gap = np.flatnonzero(np.diff(recorded["tick"]) != 1) + 1
    dt[gap] = t[gap] - t[gap - 1]
    dt[0] = 0
    fault = recorded["fault"].astype(np.uint32)
    each = {name: _per_axis(recorded, column) for name, column in _EACH.items()}
    gain = recorded["ramp"] if "ramp" in recorded else _gain(recorded, device)
    return _core.ReplayLog(
        t=t,
        dt=dt,
        lateness=recorded["lateness"],
        counts_age=_counts_age(recorded, dt),
        force_age=force_age(recorded, dt),
        force_status=force_status(recorded, dt),
        # What a stage of the loop found, the loop finds again, or not: that is for the new law to show.
        fault=np.where(fault >= int(_core.Fault.DEVICE), fault, 0),
        gain=gain,
        came=np.diff(gain, prepend=gain[0]) if "ramp" in recorded else np.zeros(len(gain)),
        **each,
    )


def _gain(recorded: Trace, device: Device) -> NDArray[np.float64]:
    """Return the gain with which the currents of each row were sent, of a log without `ramp`."""
    gain = np.ones(len(recorded))
    if "limited" not in recorded or "tau" not in recorded:
        return gain
    peak = device.drive.peak_current(device.motor)
    asked = _per_axis(recorded, "tau") / (device.motor.torque_constant * device.capstan.ratio)
    asked = np.clip(asked, -peak, peak)
    gain[(asked == 0).all(axis=1)] = 0  # nothing is asked of motors that are given nothing
    ramped = np.flatnonzero(recorded["limited"] & int(_core.Limited.RAMP))
    most = np.abs(asked).argmax(axis=1)[ramped]
    asked, sent = (of[ramped, most] for of in (asked, _per_axis(recorded, "current")))
    known = (recorded["limited"][ramped] == int(_core.Limited.RAMP)) & (asked != 0)
    if known.any():  # where another limit cut as well it is between those before and after
        shares = np.clip(sent[known] / asked[known], 0.0, 1.0)
        gain[ramped] = np.interp(recorded["t"][ramped], recorded["t"][ramped][known], shares)
    return gain


def _counts_age(recorded: Trace, dt: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how old the counts of each row were [s], from the ticks without an answer in a log of drives."""
    ages = np.zeros((len(recorded), recorded.axes))
    if "bus.age" not in recorded:
        return ages
    ticks = _per_axis(recorded, "bus.age")
    for row, axis in zip(*np.nonzero(ticks), strict=True):  # few: in the order of the rows
        before = ages[row - 1, axis] if ticks[row, axis] > 1 and row > 0 else 0.0
        ages[row, axis] = before + dt[row]
    return ages


def _per_axis(recorded: Trace, column: str) -> NDArray[Any]:
    values = recorded[column]
    return values.reshape(len(values), -1)


def _unless_faulty(trace: Trace, of_law: Exception | None) -> Trace:
    from ebac.simulation import LoopFault

    fault = _core.Fault(int(trace["fault"][-1]))
    if of_law is not None or 0 < int(fault) < int(_core.Fault.DEVICE):
        raise LoopFault(fault, trace, law=of_law) from of_law
    return trace
