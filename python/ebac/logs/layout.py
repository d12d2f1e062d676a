"""How a row lies in a log: a ROS 2 message of fixed size, in CDR, so that NumPy reads a chunk at once."""

from __future__ import annotations

import functools
import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ebac.trace.columns import ColumnInfo

#: Kind of a NumPy type: its name in a ROS 2 message, its little-endian form.
TYPES = {
    np.dtype(np.float64): ("float64", "<f8"),
    np.dtype(np.int64): ("int64", "<i8"),
    np.dtype(np.int32): ("int32", "<i4"),
    np.dtype(np.uint32): ("uint32", "<u4"),
    np.dtype(np.bool_): ("bool", "?"),
}
_KINDS = {name: np.dtype(form) for name, form in TYPES.values()}

#: A column has a value for each axis at most; more is damage.
_MOST_VALUES = 64
#: Message record of MCAP, then the header of CDR in little-endian: what stands before the numbers of a row.
#: No column has a # in its name.
_ENVELOPE = [
    ("#opcode", "u1"),
    ("#length", "<u8"),
    ("#channel", "<u2"),
    ("#sequence", "<u4"),
    ("#log_time", "<u8"),
    ("#publish_time", "<u8"),
    ("#cdr", "<u4"),
]
MESSAGE = 0x05
CDR_LITTLE_ENDIAN = 0x0100  # bytes 00 01 00 00
_BEFORE_DATA = 9  # bytes of opcode and length
_MESSAGE_HEAD = struct.Struct("<BQH")  # what all rows of a channel begin with

SCHEMA_NAME = "ebac_msgs/msg/Row"


@dataclass(frozen=True, kw_only=True)
class LoggedColumn:
    """A column of a log.

    Attributes
    ----------
    name, unit, meaning : str
        As in the trace.
    kind : str
        float64, int64, int32, uint32 or bool.
    size : int
        1 for one value per row, else the number of axes.
    """

    name: str
    unit: str
    meaning: str
    kind: str
    size: int

    @classmethod
    def from_json(cls, column: Any) -> Self:
        """Return a column from its JSON.

        Raises
        ------
        TypeError, KeyError
            When something in it is not what it must be: somebody else may have written it.
        """
        size: Any = column["size"]
        words: list[Any] = [column[name] for name in ("name", "unit", "meaning", "kind")]
        known = all(isinstance(word, str) for word in words) and words[0] and words[3] in _KINDS
        if not known or type(size) is not int or not 1 <= size <= _MOST_VALUES:
            raise TypeError(f"{column!r}: no column")
        return cls(**column)

    @property
    def info(self) -> ColumnInfo:
        """Its unit and meaning for a trace."""
        return ColumnInfo(name=self.name, unit=self.unit, meaning=self.meaning)

    @property
    def field(self) -> str:
        """Its name in a ROS 2 message, where a dot cannot be."""
        return self.name.replace(".", "_")

    @property
    def native(self) -> np.dtype[Any]:
        """Its type in a trace."""
        return _KINDS[self.kind].newbyteorder("=")

    @property
    def width(self) -> int:
        """Bytes of one value."""
        return _KINDS[self.kind].itemsize


@dataclass(frozen=True)
class Layout:
    """The columns of a row, in the order of the trace.

    In a message the widest stand first, so that nothing is padded. The numbers of a row are those of the trace, to the
    bit. A column with a value per axis is an array.
    """

    columns: tuple[LoggedColumn, ...]

    @classmethod
    def of(cls, data: Mapping[str, NDArray[Any]], columns: Mapping[str, ColumnInfo]) -> Self:
        """Lay out the columns of a trace.

        Raises
        ------
        ValueError
            For a column of another type or shape, or two names that are one in a message.
        """
        logged = []
        for name, values in data.items():
            kind = TYPES.get(values.dtype.newbyteorder("="))
            if kind is None or values.ndim > 2:
                raise ValueError(
                    f"column {name}: {values.dtype} of shape {values.shape} cannot be logged; must be "
                    f"{', '.join(_KINDS)}, one value or one per axis"
                )
            info = columns[name]
            size = values.shape[1] if values.ndim == 2 else 1
            logged.append(
                LoggedColumn(
                    name=name, unit=info.unit, meaning=info.meaning, kind=kind[0], size=size
                )
            )
        return cls(tuple(logged))._checked()

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Read what `to_json` wrote.

        Raises
        ------
        ValueError
            When it is not that.
        """
        try:
            columns = tuple(LoggedColumn.from_json(column) for column in json.loads(text))
        except (TypeError, KeyError, ValueError, RecursionError):
            columns = ()
        if not columns:
            raise ValueError("its columns are not described as ebac does")
        return cls(columns)._checked()

    def _checked(self) -> Self:
        fields = [column.field for column in self.columns]
        twice = {field for field in fields if fields.count(field) > 1}
        if twice:
            raise ValueError(
                f"columns {', '.join(sorted(twice))}: cannot be distinguished in a log"
            )
        sizes = {column.size for column in self.columns} - {1}
        if len(sizes) > 1:
            raise ValueError(f"columns of {sizes} values: must be one, or one per axis")
        numbers = {column.name: column.kind for column in self.columns if column.size == 1}
        if missing := [name for name in ("t", "tick") if name not in numbers]:
            raise ValueError(
                f"the columns t and tick are those a row is known by: {' and '.join(missing)} is missing"
            )
        if numbers["t"] == "bool" or numbers["tick"] in ("bool", "float64"):
            raise ValueError("the columns t and tick must be numbers, tick a whole one")
        if any(column.name.startswith("#") for column in self.columns):
            raise ValueError("no column of a log has a name that begins with #")
        return self

    @property
    def packed(self) -> list[LoggedColumn]:
        """The columns in their order within a message."""
        return sorted(self.columns, key=lambda column: -column.width)

    def to_json(self) -> str:
        """Return the columns as JSON, as they stand in the channel's metadata under `columns`."""
        return json.dumps([vars(column) for column in self.columns])

    def ros2msg(self) -> str:
        """Return the definition of the message, each field with its unit."""
        lines = ["# One tick of the loop; SI units. Columns of a trace, with _ for the dot."]
        for c in self.packed:
            kind = c.kind if c.size == 1 else f"{c.kind}[{c.size}]"
            comment = " ".join(f"[{c.unit}] {c.meaning}".split())  # a line each
            lines.append(f"{kind} {c.field}  # {comment}")
        return "\n".join(lines) + "\n"

    @functools.cached_property
    def record(self) -> np.dtype[Any]:
        """A whole message record as NumPy sees it."""
        fields: list[Any] = list(_ENVELOPE)
        for c in self.packed:
            form = _KINDS[c.kind].str
            fields.append((c.name, form) if c.size == 1 else (c.name, form, (c.size,)))
        return np.dtype(fields)

    @property
    def length(self) -> int:
        """Bytes of a message record behind its opcode and length."""
        return self.record.itemsize - _BEFORE_DATA

    def pack(
        self, data: Mapping[str, NDArray[Any]], *, channel: int, start_ns: int
    ) -> NDArray[Any]:
        """Return rows as message records.

        Parameters
        ----------
        data : mapping
            Columns of the trace, shape (rows,) or (rows, axes).
        channel : int
            Number of the channel.
        start_ns : int
            When t was 0 [ns]; the time of a message is that of its row.
        """
        rows = np.empty(len(data["t"]), self.record)
        rows["#opcode"] = MESSAGE
        rows["#length"] = self.length
        rows["#channel"] = channel
        rows["#sequence"] = data["tick"].astype(np.uint64) & 0xFFFFFFFF
        nanoseconds = np.rint(np.nan_to_num(1e9 * data["t"], nan=0, posinf=0, neginf=0))
        rows["#log_time"] = np.maximum(0, start_ns + nanoseconds.astype(np.int64))
        rows["#publish_time"] = rows["#log_time"]
        rows["#cdr"] = CDR_LITTLE_ENDIAN
        for column in self.columns:
            rows[column.name] = data[column.name]
        return rows

    def only_rows(self, chunk: bytes, channel: int) -> bool:
        """Return whether the content of a chunk is whole records of this channel and nothing else."""
        ours = self._head(channel)
        whole = len(chunk) % self.record.itemsize == 0
        return whole and self._run(chunk, 0, ours) * self.record.itemsize == len(chunk)

    def find(self, chunk: bytes, channel: int) -> list[bytes]:
        """Return the records of a channel in the content of a chunk, one piece for each unbroken run.

        Raises
        ------
        ValueError
            When the chunk ends inside a record.
        """
        record = self.record
        ours = self._head(channel)
        found: list[bytes] = []
        at = 0
        while at < len(chunk):
            stop = at + self._run(chunk, at, ours) * record.itemsize
            if stop > at:
                found.append(chunk[at:stop])
                at = stop
            elif at + _BEFORE_DATA > len(chunk):
                raise ValueError("a chunk ends inside a record")
            else:
                at += _BEFORE_DATA + int.from_bytes(chunk[at + 1 : at + _BEFORE_DATA], "little")
        if at > len(chunk):
            raise ValueError("a chunk ends inside a record")
        return found

    def _head(self, channel: int) -> bytes:
        """Return what every record of a row begins with."""
        return _MESSAGE_HEAD.pack(MESSAGE, self.length, channel)

    def _run(self, chunk: bytes, at: int, ours: bytes) -> int:
        """Return how many records in a row begin as ours do."""
        size = self.record.itemsize
        fit = (len(chunk) - at) // size
        if fit == 0 or chunk[at : at + len(ours)] != ours:
            return 0
        known = np.frombuffer(ours, np.uint8)
        same, step = (
            1,
            8,
        )  # looked at in growing steps: between rows and events in turn a run is short
        while same < fit:
            step = min(2 * step, fit - same)
            rows = np.frombuffer(chunk, np.uint8, step * size, at + same * size)
            alike = (rows.reshape(step, size)[:, : len(ours)] == known).all(axis=1)
            if not alike.all():
                return same + int(alike.argmin())
            same += step
        return same
