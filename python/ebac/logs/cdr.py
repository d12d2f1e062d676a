"""CDR, the encoding of ROS 2 messages: laid out once, then filled for many rows at a time by NumPy."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

_LITTLE_ENDIAN = b"\x00\x01\x00\x00"


class Cdr:
    """A message under way: constants, and room for what differs from row to row.

    Each number is aligned to its own size, counted from behind the four bytes of the header.
    """

    def __init__(self) -> None:
        self._data = bytearray(_LITTLE_ENDIAN)
        self._room: dict[str, tuple[Any, int]] = {}

    def put(self, form: str, value: float) -> None:
        """Append a number in a form of `struct`."""
        self._align(struct.calcsize(form))
        self._data += struct.pack("<" + form, value)

    def text(self, text: str) -> None:
        """Append a string."""
        data = text.encode(errors="replace").replace(b"\0", b" ") + b"\0"
        self.put("I", len(data))
        self._data += data

    def room(self, name: str, form: str, size: int = 1) -> None:
        """Leave room for `size` numbers of a NumPy form, none for 0."""
        width = np.dtype(form).itemsize
        if size:
            self._align(width)
            self._room[name] = ((form, (size,)) if size > 1 else form, len(self._data))
        self._data += bytes(width * size)

    def rows(self, number: int) -> tuple[NDArray[Any], bytearray]:
        """Return this many messages: what has room in them, by name, and the bytes in which it lies."""
        data = self._data * number
        names = list(self._room)
        forms, offsets = zip(*self._room.values(), strict=True)
        layout = np.dtype(
            {
                "names": names,
                "formats": list(forms),
                "offsets": list(offsets),
                "itemsize": len(self._data),
            }
        )
        return np.frombuffer(data, layout), data

    def __bytes__(self) -> bytes:
        """Return the message."""
        return bytes(self._data)

    def __len__(self) -> int:
        """Return its bytes."""
        return len(self._data)

    def _align(self, width: int) -> None:
        self._data += bytes((len(_LITTLE_ENDIAN) - len(self._data)) % width)
