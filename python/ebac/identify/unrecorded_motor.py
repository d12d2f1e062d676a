"""What the steps of a motor do to a fit of an arm where the log lacks the motor's force.

A motor holds its command u for a tick. Of that stair the hand gets the share k = M0/(M0 + M_h), and F sampled at the
rows misses the part g k du of it, du the change of u in a tick; g lies within half a tick, and follows from where
between two rows the steps fall. By the motion of hand and device, k du = dF - (1 - k) (B0 a + K0 v) dt, but for
k B_h a dt, which is small. So F is late by g ticks, B0 comes out too high by (1 - k) g K0 dt, and M0 by
(1 - k) g B0 dt.

g is fitted as the delay of the force, which a log shows by its phase at high frequencies. Not all of that delay need
be the motor's, and neither k nor whether a motor moves at all is in the log: the values are those for k = 1/2, and the
intervals hold every k from 0 to 1.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac.identify.parameters import SHARED, kind

if TYPE_CHECKING:
    from ebac.identify.parameters import Parameters
    from ebac.identify.problem import Problem
    from ebac.identify.recording import Recording

#: Mean of 1 - k, its variance, and the mean of its square.
MEAN, VARIANCE, SQUARE = 1 / 2, 1 / 12, 1 / 3
#: When within a tick a force is read for other reasons, such as a converter of its own: one deviation [ticks].
APART = 0.03
#: A smaller share of B0 changes nothing.
MATTERS = 0.005
#: Harmonics of a stair's sawtooth.
HARMONICS = np.arange(1, 200)

Values = NDArray[np.float64]


def late(r: Recording) -> float:
    """Return by how much steps anywhere between two rows make a force late: one deviation [ticks].

    A stair less its mean is a sawtooth, which the sensor's lag smooths. 0 where the motor was recorded.
    """
    if r.motor is not None:
        return 0.0
    passed = 1 + (2 * pi * HARMONICS * r.lag / r.dt) ** 2
    return sqrt(float(np.sum(0.5 / (pi * HARMONICS) ** 2 / passed)))


def deviation(recordings: Sequence[Recording]) -> float:
    """Return by how much a force may be late for any reason [ticks]."""
    return hypot(APART, max(late(r) for r in recordings))


def stairs(problem: Problem) -> tuple[float, float]:
    """Return which share of a delay is likely a motor's, and how far off that part is then, one deviation [s]."""
    motor = max(late(r) for r in problem.recordings)
    share = (motor / deviation(problem.recordings)) ** 2
    return share, APART * sqrt(share) * max(r.dt for r in problem.recordings)


def hands(parameters: Parameters) -> Iterator[tuple[int, int, int, int]]:
    """Yield where M0, B0, K0 and delay of each hand lie among all parameters."""
    found = {tuple(place[: len(SHARED)].tolist()) for place in parameters.places}
    for mass, damping, stiffness, delay in sorted(found):
        if kind(parameters.names[mass]) == SHARED[0]:
            yield mass, damping, stiffness, delay


def corrected(problem: Problem, values: Values, *, back: bool = False) -> Values:
    """Return values without what a motor of the mean share adds; `back`: with it again, as they were fitted."""
    out, free = values.copy(), set(problem.parameters.free.tolist())
    share, _ = stairs(problem)
    for mass, damping, stiffness, delay in hands(problem.parameters):
        off = MEAN * share * found_late(problem, values, delay)
        pairs = ((mass, damping), (damping, stiffness))
        for i, by in reversed(pairs) if back else pairs:
            if i in free:
                out[i] += off * out[by] if back else -off * out[by]
    return out


def with_any_share(
    problem: Problem, values: Values, covariance: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the covariance of the free parameters, `corrected`, from that of all that moved."""
    free, moved = len(problem.parameters.free), problem.moved.tolist()
    turn, more = np.eye(free, len(moved)), np.zeros((free, free))
    share, off = stairs(problem)
    for mass, damping, stiffness, delay in hands(problem.parameters):
        along = np.zeros(free)  # per second
        for i, by in ((mass, damping), (damping, stiffness)):
            if i in moved[:free]:
                along[moved.index(i)] = values[by]
        if delay in problem.doubt.which:
            column = moved.index(delay)
            turn[:, column] -= MEAN * share * along
            late_squared = found_late(problem, values, delay) ** 2 + covariance[column, column]
            square = VARIANCE * share**2 * late_squared + SQUARE * off**2
        else:  # of a delay that is fitted itself, nobody knows which part is a motor's
            square = SQUARE * max(late(r) * r.dt for r in problem.recordings) ** 2
        more += square * np.outer(along, along)
    return np.asarray(turn @ covariance @ turn.T + more)


def found_late(problem: Problem, values: Values, delay: int) -> float:
    """Return what was fitted of a delay that is held [s]."""
    held = delay in problem.doubt.which
    return float(values[delay] - problem.parameters.fixed[delay]) if held else 0.0


def notes(
    recordings: Sequence[Recording], parameters: Parameters, values: NDArray[np.float64]
) -> tuple[str, ...]:
    """Return a sentence about motors that were not recorded; none where they change no result."""
    found = [
        float(values[delay] - np.nan_to_num(parameters.fixed[delay]))
        for _, damping, stiffness, delay in hands(parameters)
        if max(late(r) * r.dt for r in recordings) * values[stiffness] > MATTERS * values[damping]
    ]
    if not found:
        return ()
    text = (
        "The log has no motor force. If a motor moved the handle, its steps fall somewhere between two rows, and the "
        f"hand's force reads late by a part of one: {1e3 * max(found, key=abs):+.2g} ms by this fit. The intervals "
        "hold what that leaves open; record the motor force too for narrower ones."
    )
    return (text,)
