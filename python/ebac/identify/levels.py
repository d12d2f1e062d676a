"""The target as a regressor: what share of each row belongs to which level."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac.identify.recording import Recording
from ebac.identify.target import Target


def indicators(recording: Recording, target: Target) -> NDArray[np.float64]:
    """Return one row per level, shape (levels, rows): 1 where it holds, behind the sensor's lag."""
    t = recording.t
    segment = np.searchsorted(np.asarray(target.switches), t, side="left")
    level = np.asarray(target.segments)[segment]
    out = (level == np.arange(target.levels)[:, None]).astype(float)
    return np.array([lagged(row, recording.dt, recording.lag) for row in out])


#: A lag has settled after so many of its time constants: to 1e-11.
SETTLES = 25


def lagged(values: NDArray[np.float64], dt: float, lag: float) -> NDArray[np.float64]:
    """Return a signal behind a first-order lag [s], by its impulse response."""
    if lag <= 0:
        return values
    taps = int(np.ceil(SETTLES * lag / dt)) + 1
    response = np.exp(-dt * np.arange(taps) / lag)
    response /= response.sum()
    padded = np.concatenate([np.full(taps - 1, values[0]), values])
    return np.convolve(padded, response, mode="valid")
