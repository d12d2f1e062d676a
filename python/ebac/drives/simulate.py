"""Simulated drives on a bus in real time: frames in, time passes, frames out.

On SocketCAN and on the interface `ebac` a thread of the C++ core does it (`ebac._core.SocketCanJoystick`,
`LoopbackJoystick`); on any other interface of python-can a thread of Python does, some 0.1 ms slower an answer.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from types import TracebackType
from typing import TYPE_CHECKING, Protocol, Self

from ebac._util.arguments import unknown
from ebac.drives.bus import READ_DEVICE_TYPE
from ebac.drives.bus_monitor import BusMonitor
from ebac.drives.errors import BusError, DriveError
from ebac.drives.objects import Object

if TYPE_CHECKING:
    import can

    from ebac.drives.drive import Drive

#: Conditions of a simulated drive by name: bits of its objects 0x5F00 and, from 256 on, 0x5F01.
CONDITIONS = {
    "over-voltage": 1,
    "encoder-lost": 2,
    "over-temperature": 4,
    "silent": 8,
    "under-voltage": 16,
    "motor-temperature": 32,
    "short-circuit": 64,
    "torque-off": 128,
    "enable-missing": 256,
    "brake-stuck": 512,
}
#: Product code of a simulated drive with a dictionary of its own (0x1018:2).
_SIMULATED = 0x65626163

#: Longest wait for a frame [s]: heartbeats and timers of the drives are this late at most.
_WAIT = 1e-3
#: How long to listen for drives that are there already [s]: two of their heartbeats.
_LISTEN = 0.25
_FAILED = "{}: the bus failed ({}); is the interface still up?"


def inject(drive: Drive, names: Sequence[str]) -> None:
    """Put a simulated drive into conditions, over the bus, and out of all others.

    Parameters
    ----------
    drive : Drive
        Which.
    names : sequence of str
        Of `CONDITIONS`; none ends them all. A silent drive hears nothing, not even that it is over.

    Raises
    ------
    ValueError
        For a name that is none.
    DriveError
        When the drive is not a simulated one with its own dictionary.
    """
    for name in names:
        if name not in CONDITIONS:
            raise ValueError(unknown(f"fault {name}", name, list(CONDITIONS)))
    if drive.look("product_code") != _SIMULATED:  # the vendor may be that of its profile
        raise DriveError(
            f"node {drive.node} is no simulated drive with its own dictionary: faults are injected only there",
            node=drive.node,
        )
    bits = sum({CONDITIONS[name] for name in names})
    for sub, part in ((0x5F01, bits >> 8), (0x5F00, bits & 0xFF)):
        drive.sdo.download(Object(name="conditions", index=sub, kind="u8"), bytes([part]))


def refuse_taken(bus: can.BusABC, name: str, nodes: Sequence[int]) -> None:
    """Look whether somebody on a bus has one of these node ids already.

    Parameters
    ----------
    bus : can.BusABC
        An open bus of python-can. Each id is asked for its device type (0x1000); nothing is written.
    name : str
        Of the bus, for messages.
    nodes : sequence of int
        Ids that are to be free.

    Raises
    ------
    BusError
        When a node with one of these ids answers or sends a heartbeat, and when the bus fails.
    """
    import can

    for node in nodes:
        request = can.Message(
            arbitration_id=0x600 + node, data=READ_DEVICE_TYPE, is_extended_id=False
        )
        with suppress(can.CanError, OSError):  # nobody acknowledges: nobody is there
            bus.send(request)
    monitor = BusMonitor()
    end = time.monotonic() + _LISTEN
    while (left := end - time.monotonic()) > 0:
        try:
            message = bus.recv(left)
        except (can.CanError, OSError) as error:
            raise BusError(_FAILED.format(name, error)) from error
        if message is not None:
            monitor(message)
    if found := sorted(set(monitor.nodes(asked=True)) & set(nodes)):
        ids = ", ".join(map(str, found))
        raise BusError(
            f"{name}: there are drives with these node ids already: {ids}; end the other "
            "`ebac drive simulate`, or give another channel"
        )


class SimulatedNodes(Protocol):
    """What is on the bus: `ebac._core.Joystick`, or one `SimulatedDrive`."""

    def receive(self, id: int, data: bytes = b"", *, remote: bool = False) -> None:  # noqa: A002
        """Take one frame of the bus."""

    def elapse(self, seconds: float) -> None:
        """Let time pass [s]."""

    def take(self) -> list[tuple[int, bytes]]:
        """Give every frame on its way out: identifier, data."""


@dataclass(kw_only=True)
class Counts:
    """Frames, counted here because python-can does not."""

    sent: int = 0
    refused: int = 0
    received: int = 0
    lost: int = 0


class Simulation:
    """Simulated nodes at work on a bus, in a thread of their own. A context manager.

    Parameters
    ----------
    bus : can.BusABC
        An open bus of python-can. It stays open.
    nodes : SimulatedNodes
        Who is on it. Nobody else may touch them meanwhile.

    Attributes
    ----------
    counts : Counts
        Frames taken from the bus, put on it, and refused by it.
    """

    def __init__(self, bus: can.BusABC, nodes: SimulatedNodes) -> None:
        self.bus = bus
        self.counts = Counts()
        self._nodes = nodes
        self._over = threading.Event()
        self._failure: Exception | None = None
        self._thread = threading.Thread(target=self._work, name="simulated drives", daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._over.set()
        self._thread.join()

    def check(self) -> None:
        """Look whether the nodes are still at work.

        Raises
        ------
        BusError
            When the bus has failed.
        """
        if self._failure is not None:
            raise BusError(_FAILED.format(self.bus.channel_info, self._failure)) from self._failure

    def _work(self) -> None:
        last = time.monotonic()
        try:
            while not self._over.is_set():
                message = self.bus.recv(_WAIT)
                now = time.monotonic()
                self._nodes.elapse(now - last)
                last = now
                if message is not None and not (message.is_error_frame or message.is_extended_id):
                    self.counts.received += 1
                    data = b"" if message.is_remote_frame else bytes(message.data)
                    self._nodes.receive(
                        message.arbitration_id, data, remote=message.is_remote_frame
                    )
                self._send()
        except Exception as error:  # raised by `check`, in the thread that asks
            self._failure = error
            self._over.set()

    def _send(self) -> None:
        import can

        for cob, data in self._nodes.take():
            message = can.Message(arbitration_id=cob, data=data, is_extended_id=False)
            try:
                self.bus.send(message)
                self.counts.sent += 1
            except can.CanOperationError:  # its queue is full, or nobody acknowledges
                self.counts.refused += 1
