"""What can hurt a hand: torque nobody asked for, a drive that holds it without a loop, a second master."""

import dataclasses
import json
import re
import threading
import time
from collections.abc import Callable, Iterator
from math import inf
from pathlib import Path
from typing import Any

import can
import pytest
from simulated_bus import SimulatedBus
from typer.testing import CliRunner

import ebac
from ebac import drives
from ebac._core import SimulatedDrive
from ebac.cli import app
from ebac.drives.bus_monitor import BusMonitor
from ebac.drives.profile import read_source
from ebac.hardware import Configuration

Open = Callable[[], can.BusABC]
pytestmark = pytest.mark.real_time

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"


def configuration() -> Configuration:
    """The example without its sensor, patient with a busy machine."""
    known = Configuration.load(EXAMPLE)
    patient = known.limits.replace(overruns=100_000, pause=100, jump=1.0, speed=100.0)
    return known.replace(silent=1000, limits=patient, soft_start=0.05, ramp_down=0.05, sensor=None)


@pytest.fixture
def bus(open_bus: Open) -> Iterator[drives.DriveBus]:
    with drives.DriveBus(open_bus()) as opened:
        yield opened


@pytest.fixture
def node() -> drives.Node:
    return drives.load("joystick").nodes[0]


@pytest.fixture
def device(monkeypatch: pytest.MonkeyPatch) -> Iterator["ebac.hardware.OpenDevice"]:
    from ebac.hardware import backends

    monkeypatch.setattr(backends, "virtual_can", lambda: None)
    with ebac.Device.open(configuration(), simulate=True) as opened:
        yield opened


def frame(cob_id: int, data: bytes) -> can.Message:
    return can.Message(arbitration_id=cob_id, data=data, is_extended_id=False)


def other_bus(device: "ebac.hardware.OpenDevice") -> can.BusABC:
    return can.Bus(interface=device.backend.interface, channel=device.backend.channel)


# --- a torque nobody asked for ---


def test_a_torque_offset_is_planned_refused_and_zeroed(
    bus: drives.DriveBus, node: drives.Node, tmp_path: Any
) -> None:
    drive, shelf = bus.drive(1), drives.Backups(tmp_path)
    drive.write("torque_offset", 4000)
    (change,) = [c for c in drives.plan(drive, node).changes if c.object.name == "torque_offset"]
    assert (change.now, change.wanted) == (4000, 0)
    drives.apply(drive, node, backups=shelf)
    assert drive.number("torque_offset") == 0
    drive.write("torque_offset", 4000)
    with pytest.raises(drives.NotVerified, match=r"torque_offset \(0x60B2\) is 4000"):
        drives.verify(drive, node)
    drive.write("torque_offset", 0)
    drives.restore(drive, backups=shelf)
    assert drive.number("torque_offset") == 0, "a torque is never put back"


def test_an_offset_written_between_runs_is_gone_before_power(
    device: "ebac.hardware.OpenDevice",
) -> None:
    with drives.DriveBus(other_bus(device)) as bus:
        bus.drive(1).write("torque_offset", 4000)
    trace = device.run(seconds=0.2)
    assert abs(trace["bus.actual_permille"][trace["state"] == ebac.LoopState.ARM]).max() == 0
    with drives.DriveBus(other_bus(device)) as bus:
        bus.drive(2).write("max_torque", 65535)
    with pytest.raises(drives.NotVerified, match="max_torque"):
        device.run(seconds=0.2)


def test_an_offset_written_while_a_loop_runs_ends_it(
    device: "ebac.hardware.OpenDevice", at_tick: Callable[..., Any]
) -> None:
    def attack() -> None:
        with drives.DriveBus(other_bus(device)) as bus:
            bus.drive(1, timeout=5.0).write("torque_offset", 1000)

    with pytest.raises(ebac.LoopFault) as stopped:
        device.run(seconds=5.0, look=at_tick(200, attack))
    assert stopped.value.fault == ebac.Fault.TORQUE_MISMATCH


def test_the_loop_asks_drives_that_it_guards(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without its requests neither side would hear of the other, and the run would end by a lost heartbeat."""
    from ebac.hardware import backends

    monkeypatch.setattr(backends, "virtual_can", lambda: None)
    profile = drives.load("copley-xenus", nodes=[1]).nodes[0].profile
    values = {name: value for name, value in profile.values.items() if name != "heartbeat.consumer"}
    guarded = dataclasses.replace(
        profile,
        values={**values, "heartbeat.guard": 0.3},
        pdos=tuple(dataclasses.replace(pdo, event=0.0) for pdo in profile.pdos),
    )
    nodes = tuple(drives.Node(id=node, profile=guarded) for node in (1, 2))
    known = configuration().replace(drives=drives.Network(name="guarded", nodes=nodes))
    with ebac.Device.open(known, simulate=True) as opened:
        trace = opened.run(seconds=0.5)
        assert set(trace["bus.heartbeat"][-1].ravel()) == {5}
        with drives.DriveBus(other_bus(opened)) as bus:
            drive = bus.drive(1)
            assert (drive.read("guard_time"), drive.read("life_time_factor")) == (100, 3)
            assert drive.read("heartbeat_producer") == 0


# --- somebody else's torque ---


@pytest.mark.parametrize("cob_id", [0x201, 0x202, 0x080, 0x700 + 127])
def test_a_second_master_ends_a_run(
    device: "ebac.hardware.OpenDevice", at_tick: Callable[..., Any], cob_id: int
) -> None:
    data = {0x080: b"", 0x77F: b"\x05"}.get(cob_id, b"\x0f\x00\xa0\x0f")

    def attack() -> None:
        with other_bus(device) as bus:
            bus.send(can.Message(arbitration_id=cob_id, data=data, is_extended_id=False))

    with pytest.raises(ebac.LoopFault) as stopped:
        device.run(seconds=5.0, look=at_tick(200, attack))
    assert stopped.value.fault == ebac.Fault.SECOND_MASTER


def test_a_bus_on_which_somebody_else_commands_is_refused(
    open_bus: Open, device: "ebac.hardware.OpenDevice", tmp_path: Any
) -> None:
    over = threading.Event()

    def command(bus: can.BusABC) -> None:
        frame = can.Message(arbitration_id=0x201, data=bytes(4), is_extended_id=False)
        with bus:
            while not over.wait(0.01):
                bus.send(frame)

    others = [
        threading.Thread(target=command, args=[one]) for one in (open_bus(), other_bus(device))
    ]
    for other in others:
        other.start()
    try:
        with drives.DriveBus(open_bus()) as bus:
            drive = bus.drive(1)
            drives.apply(drive, drives.load("joystick").nodes[0], backups=drives.Backups(tmp_path))
            with pytest.raises(drives.BusError, match=r"torques to node 1 \(0x201, "):
                drive.enable()
            assert not drive.state.powered
        with pytest.raises(drives.BusError, match="somebody else commands on this bus"):
            device.run(seconds=0.2)
    finally:
        over.set()
        for other in others:
            other.join()


def test_a_master_that_has_ended_is_forgotten_and_one_that_begins_is_heard(
    bus: drives.DriveBus, open_bus: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    drive, sync = bus.drive(1), frame(0x080, b"")
    with open_bus() as other:
        other.send(sync)
        with pytest.raises(drives.BusError, match=r"commands on this bus: SYNC \(0x080, 1 times\)"):
            drive.enable(mode=10)
        monkeypatch.setattr("ebac.drives.bus.RECENT", 0.0)  # as if that had been long ago
        with drive:
            drive.enable(mode=10)
        late = threading.Timer(0.02, other.send, [sync])
        late.start()
        with pytest.raises(drives.BusError, match="SYNC"):
            bus.check_alone([1], seconds=0.5)
        late.join()


def test_every_diagnosis_reports_the_bus_itself() -> None:
    monitor = BusMonitor()
    assert monitor.describe(0) == "nothing at all"
    monitor(can.Message(is_error_frame=True))
    monitor(can.Message(arbitration_id=0x702, data=b"\0", is_extended_id=False))
    monitor.answered_twice(3)
    text = monitor.describe(time.monotonic() + 1)
    assert "1 error frames, node 2 restarted 1 times, node 3 answered 1 requests twice" in text


def test_a_request_that_a_bus_brings_back_is_no_traffic() -> None:
    """As udp_multicast does, where it looks like a frame of another node."""
    monitor = BusMonitor()
    monitor(can.Message(arbitration_id=0x605, data=bytes(8), is_extended_id=False))
    assert monitor.describe(0) == "nothing at all"
    assert monitor.advice(5, 0)[0] == "the bit rate of interface and drives"


def test_two_nodes_of_one_id_are_reported(bus: drives.DriveBus, open_bus: Open) -> None:
    """A second node answers what the first one has answered already."""
    drive, twin = bus.drive(1), open_bus()
    drive.number("statusword")
    twin.send(can.Message(arbitration_id=0x581, data=bytes(8), is_extended_id=False))
    time.sleep(0.1)
    drive.number("statusword")
    assert any("node 1 answered 1 requests twice" in one for one in bus.monitor.troubles())
    twin.shutdown()


# --- a loop that stalls ---


def test_no_profile_holds_a_torque_without_its_loop() -> None:
    for name in drives.builtin():
        network = drives.load(name, nodes=[1])
        drives.check_stall(network)
        (node,) = network.nodes
        deadline = any(pdo.event > 0 for pdo in node.profile.pdos)
        assert drives.hold_time(node.profile) == (0.005 if deadline else 0.1)
        assert deadline == (
            name in ("copley-accelnet", "copley-xenus", "handle", "joystick", "joystick-3")
        )
        assert node.profile.values["drive.connection_lost"] == 1


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"heartbeat__consumer": 0.0}, "would hold its last torque for ever when the loop stalls"),
        ({"heartbeat__consumer": 2.0}, "would hold its last torque for 2 s when the loop stalls"),
    ],
)
def test_a_drive_that_would_hold_its_torque_is_refused(
    changes: dict[str, Any], message: str
) -> None:
    known = configuration()
    nodes = [
        drives.Node(
            id=one.id,
            profile=drives.Profile(
                name="mine",
                values=one.profile.replace(**changes).values,
                pdos=tuple(p for p in one.profile.pdos if p.sent),
            ),
        )
        for one in known.drives.nodes
    ]
    assert drives.hold_time(nodes[0].profile) == (changes["heartbeat__consumer"] or inf)
    network = drives.Network(name="mine", nodes=tuple(nodes))
    with pytest.raises(drives.ProfileError, match=message):
        ebac.Device.open(known.replace(drives=network), simulate=True)


def test_a_drive_that_would_fault_between_two_ticks_is_refused() -> None:
    known = configuration()
    with pytest.raises(
        drives.ProfileError,
        match=r"node 1: pdo\.rpdo1\.event = 0\.005 s: .* without a torque for 5 ms, .* after a tick of 0\.005 s",
    ):
        drives.check_pace(known.drives, 5e-3)
    quick = drives.Profile(name="mine", values={"heartbeat.consumer": 1e-3}, pdos=())
    network = drives.Network(name="mine", nodes=(drives.Node(id=1, profile=quick),))
    with pytest.raises(drives.ProfileError, match=r"heartbeat\.consumer = 0\.001 s"):
        drives.check_pace(network, 2.5e-4)
    drives.check_pace(known.drives, known.timing.dt)


def test_a_drive_counts_whole_milliseconds() -> None:
    """1.4 ms were compared with a tick of 1.2 ms, but the drive is told 1 ms: it faults in the first tick."""
    (rpdo,) = (one for one in configuration().drives.nodes[0].profile.pdos if not one.sent)
    profile = drives.Profile(
        name="mine",
        values={"heartbeat.master": 127},
        pdos=(dataclasses.replace(rpdo, event=1.4e-3),),
    )
    network = drives.Network(name="mine", nodes=(drives.Node(id=1, profile=profile),))
    drives.check_pace(network, 0.9e-3)
    with pytest.raises(drives.ProfileError, match=r"event = 0\.0014 s: .* torque for 1 ms"):
        drives.check_pace(network, 1.2e-3)


@pytest.mark.parametrize("longest", [0.0, -1.0, float("nan")])
def test_a_device_that_would_never_move_is_refused(longest: float) -> None:
    with pytest.raises(ValueError, match="longest_step = "):
        ebac.hardware.OpenDevice(configuration(), simulate=True, longest_step=longest)


def test_two_masters_are_refused() -> None:
    known = configuration()
    first, second = known.drives.nodes
    other = drives.Node(id=second.id, profile=second.profile.replace(heartbeat__master=100))
    network = drives.Network(name="mine", nodes=(first, other))
    with pytest.raises(
        drives.ProfileError, match=r"heartbeat\.master is 127 on node 1, 100 on node 2"
    ):
        ebac.Device.open(known.replace(drives=network), simulate=True)


def test_doctor_prints_how_long_each_drive_would_hold_its_torque(tmp_path: Path) -> None:
    text, mine = EXAMPLE.read_text(encoding="utf-8"), tmp_path / "mine.toml"
    for bare, found, verdict in (
        (
            False,
            "fault, power off after 5 ms at worst (pdo.rpdo1.event 5 ms, heartbeat.consumer 100 ms); by then 42.4 N "
            "move a free handle of 0.25 kg by 2.1 mm",
            "good",
        ),
        (
            "heartbeat alone",
            "fault, power off after 100 ms at worst (heartbeat.consumer 100 ms); by then 42.4 N have moved a free "
            "handle of 0.25 kg to the end of the workspace, after 26 ms",
            "fair",
        ),
        (True, "holds its torque for ever", "bad"),
    ):
        if bare == "heartbeat alone":
            profile = tmp_path / "heartbeat.toml"
            shipped = read_source("copley-accelnet").text
            profile.write_text(re.sub("(?m)^event = .*$", "", shipped), encoding="utf-8")
            nodes = "".join(f'[[node]]\nid = {n}\nprofile = "heartbeat.toml"\n' for n in (1, 2))
            (tmp_path / "heartbeats.toml").write_text(nodes, encoding="utf-8")
            text = text.replace('drives = "joystick" ', 'drives = "heartbeats.toml" ')
        elif bare:
            profile = tmp_path / "bare.toml"
            profile.write_text(
                "[limits]\nrated_torque = 0.053\nmax_torque = 0.1\n", encoding="utf-8"
            )
            nodes = "".join(f'[[node]]\nid = {n}\nprofile = "bare.toml"\n' for n in (1, 2))
            (tmp_path / "net.toml").write_text(nodes, encoding="utf-8")
            text = text.replace('drives = "heartbeats.toml" ', 'drives = "net.toml" ')
        mine.write_text(text, encoding="utf-8")
        ran = CliRunner().invoke(app, ["doctor", str(mine), "--json"])
        rows = {row["what"]: row for row in json.loads(ran.stdout)["rows"]}
        for node in (1, 2):
            row = rows[f"node {node}, a loop that stalls"]
            assert (row["found"], row["verdict"]) == (found, verdict)
        assert ran.exit_code == (1 if verdict == "bad" else ran.exit_code)
        assert (row["remedy"] is None) == (verdict == "good")


@pytest.mark.parametrize("name", ["copley-accelnet", "generic-cia402"])
def test_a_drive_as_shipped_lets_go_when_the_loop_stalls(name: str, tmp_path: Path) -> None:
    simulated = SimulatedDrive(node=1)
    raw = SimulatedBus(simulated, per_frame=1e-5)
    with drives.DriveBus(raw) as bus:
        drive, (node,) = bus.drive(1), drives.load(name, nodes=[1]).nodes
        drives.apply(drive, node, backups=drives.Backups(tmp_path))
        drive.nmt("start")
        for word in (0x06, 0x07, *[0x0F] * 100):
            raw.send(frame(0x201, bytes([word, 0, 0xF4, 0x01])))
            raw.send(frame(0x080, b""))
            raw.elapse(1e-3)
        assert simulated.current == pytest.approx(0.4926, abs=1e-3)
        stalled = 1e-3  # s, since the last torque
        while simulated.current != 0:
            raw.elapse(1e-4)
            stalled += 1e-4
            assert stalled <= drives.hold_time(node.profile) + 2e-4
        assert drive.state is drives.State.FAULT
