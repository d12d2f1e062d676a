"""What outliers are, and a start that half of the points being outliers cannot spoil."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]

#: Tukey's biweight gives no weight beyond this many standard deviations; 95 % efficient for normal errors.
CUT = 4.685
#: The median of |d| of a normal distribution is this many standard deviations.
MEDIAN = 0.6745
#: Random subsets tried for the start: with half the points outliers, all fail with a chance below 1e-20.
SUBSETS = 500
STEPS = 50


def start(
    points: Numbers, size: int, distances: Callable[[Numbers], Numbers | None]
) -> NDArray[np.bool_]:
    """Return the half of the points nearest to the exact path through the best subset (least median of squares).

    Parameters
    ----------
    points : array, shape (n, d)
    size : int
        Points that determine a path.
    distances : function
        Takes `size` points; returns |distances| of all points [m], or None where they determine no path.
    """
    random = np.random.default_rng(1)  # the same subsets for the same number of points
    best, least = None, np.inf
    for _ in range(SUBSETS):
        found = distances(points[random.choice(len(points), size, replace=False)])
        median = np.inf if found is None else float(np.median(found))
        if median < least:
            best, least = found, median
    if best is None:
        return np.ones(len(points), bool)
    return np.asarray(best <= np.median(best))


def weights(distances: Numbers, floor: float) -> Numbers:
    """Return Tukey's weights of |distances| [m], their scale from the median; `floor` is what rounding may be [m]."""
    scale = max(float(np.median(distances)) / MEDIAN, floor)
    u = distances / (CUT * scale)
    return np.where(u < 1, (1 - u**2) ** 2, 0.0)
