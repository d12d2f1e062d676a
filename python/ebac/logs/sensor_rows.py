"""How old the force of each row is, and what the sensor said of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac import _core

if TYPE_CHECKING:
    from ebac.trace import Trace

#: A force sensor that reports an error, as the loop knows it.
ERROR = 3


def force_age(recorded: Trace, dt: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the age of each row's force [s]: as recorded, or by the times at which a simulated sensor sends."""
    if "ft.age" in recorded:
        return recorded.axis("ft.age").astype(float)
    if not _simulated(recorded):
        return np.zeros(len(recorded))
    sensor, t = _sensor(recorded), _device_time(recorded, dt)
    stopped = _stopped(sensor, t)
    sent = np.floor(t / sensor.period) * sensor.period if sensor.period > 0 else t
    age = t - np.maximum.accumulate(np.where(stopped, 0.0, sent))
    return np.where(stopped & sensor.repeats, 0.0, age)


def force_status(recorded: Trace, dt: NDArray[np.float64]) -> NDArray[np.uint32]:
    """Return 0 for each row whose force was good, 3 for others: by a simulated sensor, or as an observer took note."""
    if _simulated(recorded):
        sensor = _sensor(recorded)
        force = np.abs(recorded["f_meas"].reshape(len(recorded), -1)).max(axis=1)
        bad = force >= sensor.range
        if sensor.disconnects:
            bad |= _stopped(sensor, _device_time(recorded, dt))
    elif "est.fallback" in recorded:
        bad = recorded.axis("est.fallback") == int(_core.Fallback.FORCE_STATUS)
    else:
        bad = np.zeros(len(recorded), dtype=bool)
    return np.where(bad, ERROR, 0).astype(np.uint32)


def _simulated(recorded: Trace) -> bool:
    return recorded.scenario is not None and "true.x" in recorded


def _device_time(recorded: Trace, dt: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the time of each row [s], added up as a simulated device does, so that it is the same to the bit."""
    return np.asarray(recorded["t"][0] + np.cumsum(dt))


def _sensor(recorded: Trace) -> _core.ForceSensor:
    assert recorded.scenario is not None
    return recorded.scenario.device.sensor


def _stopped(sensor: _core.ForceSensor, t: NDArray[np.float64]) -> NDArray[np.bool_]:
    return (t >= sensor.stops_at) & (t < sensor.resumes_at)
