"""Reads logs: whole, cut by a kill, damaged or repaired."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ebac.logs.about import SCENARIO_FILE, About
from ebac.logs.chunks import Chunks, Content, Where, unpackers
from ebac.logs.columns import Columns
from ebac.logs.events import Event
from ebac.logs.layout import MESSAGE, Layout
from ebac.logs.log import Log
from ebac.logs.records import (
    ATTACHMENT,
    CHANNEL,
    CHUNK,
    MAGIC,
    METADATA,
    Condition,
    FileBytes,
    channels,
    parsed,
    profile,
    records,
    summary_channels,
    unpacked,
)
from ebac.logs.summary import EVENTS_TOPIC, ROWS_TOPIC
from ebac.scenario import Scenario
from ebac.trace import Trace
from ebac.trace.time_slice import check_order, is_outside

#: Digits of the largest whole number in a file.
_DIGITS = 19


@dataclass
class _Found:
    """Contents of the records of a file so far."""

    start: float = -math.inf
    stop: float = math.inf
    where: Where | None = None
    columns: Columns | None = None
    into: Callable[[Layout, float, float], Columns] = Columns
    by_summary: bool | None = (
        None  # whether that describes the channels; None before it was looked at
    )
    events_channel: int | None = None
    events: list[Event] = field(default_factory=list)
    changed: bool = False  # law or world, before the part that is read or in it
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)


def read(
    path: str | Path,
    *,
    start: float | None = None,
    stop: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Log:
    """Read a log, whatever state it is in.

    What is whole is read: a log whose writer was killed loses at most its last chunk, a damaged chunk is left out and
    counted in `condition`. So is a log that the `mcap` library or command wrote anew, in other chunks or none.

    Parameters
    ----------
    path : str or Path
        A file that ebac wrote: MCAP, or one of the other formats of `Trace.save`, by the extension.
    start, stop : float, optional
        Only rows and events with start <= t < stop [s]. Of MCAP no others come into memory.
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
        When it is no log of ebac, was cut before its columns were written, `start` and `stop` lie outside it, or `stop`
        lies before `start`.
    """
    path = Path(path)
    if path.suffix.lower() in (".npz", ".csv", ".parquet", ".mat", ".h5"):
        return _of_trace(path, start, stop)
    with path.open("rb") as file:
        return read_bytes(FileBytes(file), path, start=start, stop=stop, progress=progress)


def _of_trace(path: Path, start: float | None, stop: float | None) -> Log:
    """Read a file that holds the rows alone, with law and scenario where its format has room for them."""
    from ebac.logs.files import load

    trace = load(path, start=start, stop=stop)
    about = About(
        axes=trace.axes,
        law=trace.law,
        law_repr=trace.law_repr,
        scenario=trace.scenario,
        made_by={},
        changed=trace.changed,
    )
    return Log(
        path=path,
        trace=trace,
        events=[],
        about=about,
        condition=Condition(complete=True),
        ended={},
        bytes=path.stat().st_size,
    )


def read_bytes(
    data: bytes | FileBytes,
    name: str | Path,
    *,
    start: float | None = None,
    stop: float | None = None,
    progress: Callable[[int, int], None] | None = None,
    into: Callable[[Layout, float, float], Columns] = Columns,
) -> Log:
    """Read a log that is in memory; `name` is for messages, `into` makes what takes the rows. As `read`."""
    check_order(start, stop)
    path, condition, size = Path(name), Condition(), len(data)
    found = _Found(
        -math.inf if start is None else start, math.inf if stop is None else stop, into=into
    )
    if not MAGIC.startswith(data[: len(MAGIC)]):
        raise ValueError(f"{path}: not an MCAP file (it does not begin like one)")
    if size < len(MAGIC):
        raise ValueError(f"{path}: {size} bytes, cut before anything was written")
    with unpackers() as pool:
        chunks = Chunks(pool)
        for opcode, first, end in records(data, condition, progress or _silent):
            try:
                if opcode not in (CHUNK, MESSAGE):
                    if opcode in _NAMES:
                        _take(found, opcode, data[first:end])
                    continue
                packed = opcode == CHUNK
                part = data[first if packed else first - _HEAD : end]
                _look_for_channels(found, data, part if packed else b"")
                if found.where is not None:
                    for content in chunks.put(found.where, first, part, packed=packed):
                        _take_content(found, condition, content, size)
            except ValueError as error:
                condition.leave_out(_NAMES.get(opcode, "a record"), first, error)
        if found.where is not None:
            for content in chunks.rest(found.where):
                _take_content(found, condition, content, size)
    if found.where is None and profile(data) == "ros2":
        raise ValueError(
            f"{path}: a bag of ROS 2, no log of ebac; give the log it was exported from, or read it with rosbags "
            "or mcap-ros2-support"
        )
    if found.columns is not None and found.columns.span is not None:
        check_part(path, found.columns.span, start, stop)
    return _log(path, found, condition, size)


def _look_for_channels(found: _Found, data: bytes | FileBytes, chunk: bytes) -> None:
    """Look for the channels that no record before described: in the summary, or in the chunk itself.

    ebac describes them first. The `mcap` library does so inside a chunk, and again in the summary.
    """
    if found.where is not None and found.events_channel is not None:
        return
    if found.by_summary is None:
        described = summary_channels(data)
        found.by_summary = bool(described)
        for channel in described:
            _take(found, CHANNEL, channel)
    if chunk and not found.by_summary:
        for channel in channels(unpacked(chunk)):
            _take(found, CHANNEL, channel)


def check_part(
    path: Path, span: tuple[float, float], start: float | None, stop: float | None
) -> None:
    """Refuse a part that lies outside a log [s]."""
    if is_outside(start, stop, span):
        wanted = ((" from", start), (" before", stop))
        asked = "".join(f"{word} {t:g} s" for word, t in wanted if t is not None)
        raise ValueError(f"{path}: no rows{asked}: the log has {span[0]:g} to {span[1]:g} s")


#: Bytes of opcode and length before a record.
_HEAD = 9
_NAMES = {CHUNK: "a chunk", CHANNEL: "a channel", METADATA: "metadata", ATTACHMENT: "an attachment"}


def _silent(done: int, total: int) -> None:
    pass


def _take(found: _Found, opcode: int, data: bytes) -> None:
    from mcap.records import Attachment, Channel, Metadata

    if opcode == CHANNEL:
        _take_channel(found, parsed(Channel, data))
    elif opcode == METADATA:
        record = parsed(Metadata, data)
        found.metadata[record.name] = record.metadata
    else:
        record = parsed(Attachment, data)
        found.files[record.name] = record.data.decode()


def _take_channel(found: _Found, channel: Any) -> None:
    if channel.topic == ROWS_TOPIC and channel.message_encoding == "cdr" and found.where is None:
        layout = Layout.from_json(channel.metadata.get("columns", ""))
        found.where = Where(layout=layout, rows=channel.id, events=found.events_channel)
        found.columns = found.into(layout, found.start, found.stop)
    elif channel.topic == EVENTS_TOPIC and channel.message_encoding == "json":
        found.events_channel = channel.id
        if found.where is not None:
            found.where = replace(found.where, events=channel.id)


def _take_content(found: _Found, condition: Condition, content: Content, size: int) -> None:
    assert found.columns is not None
    for start, error in content.wrong:
        condition.leave_out(_NAMES[CHUNK], start, error)
    for run in content.runs:
        found.columns.take(run, content.end / size)
    found.changed |= any(e.kind == "parameter" and e.t < found.stop for e in content.events)
    found.events += [e for e in content.events if found.start <= e.t < found.stop]


def _log(path: Path, found: _Found, condition: Condition, size: int) -> Log:
    if found.where is None or found.columns is None:
        why = condition.remarks[0] if condition.remarks else "no channel /ebac with its columns"
        raise ValueError(
            f"{path}: no log of ebac, or cut before its columns were written: {why} ({size} bytes)"
        )
    columns = found.where.layout.columns
    about = _about(found, condition, max(column.size for column in columns))
    data = found.columns.finish()
    for values in data.values():
        values.setflags(write=False)
    trace = Trace(
        data=data,
        columns={c.name: c.info for c in columns},
        axes=about.axes,
        scenario=about.scenario,
        law=about.law,
        law_repr=about.law_repr,
        origin=about.origin,
        changed=about.changed or found.changed,
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


def whole(text: str) -> int | None:
    """Return the whole number in a text, from 0 to what a file can hold; None for anything else."""
    if not text.isdecimal() or len(text) > _DIGITS:
        return None
    return int(text) if int(text) < 1 << 63 else None


def _about(found: _Found, condition: Condition, axes: int) -> About:
    metadata = dict(found.metadata.get("ebac", {}))
    own = {
        name: metadata.pop(name, "")
        for name in ("format", "axes", "law", "law_repr", "start_ns", "changed", "simulated")
    }
    files = dict(found.files)
    scenario = None
    if SCENARIO_FILE in files:
        try:
            scenario = Scenario.from_toml(files[SCENARIO_FILE])
            del files[SCENARIO_FILE]
        except (ValueError, OSError, ImportError) as error:  # a mesh that is gone, too
            condition.remarks.append(f"the scenario in it is not used: {error}")
    return About(
        axes=axes,
        law=own["law"],
        law_repr=own["law_repr"],
        scenario=scenario,
        changed=own["changed"] == "true",
        simulated=own["simulated"] == "true",
        start_ns=whole(own["start_ns"]) or 0,
        files=files,
        made_by=metadata,
    )
