"""SDO with one node: one request at a time, typed errors, late answers never taken for new ones."""

from __future__ import annotations

import struct
import threading
import time
from typing import TYPE_CHECKING

from ebac.drives.errors import BusError, NoAnswer, Refused, WrongAnswer
from ebac.drives.objects import Object

if TYPE_CHECKING:
    from canopen.sdo.client import SdoClient

    from ebac.drives.bus_monitor import BusMonitor


class Sdo:
    """The SDO channel of one node. Threads may share it.

    Parameters
    ----------
    client : canopen.sdo.SdoClient
        Of the remote node.
    node : int
        Node id, 1 to 127.
    monitor : BusMonitor
        Monitor of the bus traffic.
    timeout : float
        How long an answer may take [s].
    """

    def __init__(self, client: SdoClient, node: int, monitor: BusMonitor, timeout: float) -> None:
        self._client = client
        self._node = node
        self._monitor = monitor
        self._lock = threading.RLock()
        self._answered = False  # the last request, with all that belongs to it
        self._quiet_until = 0.0  # s, time.monotonic(): until then a late answer may come
        self.timeout = timeout

    @property
    def timeout(self) -> float:
        """How long an answer may take [s]."""
        return float(self._client.RESPONSE_TIMEOUT)

    @timeout.setter
    def timeout(self, seconds: float) -> None:
        if not 0.001 <= seconds <= 60:
            raise ValueError(f"timeout = {seconds} s: must lie in [0.001, 60] s")
        self._client.RESPONSE_TIMEOUT = seconds

    def upload(self, obj: Object) -> bytes:
        """Read the bytes of an object; a read is asked once more before it fails.

        Raises
        ------
        NoAnswer, Refused, WrongAnswer, BusError
        """
        with self._lock:
            start = time.monotonic()
            try:
                return self._upload(obj, start)
            except (NoAnswer, WrongAnswer):
                return self._upload(obj, start)

    def download(self, obj: Object, data: bytes) -> None:
        """Write the bytes of an object, once.

        Raises
        ------
        NoAnswer, Refused, WrongAnswer, BusError
        """
        with self._lock:
            self._ask(f"writing {obj}", obj, data, time.monotonic())

    def _upload(self, obj: Object, start: float) -> bytes:
        data = self._ask(f"reading {obj}", obj, None, start)
        if not data:
            raise WrongAnswer(f"node {self._node} sent no data for {obj}", node=self._node)
        return data

    def _ask(self, doing: str, obj: Object, data: bytes | None, start: float) -> bytes:
        import can
        from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

        time.sleep(max(0.0, self._quiet_until - time.monotonic()))
        if self._answered and not self._client.responses.empty():
            self._monitor.answered_twice(self._node)
        self._answered = False
        try:
            if data is None:
                data = bytes(self._client.upload(obj.index, obj.sub))
            else:
                self._client.download(obj.index, obj.sub, data)
                data = b""
            self._answered = True
            return data
        except SdoAbortedError as error:
            verb = "reading" if data is None else "writing"
            raise Refused(self._node, obj, verb, error.code) from None
        except SdoCommunicationError as error:
            self._monitor.check_receiving(f"node {self._node}, {doing}")
            self._quiet_until = time.monotonic() + self.timeout
            if "No SDO response" not in str(error):
                raise WrongAnswer(
                    f"node {self._node}, {doing}: {error}; is another program talking to it by SDO?",
                    node=self._node,
                ) from None
            raise NoAnswer(
                self._node,
                doing,
                time.monotonic() - start,
                traffic=self._monitor.describe(start),
                check=self._monitor.advice(self._node, start),
            ) from None
        except (struct.error, IndexError, ValueError) as error:
            raise WrongAnswer(
                f"node {self._node}, {doing}: an answer that is none, too short or of another form ({error}); do two "
                "nodes have this id, or is its firmware no CANopen?",
                node=self._node,
            ) from None
        except RuntimeError as error:  # as canopen has it
            raise BusError(
                f"node {self._node}, {doing}: the bus is closed; open it anew", node=self._node
            ) from error
        except (can.CanError, OSError) as error:
            self._monitor.check_receiving(f"node {self._node}, {doing}")
            raise BusError(
                f"node {self._node}, {doing}: the bus took no frame ({error}); is the interface up, "
                "is a second node on the bus to acknowledge, is the bus terminated?",
                node=self._node,
            ) from error
