"""A force that comes late or through a filter, undeclared: it is said, and the intervals hold what it does."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from pushed_arm import TRUE, pushed_arm
from typer.testing import CliRunner

from ebac import identify, simulate
from ebac.cli import app
from ebac.datasets import write
from ebac.identify import Recording
from ebac.identify.cases import draw
from ebac.identify.parameters import lay_out
from ebac.identify.problem import Problem
from ebac.identify.whole_ticks import delays, profile


@pytest.fixture(scope="module")
def pushed() -> Recording:
    return pushed_arm()


def late(values: NDArray[np.float64], rows: int) -> NDArray[np.float64]:
    return np.concatenate([np.full(rows, values[0]), values[:-rows]])


def filtered(values: NDArray[np.float64], lag: float) -> NDArray[np.float64]:
    out, keep = np.empty_like(values), np.exp(-1e-3 / lag)
    state = values[0]
    for i, value in enumerate(values):
        state = value + (state - value) * keep
        out[i] = state
    return out


def force_of(recording: Recording) -> NDArray[np.float64]:
    assert recording.force is not None
    return recording.force


def holds(result: identify.ArmResult) -> bool:
    return all(result[n].low <= true <= result[n].high for n, true in TRUE.items())


def test_a_right_log_is_not_late(pushed: Recording) -> None:
    for recording in (pushed, replace(pushed, motor=None)):
        result = identify.fit_arm(recording)
        assert result.late is None
        assert result.misses == ()


@pytest.mark.parametrize("motor", [True, False])
def test_a_force_three_rows_late_is_named(pushed: Recording, motor: bool) -> None:
    recording = replace(pushed, force=late(force_of(pushed), 3))
    result = identify.fit_arm(recording if motor else replace(recording, motor=None))
    assert result.late is not None
    assert result.late.delay == pytest.approx(3e-3, abs=1e-4)
    assert result.late.lag is None
    assert "The force seems to be 3 ms late" in result.misses[0]
    assert "--free delay" in result.misses[0]
    assert holds(result)
    assert result.to_dict()["force_late_s"] == result.late.delay


def test_a_position_ten_rows_late_is_named(pushed: Recording) -> None:
    result = identify.fit_arm(replace(pushed, x=late(pushed.x, 10)))
    assert result.late is not None
    assert result.late.delay == pytest.approx(-10e-3, abs=2e-4)
    assert "The position seems to be 10 ms late" in result.misses[0]


@pytest.mark.slow
@pytest.mark.weekly
def test_a_filter_is_distinguished_from_a_delay(pushed: Recording) -> None:
    recording = replace(pushed, force=filtered(force_of(pushed), 2e-3))
    result = identify.fit_arm(recording)
    assert result.late is not None
    assert result.late.lag == pytest.approx(2e-3, rel=0.25)
    assert "--lag 0.00" in result.misses[0]
    assert holds(result)
    declared = identify.fit_arm(replace(recording, lag=2e-3))
    assert declared.late is None


def test_a_delay_that_is_given_is_not_late(pushed: Recording) -> None:
    recording = replace(pushed, force=late(force_of(pushed), 3))
    assert identify.fit_arm(recording, fixed={"delay": 3e-3}).late is None
    free = identify.fit_arm(recording, free=["delay"])
    assert free.late is None
    assert free["delay"].value == pytest.approx(3e-3, abs=1e-4)
    assert free["delay"].low <= 3e-3 <= free["delay"].high
    for name, true in TRUE.items():
        assert free[name].value == pytest.approx(true, rel=0.01)


def test_a_delay_is_searched_over_whole_ticks(pushed: Recording) -> None:
    recording = replace(pushed, force=late(force_of(pushed), 3))
    parameters = lay_out([1], fixed={}, bounds={}, free=["delay"], own=())
    problem = Problem(
        recordings=(recording,), targets=(identify.Target.held(),), parameters=parameters
    )
    (delay,) = delays(problem)
    assert profile(problem, (delay,), None).ticks == {delay: 3}


@pytest.mark.slow
@pytest.mark.weekly
def test_the_wrong_sign_of_a_moving_target_is_named(tmp_path: Path) -> None:
    write("tapping", tmp_path)
    log = ["identify", "arm", str(tmp_path / "tapping.mcap")]
    wrong = CliRunner().invoke(app, [*log, "--flip-force"])
    said = " ".join(wrong.output.split())
    assert wrong.exit_code == 1, "nothing is determined"
    assert "the log seems to hold the force on the hand" in said
    assert "deviations apart" not in said
    right = CliRunner().invoke(app, log)
    assert right.exit_code == 0
    assert "--flip-force" not in right.output


def test_a_press_that_determines_nothing_gets_no_advice_to_turn_a_right_force() -> None:
    case = draw(6, 5, 5.0)  # 57 % explained, with the other sign 99.8 %: that is the wall
    trace = simulate(case.scenario, case.law)
    assert trace["f_meas"][-1] > 0, "the hand presses"
    recording = Recording.from_trace(trace)
    result = identify.fit_arm(recording, identify.Target.of(case.scenario.hand, recording.t))
    assert result.flip == ""
    assert not any("--flip-force" in text for text in result.misses)
