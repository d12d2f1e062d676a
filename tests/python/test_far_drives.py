"""A joystick and a gastroscope on CANopen drives, over a network: bus, network, bus."""

import json
import math
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac import Hand, MinimumJerk, _core, logs
from ebac.can.channels import hub_of
from ebac.cli import app
from ebac.gastroscope import Lumen, Patient, Scope, Slave
from ebac.gastroscope.chain import OFF, Chain, chain
from ebac.gastroscope.far_side import LinkEvent, SideReport
from ebac.gastroscope.on_drives import configuration, run_master, run_slave
from ebac.hardware import Configuration
from ebac.teleop import Link, processes

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="UDP of the library is Linux's")
STILL = Patient(peristalsis=0, antral_depth=0, breathing=0)
FOLLOW = ebac.gastroscope.Follow()
ASKED = st.tuples(*(st.floats(-10, 10) for _ in range(4)))

# --- where the slave's targets go ---


@given(st.lists(ASKED, min_size=1, max_size=40), st.floats(1e-4, 0.1))
def test_targets_stay_within_place_and_speed(asked: list[Any], dt: float) -> None:
    at = np.array(_core._targets(FOLLOW, asked, dt))
    speed = np.abs(np.diff(np.vstack([np.zeros(4), at]), axis=0)) / dt
    assert np.abs(at[:, 0]).max() <= FOLLOW.deepest
    assert np.hypot(at[:, 2], at[:, 3]).max() <= FOLLOW.most_bend + 1e-9
    assert speed[:, 0].max() <= FOLLOW.insertion_speed * (1 + 1e-9)
    assert speed[:, 1:].max() <= FOLLOW.turn_speed * (1 + 1e-9)


@given(ASKED, st.floats(1e-4, 0.1))
def test_a_constant_target_is_reached_without_overshoot(asked: Any, dt: float) -> None:
    at = np.array(_core._targets(FOLLOW, [asked] * (1 + int(30 / dt / 10)), dt))
    bend = math.hypot(asked[2], asked[3])
    share = min(1.0, FOLLOW.most_bend / bend) if bend else 1.0
    goal = np.array(
        [np.clip(asked[0], -FOLLOW.deepest, FOLLOW.deepest), asked[1], share * asked[2]]
    )
    for i, one in enumerate(goal):
        way = at[:, i] * (1 if one >= 0 else -1)
        assert (np.diff(way) >= -1e-12).all()
        assert way.max() <= abs(one) + 1e-9


def test_it_begins_slowly_and_goes_on_as_fast_as_it_may() -> None:
    dt = 1e-3
    asked = [(0.0, 0.0, 0.5, 0.0)] * 1500 + [(0.0, 0.0, -0.5, 0.0)] * 400
    at = np.array(_core._targets(FOLLOW, asked, dt))[:, 2]
    assert np.diff(at[:900]).max() == pytest.approx(FOLLOW.realign * dt)
    assert -np.diff(at[1500:]).min() == pytest.approx(FOLLOW.turn_speed * dt)


# --- the scope behind the drives ---


def test_motors_that_are_elsewhere_move_the_same_scope() -> None:
    """The scope behind drives comes to rest where the model's own motors bring it."""
    lumen, gears, scope = Lumen(STILL), ebac.gastroscope.Gears(), Scope()
    driven = _core._DrivenScope(scope, lumen.core, 0.09, gears)
    model = Slave(scope, lumen)
    assert driven.report()["inserted"] == pytest.approx(model.state.inserted)


def test_configurations_load_and_fit_their_buses() -> None:
    for part, axes in (("master", 3), ("feed", 2), ("bend", 2)):
        known = configuration(part)
        assert known.device.axes == axes
        assert known.drives.check_load() is None  # at most 70 % of a bus
    with pytest.raises(KeyError, match="master, feed, bend"):
        configuration("tail")


def test_a_slave_of_other_axes_is_refused() -> None:
    with pytest.raises(ValueError, match="2 axes each"):
        run_slave(configuration("master"), simulate=True)


# --- in real time ---


class Side(threading.Thread):
    """A side in a thread of its own."""

    def __init__(self, run: Callable[[], SideReport]) -> None:
        super().__init__()
        self._run = run
        self.report: SideReport | None = None
        self.start()

    def run(self) -> None:
        self.report = self._run()

    def end(self) -> SideReport:
        self.join(timeout=120)
        assert self.report is not None
        return self.report


def held(*target: float) -> Configuration:
    """Return the joystick in a hand that goes to a place and stays."""
    path = [MinimumJerk(target=one, at=1.0, duration=1.5) for one in target]
    return configuration("master").replace(hand=Hand(path=path))


class Pair:
    """Master and slave in this process, with a network that can be cut between them."""

    def __init__(self, tmp: Path, **master: Any) -> None:
        self.ports: list[int] = []
        self.ready = threading.Event()
        self.told: list[tuple[str, LinkEvent]] = []
        self.devices: list[ebac.hardware.OpenDevice] = []
        self.over = threading.Event()
        self.slave = Side(lambda: self._slave(tmp))
        assert self.ready.wait(60)
        here = ("127.0.0.1", self.ports[0])
        link = Link(delay=0.02)
        self.network = processes.Network(link, link, host="127.0.0.1", port=0, slave=here)
        self._carry = threading.Thread(target=self._network)
        self._carry.start()
        self.log = tmp / "master.mcap"
        self.master = Side(lambda: self._master(master))

    def _slave(self, tmp: Path) -> SideReport:
        return run_slave(
            simulate=True,
            lumen=Lumen(STILL),
            give_up=3.0,
            seconds=120.0,
            log=tmp / "slave.mcap",
            notify=lambda event: self.told.append(("slave", event)),
            confirm=self.devices.append,
            ready=lambda port: (self.ports.append(port), self.ready.set()),
        )

    def _master(self, more: dict[str, Any]) -> SideReport:
        return run_master(
            more.pop("known", held(0.02, 0.0, 0.0)),
            peer=("127.0.0.1", self.network.port),
            simulate=True,
            give_up=3.0,
            log=self.log,
            notify=lambda event: self.told.append(("master", event)),
            **{"consent_after": 0.3, "seconds": 6.0, **more},
        )

    def _network(self) -> None:
        while not self.over.is_set():
            self.network.run(0.05)

    def run(self, more: float) -> None:
        """Wait until both sides follow each other, and so much longer [s]."""
        latest = time.monotonic() + 60
        while {name for name, one in self.told if one.what == "running"} != {"master", "slave"}:
            assert time.monotonic() < latest, self.told
            time.sleep(0.02)
        time.sleep(more)

    def end(self) -> tuple[SideReport, SideReport]:
        try:
            return self.master.end(), self.slave.end()
        finally:
            self.over.set()
            self._carry.join()


def at_rest(side: SideReport, count: int) -> bool:
    return len(side.drives) == count and all(one in OFF for one in side.drives)


@LINUX
@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.real_time
def test_what_is_felt_is_what_the_model_meets(tmp_path: Path) -> None:
    """A bend held against the wall: the load that came over two buses and a network is that of the model alone."""
    pair = Pair(tmp_path)
    master, slave = pair.end()
    assert master.good, master
    assert slave.good, slave
    assert at_rest(master, 3)
    assert at_rest(slave, 4)
    # Before the master ends all is at rest. The loop of the bends began a little earlier than the one that tells times.
    end = next(one.t for one in slave.events if one.what == "far ended")
    log = logs.load(slave.logs[1])
    rows = np.flatnonzero((log["t"] > end - 2.0) & (log["t"] < end - 1.4))
    gear = ebac.gastroscope.Gears().bend
    bend = gear * float(np.mean(log.axis("x", 0)[rows]))
    load = -float(np.mean(log.axis("f_env", 0)[rows])) / gear
    assert bend > 0.3
    model = Slave(Scope(), Lumen(STILL))
    base = model.state.inserted - Scope().section - Scope().tip
    for i in range(6000):
        torque = model.step(base, min(1.0, i / 2000) * bend)[1]
    assert torque > 0.03
    # One encoder count is 0.002 rad, or 0.002 N m, of the controller; 0.004 N m more for what the wall still gives way.
    assert load == pytest.approx(torque, abs=0.006)
    trace = logs.load(pair.log)
    at = np.flatnonzero(trace["state"] == 2)[-800:-100]
    felt = float(np.mean(trace.axis("f_env", 0)[at]))
    assert felt == pytest.approx(ebac.gastroscope.Master().bend_scale * torque, abs=0.3)


@LINUX
@pytest.mark.slow
@pytest.mark.real_time
def test_a_cut_link_is_held_faded_reported_and_resumed(tmp_path: Path) -> None:
    pair = Pair(tmp_path, seconds=6.0)
    pair.run(1.5)
    pair.network.cut(True)
    time.sleep(1.0)
    pair.network.cut(False)
    master, slave = pair.end()
    for side in (master, slave):
        told = [one.what for one in side.events]
        assert told[:4] == ["running", "lost", "back", "consent"], side.events
        assert side.report["losses"] == 1
        assert side.report["session"] == 2
        assert side.good
    assert master.report["force_when_lost"] < 1e-9
    assert slave.report["moved_when_lost"] == 0
    assert {name for name, one in pair.told if "LINK LOST" in one.text} == {"master", "slave"}


@LINUX
@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.real_time
def test_a_link_that_stays_away_ends_both_with_drives_at_rest(tmp_path: Path) -> None:
    pair = Pair(tmp_path, seconds=60.0)
    pair.run(1.0)
    pair.network.cut(True)
    master, slave = pair.end()
    assert master.ended_by == slave.ended_by == "link lost"
    assert not master.good
    assert at_rest(master, 3)
    assert at_rest(slave, 4)
    assert slave.report["moved_when_lost"] == 0


@LINUX
@pytest.mark.slow
@pytest.mark.real_time
@pytest.mark.parametrize("group", [0, 1])
def test_a_drive_in_fault_stops_the_slave_and_is_reported(tmp_path: Path, group: int) -> None:
    pair = Pair(tmp_path, seconds=60.0)
    pair.run(1.0)
    backend = pair.devices[group].backend
    with hub_of(backend.channel) as hub:
        over_voltage = bytes([0x2F, 0x00, 0x5F, 0x00, 1, 0, 0, 0])  # by SDO
        hub.open().send(_core.CanFrame(id=0x602, data=over_voltage))
    master, slave = pair.end()
    assert slave.ended_by == "fault"
    assert slave.fault in (ebac.Fault.DRIVE_FAULT, ebac.Fault.DRIVE_EMERGENCY)
    assert at_rest(slave, 4)
    assert master.ended_by == "fault of the slave"
    assert at_rest(master, 3)
    assert any("SLAVE'S DRIVES HAVE STOPPED by fault" in one.text for one in master.events)
    for log in slave.logs:
        trace = logs.load(log)
        assert len(trace) > 500
    one = logs.load(slave.logs[group])
    assert not one["current"][one["fault"] != 0].any()


def rough(**more: float) -> Link:
    return Link(delay=0.03, jitter=0.005, loss=0.02, **more)


@LINUX
@pytest.mark.slow
@pytest.mark.real_time
def test_three_processes_with_a_cut(tmp_path: Path) -> None:
    link = rough(cut_every=3, cut_length=1)
    found = chain(6, link=link, folder=tmp_path, give_up=4)
    assert found.faults == []
    assert found.codes["master"] == found.codes["network"] == 0
    for name in ("master", "slave"):
        assert found.reports[name]["losses"] >= 1
        assert "LINK LOST" in found.said[name]
        assert len(logs.load(tmp_path / f"{name}.mcap")) > 3000


@LINUX
@pytest.mark.slow
@pytest.mark.real_time
@pytest.mark.parametrize(
    "killed",
    ["master", *(pytest.param(one, marks=pytest.mark.weekly) for one in ("slave", "network"))],
)
def test_a_killed_process_leaves_the_others_safe(tmp_path: Path, killed: str) -> None:
    done: list[int] = []
    began: list[float] = []
    log = tmp_path / "master.mcap"

    def kill(running: dict[str, subprocess.Popen[bytes]], passed: float) -> None:
        if not began and log.exists() and log.stat().st_size > 100_000:
            began.append(passed)  # the master's loop is at work
        if began and not done and passed > began[0] + 1.5:
            done.append(running[killed].pid)
            running[killed].send_signal(signal.SIGKILL)

    found = chain(40, link=rough(), folder=tmp_path, consent_after=0.3, give_up=2, meanwhile=kill)
    assert done
    check_the_others(found, killed)
    for name in ("master", "slave"):
        assert len(logs.read(tmp_path / f"{name}.mcap").trace) > 500


def check_the_others(found: Chain, killed: str) -> None:
    assert found.codes[killed] in (-9, 0)
    for name, count in (("master", 3), ("slave", 4)):
        if name == killed:
            continue
        report = found.reports[name]
        assert report["ended_by"] == "link lost", report
        assert found.codes[name] == 1
        assert len([one for one in report["drives"] if one in OFF]) == count
        assert "LINK LOST" in found.said[name]
        assert report["force_when_lost_N"] < 1e-9
        assert report["moved_when_lost"] == 0


# --- the commands ---


def command(*words: str) -> Any:
    return CliRunner().invoke(app, ["gastroscopy", *words])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["master"], "ebac demo gastroscope-master"),
        (["slave"], "ebac demo gastroscope-feed"),
        (["master", "--simulated", "--peer", "nowhere"], "--peer nowhere: must be an address"),
        (["drives", "--seconds", "0"], "--seconds"),
        (["drives", "--loss", "1"], "no packet would arrive"),
    ],
)
def test_wrong_input_is_refused(words: list[str], said: str) -> None:
    ended = command(*words)
    assert ended.exit_code == 2
    assert said in ended.stderr


@LINUX
@pytest.mark.real_time
@pytest.mark.slow
def test_a_slave_alone_waits_and_ends_by_its_time() -> None:
    ended = command("slave", "--simulated", "--port", "0", "--seconds", "1", "--json")
    row = json.loads(ended.stdout)
    assert ended.exit_code == 0, ended.stderr
    assert row["ended_by"] == "time"
    assert row["state"] == 0
    assert row["drives"] == ["switch on disabled"] * 4
