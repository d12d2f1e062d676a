"""Logs of knobs and joints: angles and torques in every usual unit, results of a joint, mixtures refused."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.identify import Target, check_log, fit_arm, fit_device, load

INERTIA, DAMPING, FRICTION = 2e-4, 1e-3, 4e-3  # kg m^2, N m s/rad, N m
COUNTS, CONSTANT = 4_000, 0.06  # a turn, N m/A
RATE, SECONDS, INNER = 1000, 6, 40
KNOB = {"M_h": INERTIA, "B_h": DAMPING, "coulomb": FRICTION, "weight": 0.0}
UNITS = {"M_h": "kg m^2", "B_h": "N m s/rad", "coulomb": "N m", "weight": "N m"}


def turned() -> dict[str, np.ndarray]:
    """A knob that a motor turns: time [s], angle [counts], torque [N m] that holds over the interval before."""
    noise = np.random.default_rng(5)
    t = np.arange(RATE * SECONDS) / RATE
    torque = np.zeros(len(t))
    for f in (0.4, 0.9, 1.7, 2.9, 4.3):
        torque += 0.012 * np.sin(2 * np.pi * f * t + noise.uniform(0, 6))
    angle, speed, current, lag, h = 0.0, 0.0, 0.0, 3e-4, 1 / RATE / INNER
    out = np.zeros(len(t))
    for i in range(1, len(t)):
        for _ in range(INNER):
            current += h / lag * (torque[i] - current)
            drive = current - DAMPING * speed
            after = speed + h * (drive - FRICTION * np.sign(speed)) / INERTIA
            if speed * after <= 0 and abs(drive) <= FRICTION:
                after = 0.0
            speed, angle = after, angle + h * after
        out[i] = angle
    return {"t": t, "angle": np.round(out * COUNTS / 2 / np.pi), "torque": torque}


@pytest.fixture(scope="module")
def knob() -> dict[str, np.ndarray]:
    return turned()


def written(path: Path, knob: dict[str, np.ndarray], angle: str, torque: str, by: float, of: float):
    """A log with these headings, its angle in `by` counts, its torque in `of` N m."""
    rows = np.column_stack([knob["t"], knob["angle"] * by, knob["torque"] / of])
    np.savetxt(
        path, rows, fmt="%.10g", delimiter=",", header=f"t [s],{angle},{torque}", comments=""
    )
    return path


RADIAN = 2 * np.pi / COUNTS
LOGS = {
    "rad and N m": ("theta [rad]", "motor_torque [N m]", RADIAN, 1.0, {}),
    "deg and mNm": ("angle_deg", "tau_motor_mNm", 360 / COUNTS, 1e-3, {}),
    "degrees and N*cm": ("pos (°)", "motor (N*cm)", 360 / COUNTS, 1e-2, {}),
    "turns, no unit of the torque": ("q [rev]", "motor", 1 / COUNTS, 1.0, {}),
    "names alone": ("theta", "tau_m", RADIAN, 1.0, {}),
    "counts and amperes": (
        "encoder [counts]",
        "current [mA]",
        1.0,
        1e-3 * CONSTANT,
        {"counts_per_turn": COUNTS, "torque_constant": CONSTANT},
    ),
}


@pytest.mark.parametrize("name", LOGS)
def test_a_knob_comes_back_in_units_of_a_joint(
    name: str, knob: dict[str, np.ndarray], tmp_path: Path
) -> None:
    angle, torque, by, of, options = LOGS[name]
    log = written(tmp_path / "knob.csv", knob, angle, torque, by, of)
    recording = load(log, flip_motor=True, **options)
    assert recording.rotary
    assert recording.units == ("rad", "N m")
    assert recording.x == pytest.approx(knob["angle"] * RADIAN, abs=1e-6)
    assert recording.count == pytest.approx(RADIAN, rel=1e-4)
    assert "count 1.571 mrad" in repr(recording)
    found = fit_device(recording)
    assert {n: e.unit for n, e in found.estimates.items()} == UNITS
    assert found.undetermined == ()
    assert found.impossible == ()
    assert found.explained > 0.99
    for parameter, truth in KNOB.items():
        e = found.estimates[parameter]
        assert e.low - 0.01 * abs(truth) <= truth <= e.high + 0.01 * abs(truth), e
    assert found.estimates["M_h"].value == pytest.approx(INERTIA, rel=0.01)
    assert "M_h = 0.0002" in repr(found)
    assert "kg m^2" in repr(found)
    assert "% of the torque" in repr(found)


@pytest.mark.slow
def test_the_command_shows_and_writes_units_of_a_joint(
    knob: dict[str, np.ndarray], tmp_path: Path
) -> None:
    log = written(tmp_path / "knob.csv", knob, "enc [counts]", "i_motor [A]", 1.0, CONSTANT)
    words = ["identify", "device", str(log), "--flip-motor", "--counts-per-turn", str(COUNTS)]
    words += ["--torque-constant", str(CONSTANT)]
    run = CliRunner().invoke(app, [*words, "--out", str(tmp_path / "report")])
    assert run.exit_code == 0, run.output
    for unit in UNITS.values():
        assert unit in run.output
        assert unit in (tmp_path / "report" / "device.html").read_text()
    assert "% of the torque where it slides" in run.output
    assert "gravity_mass" not in run.output  # a Compensation is one of a handle
    run = CliRunner().invoke(app, [*words, "--json"])
    assert run.exit_code == 0, run.output
    document = json.loads(run.stdout)
    assert {row["name"]: row["unit"] for row in document["rows"]} == UNITS
    assert "stribeck_speed_rad_per_s" in document
    assert document["compensation"] is None


def test_axes_of_a_figure_are_those_of_a_joint(knob: dict[str, np.ndarray], tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    from ebac.identify.figures import plot_device

    log = written(tmp_path / "knob.csv", knob, "theta [rad]", "motor [Nm]", RADIAN, 1.0)
    motion, force, friction = plot_device(fit_device(load(log, flip_motor=True))).axes
    labels = [axis.get_ylabel() for axis in (motion, force, friction)]
    assert labels == ["angle [rad]", "driving torque [N m]", "friction [N m]"]
    assert friction.get_xlabel() == "velocity [rad/s]"
    shown = motion.lines[0].get_ydata()
    assert np.ptp(shown) == pytest.approx(np.ptp(knob["angle"]) * RADIAN, rel=0.01)


def test_a_lever_gives_the_device_at_the_handle(
    knob: dict[str, np.ndarray], tmp_path: Path
) -> None:
    log = written(tmp_path / "knob.csv", knob, "theta [deg]", "motor [mN m]", 360 / COUNTS, 1e-3)
    handle = load(log, flip_motor=True, lever=0.02)
    assert not handle.rotary
    assert handle.x == pytest.approx(0.02 * RADIAN * knob["angle"], abs=1e-8)
    found = fit_device(handle).estimates
    assert found["M_h"].unit == "kg"
    assert found["M_h"].value == pytest.approx(INERTIA / 0.02**2, rel=0.01)
    assert found["coulomb"].value == pytest.approx(FRICTION / 0.02, rel=0.05)


def test_the_lever_of_the_search_does_not_matter(
    knob: dict[str, np.ndarray], tmp_path: Path
) -> None:
    """From a watch to an excavator: all torques by the same factor, the same numbers by that factor."""
    for by in (1e-3, 1e-1, 1e3, 1e6):
        log = written(tmp_path / "joint.csv", knob, "theta [rad]", "motor [N m]", RADIAN, 1 / by)
        found = fit_device(load(log, flip_motor=True))
        assert found.undetermined == ()
        for name in ("M_h", "B_h", "coulomb"):
            assert found.estimates[name].value == pytest.approx(by * KNOB[name], rel=0.01)


def test_a_motor_of_the_other_sign_is_named(knob: dict[str, np.ndarray], tmp_path: Path) -> None:
    log = written(tmp_path / "knob.csv", knob, "theta [rad]", "motor [N m]", RADIAN, 1.0)
    run = CliRunner().invoke(app, ["identify", "device", str(log)])
    assert run.exit_code == 1
    assert "--flip-motor" in run.output


T = 1e-3 * np.arange(200)
X = 3e-5 * np.round(1e3 * np.sin(20 * T))
F = np.cos(20 * T)
REFUSED = {
    "theta [deg],force [N]": (
        {},
        r"x \(column 'theta \[deg\]'\) is an angle in deg and force \(column 'force \[N\]'\) a force in N.*"
        r"lever=0.05 or --lever 0.05.*--unit force=Nm",
    ),
    "x [mm],torque [mNm]": ({}, r"a length in mm and force .* a torque in mN m.*--unit force=N"),
    "theta [rad],f": ({}, "an angle in rad and force .* a force in N"),
    "x,motor [A]": ({}, "a current: give the torque .*--torque-constant"),
    "enc [counts],force": ({}, r"'enc \[counts\]'\) is in counts: .*--counts-per-turn .*--count"),
    "x,force": ({"lever": 0.05}, "lever = 0.05: the file has no angle or torque"),
    "x,force [N]": ({"counts_per_turn": 4096}, "counts_per_turn = 4096: the file has no angle"),
    "x [m],force [N]": ({"torque_constant": 0.1}, "the file has no current in A or mA"),
    "theta,torque": ({"lever": -1.0}, r"lever = -1 m: must lie in \[0.0001, 10\] m"),
    "angle,torque": ({}, "x spans 5232 rad, two turns are .*--unit x=deg"),
}


@pytest.mark.parametrize("head", REFUSED)
def test_what_does_not_fit_is_refused(head: str, tmp_path: Path) -> None:
    options, message = REFUSED[head]
    x = 1e5 * X if head == "angle,torque" else X
    np.savetxt(
        tmp_path / "log.csv",
        np.column_stack([T, x, F]),
        delimiter=",",
        header=f"t,{head}",
        comments="",
    )
    with pytest.raises(ValueError, match=rf"log.csv: .*{message}|^{message}"):
        load(tmp_path / "log.csv", **options)


def test_a_lever_joins_an_angle_and_a_force(tmp_path: Path) -> None:
    """The encoder at the joint, the sensor at the handle."""
    rows = np.column_stack([T, 20 * X, F])
    np.savetxt(
        tmp_path / "log.csv", rows, delimiter=",", header="t,theta [rad],force [N]", comments=""
    )
    r = load(tmp_path / "log.csv", lever=0.05)
    assert r.x == pytest.approx(X)
    assert r.force == pytest.approx(F)


SPARE = {
    "x,force,i": ["t", "x", "force"],
    "x,force,current [A]": [
        "t",
        "x",
        "force",
        "motor: column 'current [A]' is left out, a current; --torque",
    ],
    "x [m],force [N],motor_torque [Nm]": [
        "t",
        "x",
        "force",
        "is left out, a torque in N m with x in m; --lever",
    ],
    "theta [rad],torque [Nm],motor_force [N]": [
        "t",
        "x",
        "force",
        "a force in N with x in rad; --lever",
    ],
}


@pytest.mark.parametrize("head", SPARE)
def test_a_column_that_nothing_needs_is_left_out_where_it_does_not_fit(
    head: str, tmp_path: Path
) -> None:
    rows = np.column_stack([T, X, F, F])
    np.savetxt(tmp_path / "log.csv", rows, delimiter=",", header=f"t,{head}", comments="")
    found = load(tmp_path / "log.csv")
    assert list(found.channels()) == SPARE[head][:3]
    for remark in SPARE[head][3:]:
        assert any(remark in text for text in found.remarks), found.remarks
    if len(SPARE[head]) > 3:
        column = head.split(",")[-1]
        with pytest.raises(ValueError, match=r"--torque-constant|--lever"):
            load(tmp_path / "log.csv", columns={"motor": column})


def test_counts_of_a_slide(tmp_path: Path) -> None:
    rows = np.column_stack([T, X / 3e-5, F])
    np.savetxt(
        tmp_path / "log.csv", rows, delimiter=",", header="t,enc [counts],force [N]", comments=""
    )
    r = load(tmp_path / "log.csv", count=3e-5)
    assert (r.rotary, r.count) == (False, 3e-5)
    assert r.x == pytest.approx(X)


def test_a_hand_at_a_knob_wants_a_lever(tmp_path: Path) -> None:
    rows = np.column_stack([T, 20 * X, F])
    np.savetxt(
        tmp_path / "log.csv", rows, delimiter=",", header="t,theta [rad],torque [Nm]", comments=""
    )
    with pytest.raises(ValueError, match=r"rotary device.*--lever 0.05"):
        fit_arm(load(tmp_path / "log.csv"))
    for command in ("arm", "gains"):
        run = CliRunner().invoke(app, ["identify", command, str(tmp_path / "log.csv")])
        assert run.exit_code == 2
        assert "--lever 0.05" in run.stderr.replace("\n", " ")


def test_a_hand_at_a_knob_with_its_lever_is_that_of_the_handle(tmp_path: Path) -> None:
    """The same press as a handle, in m and N, and as a knob of 50 mm, in deg and mN m."""
    ebac.datasets.write("press", tmp_path)
    handle = load(tmp_path / "press.csv")
    assert handle.force is not None
    rows = np.column_stack([handle.t, np.rad2deg(handle.x / 0.05), 50 * handle.force])
    head = "t [s],angle [deg],torque [mN m]"
    np.savetxt(tmp_path / "knob.csv", rows, fmt="%.12g", delimiter=",", header=head, comments="")
    turned_by, held_at = load(tmp_path / "knob.csv"), load(tmp_path / "knob.csv", lever=0.05)
    target = Target.steps(1.0)
    known, found = check_log(held_at, target).rows(), check_log(turned_by, target).rows()
    for one, other in zip(known, found, strict=True):
        assert one["told"] == other["told"]
        assert one["deviation_share"] == pytest.approx(other["deviation_share"], rel=1e-3)
    options = {"lag": handle.lag, "current_lag": handle.current_lag}
    bare = replace(load(tmp_path / "press.csv", **options), motor=None, desired=None)
    known = fit_arm(bare, target)
    found = fit_arm(load(tmp_path / "knob.csv", lever=0.05, **options), target)
    for name in ("M0", "B0", "K0"):
        assert found[name].unit == known[name].unit
        assert found[name].value == pytest.approx(known[name].value, rel=1e-3)
