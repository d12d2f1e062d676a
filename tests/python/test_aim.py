"""A simulated hand that is told where to go while a loop runs, and changes at times that are known before."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from busy_machine import patient_file
from typer.testing import CliRunner

import ebac
from ebac._core import Joystick, SharedHandTarget
from ebac.cli import app
from ebac.hardware import Configuration, Run
from ebac.hardware.schedule import Order, Schedule

pytestmark = pytest.mark.real_time

#: The fixture: waits for something that happens while a loop runs.
Until = Callable[[Run, Callable[[], bool]], None]

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
STAY = float("nan")


def patient(**changes: object) -> Configuration:
    """The example without a wall, patient with a busy machine, its hand still."""
    known = Configuration.load(EXAMPLE)
    return known.replace(
        silent=1000,
        limits=known.limits.replace(
            overruns=100_000, pause=100, force_age=10, jump=1.0, speed=100.0
        ),
        environment=ebac.Free(),
        hand=known.hand.replace(path=[ebac.Step(target=0.0)] * 3),
        soft_start=0.05,
        ramp_down=0.05,
    ).replace(**changes)


def passed(joystick: Joystick, seconds: float) -> list[float]:
    """Where the axes are so much later [m]."""
    for _ in range(round(seconds / 0.01)):
        joystick.elapse(0.01)
    return [joystick.truth(axis).x for axis in range(joystick.axes)]


def test_the_hand_follows_its_cell_and_an_axis_that_is_not_told_stays() -> None:
    cell = SharedHandTarget()
    joystick = Joystick(patient().scenario().setup(), aim=cell)
    assert passed(joystick, 1) == [0, 0]
    cell.post([0.03, STAY, STAY])
    x, y = passed(joystick, 3)
    assert abs(x - 0.03) < 1e-3
    assert y == 0
    cell.post([STAY, -0.02, STAY])
    x, y = passed(joystick, 3)
    assert abs(x - 0.03) < 1e-3
    assert abs(y + 0.02) < 1e-3


@pytest.mark.parametrize("path", [ebac.MinimumJerk(target=0.02), ebac.Sine(), ebac.Tapping()])
def test_every_path_but_a_recorded_one_is_left(path: object) -> None:
    cell = SharedHandTarget()
    joystick = Joystick(patient(hand=ebac.Hand(path=[path])).scenario().setup(), aim=cell)
    passed(joystick, 1)
    cell.post([-0.03, STAY, STAY])
    assert abs(passed(joystick, 3)[0] + 0.03) < 1e-3


def test_another_process_gives_the_target_by_the_same_cell() -> None:
    cell = SharedHandTarget()
    joystick = Joystick(patient().scenario().setup(), aim=cell)
    script = f"from ebac._core import SharedHandTarget; SharedHandTarget({cell.descriptor}).post([0.03, {STAY!r}, 0.0])"
    script = f"nan = float('nan'); {script}"
    subprocess.run([sys.executable, "-c", script], pass_fds=[cell.descriptor], check=True)
    assert abs(passed(joystick, 3)[0] - 0.03) < 1e-3


def test_what_is_no_cell_is_refused(tmp_path: Path) -> None:
    with (tmp_path / "file").open("w+b") as file:
        with pytest.raises(ValueError, match="bytes expected"):
            SharedHandTarget(file.fileno())
        number = os.dup(file.fileno())
        os.close(number)
        with pytest.raises(OSError, match=f"descriptor {number}"):
            SharedHandTarget(number)


def test_a_target_acts_within_a_run_and_is_in_its_log(tmp_path: Path, until: Until) -> None:
    log = tmp_path / "run.mcap"
    with ebac.Device.open(patient(), simulate=True) as device:
        with device.start(seconds=60, log=log) as run:
            until(run, lambda: run.state is ebac.LoopState.RUN and run.ticks >= 300)
            assert run.target == (None, None)
            assert run.set_target(0.03) == (0.03, None)
            until(run, lambda: bool(run.tail(1)["x"][-1, 0] > 0.02))
            assert run.set_target(None, -0.02) == run.target == (0.03, -0.02)
            until(run, lambda: bool(run.tail(1)["x"][-1, 1] < -0.01))
            for wrong, words in (
                ((11.0,), r"Step.target = 11 m: must lie in \[-10, 10\] m"),
                ((0, 0, 0), "3 numbers for 2 axes"),
                ((), "0 numbers for 2 axes"),
            ):
                with pytest.raises(ValueError, match=words):
                    run.set_target(*wrong)
            run.stop()
        trace = run.finish()
        with pytest.raises(RuntimeError, match="has ended"):
            run.set_target(0.0)
    events = [e for e in ebac.logs.read(log).events if e.kind == "parameter"]
    assert [e.values for e in events] == [{"hand.target_0": 0.03}, {"hand.target_1": -0.02}]
    assert events[0].message == "hand target, axis 0: 0.03 m"
    first = int(np.searchsorted(trace["tick"], events[0].tick))
    assert np.abs(trace["x"][: first + 1, 0]).max() < 1e-3  # nothing before it was taken
    shown = CliRunner().invoke(app, ["log", "info", str(log)])
    assert "hand target, axis 0: 0.03 m" in " ".join(shown.output.split())


def test_a_hand_of_flesh_goes_where_it_wants(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    known = patient(interface="ebac", channel="joystick-aim", setup="apply", sensor=None)
    with ebac.Device.open(known) as device, device.start(seconds=60) as run:
        with pytest.raises(ValueError, match="no simulated hand holds this device"):
            run.set_target(0.03)
        run.stop()


def test_a_recorded_path_is_kept_and_said_so() -> None:
    path = ebac.Recorded(t=[0.0, 1.0], x=[0.0, 0.01])
    known = patient(hand=ebac.Hand(path=[path]))
    with pytest.raises(ValueError, match=r"axis 0: follows a recorded path"):
        Schedule([Order(at=1, target=(0.0,))]).check(known, simulated=True)


def test_a_world_of_bodies_is_changed_as_a_whole() -> None:
    known = patient(environment=ebac.worlds.preset("sphere"))
    with pytest.raises(
        ValueError, match=r"environment\.stiffness: a world of bodies is changed as a whole"
    ):
        Schedule([Order(at=1, environment={"stiffness": 2e4})]).check(known, simulated=True)


# --- at times known before ---


def test_an_order_is_read() -> None:
    order = Order.parse("3 environment.stiffness=2e4 law.kp=0 hand.target_1=-0.01")
    assert order == Order(
        at=3.0, law={"kp": 0}, environment={"stiffness": 2e4}, target=(None, -0.01)
    )
    assert Order.parse("0.5 hand.target=0.02").target == (0.02,)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "must be a time"),
        ("3", "must be a time"),
        ("-1 law.kp=0", "must be a time"),
        ("nan law.kp=0", "must be a time"),
        ("soon law.kp=0", "'soon' is no number"),
        ("3 law.kp", "must be law.NAME=NUMBER"),
        ("3 wall.stiffness=1", "must be law.NAME=NUMBER"),
        ("3 law.kp=much", "'much' is no number"),
        ("3 hand.taget=1", "did you mean"),
        ("3 law.kq=0", "kq"),
        ("3 law.kp=-1", "--at 3 s: law.kp = -1"),
        ("3 law.damping=1", "cannot change from"),
        ("3 environment.stiffness=-5", "--at 3 s: environment.stiffness = -5 N/m"),
        ("3 environment.radius=1", "radius"),
        ("3 hand.target=20", "--at 3 s: hand.target = 20 m: must lie in [-10, 10] m"),
        ("10 law.kp=0", "the run ends after 10 s"),
    ],
)
def test_an_order_that_cannot_be_is_refused_before_anything_moves(text: str, words: str) -> None:
    result = CliRunner().invoke(
        app, ["run", str(EXAMPLE), "--simulated", "--no-files", "--at", text]
    )
    assert result.exit_code == 2, result.output
    said = " ".join(result.output.split())
    assert said.startswith("Error: --at"), said
    assert words in said


def test_on_hardware_no_target_is_taken() -> None:
    result = CliRunner().invoke(
        app, ["run", str(EXAMPLE), "--no-files", "--at", "1 hand.target=0.01"]
    )
    assert result.exit_code == 2
    assert "no simulated hand" in " ".join(result.output.split())


@pytest.mark.slow
def test_the_command_changes_parameters_at_their_times(tmp_path: Path) -> None:
    config = tmp_path / "joystick.toml"
    config.write_text(patient_file(EXAMPLE.read_text(encoding="utf-8")), encoding="utf-8")
    orders = ["1 hand.target=-0.01", "0.5 environment.stiffness=5e3 law.kp=0"]
    command = ["run", str(config), "--simulated", "--seconds", "1.5", "--out", str(tmp_path / "o")]
    ran = CliRunner().invoke(
        app, [*command, "--no-live", "--json", "--at", orders[0], "--at", orders[1]]
    )
    assert ran.exit_code == 0, ran.output
    log = ebac.logs.read(json.loads(ran.stdout)["log"])
    begun = ebac.hardware.under_the_law(log.trace)
    first = log.trace["t"][log.trace["state"] == ebac.LoopState.RUN][0]
    assert begun["t"][0] == 0
    told = [e for e in log.events if e.kind == "parameter"]
    assert [set(e.values) for e in told] == [
        {"law.kp"},
        {"environment.stiffness"},
        {"hand.target_0"},
    ]
    for event, at in zip(told, (0.5, 0.5, 1.0), strict=True):
        assert event.t - first >= at - 2e-3
