"""The summary at the end of a log, with which the default reader finds everything at once."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ebac.logs import events
from ebac.logs.layout import SCHEMA_NAME, Layout

if TYPE_CHECKING:
    from mcap.records import Attachment, Chunk, McapRecord

ROWS, EVENTS = 1, 2  # numbers of channel and schema
ROWS_TOPIC, EVENTS_TOPIC = "/ebac", "/ebac/events"
#: Indexes of chunks are copied to the log in parts of this many bytes.
_PART = 1 << 20


class Summary:
    """What a log holds, and where, noted while it is written.

    The indexes of chunks, 50 a second for hours, wait in a nameless file beside the log: memory stays as it is.

    Parameters
    ----------
    layout : Layout
        Columns of a row.
    folder : Path
        Where the log is.
    """

    def __init__(self, layout: Layout, folder: Path) -> None:
        from mcap.records import Statistics

        self._layout = layout
        self._chunks = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115 - closed by `close`
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

    def chunk(
        self,
        chunk: Chunk,
        at: int,
        length: int,
        indexes: Mapping[int, int],
        indexes_length: int,
        counts: Mapping[int, int],
    ) -> None:
        """Note a chunk of `length` bytes at byte `at`; by channel, where its index is, and its messages."""
        from mcap.records import ChunkIndex

        index = ChunkIndex(
            chunk_length=length,
            chunk_start_offset=at,
            compression=chunk.compression,
            compressed_size=len(chunk.data),
            message_end_time=chunk.message_end_time,
            message_index_length=indexes_length,
            message_index_offsets=dict(indexes),
            message_start_time=chunk.message_start_time,
            uncompressed_size=chunk.uncompressed_size,
        )
        self._chunks.write(record_bytes(index))
        all_ = self._counts
        first, last = chunk.message_start_time, chunk.message_end_time
        new = all_.message_count == 0
        all_.message_start_time = first if new else min(all_.message_start_time, first)
        all_.message_end_time = max(all_.message_end_time, last)
        all_.chunk_count += 1
        for channel, count in counts.items():
            all_.channel_message_counts[channel] += count
            all_.message_count += count

    def metadata(self, name: str, at: int, length: int) -> None:
        """Note a record of metadata."""
        from mcap.records import MetadataIndex

        self._described.append(MetadataIndex(offset=at, length=length, name=name))
        self._counts.metadata_count += 1

    def attachment(self, file: Attachment, at: int, length: int) -> None:
        """Note an attached file."""
        from mcap.records import AttachmentIndex

        self._attached.append(
            AttachmentIndex(
                offset=at,
                length=length,
                log_time=file.log_time,
                create_time=file.create_time,
                data_size=len(file.data),
                name=file.name,
                media_type=file.media_type,
            )
        )
        self._counts.attachment_count += 1

    def write(self, write: Callable[[bytes], None], start: int) -> int:
        """Write the groups of the summary, from byte `start` on, and where each begins; return where that list is."""
        known = described(self._layout)
        groups = (known[:2], known[2:], [self._counts], self._attached, self._described)
        at, offsets = start, b""
        for group in groups:
            packed = b"".join(map(record_bytes, group))
            write(packed)
            offsets += _place(packed[:1], at, len(packed))
            at += len(packed)
        length = self._chunks.tell()
        self._chunks.seek(0)
        first = b""
        while part := self._chunks.read(_PART):
            first = first or part[:1]
            write(part)
        offsets += _place(first, at, length)
        write(offsets)
        return at + length

    def close(self) -> None:
        """Forget what waits; nothing the second time."""
        self._chunks.close()


def _place(first: bytes, start: int, length: int) -> bytes:
    """Return where a group of records lies, all of the kind of the first; nothing for an empty one."""
    from mcap.records import SummaryOffset

    if length == 0:
        return b""
    return record_bytes(
        SummaryOffset(group_opcode=first[0], group_start=start, group_length=length)
    )


def described(layout: Layout) -> list[McapRecord]:
    """Return the schemas and channels of a log."""
    from mcap.records import Channel, Schema

    columns = {"columns": layout.to_json()}
    return [
        Schema(id=ROWS, name=SCHEMA_NAME, encoding="ros2msg", data=layout.ros2msg().encode()),
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


def record_bytes(record: McapRecord) -> bytes:
    """Return a record as it stands in a file."""
    from mcap.data_stream import RecordBuilder

    builder = RecordBuilder()
    record.write(builder)
    written: bytes = builder.end()  # type: ignore[no-untyped-call]
    return written
