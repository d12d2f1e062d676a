"""The time that a bus takes, simulated: arbitration, errors, and what comes too late for a loop."""

from __future__ import annotations

import random
from collections import deque
from dataclasses import dataclass, field

from ebac._util.wrong_calls import plain_constructor
from ebac.drives.frame_length import exact_bits
from ebac.drives.network import Network

#: Bits of an error frame with its delimiter and interframe space, and what an error-passive node waits beside [bit].
_ERROR_FRAME, _SUSPEND = 6 + 6 + 8 + 3, 8
#: Counts of errors above which a node is passive, and off the bus (ISO 11898-1).
_PASSIVE, _OFF = 127, 255
#: What a drive takes to answer a SYNC [s].
_ANSWER = 50e-6


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
        times = f"exchange {mean} us on average, {worst} us at worst, of {most} us"
        parts = [times, f"{self.late} of {self.ticks} ticks late, {self.missing} without an answer"]
        if self.errors:
            parts.append(f"{self.errors} frames destroyed")
        parts += [f"error passive: {', '.join(self.passive)}"] * bool(self.passive)
        parts += [f"bus-off: {', '.join(self.off)}"] * bool(self.off)
        return f"{self.bitrate / 1000:g} kbit/s, load {100 * self.load:.0f} %: {'; '.join(parts)}"


@dataclass(kw_only=True)
class _Station:
    """A controller: frames in the order they were given to it, and its error counter."""

    name: str
    queue: deque[tuple[float, int, bytes, int]] = field(
        default_factory=deque
    )  # when, id, data, tick
    errors: int = 0

    @property
    def off(self) -> bool:
        return self.errors > _OFF

    @property
    def passive(self) -> bool:
        return self.errors > _PASSIVE


def bus_timing(
    network: Network,
    *,
    dt: float = 1e-3,
    answer: float | None = None,
    ticks: int = 1000,
    error_rate: float = 0.0,
    broken: int | None = None,
    seed: int = 0,
) -> BusTiming:
    """Simulate the exchanges of a loop with its drives on a bus that takes its time, and judge them.

    In every tick the loop sends its torques and SYNC, and each drive answers with its process data; heartbeats and
    the network's other traffic come beside. The lowest identifier that waits when the bus is free goes first (a station
    sends its own frames in their order). A destroyed frame costs an error frame and is sent again; its sender counts 8
    errors up, and 1 down for each frame that went well: above 127 it is error passive and waits 8 bits more, above 255
    off the bus. Data are random, so that stuff bits are.

    Parameters
    ----------
    network : Network
        The drives, with bit rate and other traffic.
    dt : float
        Sample time [s], 1e-4 to 1.
    answer : float, optional
        How long the loop waits for answers [s]; default: 0.5 of `dt`, as `Configuration` has it.
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
    wait = 0.5 * dt if answer is None else answer
    for name, value, low, high in (
        ("dt", dt, 1e-4, 1.0), ("answer", wait, 0.0, dt), ("ticks", ticks, 1, 1e6),
        ("error_rate", error_rate, 0.0, 1.0),
    ):  # fmt: skip
        if not low <= value <= high:
            raise ValueError(f"{name} = {value:g}: must lie in [{low:g}, {high:g}]")
    return _Bus(network, dt, wait, error_rate, broken, random.Random(seed)).run(ticks)


class _Bus:
    """The bus in virtual time [s]."""

    def __init__(
        self,
        network: Network,
        dt: float,
        wait: float,
        rate: float,
        broken: int | None,
        chance: random.Random,
    ) -> None:
        self.network, self.dt, self.wait, self.rate, self.chance = network, dt, wait, rate, chance
        self.bit = 1 / network.bitrate
        self.loop = _Station(name="loop")
        self.drives = {node.id: _Station(name=f"node {node.id}") for node in network.nodes}
        self.others = _Station(name="others")
        self.stations = [self.loop, *self.drives.values(), self.others]
        self.broken = self.drives.get(broken or 0)
        self.now = self.busy = 0.0
        self.errors = 0
        self.passive: dict[str, None] = {}
        self.came: dict[int, list[float]] = {}

    def run(self, ticks: int) -> BusTiming:
        next_other = [0.0] * len(self.network.others)
        next_beat = dict.fromkeys(self.drives, 0.0)
        for tick in range(ticks):
            start = tick * self.dt
            self._fill(tick, start, next_other, next_beat)
            self._until(start + self.dt)
        whole = [times for times in self.came.values() if len(times) == len(self.drives)]
        spans = [max(times) for times in whole]
        return BusTiming(
            bitrate=self.network.bitrate,
            dt=self.dt,
            answer=self.wait,
            ticks=ticks,
            late=sum(span > self.wait for span in spans),
            missing=ticks - len(whole),
            mean=sum(spans) / len(spans) if spans else 0.0,
            worst=max(spans, default=0.0),
            errors=self.errors,
            passive=tuple(self.passive),
            off=tuple(one.name for one in self.stations if one.off),
            load=self.busy / max(self.now, ticks * self.dt),
        )

    def _fill(
        self, tick: int, start: float, next_other: list[float], next_beat: dict[int, float]
    ) -> None:
        for node in self.network.nodes:
            for pdo in node.profile.pdos:
                if not pdo.sent:
                    self._put(self.loop, start, pdo.cob_id(node.id) & 0x7FF, pdo.size, tick)
            if start >= next_beat[node.id]:
                next_beat[node.id] += float(node.profile.values["heartbeat.producer"])
                self._put(self.drives[node.id], start, 0x700 + node.id, 1, -1)
        self._put(self.loop, start, 0x080, 0, tick)
        for i, other in enumerate(self.network.others):
            while next_other[i] < start + self.dt:
                self._put(self.others, next_other[i], 0x7A0 + i, other.size, -1)
                next_other[i] += 1 / other.rate

    def _put(self, station: _Station, when: float, cob_id: int, size: int, tick: int) -> None:
        if not station.off and len(station.queue) < 64:
            station.queue.append((when, cob_id, self.chance.randbytes(size), tick))

    def _until(self, end: float) -> None:
        while self.now < end:
            ready = [
                one
                for one in self.stations
                if one.queue and not one.off and one.queue[0][0] <= self.now
            ]
            if not ready:
                waiting = [one.queue[0][0] for one in self.stations if one.queue and not one.off]
                self.now = min([*waiting, end])
                continue
            self._send(min(ready, key=lambda one: one.queue[0][1]))

    def _send(self, station: _Station) -> None:
        _, cob_id, data, tick = station.queue[0]
        bits = exact_bits(cob_id, data) + (_SUSPEND if station.passive else 0)
        if station is self.broken or (self.rate and self.chance.random() < self.rate):
            bits = self.chance.randrange(20, bits) + _ERROR_FRAME
            self.errors += 1
            station.errors += 8
            if station.passive:
                self.passive[station.name] = None
            if station.off:
                station.queue.clear()
        else:
            station.queue.popleft()
            station.errors = max(0, station.errors - 1)
            self._arrived(cob_id, tick, self.now + bits * self.bit)
        self.now += bits * self.bit
        self.busy += bits * self.bit

    def _arrived(self, cob_id: int, tick: int, when: float) -> None:
        if cob_id == 0x080:
            for node in self.network.nodes:
                for pdo in node.profile.pdos:
                    if pdo.sent:
                        self._put(
                            self.drives[node.id],
                            when + _ANSWER,
                            pdo.cob_id(node.id) & 0x7FF,
                            pdo.size,
                            tick,
                        )
            return
        for node in self.network.nodes:
            if tick >= 0 and cob_id == 0x180 + node.id:
                self.came.setdefault(tick, []).append(when - tick * self.dt)
