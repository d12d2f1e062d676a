"""Which points belong to a path when nearly half of them may lie anywhere.

1. Least trimmed squares: of all halves of the points, the one whose own fit has the least squares. It is sought among
   paths exactly through random subsets; the best of them are fitted to their nearest half again and again, each of
   these concentration steps with smaller squares (Rousseeuw and Leroy, Robust Regression and Outlier Detection, 1987;
   Rousseeuw and Van Driessen, Computing LTS regression for large data sets, 2006).
2. From that half outwards: fit, count what lies within the cut of the spread of what was counted, and again until
   nothing changes (Bab-Hadiashar and Suter, Robust segmentation of visual data using ranked unbiased scale
   estimate, Robotica, 1999).

The spread comes from counted points only. A median over all points grows with every outlier, 2.5 times with 45 % of
them, and so lets in what is near.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values

#: Fits a path to the first points and returns how far the second lie from it; None where the first have none.
Off = Callable[[Values, Values], Values | None]

#: Beyond this many standard deviations a point is an outlier (Iglewicz and Hoaglin, How to detect and handle outliers,
#: 1993). Of normal errors it takes one in 2150 away, and with them 0.3 % of the standard deviation.
CUT = 3.5
#: Random subsets: with half of the points outliers, each of 500 triples has one with a chance of (1 - 1/8)^500 = 1e-29.
SUBSETS = 500
#: The best of them, which are concentrated.
KEPT = 10
#: Points the half is sought in, evenly through a longer recording; all are counted.
MOST = 2000
STEPS = 50


def counted(points: Values, size: int, off: Off, floor: float) -> NDArray[np.bool_]:
    """Return which points belong to their path. Rows that are the same are one point: a rest is no majority.

    Parameters
    ----------
    points : array, shape (n, d)
    size : int
        Points that determine a path.
    off : function
        Takes points to fit and points to measure; returns |distances| of the latter, or None.
    floor : float
        What rounding may be; nothing nearer is an outlier.
    """
    _, first, same = np.unique(points, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # as recorded
    places = points[first[order]]
    inside = _grown(places, size, off, floor) if len(places) > size else np.ones(len(places), bool)
    among = np.empty(len(places), bool)
    among[order] = inside
    return among[same.reshape(-1)]


def _grown(points: Values, size: int, off: Off, floor: float) -> NDArray[np.bool_]:
    """Return which of different points belong to the path of the best half."""
    best = _best_half(points[:: 1 + (len(points) - 1) // MOST], size, off)
    distances = None if best is None else off(best, points)
    inside = np.ones(len(points), bool)
    if distances is None:
        return inside
    half = _half(len(points), size)
    inside = distances <= np.partition(distances, half - 1)[half - 1]
    for _ in range(STEPS):
        freedom = max(int(inside.sum()) - size, 2)
        spread = float(np.sqrt((distances[inside] ** 2).sum() / freedom))
        before, inside = inside, distances <= max(cut(freedom) * spread, floor)
        again = off(points[inside], points)
        if again is None or (inside == before).all():
            break
        distances = again
    return inside


def cut(freedom: int) -> float:
    """Return the quantile of Student's t that is as rare as `CUT` is of a normal distribution.

    A spread from few points is itself uncertain. Approximation of Gaver and Kafadar, A retrievable recipe for inverse
    t, The American Statistician 38 (1984).
    """
    return float(np.sqrt(freedom * np.expm1(CUT**2 * (freedom - 1.5) / (freedom - 1) ** 2)))


def _half(n: int, size: int) -> int:
    """Return the fewest points that bear the most outliers, (n - size) / 2 (Rousseeuw and Leroy, chapter 3)."""
    return (n + size + 1) // 2


def _best_half(points: Values, size: int, off: Off) -> Values | None:
    """Return the half with the least squares about its own path."""
    half = _half(len(points), size)
    random = np.random.default_rng(1)  # the same subsets for the same number of points
    starts: list[tuple[float, Values]] = []
    for _ in range(SUBSETS):
        found = off(points[random.choice(len(points), size, replace=False)], points)
        if found is not None:
            starts.append((_squares(found, half), found))
            starts = sorted(starts, key=lambda start: start[0])[:KEPT]
    ends = [_concentrated(points, found, half, off) for _, found in starts]
    if not ends:
        return None
    return points[_nearest(min(ends, key=lambda end: _squares(end, half)), half)]


def _concentrated(points: Values, distances: Values, half: int, off: Off) -> Values:
    """Fit to the nearest half until its squares fall no more."""
    for _ in range(STEPS):
        again = off(points[_nearest(distances, half)], points)
        if again is None or _squares(again, half) >= _squares(distances, half):
            break
        distances = again
    return distances


def _nearest(distances: Values, half: int) -> NDArray[np.intp]:
    return np.sort(np.argpartition(distances, half - 1)[:half])


def _squares(distances: Values, half: int) -> float:
    return float((np.partition(distances, half - 1)[:half] ** 2).sum())
