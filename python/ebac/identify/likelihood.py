"""The noise that makes the errors most likely, given the hand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac._core import ArmRecord
from ebac.identify.noise import rough
from ebac.identify.problem import Problem
from ebac.identify.search import loss

#: How far from what the force signal itself shows the noise may lie.
WIDEST = 300.0


def minus_two_log(
    record: ArmRecord, theta: NDArray[np.float64], force_noise: float, robust: float | None = None
) -> float:
    """Return -2 log of the likelihood, but for a constant; with Huber's loss beyond `robust` deviations."""
    gains = record.gains(theta, force_noise)
    e = record.innovations(theta, gains)
    return loss(e, robust) + gains.log_sum


def likely_noise(
    problem: Problem,
    values: NDArray[np.float64],
    before: NDArray[np.float64] | None = None,
    robust: float | None = None,
) -> NDArray[np.float64]:
    """Return the standard deviation of each recording's force [N], by golden section.

    It stands for all that moves a hand beside eq. (4), tremor too, as far as that is white.
    """
    found = []
    parts = zip(problem.records, problem.parameters.places, problem.recordings, strict=True)
    for i, (record, place, recording) in enumerate(parts):
        assert recording.force is not None
        theta = values[place]
        if before is None:
            centre = max(rough(recording.force), 1e-5 * float(np.ptp(recording.force)), 1e-9)
            reach = np.log(WIDEST)
        else:
            centre, reach = float(before[i]), 0.5
        found.append(_golden(record, theta, float(np.log(centre)), reach, robust))
    return np.array(found)


def _golden(
    record: ArmRecord,
    theta: NDArray[np.float64],
    centre: float,
    reach: float,
    robust: float | None,
) -> float:
    ratio = 0.6180339887498949

    def at(z: float) -> float:
        return minus_two_log(record, theta, float(np.exp(z)), robust)

    a, b = centre - 0.3 * reach, centre + reach
    c, d = b - ratio * (b - a), a + ratio * (b - a)
    f, g = at(c), at(d)
    while b - a > 0.04:
        if f < g:
            b, d, g = d, c, f
            c = b - ratio * (b - a)
            f = at(c)
        else:
            a, c, f = c, d, g
            d = a + ratio * (b - a)
            g = at(d)
    return float(np.exp(0.5 * (a + b)))
