"""A force or a motor that stands at the end of its range shows less than there was: such rows count for nothing."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pushed_arm import TRUE, pushed_arm

from ebac import identify
from ebac.datasets import write
from ebac.identify import Recording
from ebac.identify.limits import at_limits


@pytest.fixture(scope="module")
def pushed() -> Recording:
    return pushed_arm()


def test_a_force_that_is_cut_counts_for_nothing_there(pushed: Recording) -> None:
    assert pushed.force is not None
    for share in (0.02, 0.06):
        most = float(np.quantile(np.abs(pushed.force), 1 - share))
        cut = replace(pushed, force=np.clip(pushed.force, -most, most))
        result = identify.fit_arm(cut)
        for name, true in TRUE.items():
            assert result[name].value == pytest.approx(true, rel=0.02), (share, name)
        assert any("the force stands at a limit of" in text for text in result.notes)
    assert not any("at a limit" in text for text in identify.fit_arm(pushed).notes)


def test_a_motor_that_is_cut_is_left_out_of_a_device(tmp_path: Path) -> None:
    right = identify.load(write("device", tmp_path))
    assert right.motor is not None
    most = 0.6 * float(np.abs(right.motor).max())
    cut = replace(right, motor=np.clip(right.motor, -most, most))
    result, true = identify.fit_device(cut), identify.fit_device(right)
    assert true.cut_rows == 0
    assert true.misses == ()
    assert result.cut_rows > 100
    assert "the record seems to be cut" in result.misses[0]
    for name in ("M_h", "B_h", "coulomb"):
        assert result.estimates[name].value == pytest.approx(true.estimates[name].value, rel=0.05)


def test_what_is_no_limit() -> None:
    t = np.arange(5000) * 1e-3
    noise = np.random.default_rng(1).normal(0, 0.01, t.size)
    wave = np.sin(2 * np.pi * t)
    assert not at_limits(wave + noise).any()
    assert not at_limits(np.round(2 * wave) / 2).any()  # a coarse step
    assert not at_limits(np.maximum(wave, 0.0)).any()  # a wall that is not touched
    assert not at_limits(np.repeat((wave + noise)[::10], 10)).any()  # a slow sensor
    assert at_limits(np.clip(wave + noise, -0.9, 0.9)).sum() > 500
    assert at_limits(np.minimum(wave, 0.9)).sum() > 500
