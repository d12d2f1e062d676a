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


def waits_or_ramps(trace: Trace) -> bool:
    """Return whether a trace has rows in which the loop waited for drives or ramped its force down, without a fault."""
    if "state" not in trace:
        return False
    outside = np.isin(trace["state"], [int(LoopState.ARM), int(LoopState.STOP)])
    return bool((outside & (trace["fault"] == 0)).any())
