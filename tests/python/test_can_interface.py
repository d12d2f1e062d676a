"""The python-can interface `ebac`: what python-can and canopen do on any bus, they do on this one."""

import io
import logging
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import Any

import can
import canopen
import numpy as np
import pytest
from can_logger import logged
from hypothesis import given
from hypothesis import strategies as st

from ebac import _core
from ebac._core import CanFrame, LoopbackHub
from ebac.can import channels
from ebac.can.interface import NODES, EbacBus


@pytest.fixture
def channel(request: pytest.FixtureRequest) -> Iterator[str]:
    """The name of a channel of its own, which must be gone afterwards."""
    yield request.node.name
    assert channels.CHANNELS == {}


def bus(channel: str, **options: Any) -> EbacBus:
    made = can.Bus(interface="ebac", channel=channel, ignore_config=True, **options)
    assert isinstance(made, EbacBus)
    return made


def message(identifier: int, *data: int, **options: Any) -> can.Message:
    return can.Message(arbitration_id=identifier, data=data, **{"is_extended_id": False, **options})


def drain(end: can.BusABC) -> list[can.Message]:
    return list(iter(lambda: end.recv(0), None))


messages = st.one_of(
    st.builds(
        can.Message,
        arbitration_id=st.integers(0, 0x7FF),
        data=st.binary(max_size=8),
        is_extended_id=st.just(False),
        is_error_frame=st.booleans(),
    ),
    st.builds(can.Message, arbitration_id=st.integers(0, 0x1FFFFFFF), data=st.binary(max_size=8)),
    st.builds(
        can.Message,
        arbitration_id=st.integers(0, 0x7FF),
        dlc=st.integers(0, 8),
        is_extended_id=st.just(False),
        is_remote_frame=st.just(True),
    ),
)


@given(sent=st.lists(messages, max_size=30))
def test_messages_arrive_as_they_were_sent(sent: list[can.Message]) -> None:
    with bus("any") as mine, bus("any") as other:
        before = time.time()
        for one in sent:
            mine.send(one)
        got = drain(other)
        assert drain(mine) == []
    for one, back in zip(sent, got, strict=True):
        assert back.equals(one, timestamp_delta=None, check_channel=False)
        assert back.is_rx
        assert back.channel == "any"
        assert before - 1e-3 <= back.timestamp <= time.time() + 1e-3
    assert all(a.timestamp <= b.timestamp for a, b in pairwise(got))


def test_frames_arrive_as_on_the_virtual_bus() -> None:
    sent = [
        message(0x123, 1, 2),
        message(0x12345678, 3, is_extended_id=True),
        message(0x181, is_remote_frame=True, dlc=4),
        message(0x40, *range(8), is_error_frame=True),
        message(0),
    ]
    got = {}
    for interface in ("ebac", "virtual"):
        with (
            can.Bus(interface=interface, channel="same") as mine,
            can.Bus(interface=interface, channel="same") as other,
            can.Bus(interface=interface, channel="same", receive_own_messages=True) as echo,
        ):
            for one in sent:
                mine.send(one)
                echo.send(one)
            got[interface] = [drain(end) for end in (mine, other, echo)]
    for ours, theirs in zip(got["ebac"], got["virtual"], strict=True):
        assert len(ours) == len(theirs)
        for a, b in zip(ours, theirs, strict=True):
            assert a.equals(b, timestamp_delta=None), (a, b)


def test_two_channels_are_two_buses(channel: str) -> None:
    with bus(channel) as one, bus(f"{channel}2") as two:
        one.send(message(1))
        assert two.recv(0) is None


def test_a_channel_goes_with_the_last_who_leaves(channel: str) -> None:
    first, second = bus(channel), bus(channel)
    hub = channels.CHANNELS[channel].hub
    assert hub.ends == 2
    first.shutdown()
    first.shutdown()
    assert hub.ends == 1
    second.shutdown()
    assert hub.ends == 0
    with bus(channel):
        assert channels.CHANNELS[channel].hub is not hub


@pytest.mark.parametrize(
    ("filters", "expected"),
    [
        (None, [0x80, 0x181, 0x182, 0x12345]),
        ([], [0x80, 0x181, 0x182, 0x12345]),
        ([{"can_id": 0x180, "can_mask": 0x7F0}], [0x181, 0x182]),
        (
            [{"can_id": 0x181, "can_mask": 0x7FF}, {"can_id": 0x80, "can_mask": 0x7FF}],
            [0x80, 0x181],
        ),
        ([{"can_id": 0, "can_mask": 0, "extended": True}], [0x12345]),
    ],
)
def test_filters(channel: str, filters: Any, expected: list[int]) -> None:
    with bus(channel) as mine, bus(channel, can_filters=filters) as at_start, bus(channel) as later:
        later.set_filters(filters)
        for identifier in (0x80, 0x181, 0x182, 0x12345):
            mine.send(message(identifier, is_extended_id=identifier > 0x7FF))
        for end in (at_start, later):
            assert [got.arbitration_id for got in drain(end)] == expected


def test_a_filter_does_not_prolong_the_wait(channel: str) -> None:
    with (
        bus(channel) as mine,
        bus(channel, can_filters=[{"can_id": 1, "can_mask": 0x7FF}]) as other,
    ):
        mine.send_periodic(message(2), 0.005)
        start = time.monotonic()
        assert other.recv(0.1) is None
        assert 0.1 <= time.monotonic() - start < 5


def test_a_bus_full_of_frames_for_others_does_not_prolong_the_wait(channel: str) -> None:
    filters = [{"can_id": 1, "can_mask": 0x7FF}]
    with bus(channel) as mine, bus(channel, can_filters=filters) as other:
        start, over = time.monotonic(), threading.Event()

        def flood() -> None:
            while not over.is_set() and time.monotonic() - start < 0.8:
                mine.send(message(5))

        sender = threading.Thread(target=flood)
        sender.start()
        got = other.recv(0.05)
        took = time.monotonic() - start
        over.set()
        sender.join()
        assert got is None
        assert 0.05 <= took < 0.5
        drain(other)
        for identifier in (5, 5, 5, 1, 5):
            mine.send(message(identifier))
        got = other.recv(0)
        assert got is not None
        assert got.arbitration_id == 1
        assert other.recv(0) is None


@pytest.mark.parametrize("timeout", [0.0, 0.05])
def test_time_outs(channel: str, timeout: float) -> None:
    with bus(channel) as end:
        start = time.monotonic()
        assert end.recv(timeout) is None
        assert timeout <= time.monotonic() - start < timeout + 5


def test_a_wait_without_end_ends_with_a_message(channel: str) -> None:
    with bus(channel) as mine, bus(channel) as other:
        late = threading.Timer(0.08, lambda: mine.send(message(7)))
        late.start()
        got = other.recv()
        late.join()
        assert got is not None
        assert got.arbitration_id == 7


def test_iteration(channel: str) -> None:
    with bus(channel) as mine, bus(channel) as other:
        for i in range(3):
            mine.send(message(i))
        assert [got.arbitration_id for _, got in zip(range(3), other, strict=False)] == [0, 1, 2]


def kept_in_time(attempt: Callable[[], bool]) -> bool:
    """Whether what a thread of Python sends keeps its time once: a machine that stalls it gets two more chances."""
    return any(attempt() for _ in range(3))


def test_periodic_sending_keeps_its_period(channel: str) -> None:
    def attempt() -> bool:
        with bus(channel) as mine, bus(channel) as other:
            task = mine.send_periodic(message(1), 0.01)
            got = [other.recv(10) for _ in range(8)]
            task.stop()
            times = [one.timestamp for one in got if one]
            return 0.05 < times[-1] - times[0] < 1  # seven periods; how well is no matter

    assert kept_in_time(attempt)


def test_periodic_sending(channel: str) -> None:
    with bus(channel) as mine, bus(channel) as other:
        task = mine.send_periodic([message(1, 0), message(1, 9)], 0.01)
        got = [other.recv(10) for _ in range(8)]
        task.stop()
        assert [one.data[0] for one in got if one] == [0, 9] * 4
        assert isinstance(task, can.ModifiableCyclicTaskABC)
        task.modify_data([message(1, 5), message(1, 5)])
        time.sleep(0.03)
        drain(other)
        task.start()
        last = other.recv(10)
        assert last is not None
        assert list(last.data) == [5]


def test_periodic_sending_ends_with_its_time(channel: str) -> None:
    def attempt() -> bool:
        with bus(channel) as mine, bus(channel) as other:
            mine.send_periodic(message(1), 0.01, duration=0.05)
            time.sleep(0.15)
            count = len(drain(other))
            time.sleep(0.03)
            return 3 <= count <= 7 and drain(other) == []

    assert kept_in_time(attempt)


def test_shutdown_in_the_middle_of_periodic_sending(channel: str) -> None:
    for i in range(200):
        end = bus(channel)
        tasks = [end.send_periodic(message(1), 1e-4, store_task=bool(i % 2)) for _ in range(2)]
        time.sleep(5e-4)
        for task in tasks:
            task.stop()
        end.shutdown()  # a task that raises in its thread fails the test
    time.sleep(0.01)


def test_a_notifier_calls_its_listeners(channel: str) -> None:
    with bus(channel) as mine, bus(channel) as other:
        reader, got = can.BufferedReader(), []
        with can.Notifier(other, [reader, got.append], timeout=0.1):
            mine.send(message(1, 42))
            first = reader.get_message(timeout=1)
        assert first is not None
        assert list(first.data) == [42]
        assert [one.arbitration_id for one in got] == [1]


def test_a_notifier_on_two_buses(channel: str) -> None:
    with bus(channel) as mine, bus(channel) as one, bus(channel) as two:
        got: list[can.Message] = []
        with can.Notifier([one, two], [got.append], timeout=0.1):
            mine.send(message(3))
            until = time.monotonic() + 2
            while len(got) < 2 and time.monotonic() < until:
                time.sleep(0.005)
        assert [each.arbitration_id for each in got] == [3, 3]


def test_asyncio(channel: str) -> None:
    import asyncio

    async def exchange() -> can.Message:
        with bus(channel) as mine, bus(channel) as other:
            reader = can.AsyncBufferedReader()
            with can.Notifier(other, [reader], timeout=0.1, loop=asyncio.get_running_loop()):
                mine.send(message(9))
                return await asyncio.wait_for(reader.get_message(), 2)

    assert asyncio.run(exchange()).arbitration_id == 9


def test_after_shutdown(channel: str) -> None:
    end = bus(channel)
    end.shutdown()
    for act in (lambda: end.recv(0), lambda: end.recv(), lambda: end.send(message(1))):
        with pytest.raises(can.CanOperationError, match="is shut down; open it anew"):
            act()


def test_shutdown_ends_a_wait(channel: str) -> None:
    end = bus(channel)
    raised: list[Exception] = []

    def wait() -> None:
        try:
            end.recv()
        except can.CanOperationError as error:
            raised.append(error)

    waiting = threading.Thread(target=wait)
    waiting.start()
    time.sleep(0.02)
    end.shutdown()
    waiting.join(2)
    assert not waiting.is_alive()
    assert len(raised) == 1


def test_a_forgotten_bus_is_shut_down(channel: str, caplog: pytest.LogCaptureFixture) -> None:
    end = bus(channel)
    del end
    assert "was not properly shut down" in caplog.text


def test_the_state(channel: str) -> None:
    with bus(channel) as end:
        assert end.state is can.BusState.ACTIVE
        assert end.protocol is can.CanProtocol.CAN_20
        assert str(end) == f"ebac channel '{channel}'"
        assert {"interface": "ebac", "channel": channel} in can.detect_available_configs("ebac")
        end.flush_tx_buffer()
        with pytest.raises(NotImplementedError):
            end.fileno()


def test_a_queue_may_be_as_long_as_a_number_of_numpy(channel: str) -> None:
    with EbacBus(channel, rx_queue_size=np.int64(8)) as end:  # type: ignore[arg-type]
        assert end.recv(0) is None


@pytest.mark.parametrize(
    ("options", "tells"),
    [
        ({"rx_queue_size": 0}, r"rx_queue_size = 0: must be a whole number in \[1, 1048576\]"),
        ({"rx_queue_size": -1}, "rx_queue_size = -1"),
        ({"rx_queue_size": 2**21}, "rx_queue_size = 2097152"),
        ({"rx_queue_size": True}, "rx_queue_size = True"),
        ({"rx_queue_size": "many"}, "rx_queue_size = many"),
        ({"fd": True}, "leave fd out"),
        ({"protocol": can.CanProtocol.CAN_FD}, "leave fd out"),
    ],
)
def test_bad_options_are_refused(channel: str, options: dict[str, Any], tells: str) -> None:
    with pytest.raises(ValueError, match=tells):
        EbacBus(channel, **options)


def test_what_other_interfaces_know_does_no_harm(channel: str) -> None:
    with bus(channel, bitrate=1_000_000, fd=False), bus("5") as five, EbacBus(5) as same:
        same.send(message(1))
        assert five.recv(0) is not None


@pytest.mark.parametrize(
    ("bad", "tells"),
    [
        (message(1, is_fd=True), "CAN FD"),
        (message(0x800), r"CanFrame.id = 2048: must lie in \[0, 0x7FF\]"),
        (message(0x20000000, is_extended_id=True), r"must lie in \[0, 0x1FFFFFFF\]"),
    ],
)
def test_impossible_messages_are_refused(channel: str, bad: can.Message, tells: str) -> None:
    with bus(channel) as mine, bus(channel) as other:
        with pytest.raises(ValueError, match=tells):
            mine.send(bad)
        assert other.recv(0) is None


def test_lost_frames_are_counted_and_reported(
    channel: str, caplog: pytest.LogCaptureFixture
) -> None:
    with bus(channel) as mine, bus(channel, rx_queue_size=3) as other:
        for i in range(10):
            mine.send(message(i))
        with caplog.at_level(logging.WARNING):
            assert [got.arbitration_id for got in drain(other)] == [0, 1, 2]
        assert other.counts.lost == 7
        assert mine.counts.sent == 10
        assert mine.counts.lost == 0
    assert caplog.text.count("7 frames lost so far") == 1


def test_threads_hammer_both_ends(channel: str) -> None:
    each, threads = 1500, 3
    with bus(channel) as one, bus(channel) as two, bus(channel) as listener:

        def hammer(end: EbacBus, thread: int) -> None:
            for i in range(each):
                end.send(message(thread, *i.to_bytes(4, "little")))

        got: dict[EbacBus, list[tuple[int, int]]] = {one: [], two: [], listener: []}

        def read(end: EbacBus, count: int) -> None:
            while len(got[end]) < count and (back := end.recv(5)):
                got[end].append((back.arbitration_id, int.from_bytes(back.data, "little")))

        counts = {one: each * threads, two: each * threads, listener: 2 * each * threads}
        work = [threading.Thread(target=read, args=item) for item in counts.items()]
        for i in range(threads):
            work.append(threading.Thread(target=hammer, args=(one, i)))
            work.append(threading.Thread(target=hammer, args=(two, 100 + i)))
        for thread in work:
            thread.start()
        for thread in work:
            thread.join()
        assert got[one] == [item for item in got[listener] if item[0] >= 100]
        assert got[two] == [item for item in got[listener] if item[0] < 100]
        for sender in (0, 1, 2, 100, 101, 102):
            assert [n for who, n in got[listener] if who == sender] == list(range(each))


def test_threads_share_one_end(channel: str) -> None:
    with bus(channel) as mine, bus(channel) as other:
        got: list[int] = []

        def read() -> None:
            while back := other.recv(0.3):
                got.append(back.arbitration_id)

        readers = [threading.Thread(target=read) for _ in range(3)]
        for reader in readers:
            reader.start()
        for i in range(2000):
            mine.send(message(i))
        for reader in readers:
            reader.join()
        assert sorted(got) == list(range(2000))


# --- canopen ---


DICTIONARY = """[DeviceInfo]
ProductName=test
[1018]
ParameterName=Identity
ObjectType=0x9
SubNumber=2
[1018sub0]
ParameterName=Entries
ObjectType=0x7
DataType=0x0005
AccessType=ro
DefaultValue=1
[1018sub1]
ParameterName=Vendor
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=0xAB
[2000]
ParameterName=Note
ObjectType=0x7
DataType=0x0009
AccessType=rw
DefaultValue=ebac
"""


def dictionary() -> Any:
    eds = io.StringIO(DICTIONARY)
    eds.name = "test.eds"
    return canopen.import_od(eds, node_id=2)


@contextmanager
def network(channel: str) -> Iterator[canopen.Network]:
    made = canopen.Network(bus(channel))
    made.notifier = can.Notifier(made.bus, made.listeners, 0.1)
    made.nmt.network = made
    try:
        yield made
    finally:
        made.disconnect()


def test_two_canopen_networks_meet(channel: str) -> None:
    with network(channel) as here, network(channel) as there:
        local = canopen.LocalNode(2, dictionary())
        there.add_node(local)
        remote = canopen.RemoteNode(2, dictionary())
        here.add_node(remote)
        assert remote.sdo["Identity"]["Vendor"].raw == 0xAB
        remote.sdo["Note"].raw = "a text of more than four bytes"
        assert local.sdo["Note"].raw == "a text of more than four bytes"
        assert remote.sdo["Note"].raw == "a text of more than four bytes"
        with pytest.raises(canopen.SdoAbortedError) as aborted:
            remote.sdo.upload(0x3000, 0)
        assert aborted.value.code == 0x06020000
        here.scanner.search(limit=5)
        time.sleep(0.05)
        assert here.scanner.nodes == [2]
        remote.nmt.state = "OPERATIONAL"
        time.sleep(0.05)
        assert local.nmt.state == "OPERATIONAL"


def test_canopen_connects_by_name(channel: str) -> None:
    here = canopen.Network()
    here.connect(interface="ebac", channel=channel, ignore_config=True)
    with bus(channel) as other:
        here.send_message(0x80, b"")
        got = other.recv(1)
        assert got is not None
        assert got.arbitration_id == 0x80
    here.disconnect()


# --- nodes on a channel ---


class Echo:
    """A node that answers 0x600 + n with 0x580 + n, in a thread of its own."""

    def __init__(self, hub: LoopbackHub) -> None:
        self.end = hub.open()
        self.thread = threading.Thread(target=self.work)

    def work(self) -> None:
        while frame := self.end.receive(None):
            if 0x600 < frame.id < 0x680:
                self.end.send(CanFrame(frame.id - 0x80, frame.data))

    def __enter__(self) -> "Echo":
        self.thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.end.close()
        self.thread.join()


def test_nodes_stand_on_the_channel_they_are_for(
    channel: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[Echo] = []

    def build(hub: LoopbackHub) -> Echo:
        made.append(Echo(hub))
        return made[-1]

    monkeypatch.setitem(NODES, channel, build)
    with bus(channel) as first, bus(channel) as second, bus(f"{channel}2") as apart:
        assert len(made) == 2
        first.send(message(0x602, 1))
        for end in (first, second):
            answers = [end.recv(1)] if end is first else [end.recv(1), end.recv(1)]
            assert answers[-1] is not None
            assert answers[-1].arbitration_id == 0x582
        assert apart.recv(0) is None
        assert all(node.thread.is_alive() for node in made)
    assert not any(node.thread.is_alive() for node in made)


def test_the_longest_name_says_what_stands_on_a_channel(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(NODES, "rig", Echo)
    longer: channels.Nodes = lambda hub: Echo(hub)  # noqa: E731
    monkeypatch.setitem(NODES, "rig-two", longer)
    assert channels.nodes_on("rig1") is Echo
    assert channels.nodes_on("rig-two-b") is longer
    assert channels.nodes_on("other") is None


def test_own_nodes_stand_on_the_channel_of_that_name_alone(channel: str) -> None:
    with channels.standing(f"{channel}1", Echo), channels.standing(f"{channel}10", Echo):
        for name in (f"{channel}1", f"{channel}10"):
            with (
                pytest.raises(ValueError, match="has nodes of its own"),
                channels.standing(name, Echo),
            ):
                pass
        assert channels.nodes_on(f"{channel}11") is None
    assert channels.nodes_on(f"{channel}1") is None


def test_nodes_that_cannot_stand_leave_no_channel(
    channel: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def build(hub: LoopbackHub) -> Any:
        raise RuntimeError("no power")

    monkeypatch.setitem(NODES, channel, build)
    with pytest.raises(RuntimeError, match="no power"):
        bus(channel)


# --- programs ---


def test_a_forgotten_channel_ends_with_the_program() -> None:
    code = """
import can, threading
from ebac.can import interface

class Node:
    def __init__(self, hub):
        self.end = hub.open()
        self.thread = threading.Thread(target=self.end.receive, args=(None,), daemon=True)
    def __enter__(self):
        self.thread.start()
    def __exit__(self, *_):
        self.end.close()
        self.thread.join()
        print("taken off")

interface.NODES["x"] = Node
bus = can.Bus(interface="ebac", channel="x")
"""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30)
    assert run.stdout == "taken off\n", run.stderr


def test_a_wait_can_be_interrupted() -> None:
    code = """
import can
with can.Bus(interface="ebac", channel="x") as bus:
    print("waiting", flush=True)
    try:
        bus.recv()
    except KeyboardInterrupt:
        print("interrupted")
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout
        assert run.stdout.readline() == "waiting\n"
        time.sleep(0.1)
        run.send_signal(signal.SIGINT)
        assert run.communicate(timeout=10)[0] == "interrupted\n"


def test_the_logger_of_python_can(tmp_path: Path) -> None:
    assert logged("quiet", tmp_path / "log.asc", seconds=0.1).startswith("date ")


def test_importing_ebac_imports_no_can() -> None:
    code = "import ebac, sys; print([n for n in ('can', 'canopen') if n in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.strip() == "[]"


# --- the bindings beneath ---


@pytest.mark.parametrize(
    ("make", "tells"),
    [
        (lambda: CanFrame(0x800), "CanFrame.id = 2048"),
        (lambda: CanFrame(1, bytes(9)), "0 to 8"),
        (lambda: CanFrame(1, size=9), "CanFrame.size = 9"),
        (lambda: CanFrame(1, size=-1), "CanFrame.size = -1"),
        (lambda: LoopbackHub().open(frames=0), "must lie in"),
        (lambda: LoopbackHub().open().receive(float("nan")), "timeout = nan s"),
    ],
)
def test_bad_input_is_named(make: Callable[[], Any], tells: str) -> None:
    with pytest.raises(ValueError, match=tells):
        make()


def test_any_number_of_seconds_may_be_waited() -> None:
    hub = LoopbackHub()
    mine, other = hub.open(), hub.open()
    for timeout in (0, -1, -1e300, -float("inf"), 1e-12):
        assert other.receive(timeout) is None
    for timeout in (1e-3, 1e300, float("inf"), None):
        mine.send(CanFrame(1))
        assert other.receive(timeout) is not None


def test_socketcan_says_what_is_missing() -> None:
    with pytest.raises(OSError, match="CAN interface 'no-such-if0'") as error:
        _core.SocketCan("no-such-if0")
    assert "modprobe can_raw" in str(error.value) or "no such interface" in str(error.value)
    with pytest.raises(OSError, match="1 to 15 letters"):
        _core.SocketCan("")
