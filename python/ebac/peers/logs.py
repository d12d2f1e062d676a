"""How quickly logs are written and read, beside the official reader."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from ebac.peers.row import PeerRow

if TYPE_CHECKING:
    from ebac.trace import Trace

#: Rows of a log, and how many of them the official reader gets to read: it takes them one by one.
ROWS, FEW = 1_000_000, 50_000
#: How often a log is read; the quickest counts.
READINGS = 3
#: Rows a chunk: as a recorder writes them at 1 kHz, and as `Trace.save` does.
CHUNKS = {"recorded": 20, "saved": 2048}
AIM = "1,000,000 rows/s"
#: How often `compare_logs` calls `step`.
STEPS = 3 * len(CHUNKS)


def compare_logs(
    *, rows: int = ROWS, step: Callable[[str], None] = lambda name: None
) -> list[PeerRow]:
    """Write and read logs of a simulated joystick of two axes.

    Parameters
    ----------
    rows : int
        Of each log.
    step : callable
        Called with what comes next, `STEPS` times.

    Returns
    -------
    list of PeerRow
        Rows per second [1/s]; `times_ebac` compares with ebac's own reader on the same log.
    """
    trace = _trace()
    size = sum(trace[name].nbytes for name in trace) // len(trace)
    found: list[PeerRow] = []
    with tempfile.TemporaryDirectory() as folder:
        for kind, chunk in CHUNKS.items():
            path = Path(folder) / f"{kind}.mcap"
            step(f"writing, {kind}")
            writing = _write(trace, path, rows, chunk)
            step(f"reading, {kind}")
            reading = _read(path, rows)
            step(f"reading, {kind}, official")
            official = _official(path, min(rows, FEW))
            path.unlink()
            found += [
                PeerRow(subject=f"read a log as {kind}", program="ebac", value=reading, unit="1/s", times_ebac=1.0,
                        target=AIM, note=f"a row of {size} bytes becomes one of a trace"),
                PeerRow(subject=f"read a log as {kind}", program="mcap", value=official, unit="1/s",
                        times_ebac=official / reading, note="the official reader gives its bytes, not decoded"),
                PeerRow(subject=f"write a log as {kind}", program="ebac", value=writing, unit="1/s",
                        note=f"a row of a trace becomes {size} bytes, packed"),
            ]  # fmt: skip
    return found


def _trace() -> Trace:
    from ebac import Device, Linear, Scenario, simulate

    return simulate(Scenario(device=Device(kinematics=Linear(axes=2)), seconds=5), "ebac")


def _write(trace: Trace, path: Path, rows: int, chunk: int) -> float:
    from ebac.logs.about import About
    from ebac.logs.layout import Layout
    from ebac.logs.writer import LogWriter

    data = {name: trace[name] for name in trace}
    about = About(axes=trace.axes, law=trace.law, scenario=trace.scenario)
    start = perf_counter()
    with LogWriter(path, layout=Layout.of(data, trace.columns), about=about) as log:
        for first in range(0, rows, chunk):
            at = first % (len(trace) - chunk)
            count = min(chunk, rows - first)
            part = {name: values[at : at + count] for name, values in data.items()}
            part["tick"] = np.arange(first, first + count)
            part["t"] = 1e-3 * part["tick"]
            log.write(part)
    return rows / (perf_counter() - start)


def _read(path: Path, rows: int) -> float:
    """Return the best of several readings: the first one also waits for the memory of the machine."""
    from ebac.logs import read

    best = 0.0
    for _ in range(READINGS):
        start = perf_counter()
        found = len(read(path).trace)
        best = max(best, found / (perf_counter() - start))
        if found != rows:
            raise RuntimeError(f"{path}: {found} rows read, {rows} written")
    return best


def _official(path: Path, rows: int) -> float:
    from itertools import islice

    from mcap.reader import make_reader

    with path.open("rb") as file:
        start = perf_counter()
        messages = make_reader(file).iter_messages(topics="/ebac")
        count = sum(len(message.data) > 0 for _, _, message in islice(messages, rows))
        return count / (perf_counter() - start)
