"""Option codes, conditions, guarding, windows, LSS and block transfer of the simulated drive, by python-canopen."""

import sys
from collections.abc import Iterator
from pathlib import Path

import canopen
import pytest
from canopen.sdo.exceptions import SdoAbortedError

from ebac import drives
from ebac._core import DriveCondition, DriveState, SimulatedDrive

sys.path.insert(0, str(Path(__file__).parents[1] / "buses"))
from simulated_bus import SimulatedBus

IDENTITY = (0, 0x65626163, 0x00010000, 3)


@pytest.fixture
def drive() -> SimulatedDrive:
    made = SimulatedDrive(node=3)
    made.elapse(0)
    made.take()
    return made


@pytest.fixture
def network(drive: SimulatedDrive) -> Iterator[canopen.Network]:
    made = canopen.Network(SimulatedBus(drive))
    made.NOTIFIER_CYCLE = 0.01
    made.connect()
    made.lss.RESPONSE_TIMEOUT = 0.2
    yield made
    made.disconnect()


def put(drive: SimulatedDrive, index: int, value: int, size: int, sub: int = 0) -> int:
    """Write by SDO; the abort code, 0 for none."""
    head = bytes([0x23 | (4 - size) << 2, index & 0xFF, index >> 8, sub])
    drive.receive(
        0x603, head + value.to_bytes(4, "little", signed=value < 0)[:size].ljust(4, b"\0")
    )
    answer = next(data for cob, data in drive.take() if cob == 0x583)
    return int.from_bytes(answer[4:], "little") if answer[0] == 0x80 else 0


def get(drive: SimulatedDrive, index: int, sub: int = 0) -> int:
    drive.receive(0x603, bytes([0x40, index & 0xFF, index >> 8, sub, 0, 0, 0, 0]))
    answer = next(data for cob, data in drive.take() if cob == 0x583)
    assert answer[0] & 0xE3 == 0x43, answer.hex()
    return int.from_bytes(answer[4 : 8 - (answer[0] >> 2 & 3)], "little")


def enabled(drive: SimulatedDrive, permille: int = 500) -> None:
    """Power it in mode 10 at a torque."""
    drive.elapse(1e-3)
    assert put(drive, 0x6060, 10, 1) == 0
    for word in (0x06, 0x07, 0x0F):
        assert put(drive, 0x6040, word, 2) == 0
    assert put(drive, 0x6071, permille, 2) == 0
    assert drive.state == DriveState.OPERATION_ENABLED
    assert get(drive, 0x6077) == permille


# --- option codes ---


@pytest.mark.parametrize(
    ("index", "code", "word", "slope", "end"),
    [
        (0x605A, 1, 0x02, 0x6087, DriveState.SWITCH_ON_DISABLED),
        (0x605A, 2, 0x02, 0x6085, DriveState.SWITCH_ON_DISABLED),
        (0x605A, 6, 0x02, 0x6085, DriveState.QUICK_STOP_ACTIVE),
        (0x605B, 1, 0x06, 0x6087, DriveState.READY_TO_SWITCH_ON),
        (0x605C, 1, 0x07, 0x6087, DriveState.SWITCHED_ON),
    ],
)
def test_an_option_code_takes_the_torque_off_by_its_ramp(
    drive: SimulatedDrive, index: int, code: int, word: int, slope: int, end: DriveState
) -> None:
    """500 per mille at 10000 per mille a second: 50 ms."""
    assert put(drive, index, code, 2) == 0
    assert put(drive, slope, 10_000, 4) == 0
    enabled(drive)
    assert put(drive, 0x6040, word, 2) == 0
    drive.elapse(0.025)
    assert get(drive, 0x6077) == 250
    drive.elapse(0.026)
    drive.elapse(0)
    assert get(drive, 0x6077) == 0
    assert drive.state == end


@pytest.mark.parametrize("index", [0x605B, 0x605C])
def test_by_default_shutdown_and_disable_take_it_off_at_once(
    drive: SimulatedDrive, index: int
) -> None:
    enabled(drive)
    assert put(drive, 0x6040, 0x06 if index == 0x605B else 0x07, 2) == 0
    assert drive.current == 0


def test_enabling_again_on_the_ramp_of_a_shutdown_goes_on(drive: SimulatedDrive) -> None:
    put(drive, 0x605B, 1, 2)
    enabled(drive)
    put(drive, 0x6040, 0x06, 2)
    drive.elapse(0.01)
    put(drive, 0x6040, 0x0F, 2)
    drive.elapse(0.01)
    assert drive.state == DriveState.OPERATION_ENABLED
    assert get(drive, 0x6077) == 500


@pytest.mark.parametrize(("code", "left"), [(0, 0), (1, 400), (2, 250)])
def test_a_fault_takes_the_torque_off_by_605e(drive: SimulatedDrive, code: int, left: int) -> None:
    put(drive, 0x605E, code, 2)
    put(drive, 0x6087, 10_000, 4)
    put(drive, 0x6085, 25_000, 4)
    enabled(drive)
    drive.set_condition(DriveCondition.MOTOR_TEMPERATURE, True)
    drive.elapse(0.010)
    assert get(drive, 0x6077) == left
    drive.elapse(0.050)
    drive.elapse(0)
    assert drive.state == DriveState.FAULT
    assert drive.current == 0


@pytest.mark.parametrize(("code", "left"), [(1, 400), (2, 250), (3, 0)])
def test_a_halt_takes_the_torque_off_by_605d(drive: SimulatedDrive, code: int, left: int) -> None:
    put(drive, 0x605D, code, 2)
    put(drive, 0x6087, 10_000, 4)
    put(drive, 0x6085, 25_000, 4)
    enabled(drive, 0)
    put(drive, 0x6060, 4, 1)
    put(drive, 0x6071, 500, 2)
    drive.elapse(0.1)
    put(drive, 0x6040, 0x10F, 2)
    drive.elapse(0.010)
    assert get(drive, 0x6077) == left


# --- conditions ---


@pytest.mark.parametrize(
    ("condition", "code"),
    [
        (DriveCondition.UNDER_VOLTAGE, 0x3220),
        (DriveCondition.MOTOR_TEMPERATURE, 0x4310),
        (DriveCondition.SHORT_CIRCUIT, 0x2320),
        (DriveCondition.BRAKE_STUCK, 0x7121),
    ],
)
def test_a_condition_is_a_fault_with_its_code_until_it_is_gone_and_reset(
    drive: SimulatedDrive, condition: DriveCondition, code: int
) -> None:
    put(drive, 0x605E, 1, 2)  # a ramp, which what is broken in the power stage does not wait for
    enabled(drive)
    drive.set_condition(condition, True)
    if condition != DriveCondition.MOTOR_TEMPERATURE:
        assert drive.current == 0
    emergencies = [data for cob, data in drive.take() if cob == 0x83]
    assert [int.from_bytes(data[:2], "little") for data in emergencies] == [code]
    drive.elapse(1.0)
    assert drive.state == DriveState.FAULT
    put(drive, 0x6040, 0x80, 2)
    assert drive.state == DriveState.FAULT
    drive.set_condition(condition, False)
    put(drive, 0x6040, 0x00, 2)
    put(drive, 0x6040, 0x80, 2)
    assert drive.state == DriveState.SWITCH_ON_DISABLED


@pytest.mark.parametrize("condition", [DriveCondition.TORQUE_OFF, DriveCondition.ENABLE_MISSING])
def test_without_its_inputs_a_drive_has_no_power_and_no_fault(
    drive: SimulatedDrive, condition: DriveCondition
) -> None:
    enabled(drive)
    drive.set_condition(condition, True)
    assert drive.current == 0
    assert get(drive, 0x60FD) == (1 << 16 if condition == DriveCondition.TORQUE_OFF else 1 << 3)
    assert bool(get(drive, 0x6041) & 1 << 4) == (condition == DriveCondition.ENABLE_MISSING)
    for word in (0x06, 0x07, 0x0F):
        put(drive, 0x6040, word, 2)
    drive.elapse(0.01)
    assert drive.state == DriveState.SWITCH_ON_DISABLED
    drive.set_condition(condition, False)
    enabled(drive)


def test_the_brake_holds_while_there_is_no_power(drive: SimulatedDrive) -> None:
    assert get(drive, 0x60FE, 1) == 1
    enabled(drive)
    assert get(drive, 0x60FE, 1) == 0
    put(drive, 0x6040, 0, 2)
    assert get(drive, 0x60FE, 1) == 1
    drive.set_condition(DriveCondition.BRAKE_STUCK, True)
    for word in (0x06, 0x07, 0x0F):
        put(drive, 0x6040, word, 2)
    drive.elapse(0)
    assert drive.state == DriveState.FAULT


def test_faults_go_by_name_over_the_bus_and_only_to_simulated_drives(drive: SimulatedDrive) -> None:
    with drives.DriveBus(SimulatedBus(drive, per_frame=1e-3)) as bus:
        one = bus.drive(3)
        drives.inject(one, ["under-voltage", "brake-stuck"])
        assert one.read("error_code") == 0x3220
        drives.inject(one, [])
        one.reset_fault()
        with pytest.raises(ValueError, match="did you mean 'short-circuit'"):
            drives.inject(one, ["short-circus"])
    other = SimulatedDrive(node=3, sheet=[(0x1018, 2, "ro", False, 4, 0, 9, 7, "")])
    with (
        drives.DriveBus(SimulatedBus(other)) as bus,
        pytest.raises(drives.DriveError, match="no simulated drive"),
    ):
        drives.inject(bus.drive(3), ["silent"])


# --- guarding, window, counter ---


def test_a_guarded_drive_answers_with_a_toggle_and_lets_go_without_its_master(
    drive: SimulatedDrive,
) -> None:
    put(drive, 0x100C, 20, 2)
    put(drive, 0x100D, 3, 1)
    drive.receive(0x000, bytes([1, 3]))
    enabled(drive)
    drive.elapse(1.0)  # its watch begins with the first request
    drive.take()
    for state in (0x05, 0x85, 0x05):
        drive.receive(0x703, remote=True)
        assert drive.take() == [(0x703, bytes([state]))]
        drive.elapse(0.05)
    assert drive.current > 0
    drive.elapse(0.011)
    assert drive.current == 0
    assert any(cob == 0x83 and data[:2] == b"\x30\x81" for cob, data in drive.take())


def test_a_drive_with_a_heartbeat_is_not_guarded(drive: SimulatedDrive) -> None:
    put(drive, 0x1017, 100, 2)
    drive.receive(0x703, remote=True)
    assert drive.take() == []


def test_canopen_guards_it(drive: SimulatedDrive, network: canopen.Network) -> None:
    node = canopen.RemoteNode(3, canopen.ObjectDictionary())
    network.add_node(node)
    node.nmt.start_node_guarding(0.02)
    node.nmt.wait_for_heartbeat(timeout=1.0)
    node.nmt.stop_node_guarding()
    assert node.nmt.state == "PRE-OPERATIONAL"


def test_a_torque_after_the_window_of_sync_is_dropped(drive: SimulatedDrive) -> None:
    """0x1007: data for the next SYNC are taken only that long after the last one."""
    put(drive, 0x1400, 1, 1, sub=2)
    put(drive, 0x1400, 0x80000203, 4, sub=1)
    put(drive, 0x1600, 0, 1)
    put(drive, 0x1600, 0x60710010, 4, sub=1)
    put(drive, 0x1600, 1, 1)
    put(drive, 0x1400, 0x203, 4, sub=1)
    put(drive, 0x1007, 500, 4)
    drive.receive(0x000, bytes([1, 3]))
    enabled(drive, 0)
    for wait, expected in ((0.0004, 100), (0.0006, 100)):
        drive.receive(0x080)
        drive.elapse(wait)
        drive.receive(0x203, (100 if expected and wait < 0.0005 else 200).to_bytes(2, "little"))
        drive.elapse(0.001 - wait)
        drive.receive(0x080)
        assert get(drive, 0x6071) == expected


def test_a_sync_counter_is_wanted_where_1019_says_so(drive: SimulatedDrive) -> None:
    assert put(drive, 0x1019, 1, 1) == 0x06090030
    assert put(drive, 0x1019, 10, 1) == 0
    drive.receive(0x000, bytes([1, 3]))
    drive.take()
    drive.receive(0x080)
    assert [data[:2] for cob, data in drive.take() if cob == 0x83] == [b"\x40\x82"]
    drive.receive(0x080, b"\x01")
    assert [data[:2] for cob, data in drive.take() if cob == 0x83] == [b"\x00\x00"]
    put(drive, 0x1006, 1000, 4)
    assert put(drive, 0x1019, 0, 1) == 0x08000022


# --- LSS ---


def test_canopen_asks_by_lss_who_it_is_and_gives_it_another_id(
    drive: SimulatedDrive, network: canopen.Network
) -> None:
    lss = network.lss
    assert lss.send_switch_state_selective(*IDENTITY)
    assert [lss.inquire_lss_address(service) for service in (0x5A, 0x5B, 0x5C, 0x5D)] == list(
        IDENTITY
    )
    assert lss.inquire_node_id() == 3
    lss.configure_node_id(9)
    lss.configure_bit_timing(0)
    lss.store_configuration()
    assert drive.node == 3
    lss.send_switch_state_global(lss.WAITING_STATE)
    network.send_message(0, bytes([0x82, 3]))
    assert drive.node == 9
    network.send_message(0x609, bytes([0x40, 0x18, 0x10, 4, 0, 0, 0, 0]))
    assert drive.node == 9


def test_a_reset_forgets_half_an_identification(drive: SimulatedDrive) -> None:
    def ask(*numbers: tuple[int, int]) -> list[int]:
        drive.take()
        for command, number in numbers:
            drive.receive(0x7E5, bytes([command]) + number.to_bytes(4, "little") + bytes(3))
        return [cob for cob, _ in drive.take()]

    vendor, product, revision, serial = IDENTITY
    first = [(0x46, vendor), (0x47, product)]
    rest = [(0x48, revision), (0x49, revision), (0x4A, serial), (0x4B, serial)]
    assert ask(*first, *rest) == [0x7E4]
    ask(*first)
    drive.receive(0, bytes([0x82, 3]))
    assert ask(*rest) == []


def test_canopen_finds_it_by_fastscan(drive: SimulatedDrive) -> None:
    """A bit of which nothing is heard is a one: what answers stands in the queue before canopen looks."""
    network = canopen.Network()

    def send(identifier: int, data: bytes, remote: bool = False) -> None:
        drive.receive(identifier, bytes(data), remote=remote)
        for answer, said in drive.take():
            network.notify(answer, bytearray(said), 0.0)

    network.send_message = send  # type: ignore[method-assign]
    network.lss.RESPONSE_TIMEOUT = 1e-3
    found, identity = network.lss.fast_scan()
    assert found
    assert identity == list(IDENTITY)
    assert network.lss.inquire_node_id() == 3


def test_a_stranger_is_not_selected(drive: SimulatedDrive, network: canopen.Network) -> None:
    network.lss.RESPONSE_TIMEOUT = 0.02
    with pytest.raises(canopen.lss.LssError):
        network.lss.send_switch_state_selective(1, 2, 3, 4)


# --- block transfer ---


@pytest.fixture
def node(network: canopen.Network) -> canopen.RemoteNode:
    made = canopen.RemoteNode(3, canopen.ObjectDictionary())
    network.add_node(made)
    made.sdo.RESPONSE_TIMEOUT = 0.5
    return made


@pytest.mark.parametrize("length", [1, 6, 7, 8, 14, 40])
def test_canopen_writes_and_reads_a_text_in_blocks(node: canopen.RemoteNode, length: int) -> None:
    text = bytes(0x41 + i % 26 for i in range(length))
    with node.sdo.open(0x6403, 0, "wb", size=length, block_transfer=True) as out:
        out.write(text)
    with node.sdo.open(0x6403, 0, "rb", block_transfer=True) as file:
        assert file.read() == text
    assert node.sdo.upload(0x6403, 0) == text


def test_blocks_that_are_wrong_are_refused(drive: SimulatedDrive, node: canopen.RemoteNode) -> None:
    with (
        pytest.raises(SdoAbortedError) as caught,
        node.sdo.open(0x6041, 0, "wb", size=2, block_transfer=True) as out,
    ):
        out.write(b"\0\0")
    assert caught.value.code == 0x06010002

    def said(request: list[int]) -> bytes:
        drive.receive(0x603, bytes(request))
        return dict(drive.take()).get(0x583, b"")

    assert said([0xC6, 3, 0x64, 0, 3, 0, 0, 0])[0] == 0xA4
    assert said([0x81, 65, 66, 67, 0, 0, 0, 0])[:2] == b"\xa2\x01"
    assert said([0xD1, 0, 0, 0, 0, 0, 0, 0])[4:] == (0x05040004).to_bytes(4, "little")  # checksum
    assert said([0xA4, 3, 0x64, 0, 0, 0, 0, 0])[4:] == (0x05040002).to_bytes(
        4, "little"
    )  # block size
    assert said([0xC6, 3, 0x64, 0, 41, 0, 0, 0])[4:] == (0x06070012).to_bytes(4, "little")


def test_a_lost_segment_is_sent_again(drive: SimulatedDrive) -> None:
    def said(*request: int) -> list[bytes]:
        drive.receive(0x603, bytes(request).ljust(8, b"\0"))
        return [data for cob, data in drive.take() if cob == 0x583]

    name = 0x1008
    (start,) = said(0xA4, name & 0xFF, name >> 8, 0, 2)
    assert start[0] == 0xC6
    size = int.from_bytes(start[4:], "little")
    first = said(0xA3)
    assert [data[0] for data in first] == [1, 2]
    again = said(0xA2, 1, 127)  # only the first came
    assert again[0][1:] == first[1][1:]
    assert again[-1][0] & 0x80
    (end,) = said(0xA2, len(again), 127)
    assert end[0] & 0xE3 == 0xC1
    text = b"".join(data[1:] for data in (first[0], *again))[:size]
    assert text == b"ebac simulated drive"
    assert said(0xA1) == []
