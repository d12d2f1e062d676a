"""What an encoder leaves open of every place: its zero lies anywhere within a count."""

from __future__ import annotations

from math import erf, exp, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from ebac.identify.parameters import kind
from ebac.identify.problem import Problem
from ebac.identify.result import Z95


def with_counts(problem: Problem, found: NDArray[np.float64]) -> NDArray[np.float64]:
    """Add what the encoder leaves open of every place: its zero lies anywhere within a count.

    A place is off by the sum of a normal error and of one that is uniform over a count, the same one for all places.
    What is added makes it the normal error whose 95 % are as wide as those of that sum.
    """
    p = problem.parameters
    count = max(r.count for r in problem.recordings)
    out = found.copy()
    more = np.zeros(len(p.free))
    for row, i in enumerate(p.free):
        if kind(p.names[i]) == "X0":
            variance = max(float(found[row, row]), 0.0)
            half = half_width(sqrt(variance), count)
            more[row] = sqrt(max((half / Z95) ** 2 - variance, 0.0))
    return np.asarray(out + np.outer(more, more))


def half_width(deviation: float, count: float) -> float:
    """Return h such that 95 % of the sum of a normal and of an error uniform over a count lie within +-h.

    The widths do not add as squares: where both are alike, that would be 6 % too short and hold 93 %.
    """
    if deviation <= 1e-6 * count:
        return 0.475 * count
    if deviation > 100 * count:  # a count more or less is nothing
        return Z95 * deviation
    low, high = 0.0, Z95 * deviation + 0.5 * count
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = 2 * _mean_below(middle / deviation, count / deviation) - 1
        low, high = (middle, high) if inside < 0.95 else (low, middle)
    return high


def _below(z: float) -> float:
    """Return the probability of a standard normal below z."""
    return 0.5 * (1 + erf(z / sqrt(2)))


def _mean_below(z: float, width: float) -> float:
    """Return the probability below z of a normal whose centre lies anywhere within +-width/2."""

    def area(to: float) -> float:  # under the distribution function
        return to * _below(to) + exp(-0.5 * to * to) / sqrt(2 * pi)

    return (area(z + 0.5 * width) - area(z - 0.5 * width)) / width
