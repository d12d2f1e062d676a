"""Recordings as loggers write them: rows off their times, lost, paused; by a simulator that is not ours."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from typer.testing import CliRunner

pytest.importorskip("scipy")

from measure import every, judged
from recorded_arm import recorded

from ebac.cli import app
from ebac.identify import Target, check_log, fit_arm, fit_device, frequency_response, load
from ebac.identify.signals import by_place


def written(folder: Path, **columns: np.ndarray) -> Path:
    np.savez(folder / "log.npz", **columns)
    return folder / "log.npz"


@pytest.mark.parametrize("off", [3e-7, 3e-5, 2e-4])
def test_times_that_are_off_lose_no_count(off: float, tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=4)
    t = log.t + np.random.default_rng(1).uniform(-off, off, len(log.t))
    r = load(written(tmp_path, t=t, x=log.x, force=log.force))
    assert r.count == pytest.approx(log.count, rel=1e-6)
    assert set(np.unique(np.round(r.x / log.count, 6) % 1)) <= {0.0, 1.0}


def test_a_pause_of_20_ms_divides_a_recording_and_costs_nothing(tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=6)
    keep = np.abs(log.t - 2.5) > 0.010
    r = load(written(tmp_path, t=log.t[keep], x=log.x[keep], force=log.force[keep]))
    assert len(r.stretches) == 2
    assert len(r.t) == keep.sum()
    assert r.count == pytest.approx(log.count, rel=1e-6)
    found = fit_arm(r)
    assert found["M0"].value == pytest.approx(log.truth["M0"], rel=0.01)
    assert found["M0"].low <= log.truth["M0"] <= found["M0"].high
    assert found.undetermined == ()
    found.plot()
    check_log(r)
    frequency_response(r)


def test_each_stretch_has_the_levels_it_has(tmp_path: Path) -> None:
    log = recorded(3, level="clean", task="tapping", seconds=6)
    at = log.switches[3]
    keep = np.abs(log.t - at) > 0.030  # the switch itself is lost
    r = load(written(tmp_path, t=log.t[keep], x=log.x[keep], force=log.force[keep]))
    target = Target(switches=log.switches, segments=log.segments)
    cut, used = target.cut(r, r.stretches[1])
    assert cut.switches == log.switches[4:]
    assert [used[i] for i in cut.segments] == list(log.segments[4:])
    found = fit_arm(r, target)
    for name, truth in log.truth.items():
        assert found[name].value == pytest.approx(truth, rel=0.02)


def test_lost_rows_are_bridged_and_not_believed(tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=4)
    keep = np.random.default_rng(2).random(len(log.t)) > 0.05
    keep[[0, -1]] = True
    r = load(written(tmp_path, t=log.t[keep], x=log.x[keep], force=log.force[keep]))
    assert len(r.stretches) == 1
    assert r.known is not None
    assert r.known.sum() == keep.sum()
    assert any(text.endswith("lost rows are bridged") for text in r.remarks)
    more = keep & (np.random.default_rng(3).random(len(keep)) > 0.2)
    less = load(written(tmp_path, t=log.t[more], x=log.x[more], force=log.force[more]))
    assert any("% of all: the force between is taken" in text for text in less.remarks)
    found = fit_arm(r)
    assert found["K0"].value == pytest.approx(log.truth["K0"], rel=0.01)
    assert not any("rows are missing" in text for text in found.misses)


def test_an_arm_from_a_log_of_which_a_fifth_is_missing_warns_and_names_the_share(
    tmp_path: Path,
) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=4)
    keep = np.random.default_rng(3).random(len(log.t)) > 0.2
    keep[[0, -1]] = True
    file = written(tmp_path, t=log.t[keep], x=log.x[keep], force=log.force[keep])
    share = load(file).missing
    assert share == pytest.approx(1 - keep.mean())
    done = CliRunner().invoke(app, ["identify", "arm", str(file)])
    warned = f"log.npz: {100 * share:.0f} % of the rows are missing, more than 10 %: the intervals are too narrow"
    assert warned in " ".join(done.output.split())


def test_the_encoder_step_is_seen_beside_empty_rows(tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=4)
    signals = {"x": log.x.copy(), "force": log.force.copy()}
    for values in signals.values():
        values[1000:1200] = np.nan
    r = load(written(tmp_path, t=log.t, **signals))
    assert r.count == pytest.approx(log.count, rel=1e-6)


def test_pauses_everywhere_are_refused_with_a_sentence(tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=4)
    keep = log.t % 0.1 < 0.05
    with pytest.raises(ValueError, match="longest stretch has 51 rows: needs 250"):
        load(written(tmp_path, t=log.t[keep], x=log.x[keep], force=log.force[keep]))


def test_a_stretch_at_rest_is_left_out(tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=4)
    t = np.concatenate([1e-3 * np.arange(400), log.t + 1.0])
    x = np.concatenate([np.zeros(400), log.x])
    force = np.concatenate([0.01 * np.sin(np.arange(400)), log.force])
    r = load(written(tmp_path, t=t, x=x, force=force))
    assert len(r.stretches) == 1
    assert any("400 rows are left out" in text for text in r.remarks)


def test_a_device_is_identified_across_a_pause(tmp_path: Path) -> None:
    t = 1e-3 * np.arange(6000)
    w = 2 * np.pi * np.array([[0.7], [1.9]])
    size = np.array([[0.03], [0.01]])
    x, v = (size * np.sin(w * t)).sum(0), (size * w * np.cos(w * t)).sum(0)
    a = -(size * w**2 * np.sin(w * t)).sum(0)
    force = 0.8 * a + 3 * v + 0.5 * np.sign(v) + np.random.default_rng(3).normal(0, 0.01, len(t))
    keep = (t < 2.0) | (t > 2.7)
    r = load(written(tmp_path, t=t[keep], x=1e-5 * np.floor(x / 1e-5)[keep], force=force[keep]))
    found = fit_device(r).estimates
    assert found["M_h"].value == pytest.approx(0.8, rel=0.02)
    assert found["coulomb"].value == pytest.approx(0.5, abs=0.03)


def test_no_option_is_left_out_in_silence(tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=2)
    path = written(tmp_path, t=log.t, x=log.x, force=log.force)
    r = load(path, rate=500.0)
    assert r.dt == pytest.approx(2e-3)
    assert any(
        "column 't', which says 1000 rows a second, is not used" in text for text in r.remarks
    )
    assert load(path, count=log.count / 2).count == log.count / 2
    with pytest.raises(ValueError, match="x does not move in such steps; it shows steps of"):
        load(path, count=1.37 * log.count)
    with pytest.raises(ValueError, match="axis = 1: the file has one axis"):
        load(path, axis=1)
    result = CliRunner().invoke(app, ["identify", "arm", str(path), "--count", "0.001"])
    assert result.exit_code == 2
    assert "count = 0.001 m" in result.stderr


@pytest.mark.parametrize("level", [pytest.param("drift", marks=pytest.mark.weekly), "rough"])
@pytest.mark.slow
def test_intervals_hold_the_truth(level: str) -> None:
    """On ten logs; `python tests/recordings/measure.py` takes 240 of three levels."""
    found = [j for j in every(10, (level,)) if j.determined]
    assert {j.task for j in found} <= {"multisine", "sine", "tapping"}  # nothing else tells
    assert len(found) >= 12
    assert np.mean([j.held for j in found]) > 0.85
    assert max(abs(j.error) for j in found) < 0.06


def test_a_drift_is_found_where_a_fit_without_it_is_far_off() -> None:
    """Small forces of a tapping hand: without drift, mass and stiffness came out 15 % and 9 % too large."""
    with TemporaryDirectory() as folder:
        log = recorded(68, level="drift", task="tapping")
        found = judged(log, Path(folder))
    assert all(j.determined and abs(j.error) < 0.01 for j in found)


def test_noise_does_not_undo_what_a_log_shows(tmp_path: Path) -> None:
    """What noise alone tells about the delay was subtracted from what is known, and nothing was determined."""
    log = recorded(18, level="clean", task="tapping", held=True)
    noise = 0.3 * np.random.default_rng(18).standard_normal(len(log.t))
    r = load(written(tmp_path, t=log.t, x=log.x, force=log.force + noise))
    found = fit_arm(r, Target(switches=log.switches, segments=log.segments))
    for name, true in log.truth.items():
        assert found[name].determined
        assert abs(found[name].value / true - 1) < 0.05


@pytest.mark.slow
def test_a_log_with_pauses_is_tried_with_the_other_sign(tmp_path: Path) -> None:
    log = recorded(0, level="rough", task="multisine")
    r = load(written(tmp_path, t=log.t, x=log.x, force=-log.force))
    assert len(r.stretches) > 1
    found = fit_arm(r)
    assert found.other_sign is not None
    assert found.other_sign > 0.99


def test_a_drift_is_fitted_where_there_is_one_and_not_elsewhere(tmp_path: Path) -> None:
    for level in ("clean", "drift"):
        log = recorded(0, level=level, task="multisine", seconds=6)
        found = fit_arm(load(written(tmp_path, t=log.t, x=log.x, force=log.force)))
        assert (found.drift > 0.03) == (level == "drift")
        assert found.explained > 0.98
        assert abs(found.drifts()[-1] - found.drifts()[1000]) < 5
        assert found.to_dict()["force_drift_N_per_sqrt_s"] == found.drift


def test_a_resting_target_with_rounding_hides_no_hand(tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=6)
    r = load(written(tmp_path, t=log.t, x=log.x, force=log.force))
    rounded = 0.1 + 1e-8 * np.random.default_rng(5).integers(0, 2, len(r.t))
    found = check_log(r, Target.following(rounded))
    assert all(found.determines(name) for name in ("M0", "B0", "K0"))


def test_fine_counts_take_no_more_memory_than_rows(tmp_path: Path) -> None:
    t, x, force = pushed(4.0)
    r = load(written(tmp_path, t=t, x=x + 1e-9 * np.round(x / 3e-9), force=force), count=1e-9)
    assert by_place(r, np.ones(len(t))).max() < len(t)


def pushed(seconds: float = 8.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, counted position and the force [N] towards +x that moves 0.8 kg, 3 N s/m, 0.5 N to and fro."""
    t = np.arange(0, seconds, 1e-3)
    w, size = 2 * np.pi * np.array([[0.7], [1.9]]), np.array([[0.03], [0.01]])
    v = (size * w * np.cos(w * t)).sum(0)
    force = 0.8 * -(size * w**2 * np.sin(w * t)).sum(0) + 3 * v + 0.5 * np.sign(v)
    return t, 1e-5 * np.floor((size * np.sin(w * t)).sum(0) / 1e-5), force


@pytest.mark.slow
def test_a_motor_of_the_other_sign_is_an_error_that_names_the_option(tmp_path: Path) -> None:
    """As a drive's log has it: the motor's force drives to +x."""
    t, x, force = pushed()
    path = written(tmp_path, t=t, x=x, motor=force)
    found = fit_device(load(path))
    assert found.impossible
    assert found.other_signs["motor"] > 0.99
    assert set(found.undetermined) == set(found.names)
    assert found.compensation.friction == 0
    run = CliRunner().invoke(app, ["identify", "device", str(path)])
    assert run.exit_code == 1
    assert "--flip-motor" in run.stderr
    run = CliRunner().invoke(app, ["identify", "device", str(path), "--json"])
    assert run.exit_code == 1
    run = CliRunner().invoke(app, ["identify", "device", str(path), "--flip-motor"])
    assert run.exit_code == 0
    right = fit_device(load(path, flip_motor=True))
    assert right.estimates["M_h"].value == pytest.approx(0.8, rel=0.02)
    assert right.misses == ()


@pytest.mark.parametrize("turned", ["force", "motor", "force and motor"])
def test_of_two_forces_those_of_the_other_sign_are_found(turned: str, tmp_path: Path) -> None:
    t, x, force = pushed()
    share = 0.5 + 0.3 * np.sin(1.3 * t)
    log = load(written(tmp_path, t=t, x=x, force=share * force, motor=-(1 - share) * force))
    assert fit_device(log).misses == ()
    wrong = fit_device(log.flipped(*turned.split(" and ")))
    assert max(wrong.other_signs, key=wrong.other_signs.get) == turned
    assert wrong.other_signs[turned] > 0.98


def shaken(mass: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, position and force of a hand of 40 N s/m and 2 kN/m that rests while a device shakes it."""
    t = 1e-3 * np.arange(8000)
    s = 2j * np.pi * np.fft.rfftfreq(len(t), 1e-3)
    draw = np.random.default_rng(4)
    lines = (np.abs(s) > 2) & (np.abs(s) < 50)
    motion = np.where(lines, np.exp(2j * np.pi * draw.random(len(s))), 0)
    x = np.fft.irfft(motion, len(t))
    motion *= 0.004 / x.std()
    force = -np.fft.irfft((mass * s**2 + 40 * s + 2000) * motion, len(t))
    return t, 1e-5 * np.floor(0.004 / x.std() * x / 1e-5), force + draw.normal(0, 0.05, len(t))


def test_a_hand_at_the_bound_of_the_search_is_not_determined(tmp_path: Path) -> None:
    t, x, force = shaken(11.0)
    found = fit_arm(load(written(tmp_path, t=t, x=x, force=force)))
    assert "M0" in found.undetermined
    t, x, force = shaken(8.0)
    found = fit_arm(load(written(tmp_path, t=t, x=x, force=force)))
    assert found.undetermined == ()
    assert found["M0"].value == pytest.approx(8.0, rel=0.01)


@pytest.mark.slow
@pytest.mark.weekly
def test_a_hand_that_explains_less_than_none_is_an_error(tmp_path: Path) -> None:
    t, x, force = shaken(2.0)
    path = written(tmp_path, t=t, x=x, force=-force)
    found = fit_arm(load(path))
    assert found.impossible
    assert {"M0", "B0", "K0"} <= set(found.undetermined)
    run = CliRunner().invoke(app, ["identify", "arm", str(path)])
    assert run.exit_code == 1
    assert "This is no hand" in run.stderr
    assert CliRunner().invoke(app, ["identify", "arm", str(path), "--flip-force"]).exit_code == 0
