"""A run on hardware: a loop in a thread of C++, watched, told, recorded and ended from Python."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from ebac import _core
from ebac.columns import column_infos, row_views
from ebac.drives.errors import DriveError
from ebac.hardware.interrupts import Interrupts, Parent
from ebac.hardware.report import Report
from ebac.hardware.told import Note, Told
from ebac.leaving import noted_on
from ebac.trace import Trace

if TYPE_CHECKING:
    from ebac.laws import CoreLaw
    from ebac.logs import Recorder
    from ebac.scenario import Environment, Scenario

#: How often the main thread looks after the loop [s]: a signal is late by at most this.
LOOK = 0.02
#: How often somebody looks whether the parent is still there [s].
PARENT = 0.1


class Run:
    """A loop at work. Get it from `OpenDevice.start`; a context manager that ends it.

    Whatever comes first ends it: its time, a fault, `stop`, an exception, a signal, the end of the program or of its
    parent. Each ends in zero force and drives without power.
    """

    def __init__(
        self,
        running: _core.Running,
        *,
        law: CoreLaw,
        scenario: Scenario,
        interrupts: Interrupts,
        power_off: Callable[[], list[str]],
        detached: bool = False,
    ) -> None:
        self.recorder: Recorder | None = None
        self.report: Report | None = None
        self._ended_by = ""
        self._running = running
        self._interrupts = interrupts
        self._power_off = power_off
        self._law = law
        self._scenario = scenario
        self._world: Environment = scenario.environment
        self._told = Told(running, scenario.timing.dt)
        self._lock = threading.RLock()  # who changes or ends it
        self._over = threading.Event()
        self._watcher = threading.Thread(target=self._watch, name="ebac-parent", daemon=True)
        if not detached:
            self._watcher.start()

    # --- while it runs ---

    @property
    def done(self) -> bool:
        """Whether the loop has ended."""
        return self._running.done

    @property
    def ticks(self) -> int:
        """Rows so far."""
        return self._running.rows.count

    @property
    def grants(self) -> list[_core.Grant]:
        """What the loop's thread asked of the system, and what it got."""
        return self._running.grants

    @property
    def law(self) -> CoreLaw:
        """The law with its newest gains."""
        return self._law

    @property
    def environment(self) -> Environment:
        """The newest virtual world."""
        return self._world

    def tail(self, rows: int = 1000) -> Trace:
        """Return a copy of the last rows, also while it runs.

        Parameters
        ----------
        rows : int
            How many at most, at least 1.

        Returns
        -------
        Trace

        Raises
        ------
        ValueError
            For a number below 1.
        """
        if rows < 1:
            raise ValueError(f"rows = {rows}: must be at least 1")
        all_rows = self._running.rows
        stop = all_rows.count
        _, raw = all_rows.copy(max(all_rows.first, stop - rows), stop)
        return Trace(
            data=row_views(all_rows, raw),
            columns=column_infos(all_rows),
            axes=all_rows.axes,
            scenario=self._scenario,
            law=self._law.name,
            law_repr=repr(self._law),
        )

    @property
    def state(self) -> _core.LoopState:
        """Where the loop stands: arm, run, stop, idle or fault."""
        if self.done:
            return self._running.state
        last = self.tail(1)
        return _core.LoopState(int(last["state"][-1])) if len(last) else _core.LoopState.ARM

    def retune(self, **changes: Any) -> CoreLaw:
        """Change parameters of the law from the next tick on; its memory stays. Return the law with its new gains.

        Parameters
        ----------
        **changes
            In their SI units. What the law knows of the device cannot change while it runs.

        Raises
        ------
        ValueError
            For a number out of range, or one that cannot change.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            before, after = self._law, self._law.replace(**changes)
            parts = [
                f"{name} {getattr(before, name)!r} -> {value!r}" for name, value in changes.items()
            ]
            note = Note(
                message=f"law {after.name}: {', '.join(parts)}",
                values={f"law.{name}": value for name, value in changes.items()},
            )
            self._told.send(lambda: self._running.retune(after), note)
            self._law = after
            return after

    def change(self, environment: Environment | None = None, **changes: Any) -> Environment:
        """Change the virtual world from the next tick on: another one, or numbers of the present one. Return it.

        Parameters
        ----------
        environment : Free, Wall, Corner or Disc, optional
            The new one; the present one, if not given.
        **changes
            Numbers of it, in SI units: `stiffness=5e3`.

        Raises
        ------
        ValueError, TypeError
            For a number out of range, or a name it does not have.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            world = self._world if environment is None else environment
            world = world.replace(**changes) if changes else world
            note = Note(
                message=f"environment {world!r}",
                values={f"environment.{name}": value for name, value in changes.items()},
            )
            self._told.send(lambda: self._running.change_world(world), note)
            self._world = world
            return world

    def _check(self) -> None:
        if self.done:
            raise RuntimeError("the loop has ended: start another run")

    # --- its end ---

    def stop(self) -> None:
        """Ask for the end: force ramped to zero, drives without power. `finish` waits for it."""
        self._note_end("stop")
        self._running.stop()

    def record(self, path: Path, *, files: Mapping[str, str], sync: float | None = None) -> None:
        """Write the rows to a log from here on, in a thread of its own."""
        from ebac.logs import Recorder

        self.recorder = Recorder(
            self._running.rows,
            path,
            scenario=self._scenario,
            law=self._law.name,
            law_repr=repr(self._law),
            files=files,
            watch=self._told.events,
            sync=sync,
            start=time.time() - self._age(),
        )

    def _age(self) -> float:
        """Return the time since the loop's first tick [s]."""
        last = self.tail(1)
        return float(last["t"][-1]) if len(last) else 0.0

    def wait(self, *, look: Callable[[Run], None] = lambda run: None) -> None:
        """Wait for the end of the loop.

        Parameters
        ----------
        look : callable
            Called about 50 times a second with this run; what it raises ends the run.
        """
        while not self._running.wait(LOOK):
            look(self)
            if self.recorder is not None and self.recorder.error is not None:
                self._note_end("recorder")
                self._running.stop()

    def finish(self) -> Trace:
        """End the loop if it runs, see that the drives have no power, close the log; return the rows in memory.

        Raises
        ------
        LoopFault
            When the loop ended by a fault; it carries the rows.
        DriveError
            When a drive could not be seen to be without power.
        OSError
            When the log could not be written to its end.
        """
        self.end()
        trace = self.trace()
        fault = _core.Fault(int(trace["fault"][-1])) if len(trace) else _core.Fault.NONE
        if fault is not _core.Fault.NONE:
            from ebac.simulation import LoopFault

            raise LoopFault(fault, trace)
        return trace

    def end(self) -> None:
        """End the loop, power off, close the log; nothing the second time. Raises as `finish`, but for a fault."""
        with self._lock:
            if self.report is not None:
                return
            self._interrupts.ending()
            self._running.stop()
            self._running.join()
            self._over.set()
            failures: list[Exception] = []
            drives: list[str] = []
            try:
                drives = self._power_off()
            except DriveError as error:
                failures.append(error)
            if self.recorder is not None:
                try:
                    self.recorder.close()
                except OSError as error:
                    failures.append(error)
            self.report = self._report(drives)
        for other in failures[1:]:
            failures[0].add_note(str(other))
        if failures:
            self._interrupts.forget()
            raise failures[0]
        self._interrupts.settled()

    def _report(self, drives: list[str]) -> Report:
        bus, recorder = self._running.bus, self.recorder
        return Report(
            ended_by=self._why(),
            log=None if recorder is None else recorder.path,
            ticks=self._running.rows.count,
            recorded=0 if recorder is None else recorder.written,
            lost_rows=0 if recorder is None else recorder.lost,
            changes_lost=self._running.changes_lost,
            drives=tuple(drives),
            grants=tuple(self._running.grants),
            sent=bus.sent,
            received=bus.received,
            refused=bus.refused,
            lost_frames=bus.lost,
        )

    def _why(self) -> str:
        if self._running.state is _core.LoopState.FAULT:
            return "fault"
        if self._interrupts.first is not None:
            return signal.Signals(self._interrupts.first).name
        return self._ended_by or "time"

    def trace(self) -> Trace:
        """Return all rows in memory, shared and not copied where they are no ring's."""
        return Trace.from_rows(
            self._running.rows,
            scenario=self._scenario,
            law=self._law.name,
            law_repr=repr(self._law),
        )

    def __enter__(self) -> Run:
        """Return the run."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End it, whatever was raised."""
        if error is not None:
            self._note_end("exception")
        with noted_on(error, "and at the end of the run"):
            self.end()

    def _note_end(self, by: str) -> None:
        if not self._ended_by and not self.done:
            self._ended_by = by

    def _watch(self) -> None:
        """End the run when the parent has died: nobody is left who could."""
        parent = Parent()
        while not self._over.wait(PARENT):
            if parent.gone:
                self._note_end("parent")
                self.end()
                return
