"""The records of an MCAP file that may be cut or damaged anywhere: whole ones are read, damaged ones reported."""

from __future__ import annotations

import struct
import threading
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from io import BytesIO
from typing import Any, BinaryIO

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, CHANNEL, CHUNK = 0x01, 0x02, 0x04, 0x06
METADATA, ATTACHMENT = 0x0C, 0x09
#: A chunk larger than this is damage: ebac writes at most some MB, other programs 4.
MOST_CHUNK = 1 << 26
#: So is one of over a megabyte that would unpack to this many times its size: rows give a hundred times at most.
MOST_RATIO = 1000
_FOOTER_BYTES = 1 + 8 + 20  # opcode, length; where summary and offsets begin, checksum
_HEAD = struct.Struct("<BQ")
_CHUNK = struct.Struct(
    "<QQQII"
)  # first and last time, size, checksum, letters of the compression's name
_LENGTH = struct.Struct("<Q")
_OF_THREAD = threading.local()


@dataclass
class Condition:
    """What was wrong with a file.

    Attributes
    ----------
    complete : bool
        Whether it ends as a log that was closed.
    damaged : int
        Chunks and other records that could not be read and were left out.
    bytes_left : int
        Bytes at the end that are no whole record.
    """

    complete: bool = False
    damaged: int = 0
    bytes_left: int = 0
    remarks: list[str] = field(default_factory=list)

    @property
    def damage(self) -> str:
        """What was left out, in words; empty where nothing was."""
        if not self.damaged:
            return ""
        left_out = "1 damaged part" if self.damaged == 1 else f"{self.damaged} damaged parts"
        return f"{left_out} left out: {'; '.join(self.remarks)}"

    def leave_out(self, what: str, at: int, why: object) -> None:
        """Note a record that is left out."""
        self.damaged += 1
        if self.damaged <= 5:
            self.remarks.append(f"{what} at byte {at} left out: {why}")


class FileBytes:
    """The bytes of a file, read where they are asked for: no more of it is in memory.

    Where another program cuts the file meanwhile, a part comes out short; a mapping would end the process.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._size = file.seek(0, 2)

    def __len__(self) -> int:
        """Return the bytes there were when it was opened."""
        return self._size

    def __getitem__(self, part: slice) -> bytes:
        """Return a part."""
        start, stop, _ = part.indices(self._size)
        self._file.seek(start)
        return self._file.read(max(0, stop - start))


def records(
    data: bytes | FileBytes, condition: Condition, report: Callable[[int, int], None]
) -> Iterator[tuple[int, int, int]]:
    """Yield (opcode, first byte, byte after the last) of the content of each whole record.

    Parameters
    ----------
    data : bytes or FileBytes
        The file.
    condition : Condition
        Takes what is wrong.
    report : callable
        Progress: bytes done, bytes in all.
    """
    at, size = len(MAGIC), len(data)
    while at + _HEAD.size <= size:
        head = data[at : at + _HEAD.size]
        if len(head) < _HEAD.size:
            break
        opcode, length = _HEAD.unpack(head)
        start = at + _HEAD.size
        if opcode == 0 or length > size - start:
            break
        yield opcode, start, start + length
        at = start + length
        report(at, size)
        if opcode == FOOTER:
            condition.complete = data[at : at + len(MAGIC)] == MAGIC
            if condition.complete:
                at += len(MAGIC)
            break
    condition.bytes_left = max(0, size - at)


def profile(data: bytes | FileBytes) -> str:
    """Return what kind of messages a file announces, such as ros2; empty where it does not."""
    start = len(MAGIC) + _HEAD.size
    head = data[len(MAGIC) : start + 4]
    if len(head) < _HEAD.size + 4 or head[0] != HEADER:
        return ""
    return data[start + 4 : start + 4 + min(head[_HEAD.size], 64)].decode(errors="replace")


def summary_channels(data: bytes | FileBytes) -> list[bytes]:
    """Return the channels that the summary of a closed file repeats, as they stand in it; none for another file."""
    end = len(data) - len(MAGIC) - _FOOTER_BYTES
    if end < len(MAGIC) or data[end + _FOOTER_BYTES : len(data)] != MAGIC:
        return []
    opcode, _, at = struct.unpack("<BQQ", data[end : end + 17])
    if opcode != FOOTER or not len(MAGIC) <= at < end:
        return []
    return channels(data[at:end])


def channels(content: bytes) -> list[bytes]:
    """Return the channels among records, as they stand there."""
    found = []
    at = 0
    while at + _HEAD.size <= len(content):
        opcode, length = _HEAD.unpack_from(content, at)
        at += _HEAD.size + length
        if opcode == CHANNEL:
            found.append(content[at - length : at])
    return found


def unpacked_size(data: bytes) -> int:
    """Return how many bytes a chunk record gives as its content's, at most as many as are ever unpacked."""
    size = int.from_bytes(data[16:24], "little")
    return size if size <= MOST_CHUNK else 0


def parsed(kind: Any, data: bytes) -> Any:
    """Return a record of the `mcap` library from its content.

    Raises
    ------
    ValueError
        When the content is not that of such a record.
    """
    from mcap.data_stream import ReadDataStream
    from mcap.exceptions import McapError

    stream = BytesIO(data)
    try:
        return kind.read(ReadDataStream(stream))
    except (McapError, struct.error, UnicodeDecodeError, MemoryError, OverflowError) as error:
        raise ValueError(f"not a {kind.__name__} ({error})") from None


def unpacked(data: bytes) -> bytes:
    """Return the content of a chunk record, checked against its size and its sum.

    Raises
    ------
    ValueError
        When it is damaged, or packed in a way ebac does not know.
    """
    try:
        _, _, size, checksum, letters = _CHUNK.unpack_from(data)
        at = _CHUNK.size + letters
        how = data[_CHUNK.size : at].decode()
        (length,) = _LENGTH.unpack_from(data, at)
    except (struct.error, UnicodeDecodeError) as error:
        raise ValueError(f"not a chunk ({error})") from None
    at += _LENGTH.size
    if at + length != len(data):
        raise ValueError("it ends too early or too late")
    if size > 1 << 20 and size > MOST_RATIO * length:
        raise ValueError(f"its header gives {size} bytes for {length} packed ones")
    content = _decompress(how, data[at:], size)
    if len(content) != size:
        raise ValueError(f"{len(content)} bytes instead of {size}")
    if checksum not in (0, zlib.crc32(content)):
        raise ValueError("its checksum is wrong")
    return content


def _zstd() -> Any:
    """Return the decompressor of this thread: making one takes longer than a chunk does."""
    if not hasattr(_OF_THREAD, "zstd"):
        import zstandard

        _OF_THREAD.zstd = zstandard.ZstdDecompressor()
    return _OF_THREAD.zstd


def _decompress(how: str, data: bytes, size: int) -> bytes:
    if size > MOST_CHUNK:
        raise ValueError(f"its header gives {size} bytes")
    if how == "":
        return data
    if how == "zstd":
        import zstandard

        try:
            known_size = zstandard.frame_content_size(data)
            if known_size not in (size, -1):  # -1: unknown
                raise ValueError(f"{known_size} bytes instead of {size}")
            return bytes(_zstd().decompress(data, max_output_size=size))
        except zstandard.ZstdError as error:
            raise ValueError(str(error)) from None
    if how == "lz4":
        import lz4.frame

        frame = lz4.frame.LZ4FrameDecompressor()
        try:
            content = bytes(frame.decompress(data, max_length=size))
            if not frame.eof:
                raise ValueError(f"more than {size} bytes, or its end is missing")
            return content
        except (RuntimeError, EOFError) as error:
            raise ValueError(str(error)) from None
    raise ValueError(f"packed as {how!r}: must be zstd, lz4 or nothing")
