"""Taps of a person, who is no metronome: what `ebac identify log` advises is what such a log needs."""

from pathlib import Path

import numpy as np
import pytest
from metronome import LOW, RATE, SECONDS, log
from typer.testing import CliRunner

from ebac.cli import app
from ebac.datasets import write
from ebac.identify import Recording, Target, check_log, fit_arm


@pytest.fixture(scope="module")
def taps() -> Recording:
    return log(3, 0.03)


def file_of(taps: Recording, folder: Path) -> Path:
    np.savez(folder / "taps.npz", t=taps.t, x=taps.x, force=taps.force, motor=taps.motor)
    return folder / "taps.npz"


def said(*words: str) -> str:
    done = CliRunner().invoke(app, ["identify", "log", *words])
    assert done.exit_code == 1
    return " ".join(done.output.split())


def test_a_right_force_of_taps_is_not_simply_to_be_turned() -> None:
    """In 4 of 10 logs of a hand that taps, spectra without its target show device and wall, by the other sign."""
    taps = log(1, 0.03)
    assert check_log(taps, Target.held()).other_sign
    row = check_log(taps, Target.held()).rows()[0]
    assert str(row["remedy"]).startswith(
        "give the target if the hand moved on its own; else --flip"
    )


def test_taps_without_a_target_are_asked_for_it(taps: Recording, tmp_path: Path) -> None:
    told = said(str(file_of(taps, tmp_path)))
    assert "taken as held in one place. If it moved on its own, as in taps, record the path" in told
    assert "column target, or give its times by --switch" in told


def test_taps_off_the_beat_are_not_said_to_be_slow_only(taps: Recording, tmp_path: Path) -> None:
    told = said(str(file_of(taps, tmp_path)), "--tapping", str(RATE))
    assert "the target is that of a metronome. Taps must be on the beat within 3 ms" in told


def test_what_is_advised_helps(taps: Recording) -> None:
    path = taps.path.x if taps.path is not None else []
    at = np.flatnonzero(np.diff(np.asarray(path)[: len(taps.t)])) + 1
    assert len(at) > 1.5 * RATE * SECONDS
    by_switch = Target.steps(*taps.t[at].tolist())
    by_column = Target.following(np.asarray(path)[: len(taps.t)] - LOW)
    for target in (by_switch, by_column):
        check = check_log(taps, target)
        assert all(check.determines(name) for name in ("M0", "B0", "K0"))


def test_a_metronome_that_is_right_gets_no_advice(tmp_path: Path) -> None:
    write("tapping", tmp_path)
    words = ["identify", "log", str(tmp_path / "tapping.mcap"), "--tapping", "0.8"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0
    assert "metronome" not in done.output


@pytest.mark.slow
@pytest.mark.weekly
def test_a_wrong_target_is_not_taken_for_a_wrong_sign(tmp_path: Path) -> None:
    """With one switch of twelve the fit had no stiffness, which was said to be the device, by the other sign."""
    write("tapping", tmp_path)
    words = ["identify", "arm", str(tmp_path / "tapping.mcap"), "--switch", "1.0"]
    done = CliRunner().invoke(app, words)
    told = " ".join(done.output.split())
    assert done.exit_code == 1
    assert "is the target of the hand the right one (--switch with the time of every step" in told
    assert "other sign" not in told
    assert "--flip-force" not in told
    assert "VAF below 0" in told
    assert "late" not in told  # with another target it may be not


@pytest.mark.slow
@pytest.mark.weekly
def test_a_metronome_that_is_wrong_is_not_taken_for_a_wrong_sign() -> None:
    """The spectra by a target of 1.0 Hz, where the hand taps at 0.8 Hz, showed a hand by the other sign only."""
    result = fit_arm(log(1, 0.0), Target.tapping(1.0, SECONDS))
    assert result.other_sign is not None
    assert 0.5 < result.other_sign < 0.9
    assert result.flip == ""
    assert not any("--flip-force" in text for text in result.misses)
    right = fit_arm(log(1, 0.0).flipped(), Target.tapping(RATE, SECONDS))
    assert right.flip == "fit", "a sign that is wrong is still named"
