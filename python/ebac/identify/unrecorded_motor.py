"""What a fit of an arm cannot know where the log lacks the motor's force.

A motor holds its command u for a tick. Of that stair the hand gets the share k = M0/(M0 + M_h), and F sampled at the
rows misses the part g k du of it, du the change of u in a tick; g follows from the lags of current loop and sensor. By
the motion of hand and device, k du = dF - (1 - k) (B0 a + K0 v) dt, but for k B_h a dt, which is small. Left out, this
acts as a force that is late by g ticks, as B0 too high by (1 - k) g K0 dt, and as M0 too high by (1 - k) g B0 dt.
Neither k nor whether a motor moves at all is in the log, so that the intervals hold all of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac.identify.parameters import SHARED
from ebac.identify.signals import stair

if TYPE_CHECKING:
    from ebac._core import ArmGains
    from ebac.identify.parameters import Parameters
    from ebac.identify.problem import Problem
    from ebac.identify.recording import Recording

#: Root of the mean square of a share that lies anywhere between 0 and 1.
ANYWHERE = 1 / sqrt(3)
#: A smaller share of B0 changes nothing.
MATTERS = 0.005
#: Rows of the ramp by which g is found; long lags settle in so many.
RAMP = 2000


def late(r: Recording) -> float:
    """Return by how much the stair of a motor at full share makes a force late [s]; 0 where the motor was recorded."""
    if r.motor is not None:
        return 0.0
    return (
        float(stair(np.arange(RAMP, dtype=float), r.dt, r.current_lag, r.lag)[1][RAMP // 2]) * r.dt
    )


def unseen(
    problem: Problem, values: NDArray[np.float64], gains: list[ArmGains]
) -> NDArray[np.float64]:
    """Return what the stair may change in the errors, by one deviation each, shape (0 or 2, rows)."""
    times = [late(r) for r in problem.recordings]
    if not any(times):
        return np.zeros((0, sum(len(r.t) for r in problem.recordings)))
    slope = problem.jacobian(values, gains, np.arange(len(values)))
    out, start = np.zeros((2, slope.shape[1])), 0
    for r, place, time in zip(problem.recordings, problem.parameters.places, times, strict=True):
        rows = slice(start, start + len(r.t))
        start = rows.stop
        mass, damping, stiffness, delay = place[: len(SHARED)].tolist()
        share = slope[mass, rows] * values[damping] + slope[damping, rows] * values[stiffness]
        held = not np.isnan(problem.parameters.fixed[delay])
        middle = slope[delay, rows] + 0.5 * share if held else 0.5 * share
        out[:, rows] = ANYWHERE * time * np.array([middle, 0.5 * share])
    return out


def notes(
    recordings: Sequence[Recording], parameters: Parameters, values: NDArray[np.float64]
) -> tuple[str, ...]:
    """Return a sentence about motors that were not recorded; none where they change no result."""
    found = [
        time
        for r, place in zip(recordings, parameters.places, strict=True)
        if (time := late(r)) * values[place[2]] > MATTERS * values[place[1]]
    ]
    if not found:
        return ()
    text = (
        "The log has no motor force. If a motor moved the handle, the hand's force reads late by up to "
        f"{1e3 * max(found):.2g} ms, because a motor moves in steps; the intervals are widened by that. Record the "
        "motor force too for narrower ones."
    )
    return (text,)
