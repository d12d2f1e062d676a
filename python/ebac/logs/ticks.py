"""Numbers of rows where a table of another program has no column `tick`: from their times."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac.trace.columns import ColumnInfo

if TYPE_CHECKING:
    from ebac.trace import Trace


def numbered(trace: Trace) -> tuple[dict[str, NDArray[Any]], dict[str, ColumnInfo]]:
    """Return the columns of a trace and what they are, with a column `tick` where there is a time and none."""
    data, columns = {name: trace[name] for name in trace}, trace.columns
    if "tick" in data or "t" not in data:
        return data, columns
    info = ColumnInfo(name="tick", unit="1", meaning="number of the row, from its time")
    return {**data, "tick": ticks_of(data["t"])}, {**columns, "tick": info}


def ticks_of(t: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return a number for each row, which a pause leaves out: the time over the median step.

    Parameters
    ----------
    t : array, shape (rows,)
        Times [s].

    Returns
    -------
    array, shape (rows,)
        From 0 up; the place of each row where the times give no step, or two rows one number.
    """
    rows = np.arange(len(t), dtype=np.int64)
    step = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    if not step > 0 or not np.isfinite(t).all():
        return rows
    steps = np.rint(np.diff(t) / step).astype(np.int64)  # each for itself: errors do not add up
    return np.concatenate([[0], np.cumsum(steps)]) if (steps > 0).all() else rows
