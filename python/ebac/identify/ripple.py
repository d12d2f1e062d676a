"""What a motor's stair of forces does between two rows of the force sensor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac.identify.levels import lagged
from ebac.identify.recording import Recording

Values = NDArray[np.float64]


def ripple(recording: Recording) -> Values:
    """Return how far the mean force over the tick from each row on lies above its samples there [N], shape (rows,).

    A drive holds its command for a tick. Behind its current loop and the lag of the sensor that stair is a curve with
    a ripple of one tick, and the rows always meet the same phase of it: read as a smooth force, it comes a few
    hundredths of a tick late or early, always to one side. Where the log has the motor's force, the mean is known:
    both lags are linear, and their answer to a stair has a closed form. Which share of it reaches the sensor is left
    to the fit. Zero where there is no motor.
    """
    n, dt = len(recording.t), recording.dt
    if recording.motor is None:
        return np.zeros(n)
    first, second = recording.current_lag, recording.lag
    if abs(first - second) < 1e-3 * max(first, second):  # two equal poles: as near as makes no difference
        second *= 1.01
    ahead = np.append(recording.motor[1:], recording.motor[-1])  # the level of the tick to come
    if first == second == 0:
        return ahead - _smooth_mean(ahead)
    here, mean = np.zeros(n), np.zeros(n)
    for lag, share in ((first, first / (first - second)), (second, second / (second - first))):
        follows = lagged(recording.motor, dt, lag)
        kept = lag / dt * -np.expm1(-dt / lag) if lag > 0 else 0.0
        here += share * follows
        mean += share * (ahead + (follows - ahead) * kept)
    return mean - _smooth_mean(here)


def _smooth_mean(samples: Values) -> Values:
    """Return the mean over the tick from each row on of a smooth curve through samples, as the model takes it."""
    before = np.concatenate([samples[:1], samples[:-1]])
    after = np.append(samples[1:], samples[-1])
    sharp = samples - (after - 2 * samples + before) / 12
    return np.asarray(0.5 * (sharp + np.append(sharp[1:], sharp[-1])))
