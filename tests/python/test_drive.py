"""A drive on a bus: objects, states, faults, and what it says when something goes wrong.

All on the simulated drives of the joystick, nodes 1 and 2.
"""

import contextlib
import os
import re
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import can
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ebac import _core, drives
from ebac.drives import Command, State, Statusword
from ebac.drives.objects import known
from ebac.drives.who_answers import naming_who_answers

#: Reads of the test that hammers; EBAC_DRIVE_READS=100000 for all that was promised.
READS = int(os.environ.get("EBAC_DRIVE_READS", "2000"))
#: Conditions of the simulated drive: an SDO to this object makes one (bits), 0 cures all.
CONDITIONS = (0x5F00, 0)
OVER_VOLTAGE, SILENT = 1, 8

Open = Callable[[], can.BusABC]


@pytest.fixture
def bus(open_bus: Open) -> Iterator[drives.DriveBus]:
    with drives.DriveBus(open_bus()) as opened:
        yield opened


@pytest.fixture
def drive(bus: drives.DriveBus) -> drives.Drive:
    return bus.drive(1)


def fail(drive: drives.Drive, condition: int) -> None:
    drive.sdo.download(
        drives.Object(name="conditions", index=0x5F00, kind="u8"), bytes([condition])
    )


# --- objects ---


def test_scan_finds_both_drives_and_nobody_else(bus: drives.DriveBus) -> None:
    assert bus.scan(seconds=0.1) == [1, 2]
    assert bus.scan(seconds=0.1, nodes=range(2, 10)) == [2]


def test_every_object_the_drive_has_is_read_by_its_name(drive: drives.Drive) -> None:
    there = {name: drive.look(name) for name in known()}
    assert there["device_type"] == 0x20192
    assert there["rated_torque"] == 53
    assert there["motor_torque_constant"] == 5380
    assert there["rpdo1_inhibit"] is None
    assert isinstance(there["device_name"], str)
    assert len(there["device_name"]) > 4  # longer than expedited: segments
    assert sum(value is not None for value in there.values()) > 100


@pytest.mark.parametrize("value", [-32768, -1, 0, 1, 32767])
def test_a_number_written_is_the_number_read(drive: drives.Drive, value: int) -> None:
    drive.write("target_torque", value)
    assert drive.read("target_torque") == value
    assert drive.read(0x6071) == value
    assert drive.read((0x6071, 0)) == value


def test_numbers_of_numpy_are_numbers(bus: drives.DriveBus) -> None:
    drive: Any = bus.drive(np.int64(1))  # type: ignore[arg-type]
    assert drive is bus.drive(1)
    drive.write("target_torque", np.int16(-3))
    for what in (np.uint16(0x6071), (np.int64(0x6071), np.uint8(0))):
        assert drive.number(what) == -3
    assert [one.id for one in drives.load("joystick", nodes=np.array([2])).nodes] == [2]  # type: ignore[arg-type]
    with drive:
        drive.enable(mode=np.int64(10))


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda d: d.write("target_torque", 0.0), "target_torque (0x6071) = 0.0: must be a whole number"),
        (lambda d: d.write("target_torque", True), "target_torque (0x6071) = True: must be a whole number"),
        (lambda d: d.enable(mode=10.0), "mode = 10.0: must be a whole number"),
        (lambda d: d.number(24641.0), "index of an object = 24641.0: must be a whole number"),
        (lambda d: d.number((0x6041, 0, 0)), "object (24641, 0, 0): must be a name, an index, or (index, sub-index)"),
    ],
)  # fmt: skip
def test_what_is_no_whole_number_is_refused_in_a_sentence(
    drive: drives.Drive, act: Callable[[drives.Drive], None], message: str
) -> None:
    with pytest.raises(TypeError, match=re.escape(message)):
        act(drive)


@pytest.mark.parametrize(
    ("act", "message"),
    [
        (lambda d: d.read((0x2383, 99)),
         "node 1 refused reading object_2383_99 (0x2383:99): the sub-index does not exist (0x06090011); is this"),
        (lambda d: d.read(0x2FFF), "the object does not exist (0x06020000); is this the right profile"),
        (lambda d: d.write("statusword", 0),
         "node 1 refused writing statusword (0x6041): read only (0x06010002); it cannot be written"),
        (lambda d: d.read(CONDITIONS), "write only (0x06010001)"),
        (lambda d: d.sdo.download(drives.find("mode"), bytes(4)),
         "node 1 refused writing mode (0x6060): data type or length does not match (0x06070010)"),
    ],
)  # fmt: skip
def test_a_refusal_names_node_object_meaning_and_remedy(
    drive: drives.Drive, act: Callable[[drives.Drive], None], message: str
) -> None:
    with pytest.raises(drives.Refused, match=re.escape(message)) as caught:
        act(drive)
    assert caught.value.node == 1


def test_names_of_a_data_sheet_are_read_too(bus: drives.DriveBus, tmp_path: Path) -> None:
    sheet = tmp_path / "drive.eds"
    sheet.write_text(_core.SimulatedDrive(node=1).eds(), encoding="ascii")
    drive = bus.drive(1, eds=sheet)
    assert drive.read("Device type") == drive.read("device_type")
    assert drive.read("Motor data.Torque constant") == 5380
    assert drive.read("Manufacturer device name") == drive.read("device_name")
    drive.write("Target torque", -5)
    assert drive.read("Target torque") == -5
    with pytest.raises(KeyError, match="no such name"):
        drive.read("Motor data")


def test_what_does_not_fit_is_refused_before_it_is_sent(drive: drives.Drive) -> None:
    with pytest.raises(
        ValueError, match=r"target_torque \(0x6071\) = 40000 per mille of rated: must lie"
    ):
        drive.write("target_torque", 40000)
    with pytest.raises(KeyError, match="did you mean 'target_torque'"):
        drive.write("target_torqe", 1)


def test_timeout_and_data_sheet_of_a_drive_may_be_given_later(
    bus: drives.DriveBus, tmp_path: Path
) -> None:
    drive = bus.drive(1)
    assert drive.sdo.timeout == 0.3
    sheet = tmp_path / "drive.eds"
    sheet.write_text(_core.SimulatedDrive(node=1).eds(), encoding="ascii")
    assert bus.drive(1, eds=sheet, timeout=5) is drive
    for wrong, message in (
        ({"timeout": 1e9}, r"timeout = 1000000000.0 s: must lie in \[0.001, 60\] s"),
        ({"eds": tmp_path / "nix.eds", "timeout": 1.0}, r"nix\.eds: no such file"),
    ):
        with pytest.raises(ValueError, match=message):
            bus.drive(1, **wrong)  # type: ignore[arg-type]
    assert bus.drive(1).sdo.timeout == 5
    assert drive.read("Device type") == drive.read("device_type")


@pytest.mark.parametrize("node", [0, 128, -1])
def test_a_node_id_out_of_range_is_refused(bus: drives.DriveBus, node: int) -> None:
    with pytest.raises(ValueError, match=rf"node = {node}: must lie in \[1, 127\]"):
        bus.drive(node)


def test_two_threads_hammering_read_nothing_wrong_and_fail_never(bus: drives.DriveBus) -> None:
    """No lock, and two readers fail in every third read; one lock, and none does."""
    wrong: list[object] = []
    expected = {
        "device_type": 0x20192,
        "rated_torque": 53,
        "max_torque": None,
        "motor_counts_per_turn": None,
    }
    one = bus.drive(1)
    expected = {name: value or one.read(name) for name, value in expected.items()}

    def hammer() -> None:
        try:
            for i in range(READS // 2):
                name = list(expected)[i % len(expected)]
                if (value := one.read(name)) != expected[name]:
                    wrong.append((name, value))
        except drives.DriveError as error:
            wrong.append(error)

    threads = [threading.Thread(target=hammer) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


# --- states ---


@pytest.mark.parametrize(
    "start", [s for s in State if not s.name.startswith(("NOT", "FAULT", "QUICK"))]
)
@pytest.mark.parametrize(
    "goal", [s for s in State if not s.name.startswith(("NOT", "FAULT", "QUICK"))]
)
def test_go_leads_from_any_state_to_any(drive: drives.Drive, start: State, goal: State) -> None:
    drive.set_mode(10)
    drive.go(start)
    drive.go(goal)
    assert drive.state is goal


@given(
    commands=st.lists(
        st.sampled_from([c for c in Command if c is not Command.QUICK_STOP]), max_size=12
    )
)
@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_the_drive_follows_the_table(drive: drives.Drive, commands: list[Command]) -> None:
    state = drive.disable()
    for command in commands:
        drive.command(command)
        state = drives.state.after(state, command)
        drive.wait(lambda now, state=state: now is state, str(command), timeout=0.5)  # type: ignore[misc]


def test_enable_powers_at_zero_torque_and_disable_takes_it_off(drive: drives.Drive) -> None:
    drive.write("target_torque", 300)
    drive.write("torque_offset", 5)
    drive.enable(mode=10)
    assert drive.state is State.OPERATION_ENABLED
    assert drive.read("target_torque") == 0
    assert drive.read("torque_offset") == 0
    assert drive.disable() is State.SWITCH_ON_DISABLED


def test_a_mode_that_commands_no_torque_is_not_enabled(drive: drives.Drive) -> None:
    assert drive.number("mode_display") not in (4, 10)
    with pytest.raises(
        drives.WrongAnswer, match="does not command torque, so zero torque cannot be"
    ):
        drive.enable()
    assert drive.state is State.SWITCH_ON_DISABLED


@pytest.mark.parametrize("mode", [0, 1, 33])
def test_a_mode_the_drive_does_not_offer_is_refused(drive: drives.Drive, mode: int) -> None:
    with pytest.raises(ValueError, match=rf"mode = {mode}: the drive offers \[4, 10\]"):
        drive.set_mode(mode)


def test_leaving_the_block_disables_whatever_happened(bus: drives.DriveBus) -> None:
    with bus.drive(1) as drive:
        drive.enable(mode=10)
    assert drive.state is State.SWITCH_ON_DISABLED
    with pytest.raises(ZeroDivisionError), bus.drive(1) as drive:  # noqa: PT012
        drive.enable()
        _ = 1 / 0
    assert drive.state is State.SWITCH_ON_DISABLED


def test_a_statusword_of_no_state_is_an_error_of_the_drive(
    drive: drives.Drive, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drives.Drive, "statusword", property(lambda _: Statusword(0x0203)))
    with pytest.raises(drives.WrongAnswer, match="node 1: statusword = 0x0203: bits") as caught:
        _ = drive.state
    assert caught.value.node == 1


@pytest.mark.parametrize(
    "breaks", [Statusword(0x0205), KeyboardInterrupt()], ids=["word", "Ctrl-C"]
)
def test_whatever_breaks_in_when_a_drive_is_enabled_it_loses_its_power(
    drive: drives.Drive, monkeypatch: pytest.MonkeyPatch, breaks: Any
) -> None:
    asked = drives.Drive.statusword.fget  # type: ignore[attr-defined]
    broken: list[bool] = []

    def once(self: drives.Drive) -> Statusword:
        word = asked(self)
        if State.of(word) is not State.OPERATION_ENABLED or broken:
            return Statusword(word)
        broken.append(True)
        if isinstance(breaks, Statusword):
            return breaks
        raise breaks

    monkeypatch.setattr(drives.Drive, "statusword", property(once))
    with pytest.raises((drives.WrongAnswer, KeyboardInterrupt)):
        drive.enable(mode=10)
    assert broken
    assert drive.state is State.SWITCH_ON_DISABLED


def test_a_quick_stop_ends_without_power(drive: drives.Drive) -> None:
    drive.enable(mode=10)
    drive.quick_stop()
    drive.wait(lambda now: not now.powered, "without power", timeout=2)


# --- faults ---


def test_a_fault_names_code_latched_names_and_emergencies(drive: drives.Drive) -> None:
    drive.enable(mode=10)
    fail(drive, OVER_VOLTAGE)
    with pytest.raises(drives.DriveFault) as caught:
        drive.go(State.SWITCHED_ON)
    said = str(caught.value)
    assert "node 1 is in fault while going to 'switched on'" in said
    assert "over voltage" in said
    assert "emergencies: 0x3" in said
    assert "check supply and regeneration" in said
    assert "ebac drive reset-fault --node 1" in said
    assert caught.value.code is not None
    assert caught.value.latched


def test_where_no_command_leads_is_refused_by_the_node(drive: drives.Drive) -> None:
    with pytest.raises(ValueError, match="node 1: no command leads from 'switch on disabled' to"):
        drive.go(State.NOT_READY_TO_SWITCH_ON)


def test_a_fault_goes_by_reset_only_when_its_cause_is_gone(drive: drives.Drive) -> None:
    fail(drive, OVER_VOLTAGE)
    drive.wait(lambda now: now is State.FAULT, "in fault", timeout=1)
    with pytest.raises(drives.DriveFault, match="while resetting the fault"):
        drive.reset_fault(timeout=0.05)
    assert drive.disable() is State.FAULT  # disabled all the same
    fail(drive, 0)
    drive.reset_fault()
    assert drive.state is State.SWITCH_ON_DISABLED
    assert drive.latched() == []
    drive.reset_fault()  # no fault, no change
    drive.enable(mode=10)
    drive.disable()


# --- nobody answers ---


def said_by_nobody(bus: drives.DriveBus, node: int) -> str:
    with pytest.raises(drives.NoAnswer) as caught:
        bus.drive(node, timeout=0.02).read("statusword")
    assert caught.value.node == node
    return str(caught.value)


def test_silence_on_a_silent_bus_names_what_to_check() -> None:
    with drives.DriveBus(can.Bus(interface="virtual", channel="nobody")) as bus:
        said = said_by_nobody(bus, 7)
    assert said.startswith("node 7 did not answer within ")
    assert (
        "(reading statusword (0x6041)). On the bus meanwhile: nothing at all. Check: 1. the bit rate"
        in said
    )
    for word in ("termination", "power", "node id", "interface is up"):
        assert word in said


def test_silence_on_a_bus_of_new_drives_names_those_that_answer_when_asked(
    bus: drives.DriveBus,
) -> None:
    with pytest.raises(drives.NoAnswer) as caught, naming_who_answers(bus):
        bus.drive(7, timeout=0.02).read("statusword")
    said = str(caught.value)
    assert (
        "(reading statusword (0x6041)). On the bus meanwhile: nothing, but nodes 1, 2 answer"
        in said
    )
    assert "Check: 1. the node id: nodes 1, 2 answer, node 7 does not" in said
    assert "bit rate of interface" not in said


def test_silence_of_one_node_among_others_points_at_its_id(bus: drives.DriveBus) -> None:
    assert bus.scan(seconds=0.05, nodes=range(1, 3)) == [1, 2]
    said = said_by_nobody(bus, 7)
    assert "On the bus meanwhile: nothing; before that nodes 1, 2. Check: 1. the node id" in said


def test_a_node_that_falls_silent_is_distinguished_from_one_that_never_was(
    bus: drives.DriveBus,
) -> None:
    drive = bus.drive(1, timeout=0.02)
    assert drive.state is State.SWITCH_ON_DISABLED
    with contextlib.suppress(drives.NoAnswer):
        fail(drive, SILENT)
    assert "node 1 was there before: has it lost power, or its cable" in said_by_nobody(bus, 1)


def test_a_channel_that_is_no_multicast_address_is_named() -> None:
    with pytest.raises(drives.BusError, match=r"a multicast address such as 239\.74\.163\.2$"):
        drives.DriveBus.open(interface="udp_multicast", channel="1.2.3.4")


def other_frames(channel: str, frames: list[tuple[int, bytes]], stop: threading.Event) -> None:
    with can.Bus(interface="virtual", channel=channel) as other:
        while not stop.is_set():
            for cob, data in frames:
                other.send(can.Message(arbitration_id=cob, data=data, is_extended_id=False))
            time.sleep(0.002)


@pytest.mark.parametrize(
    ("frames", "expected"),
    [
        ([(0x707, b"\x04")], ["heartbeat of node 7 (stopped)", "is stopped and answers no SDO"]),
        ([(0x707, b"\x05")], ["heartbeat of node 7 (operational)", "is alive but answers no SDO"]),
        ([(0x083, b"\x10\x32\x04\0\0\0\0\0")], ["emergency of node 3 (0x3210 over voltage", "the node id"]),
        ([(0x187, b"\0\0")], ["0x187 (", "is alive but answers no SDO"]),
        ([(0x123, b"")], ["0x123 (", "power of drive 7, and its own bit rate"]),
        ([(0x707, b"")], ["heartbeat of node 7"]),
        ([(0x087, b"\1")], ["emergency of node 7"]),
    ],
)  # fmt: skip
def test_silence_says_what_was_heard_and_what_that_means(
    frames: list[tuple[int, bytes]], expected: list[str]
) -> None:
    stop = threading.Event()
    thread = threading.Thread(target=other_frames, args=("others", frames, stop))
    with drives.DriveBus(can.Bus(interface="virtual", channel="others")) as bus:
        thread.start()
        try:
            said = said_by_nobody(bus, 7)
        finally:
            stop.set()
            thread.join()
    for words in expected:
        assert words in said, said


def test_an_answer_that_comes_late_is_not_taken_for_the_next() -> None:
    """A slow node answers every request 30 ms late; the time-out is 20 ms."""

    def slow(channel: str, stop: threading.Event) -> None:
        with can.Bus(interface="virtual", channel=channel) as node:
            while not stop.is_set():
                asked = node.recv(0.01)
                if asked is None or asked.arbitration_id != 0x605 or asked.data[0] != 0x40:
                    continue
                time.sleep(0.03)
                index = bytes(asked.data[1:4])
                number = int.from_bytes(index[:2], "little")
                node.send(
                    can.Message(
                        arbitration_id=0x585,
                        data=b"\x43" + index + number.to_bytes(4, "little"),
                        is_extended_id=False,
                    )
                )

    stop = threading.Event()
    thread = threading.Thread(target=slow, args=("slow", stop))
    with drives.DriveBus(can.Bus(interface="virtual", channel="slow")) as bus:
        thread.start()
        try:
            drive = bus.drive(5, timeout=0.02)
            for name in ("device_type", "statusword", "error_code"):
                try:
                    assert drive.read(name) == drives.find(name).index
                except drives.NoAnswer:
                    continue
            drive.sdo.timeout = 1.0
            for name in ("device_type", "statusword", "error_code"):
                assert drive.read(name) == drives.find(name).index
        finally:
            stop.set()
            thread.join()


# --- opening ---


def test_no_interface_chosen_says_how_to_choose_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", "/nonexistent")
    monkeypatch.setattr(can.util, "load_file_config", lambda *args: {})
    for name in ("CAN_INTERFACE", "CAN_CHANNEL"):
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(
        drives.BusError, match="give --interface and --channel, or set CAN_INTERFACE"
    ):
        drives.DriveBus.open()


def test_the_configuration_of_python_can_is_honoured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAN_INTERFACE", "virtual")
    monkeypatch.setenv("CAN_CHANNEL", "from-the-environment")
    with drives.DriveBus.open() as bus:
        assert bus.network.bus is not None
        assert "from-the-environment" in bus.network.bus.channel_info


def test_an_interface_nobody_knows_lists_those_there_are() -> None:
    with pytest.raises(
        drives.BusError, match=r"interface 'nonsense' is not usable.*There are: .*socketcan"
    ):
        drives.DriveBus.open(interface="nonsense", channel="x")


def test_socketcan_without_an_interface_says_what_to_do() -> None:
    with pytest.raises(drives.BusError, match=r"ip link|modprobe") as caught:
        drives.DriveBus.open(interface="socketcan", channel="nocan7")
    assert "interface socketcan, channel nocan7" in str(caught.value)


def test_closing_twice_is_closing_and_a_closed_bus_says_so(open_bus: Open) -> None:
    with drives.DriveBus(open_bus()) as bus:
        drive = bus.drive(1)
        bus.close()
    for act in (lambda: drive.state, drive.disable, bus.scan):
        with pytest.raises(drives.BusError, match=r"closed|Not connected"):
            act()
