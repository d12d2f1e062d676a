"""The simulated drive, seen by canopen: a stranger who knows nothing but its EDS."""

import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import canopen
import numpy as np
import pytest
from canopen.objectdictionary import ODVariable
from canopen.objectdictionary.datatypes import SIGNED_TYPES, VISIBLE_STRING
from hypothesis import given
from hypothesis import strategies as st
from simulated_bus import SimulatedBus

import ebac
from ebac import _core
from ebac._core import DriveCondition, DriveState, DriveWiring, Joystick, SimulatedDrive

CONTROLWORDS = {"none": 0x80, "off": 0, "quick stop": 2, "shutdown": 6, "switch on": 7,
                "enable": 15, "reset": 0x80}  # fmt: skip


class Desk:
    """One drive, a bus, a network, and the drive's node in it."""

    def __init__(self, drives: SimulatedDrive | Joystick, drive: SimulatedDrive) -> None:
        self.drive = drive
        self.bus = SimulatedBus(drives)
        self.network = canopen.Network(self.bus)
        self.network.NOTIFIER_CYCLE = 0.01
        self.network.NOTIFIER_SHUTDOWN_TIMEOUT = 1.0
        self.network.connect()
        self.node = self.network.add_node(
            canopen.RemoteNode(drive.node, io_of(drive))  # type: ignore[no-untyped-call]
        )

    def abort_of(self, action: Any) -> int:
        with pytest.raises(canopen.SdoAbortedError) as refused:
            action()
        return int(refused.value.code)


def io_of(drive: SimulatedDrive) -> io.StringIO:
    text = io.StringIO(drive.eds())
    text.name = "drive.eds"
    return text


@pytest.fixture
def desk() -> Iterator[Desk]:
    drive = SimulatedDrive(node=5)
    made = Desk(drive, drive)
    yield made
    made.network.disconnect()


def reset(desk: Desk) -> None:
    """Leave the drive as after power-on."""
    desk.node.nmt.state = "RESET"
    desk.bus.elapse(0)


def variables(dictionary: canopen.ObjectDictionary) -> Iterator[tuple[ODVariable, tuple[str, ...]]]:
    """Every variable and the names that lead to it."""
    for thing in dictionary.values():
        if isinstance(thing, ODVariable):
            yield thing, (thing.name,)
        else:
            for member in thing.values():
                yield member, (thing.name, member.name)


def sdo(desk: Desk, names: tuple[str, ...]) -> Any:
    found: Any = desk.node.sdo
    for name in names:
        found = found[name]
    return found


DICTIONARY = canopen.import_od(io_of(SimulatedDrive(node=5)), node_id=5)
ALL = {
    "/".join(names): (variable, names)
    for variable, names in variables(DICTIONARY)
    if variable.index > 7  # below: data types, that an RPDO may drop bytes by
}


def test_the_eds_names_everything_once() -> None:
    assert len(ALL) > 150
    assert len(ALL) == sum(variable.index > 7 for variable, _ in variables(DICTIONARY))
    assert DICTIONARY.device_information.nr_of_TXPDO == 4
    for variable, _ in ALL.values():
        assert variable.data_type in {*range(2, 8), VISIBLE_STRING}


def test_every_object_reads_as_its_eds_says(desk: Desk, of_each: Any) -> None:
    def check(case: tuple[ODVariable, tuple[str, ...]]) -> None:
        variable, names = case
        reset(desk)
        remote = sdo(desk, names)
        if variable.access_type == "wo":
            assert desk.abort_of(lambda: remote.raw) == 0x06010001
        elif variable.index == 0x1003 and variable.subindex > 0:
            assert desk.abort_of(lambda: remote.raw) == 0x08000024
        else:
            data = desk.node.sdo.upload(variable.index, variable.subindex)
            if variable.data_type != VISIBLE_STRING:
                assert len(data) == len(variable) // 8
            live = {0x6041, 0x1002, 0x6075, 0x6076}
            if variable.index not in live:
                assert remote.raw == variable.default

    of_each(ALL, check)


def test_every_object_is_written_or_refused_for_the_right_reason(desk: Desk, of_each: Any) -> None:
    def check(case: tuple[ODVariable, tuple[str, ...]]) -> None:
        variable, names = case
        reset(desk)
        remote = sdo(desk, names)
        if variable.access_type in {"ro", "const"}:
            data = bytes(1 if variable.data_type == VISIBLE_STRING else len(variable) // 8)
            code = desk.abort_of(
                lambda: desk.node.sdo.download(variable.index, variable.subindex, data)
            )
            assert code == 0x06010002
        elif variable.data_type == VISIBLE_STRING:
            remote.raw = "maxon RE 30, 15 W, 24 V winding"
            assert remote.raw == "maxon RE 30, 15 W, 24 V winding"
        elif variable.index in {0x1010, 0x1011}:
            assert desk.abort_of(lambda: setattr(remote, "raw", 1)) == 0x08000020
            remote.raw = int.from_bytes(b"save" if variable.index == 0x1010 else b"load", "little")
            assert remote.raw == 1
        elif variable.access_type == "wo":
            remote.raw = 0
        elif variable.index in {0x1600, 0x1A00}:  # of a PDO that is on
            assert desk.abort_of(lambda: setattr(remote, "raw", 0)) == 0x06010000
        elif 0x1600 <= variable.index < 0x1700 or 0x1A00 <= variable.index < 0x1B00:
            if variable.subindex > 0:
                assert desk.abort_of(lambda: setattr(remote, "raw", 0)) == 0x06010000
            sdo(desk, (names[0], "Highest sub-index")).raw = 0
            remote.raw = 0
            assert remote.raw == 0
        elif variable.index == 0x1800 and variable.subindex == 3:
            assert desk.abort_of(lambda: setattr(remote, "raw", 10)) == 0x08000022
        else:
            before = remote.raw
            remote.raw = before
            assert remote.raw == before

    of_each(ALL, check)


@given(data=st.data())
def test_any_value_within_the_eds_is_kept_or_refused_by_name(data: st.DataObject) -> None:
    drive = SimulatedDrive(node=5)
    numbers = [
        v for v, _ in variables(DICTIONARY)
        if v.index > 7 and v.access_type == "rw" and v.data_type != VISIBLE_STRING
    ]  # fmt: skip
    orders = {0x1003, 0x1010, 0x1011, 0x2183, 0x5F00, 0x5F01}
    for _ in range(20):
        variable = data.draw(st.sampled_from(numbers))
        bits = len(variable)
        signed = variable.data_type in SIGNED_TYPES
        low, high = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
        value = data.draw(st.integers(low, high))
        raw = value.to_bytes(4, "little", signed=signed)[: bits // 8].ljust(4, b"\0")
        where = variable.index.to_bytes(2, "little") + bytes([variable.subindex])
        command = {8: 0x2F, 16: 0x2B, 32: 0x23}[bits]
        drive.receive(0x605, bytes([command]) + where + raw)
        [answer] = [d for i, d in drive.take() if i == 0x585]
        inside = (variable.min is None or value >= variable.min) and (
            variable.max is None or value <= variable.max
        )
        if answer[0] == 0x60:
            assert inside
            drive.receive(0x605, b"\x40" + where + bytes(4))
            [read] = [d for i, d in drive.take() if i == 0x585]
            assert variable.index in orders or read[4 : 4 + bits // 8] == raw[: bits // 8]
        else:
            code = int.from_bytes(answer[4:], "little")
            known = {0x06010000, 0x06020000, 0x06040041, 0x06040042, 0x06040043, 0x06090011,
                     0x06090030, 0x08000020, 0x08000022}  # fmt: skip
            if not inside:
                known = {0x06090031, 0x06090032}
            assert code in known, f"{variable.index:04X}:{variable.subindex} = {value}: {code:08X}"


def test_scan_finds_the_node(desk: Desk) -> None:
    desk.network.scanner.search(limit=10)
    for _ in range(100):
        if desk.network.scanner.nodes:
            break
        desk.network.scanner.search(limit=10)
    assert desk.network.scanner.nodes == [5]


def test_strings_are_segmented_both_ways(desk: Desk) -> None:
    assert desk.node.sdo["Manufacturer device name"].raw == "ebac simulated drive"
    desk.node.sdo.download(0x6404, 0, b"maxon motor ag", force_segment=True)
    assert desk.node.sdo["Motor manufacturer"].raw == "maxon motor ag"
    desk.node.sdo.download(0x6071, 0, b"\x9c\xff", force_segment=True)
    assert desk.node.sdo["Target torque"].raw == -100
    with desk.node.sdo[0x6404].open("wt", encoding="ascii") as stream:  # length not told
        stream.write("x" * 40)
    assert desk.node.sdo["Motor manufacturer"].raw == "x" * 40


def test_a_name_is_read_in_blocks(desk: Desk) -> None:
    with desk.node.sdo.open(0x1008, 0, "rb", block_transfer=True) as file:
        assert file.read() == b"ebac simulated drive"


def test_abort_codes_where_they_belong(desk: Desk) -> None:
    up, down = desk.node.sdo.upload, desk.node.sdo.download
    assert desk.abort_of(lambda: up(0x2000, 0)) == 0x06020000
    assert desk.abort_of(lambda: up(0x1018, 9)) == 0x06090011
    assert desk.abort_of(lambda: up(0x5F00, 0)) == 0x06010001
    assert desk.abort_of(lambda: down(0x6041, 0, b"\0\0")) == 0x06010002
    assert desk.abort_of(lambda: down(0x6071, 0, b"\0\0\0\0")) == 0x06070010
    assert desk.abort_of(lambda: down(0x6071, 0, b"\0" * 9)) == 0x06070010
    assert desk.abort_of(lambda: down(0x6060, 0, b"\x08")) == 0x06090030
    for word in (6, 7, 15):
        desk.node.sdo["Controlword"].raw = word
    torque = desk.node.sdo["Motor data"]["Continuous torque"]
    assert desk.abort_of(lambda: setattr(torque, "raw", 1)) == 0x08000022
    desk.node.sdo["Controlword"].raw = 0
    torque.raw = 5301
    assert torque.raw == 5301


def test_pdos_are_remapped_and_exchanged(desk: Desk) -> None:
    node = desk.node
    node.tpdo.read()
    node.rpdo.read()
    tpdo, rpdo = node.tpdo[1], node.rpdo[1]
    assert [v.name for v in tpdo.map] == ["Statusword"]
    assert not tpdo.rtr_allowed
    tpdo.clear()
    for name in ("Statusword", "Position actual value", "Torque actual value"):
        tpdo.add_variable(name)
    tpdo.trans_type = 1
    tpdo.save()
    rpdo.clear()
    for name in ("Controlword", "Target torque"):
        rpdo.add_variable(name)
    rpdo.trans_type = 1
    rpdo.save()
    node.tpdo.read()
    assert [v.index for v in node.tpdo[1].map] == [0x6041, 0x6064, 0x6077]

    node.sdo["Modes of operation"].raw = 10
    node.nmt.state = "OPERATIONAL"
    desk.drive.set_position(-12345)
    told = []
    for word in (6, 7, 15, 15):
        rpdo["Controlword"].raw = word
        rpdo["Target torque"].raw = -250
        rpdo.transmit()
        with tpdo.receive_condition:
            tpdo.is_received = False
        desk.network.sync.transmit()
        with tpdo.receive_condition:
            assert tpdo.receive_condition.wait_for(lambda: tpdo.is_received, timeout=5)
        told.append((tpdo["Statusword"].raw & 0x6F, tpdo["Torque actual value"].raw))
    # Latched at each SYNC, before what was received until then takes effect.
    assert told == [(0x40, 0), (0x21, 0), (0x23, 0), (0x27, -250)]
    assert tpdo["Position actual value"].raw == -12345
    assert desk.drive.state == DriveState.OPERATION_ENABLED
    assert desk.drive.current == pytest.approx(-0.2463, abs=5e-5)


def test_nmt_transitions_boot_up_and_heartbeat(desk: Desk) -> None:
    beats: list[int] = []
    desk.node.nmt.add_heartbeat_callback(beats.append)

    def beat() -> int:
        count = len(beats)
        desk.bus.elapse(0.1)
        with desk.node.nmt.state_update:
            desk.node.nmt.state_update.wait_for(lambda: len(beats) > count, timeout=5)
        return beats[-1]

    desk.node.sdo["Producer heartbeat time"].raw = 100
    assert beat() == 127
    for name, state in [("OPERATIONAL", 5), ("STOPPED", 4), ("PRE-OPERATIONAL", 127)]:
        desk.node.nmt.state = name
        assert beat() == state
    desk.node.nmt.state = "RESET"
    with desk.node.nmt.state_update:
        assert desk.node.nmt.state_update.wait_for(lambda: beats[-1] == 0, timeout=5)
    assert desk.node.sdo["Producer heartbeat time"].raw == 0


@pytest.mark.parametrize(
    ("condition", "code", "register"),
    [
        (DriveCondition.OVER_VOLTAGE, 0x3210, 0x05),
        (DriveCondition.ENCODER_LOST, 0x7305, 0x21),
        (DriveCondition.OVER_TEMPERATURE, 0x4210, 0x09),
    ],
)
def test_faults_on_request(desk: Desk, condition: DriveCondition, code: int, register: int) -> None:
    emcy = desk.node.emcy

    def wait(count: int) -> None:
        with emcy.emcy_received:
            assert emcy.emcy_received.wait_for(lambda: len(emcy.log) >= count, timeout=5)

    desk.node.sdo["Simulated conditions"].raw = condition
    wait(1)
    assert (emcy.log[0].code, emcy.log[0].register) == (code, register)
    desk.bus.elapse(0)
    assert desk.drive.state == DriveState.FAULT
    assert desk.node.sdo["Error code"].raw == code
    assert desk.node.sdo["Pre-defined error field"]["Error 1"].raw & 0xFFFF == code
    for word in (0, 0x80):
        desk.node.sdo["Controlword"].raw = word
    assert desk.drive.state == DriveState.FAULT  # its cause is still there
    desk.node.sdo["Simulated conditions"].raw = 0
    for word in (0, 0x80):
        desk.node.sdo["Controlword"].raw = word
    wait(2)
    assert emcy.active == []
    assert desk.drive.state == DriveState.SWITCH_ON_DISABLED


def test_a_master_that_falls_silent_is_noticed(desk: Desk) -> None:
    desk.node.sdo["Consumer heartbeat time"]["Consumer heartbeat time 1"].raw = 127 << 16 | 100
    desk.network.send_message(0x700 + 127, [5])
    desk.bus.elapse(0.099)
    assert desk.node.sdo["Error register"].raw == 0
    desk.bus.elapse(0.001)
    assert desk.node.sdo["Error code"].raw == 0x8130
    desk.network.send_message(0x700 + 127, [5])
    assert desk.node.sdo["Error register"].raw == 0


def test_a_silent_node_times_out(desk: Desk) -> None:
    desk.drive.set_condition(DriveCondition.SILENT, True)
    desk.node.sdo.RESPONSE_TIMEOUT = 0.02
    with pytest.raises(canopen.SdoCommunicationError):
        desk.node.sdo.upload(0x1000, 0)
    desk.drive.set_condition(DriveCondition.SILENT, False)
    desk.node.sdo.RESPONSE_TIMEOUT = 5
    assert desk.node.sdo["Device type"].raw == 0x00020192


def test_every_state_times_every_command_over_sdo() -> None:
    table = _core._drive_transitions()
    assert len(table) == len(DriveState)
    way = {
        DriveState.SWITCH_ON_DISABLED: (0,),
        DriveState.READY_TO_SWITCH_ON: (6,),
        DriveState.SWITCHED_ON: (6, 7),
        DriveState.OPERATION_ENABLED: (6, 7, 15),
        DriveState.QUICK_STOP_ACTIVE: (6, 7, 15, 2),
        DriveState.FAULT: (0,),
    }
    for state, words in way.items():
        for column, word in enumerate(CONTROLWORDS.values()):
            if column == 0:
                continue  # a held bit 7, which the C++ tests hold
            drive = SimulatedDrive(node=1)
            drive.elapse(0)
            drive.receive(0x601, b"\x2b\x5a\x60\x00\x06\x00\x00\x00")  # a quick stop stays
            if state == DriveState.FAULT:
                drive.set_condition(DriveCondition.OVER_VOLTAGE, True)
                drive.set_condition(DriveCondition.OVER_VOLTAGE, False)
                drive.elapse(0)
            for step in (*words, word):
                before = drive.state
                drive.receive(0x601, b"\x2b\x40\x60\x00" + step.to_bytes(4, "little"))
            assert before == state
            assert drive.state == table[state][column], (state, column)


def setup_of(device: ebac.Device, seconds: float = 1.0) -> Any:
    return _core.Setup(
        device=device, hand=ebac.Hand(stiffness=0), environment=ebac.Free(),
        timing=ebac.Timing(), seconds=seconds, jitter=0, seed=1,
    )  # fmt: skip


def test_two_drives_move_one_joystick() -> None:
    joystick = Joystick(
        setup_of(ebac.Device(kinematics=ebac.Gimbal())), wiring=DriveWiring(nodes=[3, 4])
    )
    desk = Desk(joystick, joystick.drive(1))
    try:
        node = desk.node
        assert node.id == 4
        node.sdo["Modes of operation"].raw = 10
        node.sdo["Target torque"].raw = -500
        desk.bus.elapse(0.05)
        assert joystick.truth(1).v == 0  # not enabled: no current
        for word in (6, 7, 15):
            node.sdo["Controlword"].raw = word
        assert joystick.drive(0).current == 0
        assert joystick.drive(1).current == pytest.approx(-0.4926, abs=5e-5)
        desk.bus.elapse(0.05)  # without SYNC, as time is told
        assert joystick.truth(1).v > 0
        assert node.sdo["Position actual value"].raw > 10
        assert node.sdo["Velocity actual value"].raw > 1000
        node.sdo["Controlword"].raw = 0
        assert joystick.drive(1).current == 0
    finally:
        desk.network.disconnect()


def test_a_current_between_two_syncs_acts_from_then_on() -> None:
    """0.4 ms at 500 per mille and 0.6 ms at 0: two fifths of the impulse of a whole tick."""
    device = ebac.Device(drive=ebac.Drive(current_lag=0))

    def speed(at: float | None) -> float:
        joystick = Joystick(setup_of(device))
        joystick.elapse(0)

        def write(index: int, value: int, size: int = 0x2B) -> None:
            where = bytes([size]) + index.to_bytes(2, "little") + b"\0"
            joystick.receive(0x601, where + value.to_bytes(4, "little"))

        write(0x6060, 10, 0x2F)
        for word in (6, 7, 15):
            write(0x6040, word)
        joystick.receive(0x080)
        write(0x6071, 500)
        if at is None:
            joystick.elapse(1e-3)
        else:
            joystick.elapse(at)
            write(0x6071, 0)
            joystick.elapse(1e-3 - at)
        joystick.receive(0x080)
        return float(joystick.truth(0).v)

    assert speed(4e-4) == pytest.approx(0.4 * speed(None), rel=0.01)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (lambda: SimulatedDrive(node=0), r"drive.node = 0: must lie in \[1, 127\]"),
        (lambda: SimulatedDrive(node=128), r"must lie in \[1, 127\]"),
        (lambda: SimulatedDrive(peak_time=100), r"peak_time = 100 s.*65.535"),
        (lambda: SimulatedDrive().elapse(-1), r"seconds = -1 s: must lie in \[0, 86400\] s"),
        (lambda: SimulatedDrive().elapse(float("nan")), "seconds = nan"),
        (lambda: SimulatedDrive().receive(0x800), "2048"),
        (lambda: SimulatedDrive().receive(1, b"123456789"), "9 bytes"),
        (
            lambda: Joystick(setup_of(ebac.Device()), wiring=DriveWiring(nodes=[128])),
            r"node = 128: must lie in \[1, 127\]",
        ),
    ],
)
def test_wrong_input_is_named(wrong: Any, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        wrong()


def test_rows_of_the_table_are_states() -> None:
    table = np.array(_core._drive_transitions())
    assert table.shape == (8, len(CONTROLWORDS))


def test_the_documentation_lists_every_object() -> None:
    page = (Path(__file__).parents[2] / "docs" / "reference" / "simulated_drive.md").read_text(
        encoding="utf-8"
    )
    told = re.findall(r"0x([0-9A-F]{4})\b", page.split("## Objects")[1])
    has = {thing.index for thing in DICTIONARY.values() if thing.index > 7}
    assert sorted(int(index, 16) for index in told) == sorted(has)
