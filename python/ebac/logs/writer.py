"""Writes logs: MCAP, chunk by chunk, each in one write, so that a kill costs the last one at most."""

from __future__ import annotations

import contextlib
import json
import os
import struct
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from ebac.logs import events
from ebac.logs.about import About
from ebac.logs.layout import MESSAGE, SCHEMA_NAME, Layout

if TYPE_CHECKING:
    from mcap.records import McapRecord

ROWS, EVENTS = 1, 2  # numbers of channel and schema
ROWS_TOPIC, EVENTS_TOPIC = "/ebac", "/ebac/events"
MAGIC = b"\x89MCAP0\r\n"
_MESSAGE_HEAD = struct.Struct("<BQHIQQ")
_INDEX_HEAD = struct.Struct("<BQHI")


class LogWriter:
    """A log under way: rows and events in, chunks out.

    Every call that takes rows ends with one unbuffered write of a whole chunk: what it returned from is in
    the hands of the kernel and outlives the process, killed or not. It outlives the loss of power after `sync`.

    Parameters
    ----------
    path : str or Path
        The file; must not exist.
    layout : Layout
        Columns of a row.
    about : About
        Law, scenario, versions.

    Raises
    ------
    FileExistsError
        When there is such a file.
    """

    def __init__(self, path: str | Path, *, layout: Layout, about: About) -> None:
        import zstandard
        from mcap.records import Statistics

        self.path = Path(path)
        self.layout = layout
        self.about = about
        self.rows = 0
        self._compress = zstandard.ZstdCompressor(level=1).compress
        self._chunks = bytearray()  # their indexes, written out: 50 a second for hours
        self._attached: list[McapRecord] = []
        self._described: list[McapRecord] = []
        self._counts = Statistics(
            attachment_count=0,
            channel_count=2,
            channel_message_counts={ROWS: 0, EVENTS: 0},
            chunk_count=0,
            message_count=0,
            message_end_time=0,
            message_start_time=0,
            metadata_count=0,
            schema_count=2,
        )
        self._at = 0
        self._file = self.path.open("xb", buffering=0)
        try:
            self._begin()
        except BaseException:
            self._file.close()
            self.path.unlink(missing_ok=True)
            raise

    def _begin(self) -> None:
        from mcap.records import Header

        from ebac import __version__

        header = _bytes(Header(profile="", library=f"ebac {__version__}"))
        self._write(MAGIC + header + b"".join(map(_bytes, self._described_channels())))
        self._metadata("ebac", self.about.metadata)
        for name, text in self.about.attachments.items():
            self._attach(name, text)

    def _described_channels(self) -> list[McapRecord]:
        from mcap.records import Channel, Schema

        columns = {"columns": self.layout.to_json()}
        return [
            Schema(
                id=ROWS, name=SCHEMA_NAME, encoding="ros2msg", data=self.layout.ros2msg().encode()
            ),
            Schema(
                id=EVENTS,
                name=events.SCHEMA_NAME,
                encoding="jsonschema",
                data=json.dumps(events.SCHEMA).encode(),
            ),
            Channel(
                id=ROWS, topic=ROWS_TOPIC, message_encoding="cdr", metadata=columns, schema_id=ROWS
            ),
            Channel(
                id=EVENTS,
                topic=EVENTS_TOPIC,
                message_encoding="json",
                metadata={},
                schema_id=EVENTS,
            ),
        ]

    def write(
        self, data: Mapping[str, NDArray[Any]], happened: Sequence[events.Event] = ()
    ) -> None:
        """Write rows and events as one chunk.

        Parameters
        ----------
        data : mapping
            Columns of the layout, shape (rows,) or (rows, axes); may have no rows.
        happened : sequence of Event
            Written behind the rows.

        Raises
        ------
        OSError
            When the file cannot be written; the file then ends as if cut there.
        """
        start = self.about.start_ns
        rows = self.layout.pack(data, channel=ROWS, start_ns=start)
        content = [rows.tobytes()]
        at = len(content[0])
        offsets = np.arange(len(rows), dtype=np.uint64) * rows.itemsize
        indexes = {ROWS: np.column_stack((rows["#log_time"], offsets))} if len(rows) else {}
        if happened:
            entries = []
            for event in happened:
                time, message = event.time_ns(start), event.to_json(start)
                entries.append((time, at))
                length = _MESSAGE_HEAD.size - 9 + len(message)
                head = _MESSAGE_HEAD.pack(
                    MESSAGE, length, EVENTS, event.tick & 0xFFFFFFFF, time, time
                )
                content.append(head + message)
                at += len(content[-1])
            indexes[EVENTS] = np.array(entries, np.uint64)
        if indexes:
            self._chunk(b"".join(content), indexes)
            self.rows += len(rows)

    def _chunk(self, content: bytes, indexes: Mapping[int, NDArray[np.uint64]]) -> None:
        from mcap.records import Chunk, ChunkIndex

        times = np.concatenate([index[:, 0] for index in indexes.values()])
        chunk = Chunk(
            compression="zstd",
            data=self._compress(content),
            message_end_time=int(times.max()),
            message_start_time=int(times.min()),
            uncompressed_crc=zlib.crc32(content),
            uncompressed_size=len(content),
        )
        record = _bytes(chunk)
        where, after = {}, b""
        for channel, index in indexes.items():
            where[channel] = self._at + len(record) + len(after)
            size = index.nbytes
            after += _INDEX_HEAD.pack(0x07, 6 + size, channel, size) + index.astype("<u8").tobytes()
        self._chunks += _bytes(
            ChunkIndex(
                chunk_length=len(record),
                chunk_start_offset=self._at,
                compression=chunk.compression,
                compressed_size=len(chunk.data),
                message_end_time=chunk.message_end_time,
                message_index_length=len(after),
                message_index_offsets=where,
                message_start_time=chunk.message_start_time,
                uncompressed_size=len(content),
            )
        )
        self._write(record + after)
        self._count(indexes, chunk.message_start_time, chunk.message_end_time)

    def _count(self, indexes: Mapping[int, NDArray[np.uint64]], first: int, last: int) -> None:
        counts = self._counts
        new = counts.message_count == 0
        counts.message_start_time = first if new else min(counts.message_start_time, first)
        counts.message_end_time = max(counts.message_end_time, last)
        counts.chunk_count += 1
        for channel, index in indexes.items():
            counts.channel_message_counts[channel] += len(index)
            counts.message_count += len(index)

    def _metadata(self, name: str, values: Mapping[str, str]) -> None:
        from mcap.records import Metadata, MetadataIndex

        record = _bytes(Metadata(name=name, metadata=dict(values)))
        self._described.append(MetadataIndex(offset=self._at, length=len(record), name=name))
        self._counts.metadata_count += 1
        self._write(record)

    def _attach(self, name: str, text: str) -> None:
        from mcap.records import Attachment, AttachmentIndex

        data, time = text.encode(), self.about.start_ns
        kind = "application/toml" if name.endswith(".toml") else "text/plain"
        file = Attachment(create_time=time, log_time=time, name=name, media_type=kind, data=data)
        record = _bytes(file)
        self._attached.append(
            AttachmentIndex(
                offset=self._at,
                length=len(record),
                log_time=time,
                create_time=time,
                data_size=len(data),
                name=name,
                media_type=kind,
            )
        )
        self._counts.attachment_count += 1
        self._write(record)

    def _write(self, data: bytes) -> None:
        left = memoryview(data)
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError:
            with contextlib.suppress(OSError):
                self._file.truncate(self._at)  # no half of a record stays
            raise
        self._at += len(data)

    def sync(self) -> None:
        """Wait until everything written so far is on the disk."""
        os.fsync(self._file.fileno())

    def close(self, **ended: int) -> None:
        """Write the summary with which the default reader finds everything, and close.

        Parameters
        ----------
        **ended
            Numbers that are known only now, such as rows lost: the metadata record `ebac/end`.
        """
        from mcap.records import DataEnd, Footer

        if self._file.closed:
            return
        try:
            self._metadata("ebac/end", {name: str(n) for name, n in ended.items()})
            self._write(_bytes(DataEnd(0)))
            start = self._at
            summary, offsets = self._summary(start)
            footer = struct.pack("<BQQQ", 0x02, 20, start, start + len(summary))
            crc = zlib.crc32(summary + offsets + footer)
            end = Footer(
                summary_start=start, summary_offset_start=start + len(summary), summary_crc=crc
            )
            self._write(summary + offsets + _bytes(end) + MAGIC)
            self.sync()
        finally:
            self._file.close()

    def abandon(self) -> None:
        """Close the file as it is, as if the process had been killed."""
        self._file.close()

    def _summary(self, start: int) -> tuple[bytes, bytes]:
        """Return the groups of the summary, and where each of them starts."""
        from mcap.records import SummaryOffset

        known = self._described_channels()
        groups = (known[:2], known[2:], [self._counts], self._attached, self._described)
        summary, offsets = b"", b""
        for written in (*(b"".join(map(_bytes, group)) for group in groups), bytes(self._chunks)):
            if written:
                place = SummaryOffset(
                    group_opcode=written[0],
                    group_start=start + len(summary),
                    group_length=len(written),
                )
                offsets += _bytes(place)
                summary += written
        return summary, offsets

    def __enter__(self) -> Self:
        """Return the writer."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the file: whole, or as if cut when something was raised."""
        if kind is None:
            self.close()
        else:
            self.abandon()


def _bytes(record: McapRecord) -> bytes:
    from mcap.data_stream import RecordBuilder

    builder = RecordBuilder()
    record.write(builder)
    written: bytes = builder.end()  # type: ignore[no-untyped-call]
    return written
