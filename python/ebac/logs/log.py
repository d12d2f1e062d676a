"""Contents of a log: rows, events, and all that stands beside them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ebac._util.plural import plural
from ebac.logs.about import About
from ebac.logs.events import Event
from ebac.logs.records import Condition
from ebac.logs.ticks import ticks_of
from ebac.trace import Trace


@dataclass(frozen=True, kw_only=True)
class Gap:
    """Ticks that are not in a log.

    Attributes
    ----------
    after_tick : int
        Number of the last row before it.
    t : float
        Time of that row [s].
    rows : int
        Rows missing; 0 or less where the number of the tick stands still or goes back.
    """

    after_tick: int
    t: float
    rows: int


@dataclass(frozen=True, kw_only=True)
class Log:
    """What a log holds.

    Attributes
    ----------
    path : Path
        The file.
    trace : Trace
        Its rows, with law and scenario.
    events : list of Event
        Parameter changes, faults, rows lost.
    about : About
        Law, scenario, versions, machine, attachments.
    condition : Condition
        Whether the file is complete, and what is wrong with it.
    ended : dict
        What was known at the end: rows written, rows lost; empty for a log that was cut.
    bytes : int
        Size of the file.
    """

    path: Path
    trace: Trace
    events: list[Event]
    about: About
    condition: Condition
    ended: dict[str, str]
    bytes: int

    @property
    def lost(self) -> int:
        """Rows missing between the first row and the last."""
        return sum(max(0, gap.rows) for gap in self.gaps)

    @property
    def gaps(self) -> list[Gap]:
        """Where rows are missing between two rows of the log; by their times where it has no column `tick`."""
        t = self.trace["t"]
        tick = self.trace["tick"] if "tick" in self.trace else ticks_of(t)
        steps = np.diff(tick.astype(np.int64))
        return [
            Gap(after_tick=int(tick[i]), t=float(t[i]), rows=int(steps[i]) - 1)
            for i in np.flatnonzero(steps != 1)
        ]

    @property
    def faults(self) -> list[tuple[int, float, int]]:
        """Number of the fault, time [s] and tick of each row in which one appears or changes."""
        fault = self.trace["fault"] if "fault" in self.trace else np.zeros(len(self.trace))
        new = np.flatnonzero((fault != 0) & (np.diff(fault, prepend=0) != 0))
        t = self.trace["t"]
        tick = self.trace["tick"] if "tick" in self.trace else np.arange(len(t))
        return [(int(fault[i]), float(t[i]), int(tick[i])) for i in new]

    def __repr__(self) -> str:
        """Return one line: file, rows, events, condition."""
        return f"<Log {self.path.name}: {self.trace!r}, {plural(len(self.events), 'event')}; {self.condition}>"
