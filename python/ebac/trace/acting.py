"""The part of a run in which its law acted."""

from __future__ import annotations

import numpy as np

from ebac._core import LoopState
from ebac.trace.trace import Trace


def under_the_law(trace: Trace) -> Trace:
    """Return the rows in which the law acted; their time begins at its first tick.

    Parameters
    ----------
    trace : Trace
        Of a run.

    Returns
    -------
    Trace
        Without a row where the law never acted.
    """
    rows = np.flatnonzero(trace["state"] == int(LoopState.RUN))
    if not len(rows):
        return trace.rows(0, 0)
    part = trace.rows(int(rows[0]), int(rows[-1]) + 1)
    return part.with_column("t", part["t"] - part["t"][0])


def without_waits(trace: Trace) -> Trace:
    """Return a trace without rows in which the loop waited for drives or ramped its force down, where it has any."""
    if "state" not in trace:
        return trace
    outside = np.isin(trace["state"], [int(LoopState.ARM), int(LoopState.STOP)])
    return under_the_law(trace) if (outside & (trace["fault"] == 0)).any() else trace
