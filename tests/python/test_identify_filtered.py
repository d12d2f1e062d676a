"""A position that was filtered before it was logged: no fit to it goes without a remark."""

from dataclasses import replace

import numpy as np
import pytest
from pushed_arm import pushed_arm

from ebac import identify, simulate
from ebac.identify import Recording
from ebac.identify.cases import draw
from ebac.identify.parameters import HAND


def log(number: int) -> tuple[Recording, identify.Target, dict[str, float]]:
    case = draw(number, 41, 6.0)
    recording = Recording.from_trace(simulate(case.scenario, case.law))
    return recording, identify.Target.of(case.scenario.hand, recording.t), case.truth()


@pytest.mark.slow
@pytest.mark.parametrize("number", [23, 26])
def test_a_position_behind_a_filter_gets_a_remark(number: int) -> None:
    signal = pytest.importorskip("scipy.signal", reason="makes the filter")
    recording, target, truth = log(number)
    low_pass = signal.butter(2, 30, fs=1000)
    start = signal.lfilter_zi(*low_pass) * recording.x[0]
    x = np.asarray(signal.lfilter(*low_pass, recording.x, zi=start)[0])
    result = identify.fit_arm(replace(recording, x=x, count=0.0), target)
    off = [abs(result[name].value / truth[name] - 1) for name in HAND if result[name].determined]
    assert max(off) > 0.4, "it is wrong"
    assert "The errors are far from white, with an autocorrelation of 0." in result.misses[-1]
    assert identify.fit_arm(recording, target).misses == ()


@pytest.mark.slow  # 6 s
@pytest.mark.weekly
def test_a_force_that_is_held_gets_a_remark_where_a_recording_is_made_of_arrays() -> None:
    recording, target, truth = log(14)
    assert recording.force is not None
    rows = np.arange(len(recording.t)) // 10 * 10
    result = identify.fit_arm(replace(recording, force=recording.force[rows]), target)
    assert result["M0"].value > 1.2 * truth["M0"], "it is wrong"
    assert result.misses != ()


def test_a_right_log_of_100_hz_is_not_said_to_be_far_from_white() -> None:
    """At 20 Hz a force is no straight line between rows of 100 Hz: the autocorrelation is 0.6."""
    r = pushed_arm()
    assert r.force is not None
    slow = Recording(name="slow", t=r.t[2::10], x=r.x[2::10], force=r.force[2::10], count=r.count)
    result = identify.fit_arm(slow)
    assert max(abs(test.auto).max() for test in result.tests.values()) > 0.5
    assert result.misses == ()
