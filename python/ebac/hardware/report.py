"""Report of a run, in addition to its rows."""

from __future__ import annotations

import signal
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ebac._core import Grant, LoopState, Running
from ebac.hardware import report_text
from ebac.trace import Trace

if TYPE_CHECKING:
    from ebac.hardware.axis_positions import AxisPosition
    from ebac.logs import Recorder


@dataclass(frozen=True, kw_only=True, repr=False)
class Report:
    """Report of a run, in addition to its rows. SI units; the names contain the unit.

    Attributes
    ----------
    ended_by : str
        "time", "fault", "stop", "key", "parent", "exception", "recorder", or the name of a signal such as "SIGINT".
    log : Path or None
        File of the log.
    ticks, recorded, lost_rows : int
        Ticks of the loop, rows in the log, and rows that were overwritten before they were recorded.
    changes_lost : int
        Parameter updates that took effect but were not recorded.
    drives : tuple of str
        State of each drive, read after the run.
    positions : tuple of AxisPosition
        Position of each axis before its motor had power, and the zero used for it; none on a virtual clock.
    grants : tuple of Grant
        What its threads requested from the system and what was granted: the loop's, then those of simulated parts.
    sent, received, refused, lost_frames : int
        Numbers of frames at the loop's end of the bus.
    """

    ended_by: str
    log: Path | None
    ticks: int
    recorded: int
    lost_rows: int
    changes_lost: int
    drives: tuple[str, ...]
    positions: tuple[AxisPosition, ...]
    grants: tuple[Grant, ...]
    sent: int
    received: int
    refused: int
    lost_frames: int

    @classmethod
    def of(
        cls,
        running: Running,
        *,
        recorder: Recorder | None,
        drives: Sequence[str],
        grants: Sequence[Grant],
        positions: Sequence[AxisPosition],
        ended_by: str,
        by_signal: int | None,
    ) -> Self:
        """Return the report of a loop that has ended: by a fault, a signal, another known reason, or its time."""
        if running.state is LoopState.FAULT:
            ended_by = "fault"
        elif by_signal is not None:
            ended_by = signal.Signals(by_signal).name
        bus = running.bus
        return cls(
            ended_by=ended_by or "time",
            log=None if recorder is None else recorder.path,
            ticks=running.rows.count,
            recorded=0 if recorder is None else recorder.written,
            lost_rows=0 if recorder is None else recorder.lost,
            changes_lost=running.changes_lost,
            drives=tuple(drives),
            positions=tuple(positions),
            grants=tuple(grants),
            sent=bus.sent,
            received=bus.received,
            refused=bus.refused,
            lost_frames=bus.lost,
        )

    @classmethod
    def of_virtual(cls, trace: Trace, log: Path | None, *, fault: bool) -> Self:
        """Return the report of a run on a virtual clock: nothing is late or lost, and the state of no drive is read."""
        rows = len(trace)
        return cls(
            ended_by="fault" if fault else "time",
            log=log,
            ticks=rows,
            recorded=0 if log is None else rows,
            lost_rows=0,
            changes_lost=0,
            drives=(),
            positions=(),
            grants=(),
            sent=0,
            received=0,
            refused=0,
            lost_frames=0,
        )

    def __repr__(self) -> str:
        """Return how the run ended and what it left, in one line."""
        return report_text.one_line(self)

    def __str__(self) -> str:
        """Return every part of it, one a line."""
        return report_text.listed(self)

    def row(self) -> dict[str, Any]:
        """Return it as plain values."""
        values: dict[str, Any] = {one.name: getattr(self, one.name) for one in fields(self)}
        values["log"] = None if self.log is None else str(self.log)
        values["positions"] = [one.row() for one in self.positions]
        values["grants"] = [grant_row(one) for one in self.grants]
        return values


def grant_row(grant: Grant) -> dict[str, Any]:
    """Return a grant as plain values."""
    return {name: getattr(grant, name) for name in ("name", "asked", "granted", "why", "remedy")}


@dataclass(frozen=True, kw_only=True)
class Times:
    """Computation times and lateness of a loop [s].

    Attributes
    ----------
    compute_p50_s, compute_p99_9_s, compute_most_s : float
        Time from wake-up to the end of the tick, without the exchange with the drives.
    exchange_p50_s, exchange_p99_9_s : float
        Time of the exchange, including the wait for the drives' answers.
    late_p50_s, late_p99_9_s, late_most_s : float
        Delay of the wake-up after the planned instant.
    skipped : int
        Number of ticks that were skipped because the loop was late.
    """

    compute_p50_s: float
    compute_p99_9_s: float
    compute_most_s: float
    exchange_p50_s: float
    exchange_p99_9_s: float
    late_p50_s: float
    late_p99_9_s: float
    late_most_s: float
    skipped: int


def times(trace: Trace) -> Times:
    """Measure the ticks of a run in real time.

    Parameters
    ----------
    trace : Trace
        Of a run on drives or of simulated ones in real time.

    Raises
    ------
    ValueError
        When the trace has no rows or is not the trace of a run in real time.
    """
    if len(trace) == 0 or "time.busy" not in trace:
        raise ValueError("the trace has no times: it is empty, or of a simulation in virtual time")
    exchange = trace.axis("time.exchange")
    compute = np.maximum(trace.axis("time.busy") - exchange, 0.0)
    late = trace["lateness"]

    def part(values: Any, percent: float) -> float:
        return float(np.percentile(values, percent))

    return Times(
        compute_p50_s=part(compute, 50),
        compute_p99_9_s=part(compute, 99.9),
        compute_most_s=float(compute.max()),
        exchange_p50_s=part(exchange, 50),
        exchange_p99_9_s=part(exchange, 99.9),
        late_p50_s=part(late, 50),
        late_p99_9_s=part(late, 99.9),
        late_most_s=float(late.max()),
        skipped=int(trace["skipped"].sum()),
    )
