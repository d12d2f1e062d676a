"""What is new in the rows of a running loop, chunk by chunk."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ebac._util.plural import plural
from ebac.logs.events import Event, faults_of
from ebac.trace.columns import row_views

if TYPE_CHECKING:
    from ebac._core import Rows

#: Rows of one chunk at most: more wait for the next, so that a late reader catches up in steps.
MOST_ROWS = 16_384


class LastRow(NamedTuple):
    """Tick, time [s] and fault of a row."""

    tick: int
    t: float
    fault: int


@dataclass(frozen=True, kw_only=True)
class Chunk:
    """Some rows as columns, what happened in them, how many before them were lost, and whether more wait."""

    data: Mapping[str, NDArray[Any]]
    events: list[Event]
    lost: int
    stop: int
    more: bool

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.data["t"])


class NewRows:
    """Reads the rows of a loop, of any length or a ring, from a first one on; those written over before are lost.

    Parameters
    ----------
    rows : Rows
        Of the loop.
    first : int
        Number of the first row to read.
    """

    def __init__(self, rows: Rows, first: int) -> None:
        self._rows = rows
        self._seen = first
        self.last = LastRow(-1, 0.0, 0)

    def next(self) -> Chunk:
        """Return the next chunk; it counts as read once it is given to `done`."""
        start, count = max(self._seen, self._rows.first), self._rows.count
        stop = min(count, start + MOST_ROWS)
        first, raw = self._rows.copy(start, stop)
        data = row_views(self._rows, raw)
        lost = max(0, first - self._seen)
        events = [self._loss(lost, data)] if lost else []
        events += faults_of(data, self.last.fault)
        return Chunk(data=data, events=events, lost=lost, stop=stop, more=stop < count)

    def done(self, chunk: Chunk) -> None:
        """Go on behind a chunk."""
        self._seen = chunk.stop
        data = chunk.data
        if len(chunk):
            tick, t, fault = data["tick"][-1], data["t"][-1], data["fault"][-1]
            self.last = LastRow(int(tick), float(t), int(fault))

    def time_of(self, tick: int) -> float:
        """Return the time of a tick that was read [s]: that of its row, or of the nearest one in memory."""
        seen, last = self._seen, self.last
        wanted = seen - 1 - max(0, last.tick - tick)
        earliest = min(max(self._rows.first, wanted), seen)  # a ring may have passed all of them
        _, raw = self._rows.copy(earliest, seen)
        rows = row_views(self._rows, raw)
        if not len(rows["t"]):
            return last.t
        return float(rows["t"][int(np.abs(rows["tick"] - tick).argmin())])

    def _loss(self, rows: int, data: Mapping[str, NDArray[Any]]) -> Event:
        tick, t, _ = self.last
        if len(data["t"]):
            tick, t = int(data["tick"][0]), float(data["t"][0])
        were, they = ("was", "it was") if rows == 1 else ("were", "they were")
        message = (
            f"{plural(rows, 'row')} before tick {tick} {were} written over before {they} recorded"
        )
        return Event(kind="lost", message=message, tick=tick, t=t, values={"rows": rows})
