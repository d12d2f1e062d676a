"""The chunks of a log, unpacked several at a time and in several threads, given in their order."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field

from ebac._util.cores import usable_cores
from ebac.logs.events import Event
from ebac.logs.layout import MESSAGE, Layout
from ebac.logs.records import unpacked, unpacked_size

#: Packed bytes that are unpacked together: the rows of a log on disk come twenty at a time.
_TOGETHER = 1 << 18
#: Bytes of rows that are unpacked together, where they are packed more tightly than ours.
_TOGETHER_UNPACKED = 1 << 22
#: Bytes of rows under way at most, and one chunk more: a small file may hold very large chunks.
_UNDER_WAY = 1 << 25
#: Threads at most; the packing library and the checksum leave the interpreter alone meanwhile.
_THREADS = 4
#: So many of those are under way at most, that memory does not fill with what nobody has taken yet.
_AHEAD = 2 * _THREADS


@dataclass(frozen=True, kw_only=True)
class Where:
    """Which messages of a chunk are rows, and which are events."""

    layout: Layout
    rows: int
    events: int | None


@dataclass(kw_only=True)
class Content:
    """What some chunks held.

    Attributes
    ----------
    runs : list of bytes
        Message records of rows, each an unbroken run.
    events : list of Event
        What happened.
    wrong : list of (int, ValueError)
        Chunks that cannot be read: first byte, why.
    end : int
        First byte after the last of these chunks.
    """

    end: int
    runs: list[bytes] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    wrong: list[tuple[int, ValueError]] = field(default_factory=list)


def unpackers() -> ThreadPoolExecutor:
    """Return threads that unpack; none is made before there is work for it. A context manager."""
    return ThreadPoolExecutor(min(_THREADS, usable_cores()), thread_name_prefix="ebac-log")


class Chunks:
    """Takes chunks as they stand in a file, gives what they hold in that order. A small log needs no thread."""

    def __init__(self, pool: ThreadPoolExecutor) -> None:
        self._batch: list[_Part] = []
        self._bytes = 0
        self._unpacked = 0
        self._pool = pool
        self._under_way: deque[tuple[Future[Content], int]] = deque()

    def put(
        self, where: Where, start: int, data: bytes, *, packed: bool = True
    ) -> Iterator[Content]:
        """Take a chunk whose content begins at byte `start`, or a message that stands alone; give what is ready."""
        self._batch.append((start, data, packed))
        self._bytes += len(data)
        self._unpacked += unpacked_size(data) if packed else len(data)
        if self._bytes < _TOGETHER and self._unpacked < _TOGETHER_UNPACKED:
            return
        size = self._unpacked
        self._under_way.append((self._pool.submit(_content, where, self._taken()), size))
        while len(self._under_way) > _AHEAD or sum(n for _, n in self._under_way) > _UNDER_WAY:
            yield self._under_way.popleft()[0].result()

    def rest(self, where: Where) -> Iterator[Content]:
        """Give all that was put and not given yet."""
        while self._under_way:
            yield self._under_way.popleft()[0].result()
        if self._batch:
            yield _content(where, self._taken())

    def _taken(self) -> list[_Part]:
        batch, self._batch, self._bytes, self._unpacked = self._batch, [], 0, 0
        return batch


#: First byte, content of the record, and whether it is a chunk: else it is a message, whole.
_Part = tuple[int, bytes, bool]


def _content(where: Where, batch: list[_Part]) -> Content:
    """Return what chunks hold; one that cannot be read costs no other."""
    start, data, _ = batch[-1]
    content = Content(end=start + len(data))
    parts: list[tuple[int, bytes]] = []
    for start, data, packed in batch:
        try:
            parts.append((start, unpacked(data) if packed else data))
        except ValueError as error:
            content.wrong.append((start, error))
    size = where.layout.record.itemsize
    if all(len(part) % size == 0 for _, part in parts):
        joined = b"".join(part for _, part in parts)
        if where.layout.only_rows(joined, where.rows):
            content.runs = [joined] if joined else []
            return content
    for start, part in parts:
        try:
            runs = where.layout.find(part, where.rows)
            events = [] if sum(map(len, runs)) == len(part) else list(_events(where, part))
        except ValueError as error:
            content.wrong.append((start, error))
        else:
            content.runs += runs
            content.events += events
    content.wrong.sort(key=lambda one: one[0])
    return content


def _events(where: Where, content: bytes) -> Iterator[Event]:
    at = 0
    while at < len(content):
        stop = at + 9 + int.from_bytes(content[at + 1 : at + 9], "little")
        channel = int.from_bytes(content[at + 9 : at + 11], "little")
        if content[at] == MESSAGE and channel == where.events:
            yield Event.from_json(content[at + 31 : stop])
        at = stop
