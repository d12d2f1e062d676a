"""What a recording takes from a `Trace`: its signals, and what its scenario says."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ebac.identify.target import Path
    from ebac.trace import Trace

#: Signals of a recording, and the columns of a trace they are.
OF_TRACE = {"x": "x", "force": "f_meas", "motor": "f_applied", "desired": "f_env"}


def signals_of(trace: Trace, axis: int) -> dict[str, NDArray[np.float64]]:
    """Return the signals of a recording that a trace has."""
    found = {
        key: np.array(trace.axis(column, axis), dtype=float)
        for key, column in OF_TRACE.items()
        if column in trace
    }
    if "est.weight" in trace:
        predicted, weight = (trace.axis(f"est.{name}", axis) for name in ("x_act", "weight"))
        found |= where_met(found["x"], predicted, weight)
    return found


def where_met(
    x: NDArray[np.float64], predicted: NDArray[np.float64], weight: NDArray[np.float64]
) -> dict[str, NDArray[np.float64]]:
    """Return the signal `met` of a loop with a state observer; none where it was never trusted."""
    return {"met": x + weight * (predicted - x)} if weight.any() else {}


def trace_facts(trace: Trace, axis: int) -> dict[str, Any]:
    """Return count, lags, mass, damping and rotor, path of the hand and a remark, where a trace has a scenario."""
    if trace.scenario is None:
        return {"count": 0.0, "lag": 0.0, "current_lag": 3e-4, "remarks": ()}
    device = trace.scenario.device
    count, lag = device.facts.count, device.sensor.lag
    said = f"count {1e3 * count:.4g} mm and sensor lag {1e3 * lag:.3g} ms from the scenario"
    return {
        "count": count,
        "lag": lag,
        "current_lag": device.drive.current_lag,
        "mass": device.mass if axis < 2 else None,  # a slide of three axes has another
        "damping": device.mechanics.damping,
        "rotor": device.reflected_mass if axis < 2 else None,
        "path": path_of(trace, axis),
        "remarks": (said,),
    }


def path_of(trace: Trace, axis: int) -> Path | None:
    """Return where the hand wanted to be along an axis, by the scenario of a trace; None without one."""
    if trace.scenario is None:
        return None
    paths = trace.scenario.hand.path
    return paths[min(axis, len(paths) - 1)]
