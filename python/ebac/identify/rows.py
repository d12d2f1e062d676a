"""Put the rows of a log, jittered, lost or paused, on equal steps without losing a reading."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.identify.recording import LEAST_ROWS

Signals = dict[str, NDArray[np.float64]]

#: Steps that differ by less, as a share of the median one, are equal.
EQUAL = 1e-3
#: So many lost rows are bridged; more are a pause.
BRIDGED = 8
#: Of all rows: where more are lost than this, what is put between them biases a fit.
MANY = 0.1
#: A stretch between two pauses that is shorter contains nothing about a hand [s].
SHORTEST = 0.25


def on_rows(name: str, signals: Signals, remarks: list[str]) -> dict[str, NDArray[Any]]:
    """Put each reading on the row next to it, and remember how long before that row it was read.

    Positions stay as they were read, so that a count is a count: a fit compares each with the motion at its own
    instant, `early` before its row. Forces are moved to the row along their slope. A few lost rows are bridged, and
    are not `known`; a pause ends one stretch and begins another.

    Parameters
    ----------
    name : str
        For messages.
    signals : dict of arrays, shape (rows,)
        With `t`, rising.
    remarks : list of str
        What was changed is added.

    Raises
    ------
    ValueError
        When it pauses so often that no stretch is long enough.
    """
    t = signals["t"]
    step = np.diff(t)
    usual = float(np.median(step))
    if np.ptp(step) <= EQUAL * usual:
        return signals
    paused = step > (BRIDGED + 1.5) * usual
    stretches = np.split(np.arange(len(t)), np.flatnonzero(paused) + 1)
    whole = np.round(step / usual)
    dt = float(step[~paused].sum() / whole[~paused].sum())
    least = max(LEAST_ROWS, round(SHORTEST / dt)) if len(stretches) > 1 else 0
    x = signals["x"]
    moves = [rows for rows in stretches if least == 0 or np.ptp(x[rows]) > 0]
    long = [rows for rows in moves if len(rows) >= least]
    if not long:
        most = max(len(rows) for rows in stretches)
        raise ValueError(
            f"{name}: pauses {paused.sum()} times, and its longest stretch has {most} rows: "
            f"needs {least}, {SHORTEST:g} s without a pause"
        )
    parts = [_stretch({key: v[rows] for key, v in signals.items()}, dt) for rows in long]
    out = {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
    remarks += _said(out, dt, len(long), len(t) - int(out["known"].sum()))
    return out


def _stretch(signals: Signals, dt: float) -> dict[str, NDArray[Any]]:
    """Put the rows between two pauses on steps of `dt` [s]."""
    t = signals["t"]
    row = np.round(np.append(0.0, np.cumsum(np.round(np.diff(t) / dt))))
    row = np.round((t - np.median(t - dt * row)) / dt).astype(np.intp)
    kept = np.diff(row, prepend=row[0] - 1) > 0
    offset = float(np.median(t - dt * row))
    t, row = t[kept], row[kept] - row[kept][0]
    even = offset + dt * (np.arange(row[-1] + 1) + np.round((t[0] - offset) / dt))
    known = np.zeros(len(even), dtype=bool)
    known[row] = True
    early = np.zeros(len(even))
    early[row] = even[row] - t
    out: dict[str, NDArray[Any]] = {"t": even, "early": early, "known": known}
    for key, values in signals.items():
        v = values[kept]
        if key == "t":
            continue
        if key == "motor":  # holds over the interval that ends at a row
            out[key] = v[np.searchsorted(row, np.arange(len(even)))]
            continue
        filled = np.interp(even, t, v)
        filled[row] = v if key == "x" else v + np.gradient(v, t) * early[row]
        out[key] = filled
    return out


def _said(out: dict[str, NDArray[Any]], dt: float, stretches: int, left_out: int) -> list[str]:
    """Return what was done to the rows, for the reader."""
    worst = float(np.abs(out["early"]).max())
    lost = int((~out["known"]).sum())
    said = []
    if worst > EQUAL * dt:
        said.append(
            f"rows are up to {1e3 * worst:.3g} ms off steps of {1e3 * dt:.4g} ms: fitted at their own times"
        )
    if lost:
        share = lost / len(out["known"])
        biased = (
            f", {share:.0%} of all: the force between is taken as a straight line, and the estimates may be off by "
            "more than their intervals"
        )
        said.append(f"{lost} lost rows are bridged{biased if share > MANY else ''}")
    if stretches > 1:
        said.append(f"the recording pauses: {stretches} stretches, fitted as one")
    if left_out:
        said.append(
            f"{left_out} rows are left out: two at a time, or in a stretch that is too short or at rest"
        )
    return said
