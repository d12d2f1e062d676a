"""Logs as bags of ROS 2: MCAP with the profile `ros2`, every message in CDR."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from numpy.typing import NDArray

from ebac._util.atomic_file import draft
from ebac._util.progress import Progress
from ebac.logs.about import About
from ebac.logs.columns import Columns
from ebac.logs.events import Event
from ebac.logs.files import CHUNK_ROWS, FORMATS, about_trace, extension
from ebac.logs.layout import Layout
from ebac.logs.log import Log
from ebac.logs.reader import read, read_bytes
from ebac.logs.records import FileBytes
from ebac.logs.ros2_messages import EVENTS, TYPES, log_message, topics
from ebac.logs.ticks import numbered

if TYPE_CHECKING:
    from ebac.trace import Trace


@dataclass(frozen=True, kw_only=True)
class Bag:
    """A bag that was written.

    Attributes
    ----------
    path : Path
        The file.
    messages : dict of str to int
        Number of messages by topic.
    log : Log
        What stands beside the rows of the log: law, events, condition. Its trace has no rows where the
        log is MCAP.
    """

    path: Path
    messages: dict[str, int]
    log: Log


class BagWriter:
    """A bag under way.

    Parameters
    ----------
    file : binary file
        Takes the bag.
    layout : Layout
        Columns of a row.

    Raises
    ------
    ValueError
        When a column has a name that no field of a message can have.
    """

    def __init__(self, file: BinaryIO, layout: Layout) -> None:
        from mcap.writer import Writer

        from ebac import __version__

        self._topics = topics(layout)
        self._writer = Writer(file)
        self._writer.start(profile="ros2", library=f"ebac {__version__}")
        self._channels = [self._channel(t.name, t.schema, t.definition) for t in self._topics]
        self._events = self._channel(EVENTS, *TYPES[EVENTS])
        self.messages = dict.fromkeys([*(t.name for t in self._topics), EVENTS], 0)

    def _channel(self, topic: str, schema: str, definition: str) -> int:
        number = self._writer.register_schema(schema, "ros2msg", definition.encode())
        qos = {"offered_qos_profiles": ""}
        return self._writer.register_channel(topic, "cdr", number, qos)

    def rows(self, rows: NDArray[Any]) -> None:
        """Append the messages of rows as they lie in a log."""
        for first in range(0, len(rows), CHUNK_ROWS):
            self._block(rows[first : first + CHUNK_ROWS])

    def _block(self, rows: NDArray[Any]) -> None:
        number = len(rows)
        encoded = [memoryview(topic.encode(rows)) for topic in self._topics]
        streams = [
            (channel, data, len(data) // number)
            for channel, data in zip(self._channels, encoded, strict=True)
        ]
        times, sequences = rows["#log_time"].tolist(), rows["#sequence"].tolist()
        add = self._writer.add_message
        for i, (time, sequence) in enumerate(zip(times, sequences, strict=True)):
            for channel, data, size in streams:
                add(channel, time, bytes(data[i * size : (i + 1) * size]), time, sequence)
        for topic in self._topics:
            self.messages[topic.name] += number

    def close(self, about: About, events: Sequence[Event] = ()) -> None:
        """Append events, attach what stands beside the rows, and end the bag; the file stays open."""
        for event in events:
            time = event.time_ns(about.start_ns)
            tick = event.tick & 0xFFFFFFFF
            self._writer.add_message(self._events, time, log_message(event, time), time, tick)
        self.messages[EVENTS] += len(events)
        self._writer.add_metadata("ebac", about.metadata)
        start = about.start_ns
        for name, text in about.attachments.items():
            self._writer.add_attachment(start, start, name, "text/plain", text.encode())
        self._writer.finish()  # type: ignore[no-untyped-call]


def to_ros2(
    path: str | Path,
    out: str | Path,
    *,
    start: float | None = None,
    stop: float | None = None,
    progress: Progress | None = None,
) -> Bag:
    """Write a log as a bag of ROS 2, which rosbags and mcap-ros2-support read.

    An MCAP log is never in memory as a whole, however long it is.

    Parameters
    ----------
    path : str or Path
        A log, as for `read`.
    out : str or Path
        The bag, .mcap; a file of that name is replaced. It appears when it is whole.
    start, stop : float, optional
        Only rows and events with start <= t < stop [s].
    progress : callable, optional
        Called with how much is done and how much there is.

    Returns
    -------
    Bag
        Number of messages by topic: `/ebac/row` (`ebac_msgs/msg/Row`: all columns), `/ebac/joint_states`
        (`sensor_msgs/msg/JointState`), `/ebac/wrench` (`geometry_msgs/msg/WrenchStamped`: the measured force) and
        `/ebac/events` (`rcl_interfaces/msg/Log`).

    Raises
    ------
    ValueError
        As `read`; also for an `out` that does not end in .mcap or is the log itself, and for a column whose name no
        field of a message can have.
    OSError
        When a file cannot be read or written.
    """
    path, out = Path(path), Path(out)
    extension(out, (".mcap",))
    if out.exists() and path.exists() and out.samefile(path):
        raise ValueError(f"{out}: is the log itself; give the bag another name")
    if path.suffix.lower() in set(FORMATS) - {".mcap"}:
        log = read(path, start=start, stop=stop)
        with draft(out) as name:
            return Bag(path=out, messages=write_trace(log.trace, name, progress), log=log)
    with path.open("rb") as source, draft(out) as name, name.open("wb") as file:
        bags: list[_Rows] = []

        def into(layout: Layout, first: float, last: float) -> _Rows:
            bags.append(_Rows(layout, first, last, BagWriter(file, layout)))
            return bags[-1]

        log = read_bytes(
            FileBytes(source), path, start=start, stop=stop, progress=progress, into=into
        )
        bags[0].bag.close(log.about, log.events)
    return Bag(path=out, messages=bags[0].bag.messages, log=log)


def write_trace(trace: Trace, path: Path, progress: Progress | None = None) -> dict[str, int]:
    """Write a trace as a bag, its time t itself; return the number of messages by topic."""
    data, columns = numbered(trace)
    layout = Layout.of(data, columns)
    with path.open("wb") as file:
        bag = BagWriter(file, layout)
        for first in range(0, len(trace), CHUNK_ROWS):
            part = {name: values[first : first + CHUNK_ROWS] for name, values in data.items()}
            bag.rows(layout.pack(part, channel=0, start_ns=0))
            if progress is not None:
                progress(min(first + CHUNK_ROWS, len(trace)), len(trace))
        bag.close(about_trace(trace, {}))
    return bag.messages


class _Rows(Columns):
    """Rows of a log that go on to a bag instead of staying in memory."""

    def __init__(self, layout: Layout, start: float, stop: float, bag: BagWriter) -> None:
        super().__init__(layout, start, stop)
        self.bag = bag

    def _append(self, rows: NDArray[Any], share: float) -> None:
        self.bag.rows(rows)
