"""Forces of hand and motor that contradict each other, a motor that never changes, and hands that nobody has."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from ebac import identify
from ebac.cli import app
from ebac.datasets import write
from ebac.identify import Recording, motor_check


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    return identify.load(write("arm", tmp_path_factory.mktemp("arm")))


@pytest.mark.slow
def test_a_force_in_kgf_and_a_motor_of_the_other_sign_are_named(arm: Recording) -> None:
    assert identify.fit_arm(arm).misses == ()
    assert arm.force is not None
    wrong = identify.fit_arm(replace(arm, force=arm.force / 9.80665)).misses
    cure = "as if force were in kgf. Name its unit, --unit force=kgf, in Python units={'force': 'kgf'}."
    assert any(f"by 0.102 N of the hand: {cure}" in text for text in wrong)
    assert arm.motor is not None
    wrong = identify.fit_arm(replace(arm, motor=arm.motor / 4.44822)).misses
    assert any("as if motor were in lbf. Name its unit, --unit motor=lbf" in text for text in wrong)
    wrong = identify.fit_arm(replace(arm, motor=arm.motor / 30)).misses
    assert any("name the unit, as in --unit force=kgf" in text for text in wrong)
    turned = identify.fit_arm(arm.flipped("motor")).misses
    assert any("--flip-motor" in text for text in turned)


def test_a_device_names_the_unit_of_its_force_too(tmp_path: Path) -> None:
    write("device", tmp_path)
    device = identify.load(next(tmp_path.glob("device*.csv")))
    assert device.force is not None
    wrong = identify.fit_device(replace(device, force=device.force / 9.80665))
    assert wrong.impossible
    assert any("--unit force=kgf" in text for text in wrong.misses)


def test_the_unit_that_the_message_names_is_the_cure(tmp_path: Path, arm: Recording) -> None:
    assert arm.force is not None
    assert arm.motor is not None
    columns = np.array([arm.t, arm.x, arm.force / 9.80665, arm.motor]).T
    log = tmp_path / "kgf.csv"
    heads = "Zeit [s],Weg [m],Fz [N],motor [N]"
    np.savetxt(log, columns, delimiter=",", header=heads, comments="")
    wrong = identify.load(log)
    assert any("--unit force=kgf" in text for text in motor_check.doubts([wrong]))
    assert motor_check.doubts([identify.load(log, units={"force": "kgf"})]) == ()


def test_the_command_names_the_unit_before_the_table(tmp_path: Path, arm: Recording) -> None:
    assert arm.force is not None
    np.savez(tmp_path / "kgf.npz", t=arm.t, x=arm.x, force=arm.force / 9.80665, motor=arm.motor)
    done = CliRunner().invoke(app, ["identify", "arm", str(tmp_path / "kgf.npz")])
    assert done.exit_code == 0, done.output
    before, _, after = done.stdout.partition("95 % interval")
    assert "--unit force=kgf" in " ".join(before.split())
    assert "kgf" not in after.replace("kgf.npz (fitted)", "")


def test_a_unit_that_contradicts_its_heading_is_noted(tmp_path: Path, arm: Recording) -> None:
    """The remark stood among ten others, dim."""
    assert arm.force is not None
    rows = np.column_stack([arm.t, arm.x, arm.force])
    file = tmp_path / "arm.csv"
    np.savetxt(file, rows, delimiter=",", header="t [s],x [m],force [N]", comments="")
    words = ["identify", "log", str(file)]
    said = CliRunner().invoke(app, [*words, "--unit", "x=inch"]).stderr
    assert "Note: arm.csv: --unit x=inch: column 'x [m]' says m, and --unit is followed" in said
    assert "Note" not in CliRunner().invoke(app, [*words, "--unit", "x=m"]).stderr


@pytest.mark.parametrize("force", ["Kraft", "Kraft [N]", "Fz [N]", "Fy"])
def test_german_headings_and_axes_of_a_sensor_are_known(
    force: str, tmp_path: Path, arm: Recording
) -> None:
    assert arm.force is not None
    log = tmp_path / "log.csv"
    columns = np.array([arm.t, 1e3 * arm.x, arm.force]).T
    np.savetxt(log, columns, delimiter=",", header=f"Zeit [s],Weg [mm],{force}", comments="")
    recording = identify.load(log)
    assert recording.force is not None
    assert recording.x == pytest.approx(arm.x)
    assert recording.force == pytest.approx(arm.force)


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


def test_a_guessed_column_says_its_unit(tmp_path: Path) -> None:
    t = np.arange(0, 3, 1e-3)
    table = np.array([1e3 * t, 10 * np.sin(10 * t), 3 * np.cos(10 * t)]).T
    file = tmp_path / "log.csv"
    np.savetxt(file, table, delimiter=",", header="time_ms,pos_mm,force_N", comments="")
    remarks = identify.load(file).remarks
    assert "x: guessed to be column 'pos_mm'" in remarks
    assert "x: in mm, as its heading says" in remarks
    asked = identify.load(file, units={"x": "mm"}, columns={"x": "pos_mm"}).remarks
    assert not any("x: in" in text for text in asked)
