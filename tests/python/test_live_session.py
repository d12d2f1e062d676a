"""A loop that is changed while it runs, as the page of `ebac live` does."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import ebac
from ebac.drives import DriveError
from ebac.live.choices import Choices, base_of, options
from ebac.live.frames import Frames
from ebac.live.intended_hand import IntendedHand
from ebac.live.session import Session

pytestmark = pytest.mark.real_time

#: What served/main.js reads of a frame.
FRAME = {"kind", "run", "target", "x", "force", "strips", "verdict", "late_us", "skipped"}


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    with Session(folder=tmp_path) as one:
        yield one


def until(session: Session, true: Callable[[], bool], seconds: float = 10.0) -> None:
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, f"it did not come: {told(session)}"
        time.sleep(0.02)


def told(session: Session) -> str:
    """Return the fault of a session in the words of a loop: those of a stall have the test repeated."""
    fault = session.fault
    return f"fault {int(fault)} ({fault.name.lower().replace('_', ' ')})"


def in_contact(session: Session) -> bool:
    assert session.run is not None
    tail = session.run.tail(300)
    return len(tail) == 300 and bool(np.abs(tail.axis("f_env", 0)).min() > 5)


@pytest.mark.slow
def test_law_world_and_delay_change_while_the_loop_runs(session: Session) -> None:
    session.change(observer=False)
    session.start()
    until(session, lambda: in_contact(session))
    run = session.run
    assert run is not None
    for change in (
        {"law": "eba"},
        {"delay": 3},
        {"delay": 1},
        {"stiffness": 5e3},
        {"world": "sphere"},
    ):
        assert session.change(**change) is False
        acts = run.ticks + 150
        until(session, lambda at=acts: run.ticks > at)
    assert session.run is run
    assert session.starts == 1
    assert run.law.name == "eba"
    kinds = [what for _, _, what in run._running.changes(0)]
    assert kinds == ["law", "law", "delay", "law", "delay", "environment", "environment"]
    log = session.record()
    session.change(law="ebac")
    time.sleep(0.1)
    assert session.stop_recording() > 50
    events = ebac.logs.read(log).events
    assert any("eba -> EBAC" in one.message for one in events)


def test_a_law_that_takes_over_makes_no_step(session: Session) -> None:
    session.start()
    until(session, lambda: in_contact(session))
    assert session.run is not None
    time.sleep(0.5)
    session.change(law="direct")
    time.sleep(0.2)
    tail = session.run.tail(400)
    tick = session.run._running.changes(0)[0][0]
    at = int(np.searchsorted(tail["tick"], tick))
    force = tail.axis("f_cmd", 0)
    assert abs(force[at] - force[at - 1]) < 1e-6
    assert np.all(tail["law.energy"][at:] == 0)  # columns of the first law


@pytest.mark.slow
def test_what_needs_a_restart_is_restarted(session: Session) -> None:
    session.start()
    assert session.choices.observer
    assert session.change(delay=2) is True
    assert session.starts == 2
    session.change(observer=False, hand="finger")
    assert session.change(delay=1) is False
    session.change(device="joystick-3")
    assert session.run is not None
    until(session, lambda: session.run.ticks > 200)  # type: ignore[union-attr]
    assert session.run.tail(1).axes == 3
    assert not session.fault, told(session)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"law": "magic"}, "magic"),
        ({"stiffness": 1e9}, r"must lie in \[100, 50000\] N/m"),
        ({"stiffness": float("nan")}, "must lie in"),
        ({"delay": 1.5}, "must be a whole number of samples"),
        ({"stiffness": "20 kN/m"}, "must be a number of N/m, without unit"),
        ({"observer": 1}, "true or false"),
        ({"limits": 3}, "limits"),
    ],
)
def test_what_cannot_be_is_refused_by_name(change: dict[str, object], message: str) -> None:
    with pytest.raises((ValueError, KeyError), match=message):
        Choices().with_changes(change)


def test_numbers_of_numpy_can_be_chosen() -> None:
    given = {"stiffness": np.float32(5e3), "damping": np.int64(2), "delay": np.int64(2)}
    chosen = Choices().with_changes(given)
    assert chosen == Choices(stiffness=5e3, damping=2, delay=2)
    assert {type(value) for value in chosen.row().values()} <= {int, float, str, bool}
    with pytest.raises(ValueError, match="must be a whole number of samples"):
        Choices().with_changes({"delay": np.float64(2)})


def test_every_name_can_be_chosen() -> None:
    for name, values in options().items():
        for value in values:
            assert Choices().with_changes({name: value}).row()[name] == value


@pytest.mark.slow
def test_dragging_moves_the_handle_and_leaving_lets_the_force_fade(session: Session) -> None:
    session.start()
    until(session, lambda: session.run is not None and session.run.ticks > 400)
    session.hand.drag([0.03, 0.0])
    until(session, lambda: session.hand.place == [0.03, 0.0] and in_contact(session))
    assert session.run is not None
    time.sleep(0.5)
    held = abs(float(session.run.tail(50).axis("f_meas", 0).mean()))
    assert held == pytest.approx(300 * (0.03 - 0.0106), abs=0.4)
    session.hand.leave()
    time.sleep(0.3)
    assert abs(float(session.run.tail(50).axis("f_meas", 0).mean())) == pytest.approx(held, abs=0.3)
    time.sleep(1.2)
    assert abs(float(session.run.tail(50).axis("f_meas", 0).mean())) < 0.1 * held
    assert session.running, told(session)


def test_a_hand_moves_before_or_after_it_is_left_and_never_between() -> None:
    trouble: list[Exception] = []

    class Watched(IntendedHand):
        def __setattr__(self, name: str, value: object) -> None:
            super().__setattr__(name, value)
            if name == "_left" and value is not None:  # the session's thread comes in between
                others.append(threading.Thread(target=moved))
                others[-1].start()
                others[-1].join(0.1)

    def moved() -> None:
        try:
            hand.move()
        except Exception as error:
            trouble.append(error)

    others: list[threading.Thread] = []
    hand = Watched(base_of(None, "reference"))
    hand.drag([0.03, 0.0])
    hand.leave()
    others[0].join()
    assert hand.fades
    assert trouble == []


@contextmanager
def key_held(session: Session) -> Iterator[None]:
    """Hold the dead-man key in the block, also during a start, which may take longer than 0.3 s."""
    over = threading.Event()

    def hold() -> None:
        while not over.wait(0.05):
            session.hold()

    session.hold()
    holder = threading.Thread(target=hold)
    holder.start()
    try:
        yield
    finally:
        over.set()
        holder.join()


def test_a_dead_man_key_starts_and_stops_it(tmp_path: Path) -> None:
    with Session(dead_man=True, folder=tmp_path) as session:
        with pytest.raises(PermissionError, match="dead-man key"):
            session.start()
        with key_held(session):
            session.start()
            run = session.run
            assert run is not None
            until(session, lambda: run.ticks > 1000)
            assert session.running, told(session)
        released = time.monotonic()
        until(session, lambda: not session.running, 3)
        assert time.monotonic() - released < 1.5
        until(session, lambda: run.report is not None)
        assert run.report is not None
        assert run.report.ended_by == "dead-man key", told(session)
        assert all(state == "switch on disabled" for state in run.report.drives), run.report.drives


def test_a_closed_session_is_not_started_again(tmp_path: Path) -> None:
    session = Session(dead_man=True, folder=tmp_path)
    session.close()
    session.hold()
    for again in (session.start, session.reset):
        with pytest.raises(RuntimeError, match="this session is closed: make a new one"):
            again()
    assert session.run is None


def test_a_session_whose_run_ends_badly_lets_go_of_its_device(tmp_path: Path) -> None:
    session = Session(folder=tmp_path)
    session.start()
    run = session.run
    assert run is not None
    power_off = run._power_off

    def fail() -> list[str]:
        power_off()
        raise DriveError("node 1 did not answer")

    run._power_off = fail
    with pytest.raises(DriveError, match="did not answer"):
        session.close()
    assert session._device is None


def test_whatever_goes_wrong_beside_it_the_dead_man_key_is_watched(tmp_path: Path) -> None:
    with Session(dead_man=True, folder=tmp_path) as session:
        for _ in range(2):  # and again in the next run
            with key_held(session):
                session.start()
                until(session, lambda: bool(session.run and session.run.ticks > 0))
                session.hand._left, session.hand._left_at = 0.0, []  # a hand of other axes
                until(session, lambda: bool(session.run and session.run.done))
            assert session.trouble
            assert session._watch.is_alive()


def test_a_scenario_is_saved_whole_or_not_at_all(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What failed on the way left an empty file."""

    def fails(*_: object, **more: object) -> str:
        raise OSError("no mesh")

    monkeypatch.setattr(ebac.Scenario, "to_toml", fails)
    with pytest.raises(OSError, match="no mesh"):
        session.save()
    assert list(session.folder.iterdir()) == []
    assert session.kept == []


def test_a_save_replaces_no_file_of_another_session(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Which has taken the same name in the same second."""
    theirs = session.folder / "live-1.toml"
    session.folder.mkdir(parents=True, exist_ok=True)
    theirs.write_text("theirs")
    monkeypatch.setattr(Session, "_new", lambda *_: theirs)
    with pytest.raises(FileExistsError):
        session.save()
    assert theirs.read_text() == "theirs"


@pytest.mark.slow
def test_frames_have_rows_words_and_history(session: Session) -> None:
    frames = Frames(session)
    assert frames.frame()["verdict"]["head"] == "At rest"
    session.start()
    until(session, lambda: in_contact(session))
    time.sleep(2)
    frame = frames.frame()
    assert set(frame) == FRAME
    assert frame["verdict"]["kind"] in ("good", "fair")
    assert len(frame["strips"]["t"]) == len(frame["strips"]["energy"]) > 100
    rest = ebac.contact(ebac.simulate(session.scenario, "ebac")).rest_m  # 10.9 mm
    assert frame["x"][0] == pytest.approx(rest, abs=3e-4)
    saved = session.save()
    assert ebac.Scenario.load(saved).hand.path[0].target == pytest.approx(0.04)
