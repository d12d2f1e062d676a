"""A force that was read less often than its log has rows: only the rows with a new reading count."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac._util.plural import plural
from ebac.identify.files import Columns
from ebac.identify.recording import LEAST_ROWS

#: This share of the steps between new readings must be whole multiples of the usual one.
REGULAR = 0.95
#: From so many rows on, a clock of its own may put a reading a row earlier or later.
OWN_CLOCK = 4
#: A reading changes by more than this many of its least steps [1]: a slow ramp in steps of a sensor is no held force.
STEPS = 1.5


def new_readings(force: NDArray[np.float64]) -> tuple[NDArray[np.intp], int]:
    """Return the rows in which a force was read, and how many rows each reading usually holds; 1 row for none held.

    Parameters
    ----------
    force : array, shape (rows,)
        As it was logged.
    """
    every = np.arange(len(force)), 1
    step = np.abs(np.diff(force))
    changed = np.flatnonzero(step) + 1
    gaps = np.diff(changed)
    if gaps.size < LEAST_ROWS:
        return every
    usual = int(np.median(gaps))
    most = np.round(gaps / usual).astype(int)
    off = np.abs(gaps - most * usual)
    regular = (most > 0) & (off <= (1 if usual >= OWN_CLOCK else 0))
    steps = step[changed - 1]
    if usual < 2 or regular.mean() < REGULAR or np.median(steps) < STEPS * steps.min():
        return every
    between = [
        np.linspace(a, a + gap, n, endpoint=False)  # a reading may be as the one before
        for a, gap, n in zip(changed[:-1], gaps, np.maximum(most, 1), strict=True)
    ]
    return np.round(np.concatenate([*between, changed[-1:]])).astype(np.intp), usual


def without_held(signals: Columns, remarks: list[str]) -> Columns:
    """Return the rows in which the force was read anew, with the mean of the motor's force since the last of them.

    Between two readings the log repeats the last one, or has no number.

    Parameters
    ----------
    signals : dict of arrays, shape (rows,)
        In SI units.
    remarks : list of str
        What was left out is added.
    """
    if "force" not in signals:
        return signals
    force = signals["force"]
    read = np.flatnonzero(np.isfinite(force))
    if LEAST_ROWS <= read.size < force.size:
        rows, held = read, int(np.median(np.diff(read)))
        remarks.append(f"force: {_no_reading(force)}; they are left out")
    else:
        rows, held = new_readings(force)
        if held == 1:
            return signals
        remarks.append(
            f"force: changes every {plural(held, 'row')} only, it was read less often and held; the rows between, "
            "where it is late, are left out"
        )
    out = {name: values[rows] for name, values in signals.items()}
    if "motor" in signals and np.isfinite(signals["motor"]).all():
        total = np.concatenate([[0.0], np.cumsum(signals["motor"])])
        since = np.concatenate([[max(rows[0] - held, -1)], rows[:-1]])
        out["motor"] = (total[rows + 1] - total[since + 1]) / (rows - since)
    return out


def _no_reading(force: NDArray[np.float64]) -> str:
    """Return in how many rows there is no force, and why: it is empty, or not finite."""
    saturated = "is not finite (inf), perhaps of a saturated sensor,"
    counts = {"is empty": np.isnan(force).sum(), saturated: np.isinf(force).sum()}
    kinds = " and ".join(f"{what} in {n}" for what, n in counts.items() if n)
    return f"{kinds} of {force.size} rows"
