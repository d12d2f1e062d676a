"""Wrong calls of `ebac.identify` are refused with the thing, its value, its range; none is taken in silence."""

import json
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from typer.testing import CliRunner

import ebac
from ebac import identify
from ebac.cli import app
from ebac.identify import Recording, Target
from ebac.identify.loop import LoopModel, _merged

ROWS = 2000
T: NDArray[np.float64] = 1e-3 * np.arange(ROWS)
X: NDArray[np.float64] = 0.01 * np.sin(2 * np.pi * T)
LOG = Recording(name="log", t=T, x=X, force=-300 * X, motor=300 * X)

WRONG: dict[str, tuple[Callable[[], Any], str]] = {
    "text": (lambda: replace(LOG, force=np.full(ROWS, "a")), "force = .*array of numbers"),
    "complex": (lambda: replace(LOG, x=X.astype(complex)), "x = .*array of numbers"),
    "columns": (lambda: replace(LOG, t=T[:, None]), r"t has the shape \(2000, 1\)"),
    "count": (lambda: replace(LOG, count=-1e-5), r"count = -1e-05 m: must lie in \[0, 1\] m"),
    "no count": (lambda: replace(LOG, count=float("nan")), "count = nan m: must lie"),
    "no trace": (lambda: Recording.from_trace("x"), "takes a Trace, not 'x'"),  # type: ignore[arg-type]
    "two checks": (lambda: identify.check_log([LOG]), "check_log takes a Recording"),  # type: ignore[arg-type]
    "two responses": (lambda: identify.frequency_response([LOG]), "takes a Recording"),  # type: ignore[arg-type]
    "two devices": (lambda: identify.fit_device([LOG]), "fit_device takes a Recording"),  # type: ignore[arg-type]
    "lag": (lambda: identify.fit_device(LOG, current_lag=-1), r"current_lag = -1 s: must lie"),
    "levels": (lambda: identify.frequency_response(LOG, levels=np.zeros(2)), r"must be \(1,\)"),
    "falls": (lambda: Target.steps(2, 1), r"switches = \(2, 1\) s: must be finite and rise"),
    "never": (lambda: Target.steps(float("nan")), "switches = .* must be finite and rise"),
    "path": (lambda: Target.following(np.full(9, np.nan)), "path: is no number in row 0"),
    "short path": (
        lambda: identify.check_log(LOG, Target.following(np.zeros(10))),
        r"path of its target has the shape \(10,\): must be \(2000,\)",
    ),
    "short path of a fit": (
        lambda: identify.fit_arm(LOG, Target.following(np.zeros(10))),
        r"path of its target has the shape \(10,\)",
    ),
    "no target": (lambda: identify.fit_arm(LOG, "held"), "takes a Target, such as Target.held"),  # type: ignore[arg-type]
    "twice": (lambda: identify.fit_arm([LOG, LOG]), "holds the same rows as .*; give each log once"),
    "a copy": (lambda: identify.fit_arm([LOG, replace(LOG, name="b")]), "b: holds the same rows as"),
    "starts": (lambda: identify.fit_arm(LOG, starts=1.5), "starts = 1.5: must be a whole number"),  # type: ignore[arg-type]
    "seed": (lambda: identify.fit_arm(LOG, seed=-1), "seed = -1: must be at least 0"),
    "free": (lambda: identify.fit_arm(LOG, free="delay"), r"free = 'delay' \(str\): .* such as \['delay'\]"),
    "backwards": (lambda: LOG.between(1.5, 1), "stop = 1 s: must be at least start, 1.5 s"),
    "later": (lambda: LOG.between(9, 10), "outside the run, which spans 0 to 1.999 s"),
    "no time": (lambda: LOG.between(float("nan"), 1), "start = nan s: must be a time"),
    "robust": (lambda: identify.fit_arm(LOG, robust="huber"), "robust = 'huber': must be a number"),  # type: ignore[arg-type]
    "fixed": (lambda: identify.fit_arm(LOG, fixed={"M0": "1"}), "M0 = '1': must be a number"),  # type: ignore[dict-item]
    "bounds": (lambda: identify.fit_arm(LOG, bounds={"M0": 3}), "bounds of M0 = 3 .*two numbers"),  # type: ignore[dict-item]
    "misspelt": (lambda: identify.fit_loop(LOG, startz=2), "did you mean 'starts'"),
    "wall": (lambda: identify.fit_loop(LOG, wall=3), "takes a Wall, not 3"),  # type: ignore[arg-type]
    "timing": (lambda: identify.fit_loop(LOG, timing=3), "takes a Timing, not 3"),  # type: ignore[arg-type]
    "endless": (lambda: identify.excitation.chirp(1.0, seconds=np.inf), "seconds = inf s"),
    "amplitude": (lambda: identify.excitation.steps(np.nan), "amplitude = nan: must be finite"),
    "endless amplitude": (lambda: identify.excitation.multisine(np.inf), "amplitude = inf: must be"),
    "no amplitude": (lambda: identify.excitation.tapping("a", 1), "amplitude = 'a': must be a number"),  # type: ignore[arg-type]
    "no band": (lambda: identify.excitation.chirp(1, low="a"), "low = 'a': must be a number"),  # type: ignore[arg-type]
    "no tries": (lambda: identify.excitation.multisine(1, tries=1.5), "tries = 1.5: must be a whole"),  # type: ignore[arg-type]
    "limits": (lambda: identify.Limits(force="a"), "Limits.force = 'a': must be a number"),  # type: ignore[arg-type]
    "energy": (lambda: identify.Limits(energy=-1), "Limits.energy = -1 J: must be at least 0"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_call_is_refused_by_name(case: str) -> None:
    call, message = WRONG[case]
    with pytest.raises((TypeError, ValueError), match=message):
        call()


def test_a_parameter_that_a_check_does_not_have_is_refused_by_name() -> None:
    with pytest.raises(KeyError, match="no parameter is called 'K1'"):
        identify.check_log(LOG).determines("K1")


def test_lists_are_columns() -> None:
    made = Recording(name="lists", t=T.tolist(), x=X.tolist())  # type: ignore[arg-type]
    np.testing.assert_array_equal(made.x, X)
    assert identify.excitation.path([0.0, 1.0], [0.0, 1.0]).x == [0.0, 1.0]  # type: ignore[arg-type]


def write(path: Path, *, mark: str = ",", rows: int = ROWS) -> Path:
    noise = np.random.Generator(np.random.PCG64(1)).standard_normal(ROWS)
    table = np.array([T, np.round(X, 5), -300 * X + 0.01 * noise]).T[:rows]
    np.savetxt(path, table, delimiter=mark, header=mark.join(("t", "x", "f")), comments="")
    return path


def test_an_unknown_option_of_a_file_is_refused_with_the_nearest() -> None:
    with pytest.raises(TypeError, match="load has no parameter 'unit', did you mean 'units'"):
        identify.load("press.csv", unit="mm")  # type: ignore[call-arg]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda f: f.fit_arm(LOG, fre=[]), "ebac.identify.fit_arm has no parameter 'fre', did you mean 'free'"),
        (lambda f: f.fit_loop(LOG, fre=[]), "fit_loop has no parameter 'fre', did you mean 'free'"),
        (lambda f: f.fit_device(LOG, devices=1), "ebac.identify.fit_device has no parameter 'devices'"),
        (lambda f: f.fit_gains(None, evaluation=1), "fit_gains has no parameter 'evaluation', did you mean 'evaluatio"),
        (lambda f: f.force_scale(LOG, frictions=1), "ebac.identify.force_scale has no parameter 'frictions'"),
        (lambda f: f.frequency_response(LOG, stifness=1), "has no parameter 'stifness', did you mean 'stiffness'"),
        (lambda f: f.check_log(LOG, targts=1), "ebac.identify.check_log has no parameter 'targts', did you mean 'tar"),
        (lambda f: f.excitation.chirp(hgh=1), "ebac.identify.excitation.chirp has no parameter 'hgh', did you mean"),
        (lambda f: f.Target.tapping(1.0, second=1), "Target.tapping has no parameter 'second', did you mean 'second"),
        (lambda f: f.Target.tapping(1.0), "Target.tapping needs seconds"),
        (lambda f: f.Recording.from_trace(None, axes=1), "Recording.from_trace has no parameter 'axes', did you mean"),
    ],
)  # fmt: skip
def test_an_unknown_keyword_is_refused_with_the_nearest(
    call: Callable[[Any], Any], message: str
) -> None:
    with pytest.raises(TypeError, match=re.escape(message)):
        call(identify)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rate": 0}, "rate = 0 Hz: must be greater than 0"),
        ({"rate": float("nan")}, "rate = nan Hz"),
        ({"rate": float("inf")}, "rate = inf Hz: must be greater than 0, and finite"),
        ({"rate": "1000"}, "rate = '1000': must be a number"),
        ({"count": -1e-5}, "count = -1e-05 m or rad: must lie in"),
        ({"lag": "1"}, "lag = '1': must be a number"),
        ({"columns": ["t", "x"]}, "columns = .*names by signal"),
        ({"units": {"x": 3}}, "units = .*names by signal"),
        ({"columns": {"x": "x", "force": "x"}}, "column 'x' is given for x and for force"),
    ],
)
def test_a_wrong_option_of_a_file_is_refused_by_name(
    options: dict[str, Any], message: str, tmp_path: Path
) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        identify.load(write(tmp_path / "log.csv"), **options)


def test_a_file_of_one_row_is_too_short_and_not_unsorted(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"1 row; needs at least 50"):
        identify.load(write(tmp_path / "log.csv", rows=1))


def test_columns_between_spaces_are_refused_with_the_remedy(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="put commas, semicolons or tabs"):
        identify.load(write(tmp_path / "log.txt", mark=" "))


def test_guesses_beside_a_column_are_of_the_axis_that_is_asked_for(tmp_path: Path) -> None:
    device = ebac.presets.device("joystick")
    hand = ebac.Hand(path=(ebac.Step(target=0.0), ebac.Step(target=0.02)))
    trace = ebac.simulate(ebac.Scenario(device=device, hand=hand, seconds=0.2), "direct")
    trace.to_npz(tmp_path / "two.npz")
    found = identify.load(tmp_path / "two.npz", columns={"force": "f_meas_1"}, axis=1)
    np.testing.assert_array_equal(found.x, trace.axis("x", 1))
    assert found.motor is not None
    np.testing.assert_array_equal(found.motor, trace.axis("f_applied", 1))


def test_taps_fall_on_ticks_where_a_log_pauses() -> None:
    taps = ebac.Tapping(target=0.02, frequency=1.3)
    whole = Target.along(taps, T)
    paused = Target.along(taps, T[(T < 0.5) | (T > 1.2)])
    assert paused.switches == whole.switches


def test_a_target_is_that_of_the_axis() -> None:
    hand = ebac.Hand(path=(ebac.Step(target=0.0), ebac.Step(target=0.02, at=0.5)))
    assert Target.of(hand, T).switches == ()
    assert Target.of(hand, T, axis=1).switches == (0.5,)
    with pytest.raises(ValueError, match=r"axis = 3: must lie in \[0, 2\]"):
        Target.of(hand, T, axis=3)


def test_a_press_is_as_deep_as_asked() -> None:
    loop = LoopModel(
        arm=None,  # type: ignore[arg-type]
        device=ebac.Device(), found=None, wall=ebac.Wall(), timing=ebac.Timing(), remarks=(),
    )  # fmt: skip
    pressed = loop.pressing(ebac.Hand(), depth=0.002).hand.path[0]
    assert pressed.target == pytest.approx(0.012)  # behind 10 mm of free air
    with pytest.raises(ValueError, match="depth = 0 m: must be positive"):
        loop.pressing(ebac.Hand(), depth=0.0)


def test_a_device_of_which_nothing_is_determined_is_said_to_be_as_given() -> None:
    remarks: list[str] = []
    found = identify.fit_device(LOG)
    loose = replace(found, covariance=np.full_like(found.covariance, 1e9))
    _merged(ebac.Device(), loose, LOG, remarks)
    assert remarks == ["device: as given, the log determines none of it"]


@pytest.mark.parametrize("option", ["--column", "--unit", "--fix"])
def test_a_name_given_twice_is_refused(option: str, tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    rows = np.column_stack([T, X, -300 * X])
    np.savetxt(log, rows, delimiter=",", header="t [s],x [m],force [N]", comments="")
    words = ["identify", "arm", str(log), option, "x=1", option, "x=2"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 2
    assert f"{option} x=2: x is given twice; give it once" in " ".join(done.output.split())


def test_logs_of_one_name_keep_their_own_tests_and_remarks(tmp_path: Path) -> None:
    paths = []
    for day, seed in (("monday", 1), ("tuesday", 2)):
        (tmp_path / day).mkdir()
        scenario = ebac.Scenario(
            hand=ebac.Hand(path=ebac.Tapping(target=0.02, rest=-0.01, frequency=1.0)),
            seconds=3.0, seed=seed,
        )  # fmt: skip
        trace = ebac.simulate(scenario, "direct")
        paths.append(tmp_path / day / "tap.npz")
        trace.to_npz(paths[-1])
    logs = [identify.load(path) for path in paths]
    result = identify.fit_arm(logs, [Target.along(r.path, r.t) for r in logs if r.path])
    assert list(result.tests) == ["tap.npz (log 1)", "tap.npz (log 2)"]
    words = ["identify", "arm", *map(str, paths), "--json"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    assert list(json.loads(done.stdout)["remarks"]) == ["tap.npz (log 1)", "tap.npz (log 2)"]
    again = CliRunner().invoke(app, ["identify", "arm", str(paths[0]), "--hold-out", str(paths[0])])
    assert again.exit_code == 2
    assert f"{paths[0]}: holds the same rows as {paths[0]}" in " ".join(again.output.split())
    copy = shutil.copy(paths[0], tmp_path)
    again = CliRunner().invoke(app, ["identify", "arm", str(paths[0]), str(copy)])
    assert again.exit_code == 2
    assert f"{copy}: holds the same rows as {paths[0]}" in " ".join(again.output.split())


def test_a_hand_that_does_not_predict_a_log_that_was_held_out_ends_in_1(tmp_path: Path) -> None:
    for name in ("arm", "press"):
        ebac.datasets.write(name, tmp_path)
    words = ["identify", "arm", str(tmp_path / "arm.csv"), "--hold-out"]
    done = CliRunner().invoke(app, [*words, str(tmp_path / "press.csv")])
    assert done.exit_code == 1
    assert "press.csv: held out, and this hand explains less" in " ".join(done.output.split())


@pytest.fixture(scope="module")
def arm() -> identify.ArmResult:
    path = ebac.Tapping(target=0.02, rest=-0.01, frequency=1.0)
    scenario = ebac.Scenario(hand=ebac.Hand(path=path), seconds=2.0)
    return identify.fit_arm(Recording.from_trace(ebac.simulate(scenario, "direct")))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda arm: arm.simulated(3), r"recording = 3: must lie in \[0, 0\]"),
        (lambda arm: arm.simulated(-1), r"recording = -1: must lie in \[0, 0\]"),
        (lambda arm: arm.drifts("a"), "recording = 'a': must be a whole number"),
        (
            lambda arm: arm.predictions([LOG]),
            r"takes pairs \(Recording, Target\), .* not Recording",
        ),
        (lambda arm: arm.predictions(LOG), r"takes pairs \(Recording, Target\), .* not Recording"),
        (lambda arm: arm.predictions([(LOG,)]), r"takes pairs \(Recording, Target\)"),
        (lambda arm: arm.predictions([(3, Target.held())]), "takes a Recording, .* not 3"),
        (lambda arm: arm.predictions([(LOG, 3)]), "takes a Target, .* not 3"),
    ],
)
def test_a_wrong_call_of_a_result_is_refused_by_name(
    arm: identify.ArmResult, call: Callable[[Any], Any], message: str
) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        call(arm)


def test_a_check_of_gains_refuses_what_it_does_not_use() -> None:
    done = CliRunner().invoke(app, ["identify", "check", "gains", "--seconds", "5"])
    assert done.exit_code == 2
    assert "--seconds 5: is not for gains" in done.output


def test_a_recording_keeps_what_it_was_given() -> None:
    """It looked at the caller's array: one that is used again for the next log changed those before."""
    x = X.copy()
    log = Recording(name="log", t=T, x=x)
    x[:] = 0
    np.testing.assert_array_equal(log.x, X)
