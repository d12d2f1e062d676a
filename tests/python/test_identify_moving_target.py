"""A hand that follows a path while a motor moves in steps that the log lacks: the path seems a little late."""

from dataclasses import replace

import numpy as np
import pytest

from ebac import identify
from ebac.identify.moving_target import of_late_paths

pytest.importorskip("scipy", reason="the independent simulator needs SciPy")
from walled_path import log


@pytest.mark.parametrize("seed", [1, 8, 11])
def test_the_interval_of_the_stiffness_holds_what_the_steps_leave_open(seed: int) -> None:
    """By 4 to 7 deviations K0 was beside the truth."""
    recording, target, truth = log(seed)
    estimate = identify.fit_arm(recording, target)["K0"]
    assert estimate.determined
    assert estimate.low <= truth["K0"] <= estimate.high
    assert estimate.high - estimate.low < 0.02 * truth["K0"]


def test_a_motor_that_was_recorded_or_a_target_that_is_held_leaves_nothing_open() -> None:
    recording, target, _ = log(3)
    result = identify.fit_arm(recording, target)
    driven = replace(recording, motor=np.gradient(recording.x))
    for problem, rows in (
        (result.problem, 1),
        (replace(result.problem, recordings=(driven,)), 0),
        (replace(result.problem, targets=(identify.Target.held(),)), 0),
    ):
        gains = problem.gains(result.values, result.force_noise)
        errors = problem.errors(result.values, gains)
        found = of_late_paths(problem, result.values, gains, errors)
        assert found.shape == (rows, len(errors))
