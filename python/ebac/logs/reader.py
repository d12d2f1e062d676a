"""Reads logs: whole, cut by a kill, damaged or repaired."""

from __future__ import annotations

import mmap
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.logs.about import SCENARIO_FILE, About
from ebac.logs.events import Event
from ebac.logs.layout import Layout
from ebac.logs.records import (
    ATTACHMENT,
    CHANNEL,
    CHUNK,
    MAGIC,
    METADATA,
    Condition,
    parsed,
    records,
    unpacked,
)
from ebac.logs.writer import EVENTS_TOPIC, ROWS_TOPIC
from ebac.scenario import Scenario
from ebac.trace import Trace

#: Bytes of rows gathered before they become columns: what a long log takes beside its columns.
_BATCH = 64 << 20


@dataclass(frozen=True, kw_only=True)
class Gap:
    """Ticks that are not in a log.

    Attributes
    ----------
    after_tick : int
        Number of the last row before it.
    t : float
        Time of that row [s].
    rows : int
        Rows missing; 0 or less where the number of the tick stands still or goes back.
    """

    after_tick: int
    t: float
    rows: int


@dataclass(frozen=True, kw_only=True)
class Log:
    """What a log holds.

    Attributes
    ----------
    path : Path
        The file.
    trace : Trace
        Its rows, with law and scenario.
    events : list of Event
        Parameter changes, faults, rows lost.
    about : About
        Law, scenario, versions, machine, attachments.
    condition : Condition
        Whether the file is complete, and what is wrong with it.
    ended : dict
        What was known at the end: rows written, rows lost; empty for a log that was cut.
    bytes : int
        Size of the file.
    """

    path: Path
    trace: Trace
    events: list[Event]
    about: About
    condition: Condition
    ended: dict[str, str]
    bytes: int

    @property
    def lost(self) -> int:
        """Rows missing between the first row and the last."""
        return sum(max(0, gap.rows) for gap in self.gaps)

    @property
    def gaps(self) -> list[Gap]:
        """Where rows are missing between two rows of the log."""
        tick, t = self.trace["tick"], self.trace["t"]
        steps = np.diff(tick)
        return [
            Gap(after_tick=int(tick[i]), t=float(t[i]), rows=int(steps[i]) - 1)
            for i in np.flatnonzero(steps != 1)
        ]

    @property
    def faults(self) -> list[tuple[int, float, int]]:
        """Number of the fault, time [s] and tick of each row in which one appears or changes."""
        fault = self.trace["fault"] if "fault" in self.trace else np.zeros(len(self.trace))
        new = np.flatnonzero((fault != 0) & (np.diff(fault, prepend=0) != 0))
        tick, t = self.trace["tick"], self.trace["t"]
        return [(int(fault[i]), float(t[i]), int(tick[i])) for i in new]


@dataclass
class _Found:
    """What the records of a file have told so far."""

    layout: Layout | None = None
    rows: int | None = None  # number of the channel
    events_channel: int | None = None
    columns: list[dict[str, NDArray[Any]]] = field(default_factory=list)
    runs: list[bytes] = field(default_factory=list)
    waiting: int = 0  # bytes in runs
    events: list[Event] = field(default_factory=list)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)

    def gather(self) -> None:
        if self.layout is not None and (self.runs or not self.columns):
            self.columns.append(self.layout.gather(self.runs))
        self.runs, self.waiting = [], 0


def read(path: str | Path, *, progress: Callable[[int, int], None] | None = None) -> Log:
    """Read a log, whatever state it is in.

    What is whole is read: a log whose writer was killed loses at most its last chunk, a damaged chunk is left out and
    counted in `condition`.

    Parameters
    ----------
    path : str or Path
        An MCAP file that ebac wrote.
    progress : callable, optional
        Called with bytes read and bytes in all.

    Returns
    -------
    Log
        Rows, events and all that stands beside them.

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    ValueError
        When it is no log of ebac, or was cut before its columns were written.
    """
    path = Path(path)
    condition, found = Condition(), _Found()
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(0)
        if not MAGIC.startswith(file.read(len(MAGIC))):
            raise ValueError(f"{path}: not an MCAP file (it does not begin like one)")
        if size < len(MAGIC):
            raise ValueError(f"{path}: {size} bytes, cut before anything was written")
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            for opcode, start, stop in records(data, condition, progress or _silent):
                try:
                    _take(found, opcode, data, start, stop)
                except ValueError as error:
                    condition.leave_out(_NAMES.get(opcode, "a record"), start, error)
    return _log(path, found, condition, size)


_NAMES = {CHUNK: "a chunk", CHANNEL: "a channel", METADATA: "metadata", ATTACHMENT: "an attachment"}


def _silent(done: int, total: int) -> None:
    pass


def _take(found: _Found, opcode: int, data: mmap.mmap, start: int, stop: int) -> None:
    if opcode == CHUNK:
        _take_chunk(found, unpacked(data[start:stop]))
        return
    from mcap.records import Attachment, Channel, Metadata

    if opcode == CHANNEL:
        _take_channel(found, parsed(Channel, data[start:stop]))
    elif opcode == METADATA:
        record = parsed(Metadata, data[start:stop])
        found.metadata[record.name] = record.metadata
    elif opcode == ATTACHMENT:
        record = parsed(Attachment, data[start:stop])
        found.files[record.name] = record.data.decode()


def _take_channel(found: _Found, channel: Any) -> None:
    if channel.topic == ROWS_TOPIC and channel.message_encoding == "cdr" and found.layout is None:
        found.layout = Layout.from_json(channel.metadata.get("columns", ""))
        found.rows = channel.id
    elif channel.topic == EVENTS_TOPIC and channel.message_encoding == "json":
        found.events_channel = channel.id


def _take_chunk(found: _Found, content: bytes) -> None:
    if found.layout is None or found.rows is None:
        raise ValueError("it stands before the columns are described")
    runs = found.layout.find(content, found.rows)
    if sum(map(len, runs)) < len(content):
        found.events += _events(found, content)
    found.runs += runs
    found.waiting += len(content)
    if found.waiting > _BATCH:
        found.gather()


def _events(found: _Found, content: bytes) -> list[Event]:
    from ebac.logs.layout import MESSAGE

    events, at = [], 0
    while at < len(content):
        stop = at + 9 + int.from_bytes(content[at + 1 : at + 9], "little")
        channel = int.from_bytes(content[at + 9 : at + 11], "little")
        if content[at] == MESSAGE and channel == found.events_channel:
            events.append(Event.from_json(content[at + 31 : stop]))
        at = stop
    return events


def _log(path: Path, found: _Found, condition: Condition, size: int) -> Log:
    if found.layout is None:
        why = condition.remarks[0] if condition.remarks else "no channel /ebac with its columns"
        raise ValueError(
            f"{path}: no log of ebac, or cut before its columns were written: {why} ({size} bytes)"
        )
    found.gather()
    about = _about(found, condition)
    parts = found.columns
    data = {
        name: parts[0][name] if len(parts) == 1 else np.concatenate([p.pop(name) for p in parts])
        for name in list(parts[0])
    }
    for values in data.values():
        values.setflags(write=False)
    trace = Trace(
        data=data,
        columns={c.name: c.info for c in found.layout.columns},
        axes=about.axes,
        scenario=about.scenario,
        law=about.law,
        law_repr=about.law_repr,
    )
    return Log(
        path=path,
        trace=trace,
        events=found.events,
        about=about,
        condition=condition,
        ended=found.metadata.get("ebac/end", {}),
        bytes=size,
    )


def _about(found: _Found, condition: Condition) -> About:
    told = dict(found.metadata.get("ebac", {}))
    own = {name: told.pop(name, "") for name in ("format", "axes", "law", "law_repr", "start_ns")}
    files = dict(found.files)
    scenario = None
    if SCENARIO_FILE in files:
        try:
            scenario = Scenario.from_toml(files[SCENARIO_FILE])
            del files[SCENARIO_FILE]
        except ValueError as error:
            condition.remarks.append(f"the scenario in it is not used: {error}")
    return About(
        axes=max(column.size for column in found.layout.columns) if found.layout else 1,
        law=own["law"],
        law_repr=own["law_repr"],
        scenario=scenario,
        start_ns=int(own["start_ns"]) if own["start_ns"].isdecimal() else 0,
        files=files,
        made_by=told,
    )
