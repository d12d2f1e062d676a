"""A session on a virtual clock: what it gives depends on orders and their ticks, not on the machine."""

import gc
import json
import subprocess
import sys
import time
import weakref
from pathlib import Path

import numpy as np
import pytest

import ebac
from ebac import datasets
from ebac.hardware import Configuration
from ebac.hardware.virtual_device import VirtualDevice
from ebac.live import serve
from ebac.live.frames import Frames, verdict
from ebac.live.session import Session

KNOWN = Configuration.from_toml(datasets.joystick_text("joystick"), name="joystick")


@pytest.fixture
def session(tmp_path: Path) -> Session:
    return Session(virtual=True, paced=False, folder=tmp_path)


def rows(session: Session) -> dict[str, bytes]:
    assert session.run is not None
    tail = session.run.tail(10_000)
    assert len(tail) == session.run.ticks
    return {
        one: np.nan_to_num(tail[one]).tobytes()
        for one in ("tick", "x", "f_cmd", "f_meas", "true.x")
    }


def test_in_steps_it_is_the_run_of_ebac_run_virtual_to_the_bit() -> None:
    device = VirtualDevice(KNOWN, delay=KNOWN.timing.delay)
    run = device.start(KNOWN.design(), KNOWN.environment)
    for ticks in (1, 7, 500, 493):
        assert run.advance(ticks) == ticks
    whole = KNOWN.simulate(seconds=1.0)
    steps = run.tail(1001)
    assert len(steps) == 1001
    for name in ("x", "f_env", "f_cmd", "f_applied", "f_meas", "law.beta", "bus.missing"):
        assert np.array_equal(steps[name], whole[name][:1001], equal_nan=True), name
    run.stop()
    device.close()
    assert run.done
    assert run.report is not None
    assert run.report.ended_by == "stop"
    assert float(np.abs(run.tail(5)["f_applied"]).max()) == 0


def test_a_closed_session_is_gone_with_its_rows_as_soon_as_nobody_holds_it(tmp_path: Path) -> None:
    """They are 50 MB, which a collector of Python's own objects does not count."""
    gc.disable()
    try:
        with Session(virtual=True, paced=False, folder=tmp_path) as one:
            one.start()
            one.advance(0.1)
        gone = [weakref.ref(one), weakref.ref(one.run)]
        del one
        assert [found() for found in gone] == [None, None]
    finally:
        gc.enable()


#: A world in Python is called by one thread, while another one aims: each waited for what the other one had.
TWO_THREADS = """
from threading import Thread
from ebac import datasets, worlds
from ebac.hardware import Configuration
from ebac.hardware.virtual_device import VirtualDevice

known = Configuration.from_toml(datasets.joystick_text("joystick"), name="joystick")
device = VirtualDevice(known, delay=1)
run = device.start(known.design(), worlds.FunctionWorld(lambda x, v: None))
work = Thread(target=lambda: run.advance(2000))
work.start()
while work.is_alive():
    run.aim_now([0.01, 0.0, 0.0])
device.close()
"""


@pytest.mark.slow
def test_the_hand_is_aimed_from_another_thread_while_a_world_in_python_is_called() -> None:
    subprocess.run([sys.executable, "-c", TWO_THREADS], check=True, timeout=60)


def test_the_same_orders_give_the_same_bits_however_time_is_cut(tmp_path: Path) -> None:
    def played(cut: float, wait: float) -> dict[str, bytes]:
        with Session(virtual=True, paced=False, folder=tmp_path) as session:
            session.start()
            for orders in (
                {"law": "eba"}, {"stiffness": 2e4}, {"world": "sphere"}, {"law": "ebac"},
            ):  # fmt: skip
                for _ in range(round(0.24 / cut)):
                    session.advance(cut)
                session.change(**orders)
                time.sleep(wait)
            session.hand.drag([0.025, 0.003])
            session.advance(0.48)
            return rows(session)

    first, second = played(0.24, 0.0), played(0.008, 0.02)
    assert len(first["tick"]) == 8 * 1440
    assert first == second


def test_no_order_makes_a_step_of_the_force_and_each_is_noted(session: Session) -> None:
    with session:
        session.change(observer=False)
        session.start()
        session.advance(2.0)
        run = session.run
        assert run is not None
        orders = (
            {"stiffness": 2e4}, {"world": "disc"}, {"world": "sphere"}, {"damping": 20.0},
            {"world": "free"}, {"world": "wall"}, {"law": "eba"}, {"world": "as configured"},
        )  # fmt: skip
        for order in orders:
            before = run.ticks
            assert session.change(**order) is False
            session.advance(0.16)
            force = run.tail(run.ticks - before + 1).axis("f_cmd", 0)
            assert abs(force[1] - force[0]) < 0.05, order  # N
        assert session.run is run
        ticks = [tick for tick, _, _ in run._running.changes(0)]
        assert ticks == [2000 + 160 * k for k in range(len(orders))]
        assert not session.fault


def test_a_recording_begins_where_it_was_asked_for(session: Session) -> None:
    """It had the rows from before, as far as the loop still had them."""
    with session:
        session.start()
        session.advance(0.5)
        begun = session.run.ticks if session.run else 0
        log = session.record()
        session.advance(0.3)
        time.sleep(0.2)
        recorded = session.stop_recording()
    trace = ebac.logs.read(log).trace
    assert trace["tick"][0] == begun > 400
    assert 300 <= len(trace) == recorded < 310


def test_a_recording_has_every_order_with_its_tick(session: Session) -> None:
    with session:
        session.start()
        log = session.record()
        session.advance(0.5)
        session.change(world="sphere")
        session.advance(0.5)
        time.sleep(0.2)
        assert session.stop_recording() > 900
    found = ebac.logs.read(log)
    (event,) = [one for one in found.events if one.kind == "parameter"]
    assert event.tick == 504
    assert "Sphere" in event.message


def test_delay_and_observer_begin_anew(session: Session) -> None:
    with session:
        session.start()
        session.advance(0.4)
        assert session.change(delay=3) is True  # the observer is designed for it
        session.change(observer=False)
        assert session.change(delay=2) is False
        session.advance(2.0)
        assert not session.fault
        assert session.starts == 3


def test_a_delay_that_a_run_cannot_hold_back_is_refused(tmp_path: Path) -> None:
    prompt = ebac.Scenario(timing=ebac.Timing(delay=0))
    with Session(prompt, virtual=True, paced=False, folder=tmp_path) as session:
        with pytest.raises(ValueError, match=r"delay = 8 samples: must lie in \[0, 7\] samples"):
            session.change(delay=8)
        assert session.choices.delay == 0
        session.change(delay=7)


def test_a_run_that_does_not_hold_back_ends(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ebac.hardware.current_parameters.MOST_HELD_BACK", 1)
    with session:
        session.change(delay=5)
        with pytest.raises(ValueError, match="hold_back = 4 samples"):
            session.start()
        assert session.run is not None
        assert not session.running
        assert session.run.report is not None


@pytest.mark.parametrize("observer", [True, False])
def test_strips_have_a_beta_only_where_the_law_has_one(session: Session, observer: bool) -> None:
    with session:
        frames = Frames(session)
        session.change(observer=observer)
        session.start()
        session.hand.drag([0.03, 0.0])
        session.advance(1.0)
        found = frames.history()
    shown = json.loads(json.dumps(found, allow_nan=False))
    assert not any(None in shown[name] for name in ("t", "x", "f_env", "f_cmd", "f_meas", "energy"))
    assert any(beta is not None for beta in shown["beta"]) != observer


def test_time_goes_on_with_the_clock_on_the_wall_and_nothing_is_late(tmp_path: Path) -> None:
    pytest.importorskip("websockets")
    with serve(virtual=True, folder=tmp_path) as server:
        run = server.session.run
        assert run is not None
        begun = time.monotonic()
        while run.ticks < 400:
            assert time.monotonic() - begun < 20
            time.sleep(0.01)
        tail = run.tail(400)
        assert not tail["lateness"].any()
        assert not tail["skipped"].any()
        assert run.ticks <= 1000 * (time.monotonic() - begun) + 200
        assert server._state()["virtual"] is True


def test_only_a_virtual_clock_is_told_to_go_on(tmp_path: Path) -> None:
    with Session(folder=tmp_path) as session, pytest.raises(RuntimeError, match="virtual=True"):
        session.advance(1.0)


@pytest.mark.parametrize(
    ("law", "times"),
    [("ebac", "below the"), ("direct", "below 3 times the")],
    ids=["ebac", "direct"],
)
def test_a_verdict_says_below_how_many_thresholds_the_force_vibrates(
    session: Session, law: str, times: str
) -> None:
    with session:
        session.change(law=law, hand="finger", stiffness=3e3)  # direct: 2.7 thresholds
        session.start()
        session.advance(4.0)
        assert session.run is not None
        said = verdict(session.run)
    assert said["head"] == "Still and quiet"
    assert said["more"] == f"Its force vibrates {times} threshold of touch."


def test_a_handle_that_left_the_surface_has_no_contact_at_rest(session: Session) -> None:
    with session:
        frames = Frames(session)
        session.hand.drag([-0.02, 0.0])  # m; the wall begins at 0.01 m
        session.start()

        def told() -> str:
            session.advance(2.0)
            frames.frame()
            frames._judged = -1e9
            return str(frames.frame()["verdict"]["head"])

        assert told() == "Free air"
        session.hand.drag([0.04, 0.0])
        assert told() in ("Still and quiet", "Buzzes")
        session.hand.drag([-0.02, 0.0])
        assert told() == "No contact at rest"


def test_a_law_of_ones_own_can_be_chosen_beside_those_of_the_package(tmp_path: Path) -> None:
    mine = ebac.Variant("tca-damped", {"virtual_damping": 50.0})
    with Session(law=mine, virtual=True, paced=False, folder=tmp_path) as session:
        session.start()
        assert session.run is not None
        session.run.advance(10)  # type: ignore[attr-defined]
        assert session.run.law.virtual_damping == 50  # type: ignore[attr-defined]
        assert Frames(session).state()["options"]["law"][-1] == mine.name
        session.change(law="ebac")
        session.change(law=mine.name)
        assert session.run.law.virtual_damping == 50  # type: ignore[attr-defined]
        with pytest.raises(KeyError, match="magic"):
            session.change(law="magic")
