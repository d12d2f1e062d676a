"""SocketCAN from Python, on the virtual interface that EBAC_CAN names: `.ci/socketcan/run` gives one."""

import os
import threading
import time

import can
import pytest

from ebac._core import BusState, CanFrame, SocketCan

INTERFACE = os.environ.get("EBAC_CAN", "")

pytestmark = pytest.mark.skipif(
    not INTERFACE, reason="EBAC_CAN names no virtual CAN interface to test on"
)


def test_python_can_and_ebac_hear_each_other() -> None:
    mine = SocketCan(INTERFACE)
    with can.Bus(interface="socketcan", channel=INTERFACE) as other:
        assert mine.send(CanFrame(0x181, b"\x37\x02"))
        got = other.recv(2)
        assert got is not None
        assert (got.arbitration_id, bytes(got.data)) == (0x181, b"\x37\x02")
        other.send(can.Message(arbitration_id=0x12345678, data=[1, 2, 3]))
        back = mine.receive(2)
        assert back is not None
        assert (back.id, back.data, back.extended) == (0x12345678, b"\1\2\3", True)
        assert abs(1e-9 * back.stamp - time.time()) < 5
    assert (mine.counts.sent, mine.counts.received, mine.counts.lost) == (1, 1, 0)
    mine.close()


def test_filters_and_own_frames() -> None:
    mine = SocketCan(INTERFACE, filters=[(0x580, 0x780, False)], own=True)
    for identifier in (0x80, 0x581, 0x5FF, 0x600):
        assert mine.send(CanFrame(identifier))
    got = [mine.receive(1), mine.receive(1)]
    assert [(frame.id, frame.own) for frame in got if frame] == [(0x581, True), (0x5FF, True)]
    assert mine.receive(0.02) is None


def test_close_ends_a_wait() -> None:
    mine = SocketCan(INTERFACE)
    waiting = threading.Thread(target=mine.receive, args=(None,))
    waiting.start()
    time.sleep(0.05)
    mine.close()
    waiting.join(5)
    assert not waiting.is_alive()
    assert mine.state == BusState.CLOSED
    assert not mine.send(CanFrame(1))
