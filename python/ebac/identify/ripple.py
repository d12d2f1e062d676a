"""What a motor's stair of forces does between two rows of the force sensor."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac.identify.levels import lagged
from ebac.identify.recording import Recording

Values = NDArray[np.float64]


def ripple(recording: Recording) -> Values:
    """Return how far the mean of the motor's force over the tick from each row on lies above its samples there [N].

    A drive holds its command for a tick. Behind its current loop and the lag of the sensor that stair is a curve with
    a ripple of one tick, and the rows always meet the same phase of it: read as a smooth force, it comes a few
    hundredths of a tick late or early, always to one side. Where the log has the motor's force, the mean is known:
    both lags are linear, and their answer to a stair has a closed form. Which share of it reaches the sensor is left
    to the fit. Zero where there is no motor.
    """
    if recording.motor is None:
        return np.zeros(len(recording.t))
    return stair(recording.motor, recording.dt, recording.current_lag, recording.lag)[1]


def stair(levels: Values, dt: float, first: float, second: float) -> tuple[Values, Values]:
    """Return a stair behind two lags [s]: at each row, and what its mean over the tick from there lies above that.

    `levels` holds over the interval that ends at each row. The mean of the samples is taken as the fit takes it, as
    that of a smooth curve through them.
    """
    ahead = np.append(levels[1:], levels[-1])  # of the tick to come
    if first == second:  # two equal poles: as near as makes no difference
        first, second = 1.01 * first, 0.99 * second
    if first == second == 0:
        return levels, ahead - _smooth_mean(levels)
    here, mean = np.zeros(len(levels)), np.zeros(len(levels))
    for lag, share in ((first, first / (first - second)), (second, second / (second - first))):
        follows = lagged(levels, dt, lag, stepping=True)
        kept = lag / dt * -np.expm1(-dt / lag) if lag > 0 else 0.0
        here += share * follows
        mean += share * (ahead + (follows - ahead) * kept)
    return here, mean - _smooth_mean(here)


def _smooth_mean(samples: Values) -> Values:
    """Return the mean over the tick from each row on of a smooth curve through samples, as the model takes it."""
    before = np.concatenate([samples[:1], samples[:-1]])
    after = np.append(samples[1:], samples[-1])
    sharp = samples - (after - 2 * samples + before) / 12
    return np.asarray(0.5 * (sharp + np.append(sharp[1:], sharp[-1])))
