"""Rows as they lie in a log, gathered into columns while they come."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.logs.layout import Layout

#: Rows that are spread over the columns at a time: this many stay in a processor's cache.
_BLOCK = 1024
#: Columns have room for this many times the rows so far, at most: the size a log announces may be wrong.
_GROWTH = 8


class Columns:
    """Columns that grow to what the log is likely to hold, so that nothing is copied twice."""

    def __init__(self, layout: Layout, start: float = -inf, stop: float = inf) -> None:
        self._layout = layout
        self._start, self._stop = start, stop
        self._part = (start, stop) != (-inf, inf)
        #: Time of the first and the last row that came, taken or not [s].
        self.span: tuple[float, float] | None = None
        self._rows = 0
        self._room = 0
        self._data = {
            c.name: np.empty((0, c.size) if c.size > 1 else 0, c.native) for c in layout.columns
        }

    def take(self, records: bytes, share: float) -> None:
        """Append message records; they and all before them are about this share of the log, 0 to 1."""
        rows = np.frombuffer(records, self._layout.record)
        t = rows["t"]
        if len(t):
            self.span = (float(t[0]) if self.span is None else self.span[0], float(t[-1]))
        if self._part:
            rows = rows[(t >= self._start) & (t < self._stop)]
        self._append(rows, share)

    def _append(self, rows: NDArray[Any], share: float) -> None:
        stop = self._rows + len(rows)
        if stop > self._room:
            self._make_room(stop, share)
        for first in range(0, len(rows), _BLOCK):
            block = rows[first : first + _BLOCK]
            at = self._rows + first
            for name, values in self._data.items():
                values[at : at + len(block)] = block[name]
        self._rows = stop

    def finish(self) -> dict[str, NDArray[Any]]:
        """Return the columns in the order of the layout; there is nothing more to take."""
        for values in self._data.values():
            values.resize(
                (self._rows, *values.shape[1:]), refcheck=False
            )  # gives back what is over
        return self._data

    def _make_room(self, rows: int, share: float) -> None:
        likely = int(1.02 * rows / max(share, 1e-9))
        self._room = max(rows, min(likely, _GROWTH * rows))
        for name, old in self._data.items():
            new = np.empty((self._room, *old.shape[1:]), old.dtype)
            new[: self._rows] = old[: self._rows]
            self._data[name] = new
