"""Forces of hand and motor that contradict each other, a motor that never changes, and hands that nobody has."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ebac import identify
from ebac.datasets import write
from ebac.identify import Recording


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    return identify.load(write("arm", tmp_path_factory.mktemp("arm")))


def test_a_force_in_kgf_and_a_motor_of_the_other_sign_are_named(arm: Recording) -> None:
    assert identify.fit_arm(arm).misses == ()
    assert arm.force is not None
    wrong = identify.fit_arm(replace(arm, force=arm.force / 9.80665)).misses
    assert any("by 0.102 N of the hand: as if it were in kgf" in text for text in wrong)
    turned = identify.fit_arm(arm.flipped("motor")).misses
    assert any("--flip-motor" in text for text in turned)


def test_a_hand_that_nobody_has_is_named(arm: Recording) -> None:
    inches = replace(arm, x=arm.x * 39.37, count=arm.count * 39.37)
    assert any("No arm or hand is like that" in text for text in identify.fit_arm(inches).misses)


def test_a_motor_that_never_changes_is_left_out(tmp_path: Path, arm: Recording) -> None:
    columns = np.array([arm.t, arm.x, arm.force, 0 * arm.t]).T
    log = tmp_path / "still.csv"
    np.savetxt(log, columns, delimiter=",", header="t [s],x [m],force [N],motor [N]", comments="")
    recording = identify.load(log)
    assert recording.motor is None
    assert "motor is left out: constant at 0 N" in recording.remarks
