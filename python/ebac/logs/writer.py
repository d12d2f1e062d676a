"""Writes logs: MCAP, chunk by chunk, each in one write, so that a kill costs the last one at most."""

from __future__ import annotations

import contextlib
import errno
import io
import os
import struct
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ebac._util.wrong_calls import plain_constructor
from ebac.logs import events
from ebac.logs.about import About, versions
from ebac.logs.layout import MESSAGE, Layout
from ebac.logs.records import MAGIC
from ebac.logs.summary import EVENTS, ROWS, Summary, described, record_bytes

_MESSAGE_HEAD = struct.Struct("<BQHIQQ")
_INDEX_HEAD = struct.Struct("<BQHI")


def new_log(path: Path) -> io.FileIO:
    """Begin a log before there is a row, and have at hand what writing one needs.

    So a folder that takes no file is found before anything moves, and the first chunk is not late.

    Raises
    ------
    OSError
        When there is such a file, or the folder takes none.
    """
    import mcap.records  # noqa: F401
    import zstandard  # noqa: F401

    versions()  # asks git
    file = io.FileIO(path, "xb")
    try:
        file.write(MAGIC)
    except BaseException:
        discard(file, path)
        raise
    return file


def discard(file: io.FileIO, path: Path) -> None:
    """Close a log that was begun, and remove it."""
    file.close()
    path.unlink(missing_ok=True)


@plain_constructor
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
    file : FileIO, optional
        What `new_log` returned for this path.

    Raises
    ------
    FileExistsError
        When there is such a file.
    """

    def __init__(
        self, path: str | Path, *, layout: Layout, about: About, file: io.FileIO | None = None
    ) -> None:
        import zstandard

        self.path = Path(path)
        self.layout = layout
        self.about = about
        self.rows = 0
        self._compress = zstandard.ZstdCompressor(level=1).compress
        self._at = len(MAGIC)
        self._file = new_log(self.path) if file is None else file
        try:
            self._summary = Summary(layout, self.path.parent)
            self._begin()
        except BaseException:
            discard(self._file, self.path)
            raise

    def _begin(self) -> None:
        from mcap.records import Header

        from ebac import __version__

        header = record_bytes(Header(profile="", library=f"ebac {__version__}"))
        self._write(header + b"".join(map(record_bytes, described(self.layout))))
        self._metadata("ebac", self.about.metadata)
        for name, text in self.about.attachments.items():
            self._attach(name, text)

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
            When the file cannot be written; the file then ends as if cut there. Also when another program deleted it,
            or cut it.
        """
        self._check_file()
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

    def _check_file(self) -> None:
        """Raise OSError where another program took from the file what was written."""
        now = os.fstat(self._file.fileno())
        if now.st_nlink == 0:
            happened = "it was deleted while it was written"
        elif now.st_size < self._at:
            happened = f"it was cut to {now.st_size} bytes while it was written"
        else:
            return
        raise OSError(errno.EIO, happened, str(self.path))

    def _chunk(self, content: bytes, indexes: Mapping[int, NDArray[np.uint64]]) -> None:
        from mcap.records import Chunk

        times = np.concatenate([index[:, 0] for index in indexes.values()])
        chunk = Chunk(
            compression="zstd",
            data=self._compress(content),
            message_end_time=int(times.max()),
            message_start_time=int(times.min()),
            uncompressed_crc=zlib.crc32(content),
            uncompressed_size=len(content),
        )
        record = record_bytes(chunk)
        after, where = b"", {}
        for channel, index in indexes.items():
            where[channel] = self._at + len(record) + len(after)
            size = index.nbytes
            after += _INDEX_HEAD.pack(0x07, 6 + size, channel, size) + index.astype("<u8").tobytes()
        counts = {channel: len(index) for channel, index in indexes.items()}
        self._summary.chunk(chunk, self._at, len(record), where, len(after), counts)
        self._write(record + after)

    def _metadata(self, name: str, values: Mapping[str, str]) -> None:
        from mcap.records import Metadata

        record = record_bytes(Metadata(name=name, metadata=dict(values)))
        self._summary.metadata(name, self._at, len(record))
        self._write(record)

    def _attach(self, name: str, text: str) -> None:
        from mcap.records import Attachment

        data, time = text.encode(), self.about.start_ns
        kind = "application/toml" if name.endswith(".toml") else "text/plain"
        file = Attachment(create_time=time, log_time=time, name=name, media_type=kind, data=data)
        record = record_bytes(file)
        self._summary.attachment(file, self._at, len(record))
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
            self._write(record_bytes(DataEnd(0)))
            start, crc = self._at, 0

            def write(part: bytes) -> None:
                nonlocal crc
                crc = zlib.crc32(part, crc)
                self._write(part)

            offsets = self._summary.write(write, start)
            crc = zlib.crc32(struct.pack("<BQQQ", 0x02, 20, start, offsets), crc)
            end = Footer(summary_start=start, summary_offset_start=offsets, summary_crc=crc)
            self._write(record_bytes(end) + MAGIC)
            self.sync()
        finally:
            self.abandon()

    def abandon(self) -> None:
        """Close the file as it is, as if the process had been killed."""
        self._file.close()
        self._summary.close()

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
