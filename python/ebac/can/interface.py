"""The python-can interface `ebac`: CAN buses inside this process, one of them with the simulated joystick.

python-can finds it by its name, so canopen, `can.Notifier`, `can.logger` and `can.viewer` can use it::

    import can

    with can.Bus(interface="ebac", channel="joystick") as bus:
        print(bus.recv(timeout=1.0))

A channel is a bus of this process. It is created when it is first opened, and removed when the last bus object on it is
shut down. Bus objects on one channel receive each other's frames, and a C++ loop on the same `ebac._core.LoopbackHub`
receives all of them.
"""

from __future__ import annotations

import atexit
import logging
import time
from collections.abc import Sequence
from threading import current_thread
from typing import Any
from weakref import WeakSet

import can
from can.typechecking import AutoDetectedConfig

from ebac._core import BusCounts, BusState, CanFrame
from ebac._util.arguments import plain
from ebac.can.channels import CHANNELS, LOCK, NODES, join, leave

__all__ = ["DEFAULT_CHANNEL", "DEFAULT_QUEUE", "MOST_FRAMES", "NODES", "EbacBus"]

_LOG = logging.getLogger("can.ebac")

#: The channel that is meant where none is named.
DEFAULT_CHANNEL = "joystick"

#: Frames that wait to be received: about 3 s of a joystick that sends five frames every millisecond.
DEFAULT_QUEUE = 16_384
#: The most there can be.
MOST_FRAMES = 1_048_576


#: Those that nobody has shut down yet.
_OPEN: WeakSet[EbacBus] = WeakSet()


class EbacBus(can.BusABC):
    """One end of a CAN bus inside this process; `can.Bus(interface="ebac", channel=...)` opens it.

    Classical CAN only. Any thread may send and receive.

    Parameters
    ----------
    channel : str
        Name of the bus. A bus whose name starts with "joystick" contains simulated drives.
    receive_own_messages : bool
        Whether this end also receives the frames that it sent, with `is_rx` false.
    rx_queue_size : int
        Length of the receive queue [frames], 1 to 1,048,576. Frames that arrive when it is full are lost for this end
        only, counted in `counts.lost` and reported by the logger `can.ebac`.
    can_filters : list of dict, optional
        As for `can.BusABC.set_filters`.
    **kwargs
        Options of other interfaces, such as `bitrate`, have no effect.

    Raises
    ------
    ValueError
        When the length of the queue is out of range, or CAN FD is requested.
    """

    def __init__(
        self,
        channel: Any = DEFAULT_CHANNEL,
        can_filters: Any = None,
        *,
        receive_own_messages: bool = False,
        rx_queue_size: int = DEFAULT_QUEUE,
        **kwargs: Any,
    ) -> None:
        _refuse_fd(kwargs)
        name = str(channel)
        self._longest = _checked_queue(rx_queue_size)
        self._end = join(name, self._longest, receive_own_messages)
        self.channel = name
        self.channel_info = f"ebac channel '{name}'"
        self._tasks: WeakSet[Any] = WeakSet()
        self._warned_of = 0
        super().__init__(channel=name, can_filters=can_filters, **kwargs)
        _OPEN.add(self)

    @property
    def counts(self) -> BusCounts:
        """Numbers of frames sent, refused, received and lost by this end."""
        return self._end.counts

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a message to all others on the channel.

        As on a real bus it is accepted at once, whether or not anyone receives it. It may have to wait only if another
        sending thread is held up.

        Parameters
        ----------
        msg : can.Message
            A classical frame with an 11-bit or 29-bit identifier and up to 8 bytes.
        timeout : float, optional
            How long to try [s]; None for no limit.

        Raises
        ------
        can.CanOperationError
            When the bus is shut down or did not accept the message in time.
        ValueError
            When the message does not fit a classical frame.
        """
        if msg.is_fd:
            raise ValueError(f"{msg}: a message of CAN FD, but this bus is classical; is_fd=False")
        frame = CanFrame(
            msg.arbitration_id,
            bytes(msg.data),
            extended=msg.is_extended_id,
            remote=msg.is_remote_frame,
            error=msg.is_error_frame,
            size=msg.dlc,
        )
        start = time.monotonic()
        while not self._end.send(frame):
            if self._end.state == BusState.CLOSED:
                if any(task.thread is current_thread() for task in self._tasks):
                    return  # a periodic task that was stopped in the middle of its last turn
                raise can.CanOperationError(_closed(self.channel_info))
            if timeout is not None and time.monotonic() - start >= timeout:
                raise can.CanOperationError(f"{self.channel_info}: not taken within {timeout:g} s")
            time.sleep(1e-4)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        """Filter here, so that `recv(0)` finds what stands behind a message for somebody else.

        Once the time is over, what waits is looked through, and nothing that comes later.
        """
        start = time.monotonic()
        left, looked = timeout, 0
        over: int | None = None  # when the time was over [ns since 1970]
        while (frame := self._end.receive(left)) is not None:
            message = self._message(frame)
            if self._matches_filters(message):
                return message, True
            if timeout is not None:
                left = max(0.0, timeout - (time.monotonic() - start))
            if left == 0:
                over = time.time_ns() if over is None else over
                looked += 1  # a clock that was set back must not prolong it
                if frame.stamp > over or looked > self._longest:
                    break
        if self._end.state == BusState.CLOSED:
            raise can.CanOperationError(_closed(self.channel_info))
        return None, True

    def _message(self, frame: CanFrame) -> can.Message:
        lost = self._end.counts.lost
        if lost > self._warned_of:
            self._warn_lost(lost)
        return can.Message(
            timestamp=1e-9 * frame.stamp,
            arbitration_id=frame.id,
            is_extended_id=frame.extended,
            is_remote_frame=frame.remote,
            is_error_frame=frame.error,
            channel=self.channel,
            dlc=frame.size,
            data=frame.data,
            is_rx=not frame.own,
        )

    def _warn_lost(self, lost: int) -> None:
        """Warn of lost frames, the next time when they are twice as many."""
        self._warned_of = 2 * lost
        _LOG.warning(
            "%s: %d frames lost so far, as they came faster than they were received; read them in a thread of "
            "its own (can.Notifier) or give a larger rx_queue_size",
            self.channel_info,
            lost,
        )

    def _send_periodic_internal(self, *args: Any, **kwargs: Any) -> Any:
        task = super()._send_periodic_internal(*args, **kwargs)
        self._tasks.add(task)
        return task

    def flush_tx_buffer(self) -> None:
        """Do nothing: frames are sent at once."""

    def shutdown(self) -> None:
        """Leave the channel. A thread that waits in `recv` gets `can.CanOperationError`."""
        super().shutdown()
        with LOCK:
            if self._end.state == BusState.CLOSED:
                return
            self._end.close()
        leave(self.channel)

    @staticmethod
    def _detect_available_configs() -> Sequence[AutoDetectedConfig]:
        with LOCK:
            names = sorted({*CHANNELS, DEFAULT_CHANNEL})
        return [{"interface": "ebac", "channel": name} for name in names]


def _checked_queue(given: object) -> int:
    frames = plain(given)
    if isinstance(frames, bool) or not isinstance(frames, int) or not 1 <= frames <= MOST_FRAMES:
        raise ValueError(
            f"rx_queue_size = {frames}: must be a whole number in [1, {MOST_FRAMES}] frames"
        )
    return frames


def _refuse_fd(options: dict[str, Any]) -> None:
    protocol = options.get("protocol", can.CanProtocol.CAN_20)
    if options.get("fd") or protocol != can.CanProtocol.CAN_20:
        raise ValueError("CAN FD is asked for, but the interface 'ebac' is classical; leave fd out")


def _closed(info: str) -> str:
    return f"{info}: the bus is shut down; open it anew with can.Bus(interface='ebac')"


@atexit.register
def _let_go() -> None:
    """Let a program end with buses open: nothing more is sent, and what waits to receive waits on in silence."""
    for bus in list(_OPEN):
        can.BusABC.shutdown(bus)
