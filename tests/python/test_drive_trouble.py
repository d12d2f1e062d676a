"""A bus in trouble: missing drivers, interfaces that go down, answers that are none. One sentence, no traceback."""

import errno
import json
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import can
import pytest
from typer.testing import CliRunner

from ebac import drives
from ebac.cli import app
from ebac.datasets import joystick_text

Open = Callable[[], can.BusABC]


def command(*words: str) -> Any:
    return CliRunner().invoke(app, ["drive", *words])


@pytest.mark.parametrize("number", [errno.EAFNOSUPPORT, errno.ENODEV])
@pytest.mark.parametrize(
    ("words", "instead"),
    [
        ("run FILE --yes --no-files", "the same command with --simulated takes"),
        ("live FILE --no-browser", "the same command with --simulated in place of --allow-control takes"),
        ("drive zero FILE", "the same command with --simulated takes"),
        ("drive signs FILE --yes", "the same command with --simulated takes"),
        ("drive scan --interface socketcan --channel can0", "--interface ebac --channel joystick takes"),
    ],
)  # fmt: skip
def test_without_can_each_command_names_a_simulation_that_it_has(
    words: str, instead: str, number: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def absent(**_: object) -> None:
        raise OSError(number, "absent")

    monkeypatch.setattr(can, "Bus", absent)
    file = tmp_path / "joystick.toml"
    file.write_text(joystick_text("joystick"))
    ran = CliRunner().invoke(app, words.replace("FILE", str(file)).split())
    assert ran.exit_code == 1, ran.output
    said = " ".join(ran.stderr.split())
    assert f"Without CAN: {instead} simulated drives" in said
    assert "ebac run --simulated" not in said


@pytest.mark.parametrize(
    "raised", [NameError("name 'canGetNumberOfChannels'"), ImportError("Please install python-ics")]
)
def test_a_missing_driver_is_one_sentence(
    raised: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(**_: object) -> None:
        raise raised

    monkeypatch.setattr(can, "Bus", fail)
    ran = command("scan", "--interface", "kvaser", "--channel", "0")
    assert ran.exit_code == 1
    assert "interface kvaser, channel 0: its driver is missing or does not load" in " ".join(
        ran.stderr.split()
    )
    assert isinstance(ran.exception, SystemExit)


class FailingBus(can.BusABC):
    """A bus whose interface goes down once `down` is set."""

    def __init__(self, inner: can.BusABC) -> None:
        self.inner, self.down = inner, threading.Event()
        self.channel_info = "failing"
        super().__init__(channel=None)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self._check()
        self.inner.send(msg, timeout)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self._check()
        return self.inner.recv(min(timeout or 0.0, 0.02)), False

    def _check(self) -> None:
        if self.down.is_set():
            raise can.CanOperationError("Failed to receive: Network is down [Error Code 100]")

    def shutdown(self) -> None:
        super().shutdown()
        self.inner.shutdown()


def test_an_interface_that_goes_down_is_named_everywhere(
    open_bus: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    printed: list[Any] = []
    monkeypatch.setattr(threading, "excepthook", printed.append)
    raw = FailingBus(open_bus())
    with drives.DriveBus(raw) as bus:
        drive = bus.drive(1)
        assert drive.state is drives.State.SWITCH_ON_DISABLED
        raw.down.set()
        time.sleep(0.1)
        for act in (lambda: drive.state, drive.disable, lambda: bus.scan(nodes=range(1, 3))):
            with pytest.raises(drives.BusError, match="Network is down"):
                act()
        raw.down.clear()  # up again, but nobody receives any more
        with pytest.raises(drives.BusError, match=r"the interface has stopped .* Bring it up"):
            bus.scan(nodes=range(1, 3), seconds=0.01)
        with pytest.raises(drives.BusError, match="the interface has stopped"):
            drive.number("statusword")
    assert printed == []


class Answering(can.Listener):
    """A node that answers every SDO request with the same bytes."""

    def __init__(self, bus: can.BusABC, node: int, data: bytes) -> None:
        self.bus, self.node, self.data = bus, node, data

    def on_message_received(self, msg: can.Message) -> None:
        if msg.arbitration_id == 0x600 + self.node:
            self.bus.send(
                can.Message(arbitration_id=0x580 + self.node, data=self.data, is_extended_id=False)
            )


@pytest.mark.parametrize("data", [b"", b"\x4f", b"\x4b\x41\x60", b"\x80\x41\x60\x00", b"\x00" * 8])
def test_an_answer_that_is_none_is_a_wrong_answer(data: bytes) -> None:
    channel = f"wrong-answers-{len(data)}"
    with can.Bus(interface="ebac", channel=channel) as other:
        notifier = can.Notifier(other, [Answering(other, 5, data)])
        with drives.DriveBus.open(interface="ebac", channel=channel) as bus:
            drive = bus.drive(5, timeout=0.02)
            for act in (lambda: drive.number("statusword"), lambda: drive.write("mode", 10)):
                with pytest.raises((drives.WrongAnswer, drives.NoAnswer), match="node 5"):
                    act()
            ran = command("scan", "--interface", "ebac", "--channel", channel, "--timeout", "0.005")
            assert ran.exit_code == 0
        notifier.stop()


def test_scan_believes_no_identifier_of_a_sensor(open_bus: Open) -> None:
    over = threading.Event()

    def sense(bus: can.BusABC) -> None:
        with bus:
            while not over.wait(0.005):
                for cob in (0x185, 0x28A, 0x391, 0x4A0, 0x0C5):
                    bus.send(can.Message(arbitration_id=cob, data=b"1234", is_extended_id=False))

    sensor = threading.Thread(target=sense, args=[open_bus()])
    sensor.start()
    try:
        with drives.DriveBus(open_bus()) as bus:
            assert bus.scan(seconds=0.1) == [1, 2]
    finally:
        over.set()
        sensor.join()


def test_show_prints_what_could_be_read(open_bus: Open, monkeypatch: pytest.MonkeyPatch) -> None:
    from ebac.drives.sdo import Sdo

    whole, lost = Sdo.upload, {"error_code", "statusword"}

    def upload(self: Sdo, obj: drives.Object) -> bytes:
        if obj.name == "error_code":
            raise drives.Refused(1, obj, "reading", 0x08000000)
        if obj.name == "mode":
            raise drives.WrongAnswer("node 1: garbled", node=1)
        if obj.name == "position" and "position" in lost:
            raise drives.NoAnswer(1, "reading position", 0.3, traffic="nothing", check=["power"])
        return whole(self, obj)

    monkeypatch.setattr(Sdo, "upload", upload)
    bus = open_bus()
    where = ["show", "--interface", "ebac", "--channel", str(bus.channel), "-n", "1", "--json"]
    ran = command(*where)
    assert ran.exit_code == 0
    rows = {row["name"]: row for row in json.loads(ran.stdout)["rows"]}
    assert (rows["error_code"]["value"], rows["mode"]["value"]) == (None, None)
    assert rows["error_code"]["text"] == "not read: 0x08000000"
    assert rows["torque_offset"]["value"] == 0
    lost.add("position")
    ran = command(*where)
    assert ran.exit_code == 1
    assert "did not answer" in ran.stderr
    names = {row["name"] for row in json.loads(ran.stdout)["rows"]}
    assert "statusword" in names
    assert "velocity" not in names
    bus.shutdown()


def test_a_stopped_node_is_one_sentence(open_bus: Open) -> None:
    with drives.DriveBus(open_bus()) as bus:
        bus.drive(1).nmt("stop")
        channel = str(bus.network.bus.channel)  # type: ignore[union-attr]
        ran = command(
            "show", "-n", "1", "--interface", "ebac", "--channel", channel, "--timeout", "0.02"
        )
    assert ran.exit_code == 1
    assert isinstance(ran.exception, SystemExit)
    assert "node 1 did not answer" in " ".join(ran.stderr.split())


def test_a_node_that_is_silent_is_an_exception_and_nothing_on_stderr() -> None:
    asked = """
from ebac.drives import DriveBus, NoAnswer
with DriveBus.open(interface="ebac", channel="joystick") as bus:
    try:
        bus.drive(7).read("statusword")
    except NoAnswer:
        print("no answer")
"""
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, timeout=60)
    assert (done.stdout, done.stderr) == ("no answer\n", "")
