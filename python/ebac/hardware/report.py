"""How a run went, beside its rows."""

from __future__ import annotations

import signal
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ebac._core import Grant, LoopState, Running
from ebac.trace import Trace

if TYPE_CHECKING:
    from ebac.hardware.axis_positions import AxisPosition
    from ebac.logs import Recorder


@dataclass(frozen=True, kw_only=True)
class Report:
    """How a run went, beside its rows. SI units, the unit in the name.

    Attributes
    ----------
    ended_by : str
        "time", "fault", "stop", "key", "parent", "exception", "recorder", or the name of a signal such as "SIGINT".
    log : Path or None
        The log.
    ticks, recorded, lost_rows : int
        Ticks of the loop, rows in the log, and rows written over before they were recorded.
    changes_lost : int
        Changes that acted but of which no note was kept.
    drives : tuple of str
        State of each drive, asked after the run.
    positions : tuple of AxisPosition
        Where each axis stood before it had power, and the zero it was counted from; none on a virtual clock.
    grants : tuple of Grant
        What its threads asked of the system, and got: the loop's, then those of what is simulated.
    sent, received, refused, lost_frames : int
        Frames at the loop's end of the bus.
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
        """Return how a loop went that has ended: by a fault, a signal, or what else is known, else by its time."""
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
        """Return how a run on a virtual clock went: nothing was late or lost, and no drive is left to ask."""
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
    """How quick and how punctual a loop was. Times in s.

    Attributes
    ----------
    compute_p50_s, compute_p99_9_s, compute_most_s : float
        From wake-up to the end of the tick, less the exchange with the drives.
    exchange_p50_s, exchange_p99_9_s : float
        The exchange, waiting for the drives' answers included.
    late_p50_s, late_p99_9_s, late_most_s : float
        Wake-up after the planned instant.
    skipped : int
        Ticks that could not be kept.
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

    Raises
    ------
    ValueError
        When the trace has no rows, or is not of a run in real time.
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


def under_the_law(trace: Trace) -> Trace:
    """Return the rows in which the law acted, their time from its first tick on."""
    rows = np.flatnonzero(trace["state"] == int(LoopState.RUN))
    if not len(rows):
        return trace.rows(0, 0)
    part = trace.rows(int(rows[0]), int(rows[-1]) + 1)
    return part.with_column("t", part["t"] - part["t"][0])
