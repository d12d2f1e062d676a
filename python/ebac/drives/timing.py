"""The time that a bus takes, simulated: arbitration, errors, and what comes too late for a loop."""

from __future__ import annotations

import random
from collections import defaultdict, deque
from dataclasses import dataclass
from math import inf

from ebac._core import SimulatedWire, TimedBus
from ebac._util.arguments import nearest_float, whole
from ebac._util.plural import plural
from ebac._util.wrong_calls import plain_constructor
from ebac.drives.network import Network
from ebac.drives.signs_of_life import guards, own_beat, request_period

#: Stations of the wire; the drives come after them.
_LOOP, _OTHERS, _DRIVES = 0, 1, 2
_SYNC = 0x080
#: Heartbeats, and node guarding: of node n with n added.
_SIGNS = 0x700


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class BusTiming:
    """What a simulated bus did to a loop's exchanges.

    Parameters
    ----------
    bitrate : int
        Of the bus [bit/s].
    dt : float
        Sample time of the loop [s].
    answer : float
        How long the loop waits for answers [s].
    ticks : int
        Samples simulated.
    late : int
        Ticks in which an answer came after `answer`, or in the next tick.
    missing : int
        Ticks in which an answer never came: a node is off the bus, or its frame waited for ever.
    mean, worst : float
        From the loop's first frame to the last answer [s], over ticks with all answers.
    errors : int
        Frames that were destroyed and sent again.
    passive, off : tuple of str
        Nodes that were error passive at some time, and nodes that went off the bus.
    load : float
        Share of the bus in use, 0 to 1.
    """

    bitrate: int
    dt: float
    answer: float
    ticks: int
    late: int
    missing: int
    mean: float
    worst: float
    errors: int
    passive: tuple[str, ...]
    off: tuple[str, ...]
    load: float

    @property
    def good(self) -> bool:
        """Whether every answer of every tick came in time."""
        return self.late == self.missing == 0

    def describe(self) -> str:
        """Return it in one sentence."""
        mean, worst, most = (round(1e6 * time) for time in (self.mean, self.worst, self.answer))
        times = f"simulated exchange {mean} us on average, {worst} us at most, of {most} us"
        parts = [times, f"{self.late} of {self.ticks} ticks late, {self.missing} without an answer"]
        if self.errors:
            parts.append(f"{plural(self.errors, 'frame')} destroyed")
        parts += [f"error passive: {', '.join(self.passive)}"] * bool(self.passive)
        parts += [f"bus-off: {', '.join(self.off)}"] * bool(self.off)
        return f"{self.bitrate / 1000:g} kbit/s, load {100 * self.load:.0f} %: {'; '.join(parts)}"


def bus_timing(
    network: Network,
    *,
    dt: float = 1e-3,
    answer_share: float | None = None,
    ticks: int = 1000,
    error_rate: float = 0.0,
    broken: int | None = None,
    seed: int = 0,
) -> BusTiming:
    """Simulate the exchanges of a loop with its drives on a bus that takes its time, and judge them.

    The wire is that of a simulated run on a `TimedBus`; here the data are random, so that stuff bits are.

    In every tick the loop sends its torques and SYNC, and each drive answers with its process data; heartbeats of
    drives and loop, requests of node guarding and the network's other traffic come beside. The lowest identifier that
    waits when the bus is free goes first (a station sends its own frames in their order). A destroyed frame costs an
    error frame and is sent again; its sender counts 8 errors up, and 1 down for each frame that went well: above 127 it
    is error passive and waits 8 bits more, above 255 off the bus.

    Parameters
    ----------
    network : Network
        The drives, with bit rate and other traffic.
    dt : float
        Sample time [s], 1e-4 to 1.
    answer_share : float, optional
        How long the loop waits for answers, as a share of `dt`, 0 to 1; default: 0.7, as `Configuration` has it.
    ticks : int
        How many samples, 1 to 1e6.
    error_rate : float
        Probability that a frame is destroyed, 0 to 1.
    broken : int, optional
        Id of a node whose every frame is destroyed, as by a bad transceiver.
    seed : int
        Of data and errors.

    Raises
    ------
    ValueError
        For a value out of range.
    """
    share = TimedBus().answer_share if answer_share is None else answer_share
    for name, value, low, high in (
        ("dt", dt, 1e-4, 1.0), ("answer_share", share, 0.0, 1.0), ("ticks", ticks, 1, 1e6),
        ("error_rate", error_rate, 0.0, 1.0),
    ):  # fmt: skip
        if not low <= value <= high:
            unit = " s" if name == "dt" else ""
            raise ValueError(
                f"{name} = {nearest_float(value):g}{unit}: must lie in [{low:g}, {high:g}]{unit}"
            )
    seed = whole("seed", seed)
    if not 0 <= seed < 2**64:
        raise ValueError(f"seed = {nearest_float(seed):g}: must lie in [0, 2**64 - 1]")
    ids = [node.id for node in network.nodes]
    if broken is not None and broken not in ids:
        raise ValueError(
            f"broken = {broken!r}: must be the id of a node: {', '.join(map(str, ids))}"
        )
    wire = SimulatedWire(
        stations=_DRIVES + len(network.nodes),
        bit_rate=network.bitrate,
        error_rate=error_rate,
        seed=seed,
    )
    if broken is not None:
        wire.break_station(_DRIVES + ids.index(broken))
    return _Exchanges(network, wire, dt, share * dt, random.Random(seed)).run(ticks)


def _ns(seconds: float) -> int:
    return round(1e9 * seconds)


class _Exchanges:
    """What loop and drives put on the wire, and when it arrives: times in ns."""

    def __init__(
        self,
        network: Network,
        wire: SimulatedWire,
        dt: float,
        wait: float,
        chance: random.Random,
    ) -> None:
        self.network, self.wire, self.dt, self.wait, self.chance = network, wire, dt, wait, chance
        self.names = ["loop", "others", *(f"node {node.id}" for node in network.nodes)]
        self.answers = {0x180 + node.id for node in network.nodes}
        self.asked: dict[tuple[int, int], deque[int]] = defaultdict(
            deque
        )  # station, id: ticks of its frames
        self.came: dict[int, list[int]] = {}
        profiles = [node.profile for node in network.nodes]
        self.guarded = [guard > 0 for guard in guards(profiles)]
        self.beat, self.request = own_beat(profiles), request_period(profiles)
        self.next_beat = self.next_request = 0.0  # s, of the loop
        self.master = int(profiles[0].values["heartbeat.master"]) if profiles else 0

    def run(self, ticks: int) -> BusTiming:
        next_other = [0.0 if other.rate else inf for other in self.network.others]
        next_beat = [0.0] * len(self.network.nodes)
        for tick in range(ticks):
            self._fill(tick, tick * self.dt, next_other, next_beat)
            while (came := self.wire.next(_ns((tick + 1) * self.dt))) is not None:
                self._arrived(*came)
        whole = [times for times in self.came.values() if len(times) == len(self.network.nodes)]
        spans = [max(times) for times in whole]  # ns
        stations = list(enumerate(self.names))
        return BusTiming(
            bitrate=self.network.bitrate,
            dt=self.dt,
            answer=self.wait,
            ticks=ticks,
            late=sum(span > _ns(self.wait) for span in spans),
            missing=ticks - len(whole),
            mean=1e-9 * sum(spans) / len(spans) if spans else 0.0,
            worst=1e-9 * max(spans, default=0),
            errors=self.wire.destroyed,
            passive=tuple(name for i, name in stations if self.wire.was_passive(i)),
            off=tuple(name for i, name in stations if self.wire.off(i)),
            load=min(1.0, 1e-9 * self.wire.busy / (ticks * self.dt)),
        )

    def _fill(
        self, tick: int, start: float, next_other: list[float], next_beat: list[float]
    ) -> None:
        for i, node in enumerate(self.network.nodes):
            for pdo in node.profile.pdos:
                if not pdo.sent:
                    self._put(_LOOP, start, pdo.cob_id(node.id) & 0x7FF, pdo.size, tick)
            if not self.guarded[i] and start >= next_beat[i]:
                next_beat[i] += float(node.profile.values["heartbeat.producer"])
                self._put(_DRIVES + i, start, _SIGNS + node.id, 1, tick)
        self._put(_LOOP, start, _SYNC, 0, tick)
        self._fill_signs(tick, start)
        for i, other in enumerate(self.network.others):
            while next_other[i] < start + self.dt:
                self._put(_OTHERS, next_other[i], 0x7A0 + i, other.size, tick)
                next_other[i] += 1 / other.rate

    def _fill_signs(self, tick: int, start: float) -> None:
        """Send the loop's signs of life once it no longer waits for answers: before SYNC they would delay them."""
        if self.beat and start >= self.next_beat:
            self.next_beat += self.beat
            self._send(_LOOP, start + self.wait, _SIGNS + self.master, b"\x05", tick)
        if self.request and start >= self.next_request:
            self.next_request += self.request
            for node in self.network.nodes:  # a remote frame is as long as one without data
                self._send(_LOOP, start + self.wait, _SIGNS + node.id, b"", tick)

    def _put(self, station: int, when: float, cob_id: int, size: int, tick: int) -> None:
        self._send(station, when, cob_id, self.chance.randbytes(size), tick)

    def _send(self, station: int, when: float, cob_id: int, data: bytes, tick: int) -> None:
        if self.wire.send(station, cob_id, data, _ns(when)):
            self.asked[station, cob_id].append(tick)

    def _arrived(self, station: int, cob_id: int, when: int) -> None:
        tick = self.asked[station, cob_id].popleft()
        if cob_id in self.answers:
            self.came.setdefault(tick, []).append(when - _ns(tick * self.dt))
        if station == _LOOP:
            for i, node in enumerate(self.network.nodes):
                if self.guarded[i] and cob_id == _SIGNS + node.id:
                    due = 1e-9 * when + TimedBus().response
                    self._send(_DRIVES + i, due, cob_id, b"\x05", tick)
        if cob_id != _SYNC:
            return
        for i, node in enumerate(self.network.nodes):
            for pdo in node.profile.pdos:
                if pdo.sent:
                    due = 1e-9 * when + TimedBus().response
                    self._put(_DRIVES + i, due, pdo.cob_id(node.id) & 0x7FF, pdo.size, tick)
