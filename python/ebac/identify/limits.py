"""Readings that stand at the end of a range: a sensor or a command that is saturated shows less than there was."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values
from ebac._util.plural import plural

if TYPE_CHECKING:
    from ebac.identify.recording import Recording


#: Rows in a row that stand at the same extreme; fewest rows in all, of several times and of one; and their share.
RUN, LEAST, LONG, SHARE = 3, 10, 30, 0.001
#: An end of a range lies this far from zero, as a share of the largest reading: a wall that nobody touches gives 0.
FROM_ZERO = 0.1
#: At a limit lie this many times more readings than next to it, within this share of the range or a step of the sensor.
BESIDE, MORE = 0.005, 2.0


def at_limits(values: Values) -> NDArray[np.bool_]:
    """Return the rows in which a signal stands at an end of its range, again and again at exactly the same value."""
    out = np.zeros(len(values), dtype=bool)
    span = float(np.ptp(values))
    for sign in (1.0, -1.0):
        level = float((sign * values).max())
        if level <= FROM_ZERO * float(np.abs(values).max()):
            continue
        below = level - sign * values
        there = below <= 1e-9 * span
        ends = np.flatnonzero(np.diff(np.concatenate([[0], there, [0]]).astype(int)))
        first, last = ends[::2], ends[1::2]
        long = last - first >= RUN
        rows = int((last - first)[long].sum())
        if rows < (LEAST if long.sum() > 1 else LONG) or rows < SHARE * len(values):
            continue
        step = float(below[~there].min(initial=span))  # to the next reading
        beside = (below <= max(BESIDE * span, 1.001 * step)) & ~there
        if there.sum() > MORE * beside.sum():
            out |= there
    return out


def notes(recordings: Sequence[Recording]) -> tuple[str, ...]:
    """Return a sentence for each recording whose force stands at a limit."""
    out = []
    for r in recordings:
        cut = np.zeros(0) if r.force is None else at_limits(r.force)
        if cut.any():
            assert r.force is not None
            ends = " and ".join(f"{v:.4g}" for v in np.unique(r.force[cut]).tolist())
            out.append(
                f"{r.name}: the force stands at a limit of {ends} {r.units[1]} in {plural(int(cut.sum()), 'row')}: the "
                "sensor seems saturated. There the force is taken as unknown; record one with less force or a wider "
                "range."
            )
    return tuple(out)
