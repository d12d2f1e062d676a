"""A log without the motor's force: intervals that hold the truth, and a remark."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from ebac import Scenario, identify, simulate
from ebac._core import Device, ForceSensor, Free, Hand, Mechanics, Step
from ebac.cli import app
from ebac.datasets.logs import NOISE, Perturbation
from ebac.identify import Recording, excitation
from ebac.identify.unrecorded_motor import late


def pushed(
    seed: int, mass: float, damping: float, stiffness: float, lag: float, handle: float = 0.25
) -> Recording:
    """Return a log as that of `ebac demo arm`, of another hand, device and force sensor."""
    _, force = excitation.multisine(6.0, low=0.3, high=20.0, seconds=10.0, tries=0)
    scenario = Scenario(
        device=Device(
            mechanics=Mechanics(handle_mass=handle), sensor=ForceSensor(noise=NOISE, lag=lag)
        ),
        hand=Hand(mass=mass, damping=damping, stiffness=stiffness, path=Step(target=0.0)),
        environment=Free(),
        seconds=10.0,
        seed=seed,
    )
    trace = simulate(scenario, Perturbation([*force[137 * seed :], *force[: 137 * seed]]))
    return Recording.from_trace(trace)


HANDS = (
    (1, 0.35, 6.0, 300.0, 0.0, 0.25),
    (2, 0.35, 6.0, 300.0, 0.0, 0.25),
    (3, 0.15, 6.0, 300.0, 0.0, 0.25),
    (4, 0.8, 15.0, 800.0, 0.0, 0.25),
    (5, 0.05, 3.0, 100.0, 0.0, 0.25),
    (6, 0.35, 6.0, 300.0, 0.0, 1.0),
    (7, 0.35, 6.0, 300.0, 0.0, 0.05),
    (8, 1.2, 4.0, 1000.0, 0.0, 0.5),
    (9, 0.2, 20.0, 200.0, 2e-4, 0.25),
    (10, 0.35, 6.0, 300.0, 8e-4, 0.25),
)


@pytest.mark.slow
@pytest.mark.weekly
def test_without_the_motor_the_intervals_hold_the_truth() -> None:
    apart = []
    for seed, mass, damping, stiffness, lag, handle in HANDS:
        recording = pushed(seed, mass, damping, stiffness, lag, handle)
        result = identify.fit_arm(replace(recording, motor=None))
        for name, true in (("M0", mass), ("B0", damping), ("K0", stiffness)):
            width = result[name].high - result[name].low
            apart.append(abs(result[name].value - true) / width)
            assert width < 0.08 * true, name
    assert np.mean(np.array(apart) <= 0.5) >= 0.9
    assert max(apart) < 0.75


@pytest.mark.parametrize("tenths", [-2, 0, 3])
def test_the_steps_of_a_motor_are_found_wherever_between_two_rows_they_fall(tenths: int) -> None:
    """Of a motor that takes the whole force, the fit finds by how much that makes it late."""
    recording = pushed(1, 0.35, 6.0, 300.0, 0.0)
    late = 0.1 * tenths * recording.dt
    again = identify.fit_arm(replace(recording, motor=None), fixed={"delay": late})
    delay = again.parameters.names.index("delay")
    assert again.values[delay] == pytest.approx(2.4e-4, abs=2e-5)
    assert again["K0"].value == pytest.approx(300.0, rel=1e-3)


def test_a_remark_says_what_the_missing_motor_costs() -> None:
    recording = pushed(1, 0.35, 6.0, 300.0, 0.0)
    assert identify.fit_arm(recording).notes == ()
    result = identify.fit_arm(replace(recording, motor=None))
    (text,) = result.notes
    assert "no motor force" in text
    assert "reads late by a part of one: +0.23 ms" in text
    assert text in repr(result)
    assert result.to_dict()["notes"] == [text]


def test_a_slow_force_sensor_hides_the_steps_of_a_motor() -> None:
    recording = replace(pushed(1, 0.35, 6.0, 300.0, 8e-4), motor=None)
    assert identify.fit_arm(recording).notes == ()


@pytest.mark.parametrize("lag", [0.0, 2e-4, 1e-3, 3e-3])
def test_a_force_is_late_by_what_the_lag_leaves_of_a_sawtooth(lag: float) -> None:
    recording = replace(pushed(1, 0.35, 6.0, 300.0, 0.0), motor=None, lag=lag)
    phase = (np.arange(1000) + 0.5) / 1000 * recording.dt
    if lag:  # of a step each tick behind a lag, less its mean
        decay = np.exp(-phase / lag) / -np.expm1(-recording.dt / lag)
        sawtooth = phase / recording.dt + decay
    else:
        sawtooth = phase / recording.dt
    assert late(recording) == pytest.approx(np.std(sawtooth), rel=0.01)
    assert late(replace(recording, motor=recording.x)) == 0


@pytest.mark.slow
@pytest.mark.weekly
def test_the_command_prints_the_note(tmp_path: Path) -> None:
    recording = pushed(1, 0.35, 6.0, 300.0, 0.0)
    rows = np.column_stack([recording.t, recording.x, recording.force])
    np.savetxt(tmp_path / "log.csv", rows, delimiter=",", header="t,x,force", comments="")
    words = ["identify", "arm", str(tmp_path / "log.csv")]
    assert "The log has no motor force." in CliRunner().invoke(app, words).output
    assert json.loads(CliRunner().invoke(app, [*words, "--json"]).output)["notes"]
    CliRunner().invoke(app, [*words, "--out", str(tmp_path / "report")])
    assert "The log has no motor force." in (tmp_path / "report" / "arm.html").read_text("utf-8")


@pytest.mark.slow
def test_delays_of_several_recordings_correct_a_shared_hand_once() -> None:
    recordings = [replace(pushed(seed, 0.35, 6.0, 300.0, 0.0), motor=None) for seed in (1, 2, 3)]
    one = identify.fit_arm(recordings)
    each = identify.fit_arm(recordings, own=["delay"])
    for name, true in (("M0", 0.35), ("B0", 6.0), ("K0", 300.0)):
        half = 0.5 * (each[name].high - each[name].low)
        assert each[name].value == pytest.approx(true, abs=1.5 * half, rel=5e-4), name
        assert each[name].value == pytest.approx(one[name].value, abs=0.5 * half), name


def test_a_recording_with_its_motor_keeps_its_delay() -> None:
    driven = pushed(1, 0.35, 6.0, 300.0, 0.0)
    blind = replace(pushed(2, 0.35, 6.0, 300.0, 0.0), motor=None)
    result = identify.fit_arm([driven, blind], own=["delay"])
    found = dict(zip(result.parameters.names, result.values.tolist(), strict=True))
    assert found["delay@1"] == 0
    assert found["delay@2"] == pytest.approx(2.4e-4, abs=2e-5)


def test_a_delay_that_was_given_is_shown_as_given() -> None:
    recording = replace(pushed(1, 0.35, 6.0, 300.0, 0.0), motor=None)
    result = identify.fit_arm(recording, fixed={"delay": 1e-4})
    assert result["delay"].value == 1e-4
    assert result["delay"].fixed


def test_columns_that_are_not_used_are_named_since_one_may_be_the_motor() -> None:
    recording = pushed(*HANDS[0])
    lacks = replace(recording, motor=None, unread=("Motor Kraft",))
    told = "not used: Motor Kraft (columns={'motor': 'Motor Kraft'})"
    assert any(told in note for note in identify.fit_arm(lacks).notes)
    assert not any("not used" in note for note in identify.fit_arm(recording).notes)
