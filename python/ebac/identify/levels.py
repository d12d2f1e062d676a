"""The target as a regressor: what share of each row belongs to which level."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac.identify.recording import Recording
from ebac.identify.target import Target


def indicators(recording: Recording, target: Target) -> NDArray[np.float64]:
    """Return one row per level, shape (levels, rows): the share of the tick before that it held, behind the lag."""
    edges = np.array([-np.inf, *target.switches, np.inf])
    t, dt = recording.t, recording.dt
    from_, to = np.maximum(edges[:-1, None], t - dt), np.minimum(edges[1:, None], t)
    shares = np.clip(to - from_, 0.0, dt) / dt
    out = np.zeros((target.levels, len(t)))
    np.add.at(out, np.asarray(target.segments), shares)
    return np.array([lagged(row, dt, recording.lag, stepping=True) for row in out])


#: A lag has settled after so many of its time constants: to 1e-11.
SETTLES = 25


def lagged(
    values: NDArray[np.float64], dt: float, lag: float, *, stepping: bool = False
) -> NDArray[np.float64]:
    """Return a signal behind a first-order lag [s], by its impulse response.

    Between two rows it is straight; `stepping`, it has the value of a row since the row before.
    """
    if lag <= 0:
        return values
    keep = np.exp(-dt / lag)
    response = keep ** np.arange(int(np.ceil(SETTLES * lag / dt)) + 1)
    if not stepping:
        ramp = lag / dt * (1 - keep)
        response = np.concatenate([[1 - ramp], ramp * (1 - keep) * response])
    response /= response.sum()
    padded = np.concatenate([np.full(len(response) - 1, values[0]), values])
    return np.convolve(padded, response, mode="valid")
