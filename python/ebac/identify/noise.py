"""How noisy the signals of a recording are, from the signals themselves."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ebac.identify.recording import Recording
from ebac.identify.smooth import kernels, smoothed


def rough(values: NDArray[np.float64]) -> float:
    """Return the standard deviation of white noise on a smooth signal, from third differences.

    Their median, so that jumps do not count.
    """
    third = np.diff(values, 3)
    return float(np.median(np.abs(third)) / 0.6745 / np.sqrt(20.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class Readings:
    """What a position signal really tells: where [m], how sure [m^2], and how long before its row [s]."""

    x: NDArray[np.float64]
    variance: NDArray[np.float64]
    early: NDArray[np.float64]


#: A run of one reading longer than this tells, in its middle, that the handle was within the count [rows].
REST = 30
#: Faster than this an edge is crossed in every tick [counts a tick].
FAST = 1.0


def readings(recording: Recording) -> Readings:
    """Return what the encoder tells.

    A count says most where it changes: then the handle crossed the edge between two counts, in the tick before,
    wherever in the tick. The rows between say the
    same thing again, with an error that follows the motion and that a law feeds back into it; they are left out. A
    long rest counts once.

    Where the handle crosses an edge in every tick, each row says where it was, to half a count. Which rows are read in
    which way follows from the smoothed speed alone: chosen by how many edges a tick crossed, the rows that crossed two
    would all lie ahead of the handle.
    """
    x, count, dt = recording.x, recording.count, recording.dt
    early = np.zeros(len(x))
    if count <= 0:
        floor = 1e-6 * float(np.ptp(x))
        return Readings(x=x, variance=np.full(len(x), max(rough(x), floor) ** 2), early=early)
    step = np.abs(np.diff(x, prepend=x[0])) / count
    changed = np.flatnonzero(step > 0.5)
    variance, position = np.full(len(x), np.inf), x.copy()
    fast = np.abs(speed(x, dt)) * dt > FAST * count
    variance[fast] = count**2 / 12
    ends = np.concatenate([[0], changed, [len(x)]])
    runs = np.diff(ends)
    rows = np.minimum(runs[:-1], runs[1:])  # that a count lasts, before or after
    slow = ~fast[changed]
    edge = changed[slow]
    position[edge] = 0.5 * (x[edge] + x[edge - 1])
    early[edge] = 0.5 * dt
    travel = count / np.maximum(rows[slow], 1)  # m, in the tick
    variance[edge] = travel**2 / 12 + (0.02 * count) ** 2
    for first, last in pairwise(ends.tolist()):
        if last - first > REST:
            variance[(first + last) // 2] = count**2 / 12
    return Readings(x=position, variance=variance, early=early)


def speed(x: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """Return the velocity at each row behind the kernel of `smooth` [m/s]; at the ends the handle rests."""
    kernel = kernels(dt)[1]
    return smoothed(np.pad(x, len(kernel) // 2, mode="edge"), kernel)
