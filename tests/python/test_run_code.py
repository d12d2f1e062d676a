"""The run code that keeps a hand safe, part by part, with stand-ins: each test notices one bug of tests/mutants."""

import signal
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from ebac import _core, drives
from ebac.datasets import joystick_text
from ebac.drives.state import State
from ebac.hardware import Configuration, Run, drive_setup
from ebac.hardware.interrupts import OTHERS, SIGNALS, Interrupts, Terminated
from ebac.hardware.run_setup import run_setup

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"


@pytest.fixture
def made_of(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Say what the loop of a configuration is made of."""
    monkeypatch.setattr(_core, "RunSetup", lambda **parts: SimpleNamespace(**parts))

    def made(known: Configuration, *, real: bool = True) -> Any:
        place: Any = SimpleNamespace(sensor=None, aim=None, real=real)
        return run_setup(known, known.drives.nodes, backend=place, seconds=1.0)

    return made


@pytest.fixture
def setup(made_of: Any) -> Any:
    """What a loop is made of, for the example."""
    return made_of(Configuration.load(EXAMPLE))


@pytest.mark.parametrize(("dt", "silent", "ticks"), [(1e-3, 10, 2010), (0.04, 500, 550)])
def test_drives_that_may_be_silent_longer_have_longer_to_be_enabled(
    made_of: Any, dt: float, silent: int, ticks: int
) -> None:
    known = Configuration.load(EXAMPLE)
    patient = known.replace(silent=silent, timing=known.timing.replace(dt=dt))
    assert made_of(patient).drives["enable_ticks"] == ticks


@pytest.mark.parametrize("name", ["handle", "joystick", "joystick-3", "gastroscope-bend"])
def test_real_drives_may_be_silent_for_3_samples_and_simulated_ones_for_10(
    made_of: Any, name: str
) -> None:
    known = Configuration.from_toml(joystick_text(name))
    silent = [made_of(known, real=real).drives["silent_ticks"] for real in (True, False)]
    assert silent == [3, 10]
    assert known.timed_bus().silent_ticks == 3, "on the virtual clock no drive is late"
    given = [made_of(known.replace(silent=5), real=real) for real in (True, False)]
    assert [one.drives["silent_ticks"] for one in given] == [5, 5]


def test_the_drives_watch_the_loop_and_it_watches_them(setup: Any) -> None:
    assert setup.drives["own_node"] == 127
    assert setup.drives["heartbeat_period"] < 0.3  # s, what the profile lets pass
    assert setup.drives["heartbeat_timeout"] == pytest.approx(0.3)


def test_force_comes_in_softly(setup: Any) -> None:
    assert setup.plan.soft_start == 0.2
    assert setup.plan.arm


def test_a_drive_in_fault_is_reported_and_never_reset() -> None:
    called: list[str] = []
    drive: Any = SimpleNamespace(
        disable=lambda: State.FAULT,
        reset_fault=lambda: called.append("reset"),
        fault=lambda doing: drives.DriveError(doing),
    )
    with pytest.raises(drives.DriveError, match="being set up"):
        drive_setup._rest(drive)
    assert not called


def test_a_second_signal_hurries_and_does_not_break_the_stop() -> None:
    interrupts, hurried = Interrupts(), []
    interrupts.hurry = lambda: hurried.append(True)
    interrupts.moving()
    with interrupts:
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        assert not hurried
        signal.raise_signal(signal.SIGINT)
    assert hurried == [True]


@pytest.mark.parametrize("closed", [0, 1])
def test_several_may_be_open_and_be_closed_in_any_order(closed: int) -> None:
    """The first, closed before the second, put Python's handlers back: the next Ctrl-C did not stop the loop."""
    before = {number: signal.getsignal(number) for number in (*SIGNALS, *OTHERS)}
    both = [Interrupts(), Interrupts()]
    for one in both:
        one.__enter__()
    both.pop(closed).__exit__(None, None, None)
    (left,) = both
    left.moving()
    for number, error in ((signal.SIGTERM, Terminated), (signal.SIGINT, KeyboardInterrupt)):
        left.moving()
        with pytest.raises(error):
            signal.raise_signal(number)
        signal.raise_signal(number)  # kept
    left.__exit__(None, None, None)
    assert {number: signal.getsignal(number) for number in before} == before


def test_a_signal_while_one_is_stopped_ends_the_other_that_moves_at_once() -> None:
    hurried: list[str] = []
    with Interrupts() as stopped, Interrupts() as moves:
        for name, one in (("stopped", stopped), ("moves", moves)):
            one.hurry = lambda name=name: hurried.append(name)  # type: ignore[misc]
            one.moving()
        stopped.ending()
        signal.raise_signal(signal.SIGINT)  # not in the middle of the stop
        assert hurried == ["stopped", "moves"]
        for one in (stopped, moves):
            with pytest.raises(KeyboardInterrupt):
                one.settled()


def test_one_that_is_being_stopped_keeps_a_signal_from_the_others() -> None:
    with Interrupts() as stopped, Interrupts() as idle:
        stopped.moving()
        stopped.ending()
        signal.raise_signal(signal.SIGINT)
        idle.settled()
        with pytest.raises(KeyboardInterrupt):
            stopped.settled()


def bare_run(**parts: Any) -> tuple[Run, list[bool]]:
    """A run whose loop has one tick left, and how it was asked to stop."""
    asked: list[bool] = []
    ticks = iter([False, True, True, True, True])
    running = SimpleNamespace(
        wait=lambda _: next(ticks),
        stop=lambda at_once=False: asked.append(at_once),
        join=lambda: None,
        done=True,
        state=_core.LoopState.IDLE,
        rows=SimpleNamespace(count=1),
        bus=SimpleNamespace(sent=0, received=0, refused=0, lost=0),
        changes_lost=0,
    )
    run = Run.__new__(Run)
    values = {
        "_running": running,
        "_lock": threading.RLock(),
        "_positions": (),
        "_interrupts": Interrupts(),
        "_parent": None,
        "_grants": [],
        "_ended_by": "",
        "_power_off": list,
        "recorder": None,
        "report": None,
        **parts,
    }
    for name, value in values.items():
        setattr(run, name, value)
    return run, asked


def test_a_drive_that_keeps_its_power_is_reported() -> None:
    def fail() -> list[str]:
        raise drives.DriveError("node 2 has power")

    run, _ = bare_run(_power_off=fail)
    with pytest.raises(drives.DriveError, match="has power"):
        run.end()


def test_whatever_fails_at_the_end_the_log_is_closed_and_there_is_a_report() -> None:
    def fail() -> list[str]:
        raise ValueError("no state of CiA 402")

    def close() -> None:
        raise UserWarning("2 rows were lost")  # a warning where warnings are errors

    recorder = SimpleNamespace(close=close, path=Path("run.mcap"), written=1, lost=2)
    run, _ = bare_run(_power_off=fail, recorder=recorder)
    with pytest.raises(ValueError, match="no state of CiA 402") as caught:
        run.end()
    assert caught.value.__notes__ == ["2 rows were lost"]
    assert run.report is not None
    assert run.report.lost_rows == 2


def test_a_recorder_that_fails_ends_the_run() -> None:
    run, asked = bare_run(recorder=SimpleNamespace(error=OSError("disk full")))
    run.wait()
    assert asked == [False]
