"""A run on hardware: a loop in a C++ thread that Python monitors, records and ends."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from ebac import _core
from ebac._util.at_user import warn
from ebac._util.exception_notes import noted_on
from ebac._util.foreign_worlds import foreign
from ebac._util.wrong_calls import plain_constructor
from ebac.hardware.current_parameters import CurrentParameters
from ebac.hardware.interrupts import Interrupts, OfParent
from ebac.hardware.lateness import loop_fault
from ebac.hardware.report import Report
from ebac.hardware.run_changes import RunChanges
from ebac.logs.about import SIMULATED_DRIVES
from ebac.trace import Trace

if TYPE_CHECKING:
    from ebac.hardware.axis_positions import AxisPosition
    from ebac.laws import CoreLaw
    from ebac.logs import Recorder
    from ebac.scenario import Scenario

#: How often the main thread looks after the loop [s]: a signal is late by at most this.
LOOK = 0.02


@plain_constructor
class Run(RunChanges):
    """A running loop. `OpenDevice.start` returns it; a context manager that ends the run.

    The first of these ends it: its time, a fault, `stop`, an exception, a signal, the end of the program or of its
    parent. In each case the force goes to zero and the drives have no power afterwards.
    """

    _nodes: Sequence[int] = ()  # of the drives, by axis

    def __init__(
        self,
        running: _core.Running,
        *,
        law: CoreLaw,
        scenario: Scenario,
        interrupts: Interrupts,
        power_off: Callable[[], list[str]],
        grants: Sequence[_core.Grant] = (),
        hand: bool = False,
        detached: bool = False,
        positions: Sequence[AxisPosition] = (),
    ) -> None:
        self.recorder: Recorder | None = None
        self.report: Report | None = None
        self._ended_by = ""
        super().__init__(
            running,
            scenario,
            CurrentParameters(running, law=law, scenario=scenario, hand=hand),
            origin=SIMULATED_DRIVES if hand else "",  # a simulated hand holds a simulated device
        )
        self._interrupts = interrupts
        interrupts.hurry = lambda: running.stop(at_once=True)
        self._power_off = power_off
        self._positions = tuple(positions)
        self._nodes = [one.node for one in self._positions]
        self._grants = [*running.grants, *grants]
        self._parent = None if detached else OfParent(self._parent_is_gone)

    @property
    def grants(self) -> list[_core.Grant]:
        """What its threads requested from the system and were granted: the loop's, then those of simulated parts."""
        return list(self._grants)

    def stop(self, *, at_once: bool = False, by: str = "stop") -> None:
        """Request the end of the run: the force is ramped to zero and the drives lose power. `finish` waits for it.

        Parameters
        ----------
        at_once : bool
            Whether the ramp is omitted, so that the force is zero from the next tick on.
        by : str
            Value of `Report.ended_by`.
        """
        self._note_end(by)
        self._running.stop(at_once=at_once)

    def record(
        self,
        path: Path,
        *,
        files: Mapping[str, str],
        sync: float | None = None,
        file: io.FileIO | None = None,
        first: int = 0,
    ) -> None:
        """Write the rows from number `first` on to a log, in a separate thread."""
        from ebac.logs import Recorder

        self.recorder = Recorder(
            self._running.rows,
            path,
            scenario=self._scenario,
            law=self.law.name,
            law_repr=repr(self.law),
            files=files,
            watch=self._parameters.updates.events,
            sync=sync,
            start=time.time() - self._age(),
            first=first,
            file=file,
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
            Called about 50 times a second with this run. An exception from it ends the run.
        """
        while not self._running.wait(LOOK):
            look(self)
            if self.recorder is not None and self.recorder.error is not None:
                self._note_end("recorder")
                self._running.stop()

    def finish(self) -> Trace:
        """End the loop if it runs, check that the drives have no power, close the log, and return the rows in memory.

        Raises
        ------
        LoopFault
            When the loop ended by a fault; it contains the rows.
        DriveError
            When it could not be confirmed that a drive has no power.
        OSError
            When the log could not be written completely.
        """
        self.end()
        trace = self.trace()
        if fault := loop_fault(trace, self._nodes):
            raise fault
        world = foreign(self._parameters.world)
        if world is not None and (remark := world.remark()):
            warn(remark)
        return trace

    def end(self) -> None:
        """End the loop, switch the power off and close the log. A second call does nothing.

        Raises the same errors as `finish`, except `LoopFault`: where the loop ended by one, it is the cause of the
        error that is raised.
        """
        with self._lock:
            if self.report is not None:
                return
            self._interrupts.ending()
            self._running.stop()
            while not self._running.wait(LOOK):  # a second Ctrl-C is taken in between
                pass
            self._running.join()
            if self._parent is not None:
                self._parent.over.set()
                self._parent = None  # it holds this run, whose rows are many
            failures: list[Exception] = []
            drives: list[str] = []
            try:
                drives = self._power_off()
            except Exception as error:
                failures.append(error)
            if self.recorder is not None:
                try:
                    self.recorder.close()
                except Exception as error:
                    failures.append(error)
            self.report = Report.of(
                self._running,
                recorder=self.recorder,
                drives=drives,
                grants=self._grants,
                positions=self._positions,
                ended_by=self._ended_by,
                by_signal=self._interrupts.first,
            )
        for other in failures[1:]:
            failures[0].add_note(str(other))
        if failures:
            self._interrupts.forget()
            fault = None
            if self._running.state is _core.LoopState.FAULT:
                fault = loop_fault(self.trace(), self._nodes)
                failures[0].add_note(f"before that: {fault}")
            raise failures[0] from fault
        self._interrupts.settled()

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

    def _parent_is_gone(self) -> None:
        self._note_end("parent")
        self.end()
