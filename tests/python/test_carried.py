"""An exception in a callback of NLopt ends the search and reaches who asked for it."""

import nlopt
import numpy as np
import pytest

from ebac._util.nlopt_callbacks import Carried


def search(fail_at: int) -> int:
    calls = 0
    optimiser = nlopt.opt(nlopt.LN_SBPLX, 1)
    carried = Carried(optimiser)

    def square(point: np.ndarray) -> float:
        nonlocal calls
        calls += 1
        if calls == fail_at:
            raise KeyboardInterrupt
        return float(point[0] ** 2)

    optimiser.set_min_objective(carried(square, instead=0.0))
    optimiser.set_maxeval(50)
    optimiser.optimize(np.array([0.7]))
    try:
        carried.settle()
    except KeyboardInterrupt:
        assert calls == fail_at  # nothing was tried after it
        raise
    return calls


def test_it_is_raised_and_nothing_is_tried_after_it() -> None:
    with pytest.raises(KeyboardInterrupt):
        search(fail_at=5)


def test_a_search_without_one_ends_by_itself() -> None:
    assert search(fail_at=10_000) > 5
