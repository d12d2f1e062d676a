"""Recordings as loggers write them: rows off their times, lost, paused; by a simulator that is not ours."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

pytest.importorskip("scipy")

from measure import every
from recorded_arm import recorded

from ebac.cli import app
from ebac.identify import Target, check_log, fit_arm, fit_device, frequency_response, load


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
    assert any("lost rows are bridged" in text for text in r.remarks)
    found = fit_arm(r)
    assert found["K0"].value == pytest.approx(log.truth["K0"], rel=0.01)


def test_pauses_everywhere_are_refused_with_a_sentence(tmp_path: Path) -> None:
    log = recorded(0, level="clean", task="multisine", seconds=4)
    keep = log.t % 0.1 < 0.05
    with pytest.raises(ValueError, match="longest stretch has 51 rows: needs 250"):
        load(written(tmp_path, t=log.t[keep], x=log.x[keep], force=log.force[keep]))


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
    assert any("column 't' is not used" in text for text in r.remarks)
    assert load(path, count=log.count / 2).count == log.count / 2
    with pytest.raises(ValueError, match="x does not move in such steps; it shows steps of"):
        load(path, count=1.37 * log.count)
    with pytest.raises(ValueError, match="axis = 1: the file has one axis"):
        load(path, axis=1)
    result = CliRunner().invoke(app, ["identify", "arm", str(path), "--count", "0.001"])
    assert result.exit_code == 2
    assert "count = 0.001 m" in result.stderr


def test_intervals_hold_the_truth_on_rough_logs() -> None:
    """Five of them; `python tests/recordings/measure.py` takes 240 of three levels."""
    found = [j for j in every(5, ("rough",)) if j.determined]
    assert len(found) >= 9
    assert np.mean([j.held for j in found]) > 0.85
    assert max(abs(j.error) for j in found) < 0.02
