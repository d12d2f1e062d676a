"""The search that breeds from the best."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ebac.studies.breeding import breed


class Hill:
    """A narrow hill in the unit cube, and every point at which it was measured."""

    def __init__(self, top: NDArray[np.float64]) -> None:
        self.top = top
        self.seen: list[NDArray[np.float64]] = []

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        self.seen += list(points)
        return np.asarray(-np.linalg.norm(points - self.top, axis=1))


def bred(top: NDArray[np.float64], runs: int, seed: int) -> Hill:
    random = np.random.default_rng(seed)
    points = random.random((20, len(top)))
    hill = Hill(top)
    breed(points, hill(points), hill, runs, random, children=16, parents=6, narrows=0.9)
    return hill


@given(runs=st.integers(0, 60), n=st.integers(1, 5), seed=st.integers(0, 99))
def test_as_many_points_as_asked_all_in_the_cube(runs: int, n: int, seed: int) -> None:
    hill = bred(np.full(n, 0.3), runs, seed)
    assert len(hill.seen) == 20 + runs
    assert all(((point >= 0) & (point <= 1)).all() for point in hill.seen)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("top", [[0.0, 1.0, 0.0], [0.2, 0.5, 0.9]])
def test_it_climbs_further_than_chance(top: list[float], seed: int) -> None:
    hill = bred(np.array(top), 200, seed)
    by_chance = Hill(hill.top)
    by_chance(np.random.default_rng(seed).random((220, 3)))
    best, other = (
        min(np.linalg.norm(point - hill.top) for point in one.seen) for one in (hill, by_chance)
    )
    assert best < 0.03
    assert best < other


def test_the_same_seed_gives_the_same_points() -> None:
    one, other = (bred(np.array([0.4, 0.6]), 50, 7) for _ in range(2))
    assert np.array_equal(one.seen, other.seen)
