"""Record parameter updates of a running loop as log events."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from ebac import _core
from ebac.logs.events import Event
from ebac.trace.columns import row_views


@dataclass(frozen=True, kw_only=True)
class Note:
    """Log entry of an update once the loop has taken it: text, and numbers with units in the key."""

    message: str
    values: dict[str, Any] = field(default_factory=dict)


class ParameterUpdates:
    """The values sent to a loop, by their serial numbers, until the loop has taken them. Any thread."""

    def __init__(self, running: _core.Running, dt: float) -> None:
        self._running = running
        self._dt = dt
        self._notes: dict[int, tuple[str, Note]] = {}
        self._seen = 0
        self.sent = False
        self._lock = threading.Lock()

    def send(self, what: str, post: Callable[[], int], note: Note) -> None:
        """Send a value of `what` by `post`, which returns its serial number."""
        with self._lock:  # nobody asks for the note before it is there
            self._notes[post()] = what, note
            self.sent = True

    def _note(self, what: str, serial: int) -> Note:
        """Return the note of a value that was taken, and forget those that it replaced before they were."""
        with self._lock:
            _, note = self._notes.pop(serial, (what, Note(message=what)))
            replaced = [s for s, (other, _) in self._notes.items() if other == what and s < serial]
            for one in replaced:
                del self._notes[one]
        return note

    def events(self) -> list[Event]:
        """Return what the loop has taken since the last call, once the rows of it are there."""
        count = self._running.rows.count
        found: list[Event] = []
        for tick, serial, what in self._running.changes(self._seen):
            if tick >= count and not self._running.done:
                break
            self._seen += 1
            note = self._note(what, serial)
            found.append(
                Event(
                    kind="parameter",
                    message=note.message,
                    tick=tick,
                    t=self._time_of(tick),
                    values=note.values,
                )
            )
        return found

    def _time_of(self, tick: int) -> float:
        rows = self._running.rows
        if rows.first <= tick < rows.count:
            first, raw = rows.copy(tick, tick + 1)
            if first == tick and len(raw):
                return float(row_views(rows, raw)["t"][0])
        return tick * self._dt
