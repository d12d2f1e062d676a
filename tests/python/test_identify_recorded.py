"""Verdicts on logs of the independent simulator in tests/recordings."""

from pathlib import Path

import numpy as np
import pytest

from ebac import identify
from ebac.identify import ArmResult, Recording, Target
from ebac.identify.informativeness import check_log

pytest.importorskip("scipy", reason="the independent simulator needs SciPy")
from recorded_arm import RecordedArm, recorded

HAND = {"M0", "B0", "K0"}


def read(log: RecordedArm, folder: Path) -> tuple[Recording, Target]:
    columns = {"t": log.t, "x": log.x, "force": log.force}
    np.savez(
        folder / "log.npz", **(columns if log.path is None else {**columns, "target": log.path})
    )
    recording = identify.load(folder / "log.npz")
    if recording.target is None:
        return recording, Target(switches=log.switches, segments=log.segments)
    return recording, Target.following(recording.target)


def fit(log: RecordedArm, folder: Path) -> ArmResult:
    return identify.fit_arm(*read(log, folder))


@pytest.mark.slow
@pytest.mark.weekly
def test_jitter_does_not_make_a_log_that_contains_nothing_informative(tmp_path: Path) -> None:
    """All three were said to be determined to 1 %, half of what is true: only their ratios were."""
    result = fit(recorded(67, level="rough", task="path"), tmp_path)
    assert set(result.undetermined) >= HAND


@pytest.mark.parametrize("level", ["clean", "rough"])
def test_a_held_hand_that_the_motor_shakes_by_one_sine_is_determined(
    level: str, tmp_path: Path
) -> None:
    log = recorded(1, level=level, task="sine")
    result = fit(log, tmp_path)
    for name, truth in log.truth.items():
        assert result[name].determined
        assert result[name].low <= truth <= result[name].high, str(result[name])


@pytest.mark.parametrize(
    ("task", "number", "informative"),
    [("multisine", 0, True), ("tapping", 3, True), ("alone", 4, False)],
)
def test_the_verdict_on_a_log_before_a_fit_is_that_of_the_fit(
    task: str, number: int, informative: bool, tmp_path: Path
) -> None:
    recording, target = read(recorded(number, level="clean", task=task), tmp_path)
    check = check_log(recording, target)
    assert [check.determines(name) for name in sorted(HAND)] == [informative] * 3


@pytest.mark.slow
def test_a_mass_beyond_the_bound_of_the_search_is_no_result(tmp_path: Path) -> None:
    """At the bound, however narrow its interval."""
    log = recorded(0, level="clean", task="multisine")
    recording, target = read(log, tmp_path)
    bound = 0.9 * log.truth["M0"]
    result = identify.fit_arm(recording, target, bounds={"M0": (0.01, bound)})
    assert result["M0"].value == pytest.approx(bound, rel=1e-6)
    assert "M0" in result.undetermined
