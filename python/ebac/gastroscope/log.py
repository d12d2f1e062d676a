"""The record of a gastroscopy as a log: a row for each row of the record, its events and its parameters beside it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._util import serialisation
from ebac.trace import Trace
from ebac.trace.columns import ColumnInfo

if TYPE_CHECKING:
    from ebac.gastroscope.procedure import Gastroscopy, Procedure
    from ebac.logs.events import Event

#: Attached to a log: what was run, beside the joystick and the hand of `scenario.toml`.
PROCEDURE_FILE = "gastroscopy.json"


def trace_of(run: Gastroscopy) -> Trace:
    """Return the record as a trace: `tick` and `fault` beside its own columns."""
    scenario = run.procedure.scenario()
    columns = {
        name: ColumnInfo(name=name, unit=unit, meaning=meaning)
        for name, unit, meaning in _core._procedure_fields()
    }
    columns["tick"] = ColumnInfo(name="tick", unit="1", meaning="number of the row of the record")
    columns["fault"] = ColumnInfo(name="fault", unit="1", meaning="0, or why the loop stopped")
    tick = _ticks(run)
    fault = np.zeros(len(tick), np.int32)
    fault[-1:] = int(run.findings["fault"])
    return Trace(
        data={"tick": tick, **run.rows, "fault": fault},
        columns=columns,
        axes=1,
        scenario=scenario,
        law=run.law,
        origin="simulated",
    )


def _ticks(run: Gastroscopy) -> NDArray[np.int64]:
    """Return the number of each row: a log counts as lost what its numbers leave out, not what nobody has kept."""
    return np.arange(len(run.rows["t"]), dtype=np.int64)


def events_of(run: Gastroscopy) -> list[Event]:
    """Return touches, the first row of each time above the limit, and the end at the pylorus or by a fault."""
    from ebac.logs.events import Event, fault_name

    rows, limit = run.rows, run.procedure.lumen.patient.force_limit
    tick = _ticks(run)
    found: list[Event] = []

    def note(row: int, kind: str, message: str, **values: Any) -> None:
        found.append(
            Event(
                kind=kind,
                message=message,
                tick=int(tick[row]),
                t=float(rows["t"][row]),
                values=values,
            )
        )

    for row in np.flatnonzero(np.diff(rows["touched"], prepend=0.0) > 0):
        number = int(rows["touched"][row])
        note(int(row), "touch", f"target {number} touched", place_m=float(rows["place"][row]))
    above = rows["section_force"] > limit
    for row in np.flatnonzero(above & ~np.concatenate([[False], above[:-1]])):
        force = float(rows["section_force"][row])
        note(int(row), "limit", f"force above {limit:g} N", force_N=force)
    fault = int(run.findings["fault"])
    if len(tick) and fault:
        note(len(tick) - 1, "fault", fault_name(fault), fault=fault)
    elif len(tick) and run.findings["reached"]:
        note(len(tick) - 1, "pylorus", "pylorus passed")
    return sorted(found, key=lambda event: event.tick)


def write_log(run: Gastroscopy, path: Path) -> None:
    """Write an MCAP file; it appears when it is whole, and replaces one of that name."""
    from ebac._util.atomic_file import draft
    from ebac.logs.files import CHUNK_ROWS, about_trace
    from ebac.logs.layout import Layout
    from ebac.logs.writer import LogWriter

    trace, events = trace_of(run), events_of(run)
    data = {name: trace[name] for name in trace}
    about = about_trace(trace, {PROCEDURE_FILE: _document(run.procedure, run.findings)})
    with (
        draft(path) as name,
        LogWriter(name, layout=Layout.of(data, trace.columns), about=about) as log,
    ):
        for first in range(0, len(trace), CHUNK_ROWS):
            part = {column: v[first : first + CHUNK_ROWS] for column, v in data.items()}
            low, high = int(part["tick"][0]), int(part["tick"][-1])
            log.write(part, [event for event in events if low <= event.tick <= high])
        log.close(rows=len(trace), lost=0)


def _document(procedure: Procedure, findings: dict[str, float]) -> str:
    parts = {
        "scope": procedure.scope,
        "patient": procedure.lumen.patient,
        "master": procedure.master,
        "physician": procedure.physician,
    }
    document = {name: serialisation.to_document(part) for name, part in parts.items()}
    targets = [serialisation.to_document(polyp) for polyp in procedure.polyps()]
    started = {"start_m": procedure.start, "seed": procedure.seed}
    return json.dumps({**document, "targets": targets, **started, "findings": findings}, indent=2)
