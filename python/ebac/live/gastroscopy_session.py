"""A gastroscopy that runs in real time, beside whatever shows it."""

from __future__ import annotations

import threading
import time
from collections import deque
from types import TracebackType
from typing import Any, Self

from ebac import _core
from ebac.gastroscope import Procedure
from ebac.gastroscope.procedure import core_law
from ebac.laws import AnyLaw, law_name
from ebac.laws.tuned_laws import on_its_observer

#: Time from look to look [s], and how far the strips look back [s].
LOOK, BACK = 1 / 50, 10.0
#: Behind by more than this the page's time stands still [s].
LATEST = 0.2


class _NoHand:
    """A page leaves: the physician steers on."""

    def leave(self) -> None:
        """Do nothing."""


class GastroscopySession:
    """A gastroscopy that runs in real time, in a thread of its own. A context manager; from any thread.

    Parameters
    ----------
    law : law
        Of the joystick, of the core.
    procedure : Procedure, optional
        Default: `Procedure()`.

    Attributes
    ----------
    starts : int
        Runs so far.
    """

    def __init__(self, law: AnyLaw = "ebac", procedure: Procedure | None = None) -> None:
        self.procedure = Procedure() if procedure is None else procedure
        self._scenario = on_its_observer(self.procedure.scenario(), law)
        self._law: Any = core_law(law, self._scenario)
        self.law = law if isinstance(law, str) else law_name(self._law)
        self.hand = _NoHand()
        self.starts, self.running = 0, False
        self._lock = threading.RLock()
        self._over = threading.Event()
        self._thread: threading.Thread | None = None
        self._begin()
        self._thread = threading.Thread(target=self._go, name="ebac-gastroscopy", daemon=True)
        self._thread.start()

    def _begin(self) -> None:
        self._run = _core._Navigation(self.procedure.core(), self._scenario.setup(), self._law)
        self._run.advance(1)
        self.starts += 1
        self.recent: deque[dict[str, float]] = deque([self._run.row()], maxlen=round(BACK / LOOK))
        self._seen = 0  # rows taken, ever
        self._rows = 1
        self._due = time.monotonic()

    def start(self) -> None:
        """Let time go on; begin anew after the end."""
        with self._lock:
            if self._run.ended:
                self._begin()
            self._due = time.monotonic()
            self.running = True

    def pause(self) -> None:
        """Let time stand still."""
        self.running = False

    def reset(self) -> None:
        """Begin anew."""
        with self._lock:
            self._begin()
            self.running = True

    def advance(self, seconds: float) -> None:
        """Let so much time pass at once, in steps of 20 ms, whatever the clock says."""
        with self._lock:
            dt = self._scenario.timing.dt
            for _ in range(round(seconds / LOOK)):
                self._take(round(LOOK / dt))

    def let_go(self) -> None:
        """Nothing is held here."""

    hold = let_go

    def close(self) -> None:
        """End it."""
        self._over.set()
        if self._thread is not None:
            self._thread.join()

    def _go(self) -> None:
        dt = self._scenario.timing.dt
        while not self._over.wait(LOOK):
            with self._lock:
                if not self.running:
                    continue
                now = time.monotonic()
                self._due = max(self._due, now - LATEST)
                ticks = int((now - self._due) / dt)
                self._due += ticks * dt
                self._take(ticks)
                if self._run.ended:
                    self.running = False  # never True here: a pause takes no lock

    def _take(self, ticks: int) -> None:
        self._run.advance(ticks)
        self.recent.append(self._run.row())
        self._rows += 1

    def snapshot(
        self,
    ) -> tuple[dict[str, Any], dict[str, Any], dict[str, float], list[dict[str, float]], int]:
        """Return newest row, state of the slave, findings, rows since the last call, number of the run."""
        with self._lock:
            new = min(self._rows - self._seen, len(self.recent))
            self._seen = self._rows
            rows = list(self.recent)
            return (
                rows[-1],
                self._run.state(),
                self._run.findings(),
                rows[len(rows) - new :],
                self.starts,
            )

    def __enter__(self) -> Self:
        """Return the session."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End it."""
        self.close()
