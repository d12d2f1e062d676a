"""A search of the unit cube that keeps the best points and breeds others from them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

#: Shares of the runs of a search: at random, and bred from the best; the rest is for a local one.
AT_RANDOM, BRED = 0.25, 0.6
#: The first and the least spread of a parameter's change.
SPREAD, LEAST_SPREAD = 0.15, 0.01


def breed(
    points: NDArray[np.float64],
    values: NDArray[np.float64],
    measure: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    runs: int,
    random: np.random.Generator,
    *,
    children: int = 40,
    parents: int = 10,
    narrows: float = 0.96,
) -> None:
    """Breed from the best: a child has some parameters of a parent changed, or a step between two others added.

    Parameters
    ----------
    points : array, shape (k, n)
        Points of the unit cube that were measured.
    values : array, shape (k,)
        What they came to; more is better.
    measure : callable
        Returns the values of points, shape (m, n), and keeps the best: nothing is returned here.
    runs : int
        Points to try.
    random : numpy.random.Generator
        Where chance comes from.
    children, parents : int
        Points of a generation, and the best that are kept for it.
    narrows : float
        Share of the spread that the next generation has.
    """
    spread = SPREAD
    n = points.shape[1]
    while runs > 0:
        best = np.argsort(-values, kind="stable")[:parents]
        points, values = points[best], values[best]
        k = min(children, runs)
        chosen, one, other = (points[random.integers(0, len(points), k)] for _ in range(3))
        changes = spread * random.normal(size=(k, n)) * (random.random((k, n)) < 0.5)
        steps = 0.5 * (one - other) * (random.random((k, 1)) < 0.5)
        born = np.clip(chosen + changes + steps, 0, 1)
        points = np.vstack([points, born])
        values = np.concatenate([values, measure(born)])
        spread = max(LEAST_SPREAD, narrows * spread)
        runs -= k
