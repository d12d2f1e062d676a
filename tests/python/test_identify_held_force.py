"""A force that was read less often than its log has rows: the rows between hold an old reading, and are left out."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from pushed_arm import TRUE, pushed_arm

from ebac import identify
from ebac.identify import Recording
from ebac.identify.cases import draw
from ebac.identify.held_force import new_readings, without_held
from ebac.simulation import simulate


@pytest.fixture(scope="module")
def pushed() -> Recording:
    return pushed_arm()


def held(values: NDArray[np.float64], rows: int, phase: int = 0) -> NDArray[np.float64]:
    at = np.arange(len(values))
    return values[np.maximum((at - phase) // rows * rows + phase, 0)]


def held_by_own_clock(values: NDArray[np.float64], rows: float) -> NDArray[np.float64]:
    at = np.arange(len(values))
    return values[np.round(np.floor(at / rows) * rows).astype(int)]


def written(r: Recording, force: NDArray[np.float64], folder: Path) -> Path:
    np.savez(folder / "log.npz", t=r.t, x=r.x, force=force, motor=r.motor)
    return folder / "log.npz"


@given(rows=st.integers(2, 30), phase=st.integers(0, 29), seed=st.integers(0, 9))
def test_new_readings_are_found_at_every_period_and_phase(rows: int, phase: int, seed: int) -> None:
    phase %= rows
    noise = np.random.default_rng(seed).normal(size=60 * rows)
    found, usual = new_readings(held(noise, rows, phase))
    assert usual == rows
    np.testing.assert_array_equal(found, np.arange(phase or rows, len(noise), rows))


@given(rows=st.floats(4, 20), seed=st.integers(0, 9))
def test_new_readings_of_another_clock_are_found(rows: float, seed: int) -> None:
    noise = np.random.default_rng(seed).normal(size=2000)
    found, usual = new_readings(held_by_own_clock(noise, rows))
    assert usual == pytest.approx(rows, abs=1)
    assert (np.diff(held_by_own_clock(noise, rows)[found]) != 0).all()


@given(quantum=st.floats(0.001, 3.0), seed=st.integers(0, 9))
def test_a_coarse_or_quiet_force_is_not_held(quantum: float, seed: int) -> None:
    draws = np.random.default_rng(seed)
    t = 1e-3 * np.arange(4000)
    for noise in (0.0, 0.3):
        for force in (np.sin(9 * t), t):
            read = quantum * np.round((force + draws.normal(0, noise, t.size)) / quantum)
            assert new_readings(read)[1] == 1


def test_a_reading_that_is_as_the_one_before_is_one(pushed: Recording) -> None:
    force = held(np.round(np.random.default_rng(1).normal(size=4000), 1), 10)
    found, usual = new_readings(force)
    assert usual == 10
    assert (np.diff(found) == 10).all()


def test_forces_of_right_logs_are_not_held() -> None:
    for number in range(12):
        case = draw(number, 9, 3.0)
        force = Recording.from_trace(simulate(case.scenario, case.law)).force
        assert force is not None
        assert new_readings(force)[1] == 1


def test_the_motor_is_the_mean_since_the_reading_before() -> None:
    force = held(np.random.default_rng(1).normal(size=1000), 10)
    motor = np.arange(1000.0)
    out = without_held({"t": motor, "x": motor, "force": force, "motor": motor}, [])
    np.testing.assert_allclose(out["motor"], out["t"] - 4.5)


@pytest.mark.parametrize("own_clock", [False, True])
def test_an_arm_is_identified_from_a_force_read_at_100_hz(
    pushed: Recording, own_clock: bool, tmp_path: Path
) -> None:
    """With all rows B0 was 10 % off."""
    assert pushed.force is not None
    force = held_by_own_clock(pushed.force, 9.97) if own_clock else held(pushed.force, 10, 3)
    log = identify.load(written(pushed, force, tmp_path))
    assert "force: changes every 10 rows only" in " ".join(log.remarks)
    result = identify.fit_arm(log)
    for name, true in TRUE.items():
        assert result[name].determined
        assert result[name].value == pytest.approx(true, rel=0.04)
        assert result[name].low <= true <= result[name].high


@pytest.mark.parametrize("rows", [2, 10])
def test_rows_without_a_force_are_those_between_two_readings(
    pushed: Recording, rows: int, tmp_path: Path
) -> None:
    assert pushed.force is not None
    force = np.where(np.arange(pushed.force.size) % rows == 1, pushed.force, np.nan)
    log = identify.load(written(pushed, force, tmp_path), lag=pushed.lag)
    gone = np.count_nonzero(np.isnan(force))
    assert f"force: is empty in {gone} of {force.size} rows" in " ".join(log.remarks)
    result = identify.fit_arm(log)
    for name, true in TRUE.items():
        assert result[name].value == pytest.approx(true, rel=0.04)
        assert result[name].low <= true <= result[name].high


def test_a_loop_says_which_tick_it_took(pushed: Recording, tmp_path: Path) -> None:
    assert pushed.force is not None
    log = identify.load(written(pushed, held(pushed.force, 10, 3), tmp_path))
    assert "timing: a tick of 10 ms, the step of the log" in identify.fit_loop(log).remarks


@pytest.mark.parametrize(
    ("empty", "remark"),
    [(0, "force: is not finite (inf), perhaps of a saturated sensor, in 1 of 4000 rows"),
     (2, "force: is empty in 2 and is not finite (inf), perhaps of a saturated sensor, in 1 of 4000 rows")],
)  # fmt: skip
def test_a_force_that_is_infinite_is_not_called_empty(empty: int, remark: str) -> None:
    force = np.sin(np.arange(4000.0))
    force[7], force[8 : 8 + empty] = np.inf, np.nan
    remarks: list[str] = []
    without_held({"force": force}, remarks)
    assert remarks == [f"{remark}; they are left out"]
