"""Bus monitor: heartbeats, emergencies, and other nodes on the bus."""

from __future__ import annotations

import threading
import time
from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ebac.drives import faults
from ebac.drives.errors import BusError

if TYPE_CHECKING:
    import can

#: What `describe` says of a bus on which no frame came.
NO_FRAME = "nothing at all"
#: NMT states in a heartbeat (CiA 301).
NMT_STATES = {0x00: "boot-up", 0x04: "stopped", 0x05: "operational", 0x7F: "pre-operational"}
#: Frames remembered, and emergencies of each node.
_FRAMES, _EMERGENCIES = 4096, 32


@dataclass(frozen=True, kw_only=True)
class Emergency:
    """An emergency frame, 0x80 + node (CiA 301)."""

    node: int
    code: int
    register: int
    data: bytes
    at: float  # s, time.monotonic()

    def __str__(self) -> str:
        vendor = f", vendor bytes {self.data.hex()}" if any(self.data) else ""
        return f"0x{self.code:04X} {faults.emergency(self.code)}{vendor}"


class BusMonitor:
    """A listener on the bus that remembers the last frames and all emergencies of late."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._frames: deque[tuple[float, int]] = deque(maxlen=_FRAMES)
        self._nmt: dict[int, tuple[float, int]] = {}
        self.broken: Exception | None = None  #: why nothing can be received any more
        self._errors = 0
        self._boots: Counter[int] = Counter()
        self._twice: Counter[int] = Counter()
        self._emergencies: dict[int, deque[Emergency]] = {}

    def __call__(self, message: can.Message) -> None:
        """Take one frame from the bus."""
        if message.is_error_frame:
            self._errors += 1
        if message.is_error_frame or message.is_remote_frame or message.is_extended_id:
            return
        now, cob, data = time.monotonic(), message.arbitration_id, bytes(message.data)
        if cob & 0x780 == 0x600:
            return  # a request by SDO: no drive sends one, and some buses bring back our own
        node = cob & 0x7F
        with self._lock:
            self._frames.append((now, cob))
            if cob & 0x780 == 0x700 and node and data:
                self._nmt[node] = (now, data[0] & 0x7F)
                self._boots[node] += data[0] == 0
            elif cob & 0x780 == 0x080 and node and len(data) >= 3:
                kept = self._emergencies.setdefault(node, deque(maxlen=_EMERGENCIES))
                code = int.from_bytes(data[:2], "little")
                kept.append(
                    Emergency(node=node, code=code, register=data[2], data=data[3:], at=now)
                )

    def emergencies(self, node: int) -> list[Emergency]:
        """Return the emergencies of a node, oldest first; from the last "error reset" on."""
        with self._lock:
            found = list(self._emergencies.get(node, ()))
        resets = [i for i, one in enumerate(found) if one.code & 0xFF00 == 0]
        return found[resets[-1] + 1 :] if resets else found

    def answered_twice(self, node: int) -> None:
        """Note that a node sent a second answer to a request."""
        with self._lock:
            self._twice[node] += 1

    def troubles(self) -> list[str]:
        """Return in words what is wrong with the bus itself: error frames, restarts, a node id that two nodes have."""
        with self._lock:
            found = [f"{self._errors} error frames"] if self._errors else []
            found += [f"node {node} restarted {n} times" for node, n in self._boots.items() if n]
            found += [
                f"node {node} answered {n} requests twice: two nodes have this id, or another program talks to it"
                for node, n in self._twice.items()
                if n
            ]
        return found

    def nmt(self, node: int) -> str | None:
        """Return the NMT state in the last heartbeat of a node, None when none was received."""
        with self._lock:
            found = self._nmt.get(node)
        return None if found is None else NMT_STATES.get(found[1], f"unknown 0x{found[1]:02X}")

    def on_error(self, error: Exception) -> None:
        """Note that nothing more can be received; python-can calls this in its thread."""
        self.broken = error

    def check_receiving(self, doing: str) -> None:
        """Raise BusError where the interface stopped receiving."""
        if self.broken is not None:
            raise BusError(
                f"{doing}: the interface has stopped ({self.broken}); is it down, or unplugged? Bring it up: `sudo ip "
                "link set can0 up type can bitrate 1000000` (with your interface), then open it anew"
            ) from self.broken

    def nodes(self, *, asked: bool = False) -> list[int]:
        """Return the nodes seen on the bus: by heartbeat, SDO answer, PDO or emergency.

        With `asked`, by heartbeat and SDO answer alone: only these are sure to be a node's. A sensor may send on any
        other identifier.
        """
        with self._lock:
            cobs = {cob for _, cob in self._frames} | {0x700 + node for node in self._nmt}
        services = (0x580, 0x700) if asked else (0x080, 0x180, 0x280, 0x380, 0x480, 0x580, 0x700)
        return sorted({cob & 0x7F for cob in cobs if cob & 0x780 in services and cob & 0x7F})

    def commanding(self, nodes: Sequence[int], start: float) -> list[str]:
        """Return in words who else sent what only the master of these nodes may send, since `start` [s, monotonic]."""
        ids = {0x080: "SYNC", **{0x200 + node: f"torques to node {node}" for node in nodes}}
        count = self.since(start)
        return [
            f"{what} (0x{cob:03X}, {count[cob]} times)" for cob, what in ids.items() if count[cob]
        ]

    def since(self, start: float) -> Counter[int]:
        """Return how many frames of each identifier came since `start` [s, monotonic]."""
        with self._lock:
            return Counter(cob for at, cob in self._frames if at >= start)

    def describe(self, start: float) -> str:
        """Return in words what came since `start` [s, monotonic]."""
        count = self.since(start)
        beats = sorted(cob & 0x7F for cob in count if cob & 0x780 == 0x700)
        alarms = sorted(cob & 0x7F for cob in count if cob & 0x780 == 0x080 and cob & 0x7F)
        parts = [f"heartbeat of node {node} ({self.nmt(node)})" for node in beats]
        parts += [
            f"emergency of node {node} ({'; '.join(str(e) for e in self.emergencies(node)[-3:])})"
            for node in alarms
        ]
        expected = {0x700 + node for node in beats} | {0x080 + node for node in alarms}
        others = sorted(set(count) - expected)
        parts += [f"0x{cob:03X} ({count[cob]} times)" for cob in others[:8]]
        if len(others) > 8:
            parts.append(f"{len(others) - 8} more identifiers")
        parts += self.troubles()
        if parts:
            return ", ".join(parts)
        before = self.nodes()
        names = f"node{'s' if len(before) > 1 else ''} {', '.join(str(node) for node in before)}"
        return f"nothing; before that {names}" if before else NO_FRAME

    def advice(self, node: int, start: float) -> list[str]:
        """Return what to check when `node` did not answer since `start` [s, monotonic]."""
        count = self.since(start)
        if any(cob & 0x7F == node and cob & 0x780 in (0x700, 0x180, 0x080) for cob in count):
            state = self.nmt(node)
            if state == "stopped":
                return [f"node {node} is stopped and answers no SDO: NMT pre-operational wakes it"]
            return [
                f"node {node} is alive but answers no SDO: is another program talking to it by SDO?",
                "is the bus overloaded (`ebac drive plan` prints the load)?",
            ]
        there = self.nodes()
        if node in there:
            return [
                f"node {node} was there before: has it lost power, or its cable, or been reset?",
                "is another program talking to it by SDO?",
            ]
        if count or there:
            others = f" (on the bus: {', '.join(str(n) for n in there)})" if there else ""
            return [
                f"the node id: `ebac drive scan` lists who answers{others}",
                f"power of drive {node}, and its own bit rate",
                "its CAN connector",
            ]
        return [
            "the bit rate of interface and drives",
            "termination: 120 ohm at both ends, 60 ohm measured between CAN-H and CAN-L, power off",
            "power of the drives",
            "the node id (`ebac drive scan` asks all 127)",
            "that the interface is up (`ip -details link show can0`) and the cable is in",
        ]
