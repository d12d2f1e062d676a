"""`can.Bus(interface="ebac", channel="joystick")`: the simulated joystick on the bus, served by C++ in real time."""

import json
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path

import can
import canopen
import pytest
from can_logger import logged
from typer.testing import CliRunner

import ebac
from ebac import drives
from ebac._core import BusState, DriveWiring, LoopbackHub, LoopbackJoystick
from ebac.can import channels
from ebac.can.interface import EbacBus
from ebac.cli import app

_NUMBERS = count()


@pytest.fixture
def channel() -> Iterator[str]:
    """The name of a channel with a joystick of its own, which must be gone afterwards."""
    name = f"joystick-channel-{next(_NUMBERS)}"
    yield name
    assert name not in channels.CHANNELS


def first_of(bus: can.BusABC, identifier: int) -> can.Message:
    end = time.monotonic() + 20
    while time.monotonic() < end:
        message = bus.recv(1)
        if message is not None and message.arbitration_id == identifier:
            return message
    raise AssertionError(f"nothing from 0x{identifier:03X}")


def test_who_opens_the_channel_hears_the_drives_boot(channel: str) -> None:
    with EbacBus(channel) as bus:
        for identifier in (0x701, 0x702):
            assert bytes(first_of(bus, identifier).data) == b"\0"


def test_drives_go_with_the_last_who_leaves(channel: str) -> None:
    first = EbacBus(channel)
    second = EbacBus(channel)
    hub = channels.CHANNELS[channel].hub
    assert hub.ends == 3
    first.shutdown()
    assert hub.ends == 2
    second.shutdown()
    assert hub.ends == 0
    with EbacBus(channel) as again:
        assert channels.CHANNELS[channel].hub is not hub
        first_of(again, 0x701)


def test_canopen_finds_and_reads_them(channel: str) -> None:
    network = canopen.Network()
    network.connect(interface="ebac", channel=channel)
    try:
        network.scanner.reset()
        network.scanner.search(limit=8)
        end = time.monotonic() + 20
        while network.scanner.nodes != [1, 2] and time.monotonic() < end:
            time.sleep(0.01)
        assert sorted(network.scanner.nodes) == [1, 2]
        node = network.add_node(2, canopen.ObjectDictionary())
        node.sdo.RESPONSE_TIMEOUT = 10
        assert node.sdo.upload(0x1008, 0) == b"ebac simulated drive"  # segmented
        node.sdo.download(0x1017, 0, b"\x05\0")
        assert node.nmt.wait_for_heartbeat(10) == "PRE-OPERATIONAL"
    finally:
        network.disconnect()


def test_a_notifier_hears_what_goes_on_and_time_passes(channel: str) -> None:
    heard: list[can.Message] = []
    with EbacBus(channel) as bus, drives.DriveBus(EbacBus(channel)) as driven:
        notifier = can.Notifier(bus, [heard.append])
        drive = driven.drive(1, timeout=10)
        drive.write(0x1017, 5)
        end = time.monotonic() + 20
        while sum(m.arbitration_id == 0x701 for m in heard) < 5 and time.monotonic() < end:
            time.sleep(0.01)
        notifier.stop()
    identifiers = [message.arbitration_id for message in heard]
    assert identifiers.count(0x701) >= 5
    assert {0x601, 0x581} <= set(identifiers)
    stamps = [message.timestamp for message in heard]
    assert stamps == sorted(stamps)


@pytest.mark.slow
def test_ebac_drive_scans_it() -> None:
    where = ["--interface", "ebac", "--channel", "joystick"]
    result = CliRunner().invoke(app, ["drive", "scan", *where, "--timeout", "5", "--json"])
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)["rows"]
    assert [(row["node"], row["name"]) for row in rows] == [
        (node, "ebac simulated drive") for node in (1, 2)
    ]


def test_a_scan_that_finds_nobody_fails() -> None:
    where = ["--interface", "virtual", "--channel", "nobody", "--timeout", "0.01"]
    for more in ([], ["--json"]):
        assert CliRunner().invoke(app, ["drive", "scan", *where, *more]).exit_code == 1


def test_the_logger_of_python_can_logs_it(tmp_path: Path) -> None:
    text = logged("joystick", tmp_path / "log.asc", seconds=0.3)
    assert re.findall(r" (70[12]) ", text) == ["701", "702"]


@pytest.mark.parametrize(
    "code",
    [
        "import can; bus = can.Bus(interface='ebac', channel='joystick'); print(bus.recv(20) is not None)",
        """
from ebac import Scenario
from ebac._core import LoopbackHub, LoopbackJoystick
hub = LoopbackHub()
end = hub.open()
LoopbackJoystick(hub, Scenario().setup()).start()
print(end.receive(20) is not None)
""",
    ],
)
def test_a_forgotten_joystick_ends_with_the_program(code: str) -> None:
    run = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, timeout=60
    )
    assert (run.returncode, run.stdout) == (0, "True\n"), run.stderr


def joystick(hub: LoopbackHub, **changes: object) -> LoopbackJoystick:
    return LoopbackJoystick(hub, ebac.Scenario().setup(), **changes)  # type: ignore[arg-type]


def test_a_joystick_works_once() -> None:
    hub = LoopbackHub()
    served = joystick(hub, wiring=DriveWiring(nodes=[5]))
    end = hub.open()
    with served as same:
        assert same is served
        frame = end.receive(20)
        assert frame is not None
        assert frame.id == 0x705
        with pytest.raises(RuntimeError, match="make new ones"):
            served.start()
    assert served.counts.sent == 1
    assert served.state == BusState.CLOSED
    served.stop()
    with pytest.raises(RuntimeError, match="make new ones"):
        served.start()


@pytest.mark.parametrize(
    ("changes", "tells"),
    [
        ({"wiring": DriveWiring(nodes=[0])}, "drive.node = 0"),
        ({"wiring": DriveWiring(nodes=[128])}, "drive.node = 128"),
        ({"peak_time": 0.0}, "drive.peak_time = 0 s"),
        ({"peak_time": float("nan")}, "drive.peak_time = nan s"),
    ],
)
def test_bad_input_is_named(changes: dict[str, object], tells: str) -> None:
    with pytest.raises(ValueError, match=tells):
        joystick(LoopbackHub(), **changes)


def test_drives_on_socketcan_tell_what_is_missing() -> None:
    result = CliRunner().invoke(app, ["drive", "simulate", "--channel", "no-such-if0"])
    assert result.exit_code == 1
    assert "CAN interface 'no-such-if0'" in result.output
    assert "modprobe can_raw" in result.output or "no such interface" in result.output


def test_a_bus_in_the_process_is_nothing_to_simulate_on() -> None:
    result = CliRunner().invoke(app, ["drive", "simulate", "--interface", "ebac"])
    assert result.exit_code == 2
    assert "a bus within one process" in " ".join(result.output.split())


Simulate = Callable[..., str]


@pytest.fixture
def simulate() -> Simulate:
    """Run `ebac drive simulate` on a bus for nobody, for a moment."""

    def run(*words: str, code: int = 0) -> str:
        bus = ["--interface", "virtual", "--channel", "served", "--seconds", "0.05"]
        result = CliRunner().invoke(app, ["drive", "simulate", *bus, *words])
        assert result.exit_code == code, result.output
        return " ".join(result.output.split())

    return run


def test_a_scenario_gives_device_and_hand(simulate: Simulate, tmp_path: Path) -> None:
    file = tmp_path / "tapping.toml"
    ebac.Scenario(hand=ebac.Hand(path=ebac.Tapping())).save(file)
    assert "drive, node 1, on" in simulate("--scenario", str(file))
    assert "nodes 1, 2, on" in simulate("--scenario", str(file), "--device", "joystick")
    assert "no such file" in simulate("--scenario", str(tmp_path / "not-there.toml"), code=2)
