"""What the steps of a motor do to a fit of an arm where the log lacks the motor's force.

A motor holds its command u for a tick. Of that stair the hand gets the share k = M0/(M0 + M_h), and F sampled at the
rows misses the part g k du of it, du the change of u in a tick; g lies within half a tick, and follows from where
between two rows the steps fall. By the motion of hand and device, k du = dF + (k B_h a - (1 - k) (B0 a + K0 v)) dt. So
F is late by g ticks, B0 comes out too high by (1 - k) g K0 dt, and M0 by (1 - k) g B0 dt - k g B_h dt.

g is fitted as the delay of the force, which a log shows by its phase at high frequencies. Not all of that delay need
be the motor's, and neither k, nor the damping B_h of the device, nor whether a motor moves at all is in the log: the
values are those for k = 1/2 and B_h = 0, and the intervals hold every k from 0 to 1 and a B_h as `DRAG`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values
from ebac.identify.missing import name_if_unread
from ebac.identify.parameters import SHARED, kind

if TYPE_CHECKING:
    from ebac.identify.parameters import Parameters
    from ebac.identify.problem import Problem
    from ebac.identify.recording import Recording

#: Mean of 1 - k, its variance, and the mean of its square, which is that of k, too.
MEAN, VARIANCE, SQUARE = 1 / 2, 1 / 12, 1 / 3
#: Damping of a device: one deviation [N s/m].
DRAG = 5.0
#: When within a tick a force is read for other reasons, such as a converter of its own: one deviation [ticks].
APART = 0.03
#: A smaller share of B0 changes nothing.
MATTERS = 0.005
#: Harmonics of a stair's sawtooth.
HARMONICS = np.arange(1, 200)


def late(r: Recording) -> float:
    """Return by how much steps anywhere between two rows make a force late: one deviation [ticks].

    A stair less its mean is a sawtooth, which the sensor's lag smooths. 0 where the motor was recorded.
    """
    if r.motor is not None:
        return 0.0
    passed = 1 + (2 * pi * HARMONICS * r.lag / r.dt) ** 2
    return sqrt(float(np.sum(0.5 / (pi * HARMONICS) ** 2 / passed)))


@dataclass(frozen=True, kw_only=True)
class Part:
    """Recordings of one hand that share a delay: where its parameters lie among all, and what of a motor is unknown."""

    mass: int
    damping: int
    stiffness: int
    delay: int
    rows: int
    motor: float  # one deviation of what its steps make late [ticks]

    @property
    def deviation(self) -> float:
        """By how much its force may be late for any reason [ticks]."""
        return hypot(APART, self.motor) if self.motor else 0.0

    @property
    def share(self) -> float:
        """Which share of a delay is likely the motor's."""
        return (self.motor / self.deviation) ** 2 if self.motor else 0.0


def parts(recordings: Sequence[Recording], parameters: Parameters) -> list[Part]:
    """Return the parts of a fit of hands; none of a device."""
    found: dict[tuple[int, ...], Part] = {}
    for r, place in zip(recordings, parameters.places, strict=True):
        key = tuple(place[: len(SHARED)].tolist())
        if kind(parameters.names[key[0]]) != SHARED[0]:
            continue
        before = found.get(key)
        mass, damping, stiffness, delay = key
        found[key] = Part(
            mass=mass,
            damping=damping,
            stiffness=stiffness,
            delay=delay,
            rows=len(r.t) + (before.rows if before else 0),
            motor=max(late(r), before.motor if before else 0.0),
        )
    return list(found.values())


def deviations(recordings: Sequence[Recording], parameters: Parameters) -> dict[str, float]:
    """Return by how much each delay may be off, by name [ticks]; 0 where all motors were recorded."""
    out: dict[str, float] = {}
    for part in parts(recordings, parameters):
        name = parameters.names[part.delay]
        out[name] = max(out.get(name, 0.0), part.deviation)
    return out


def found_late(problem: Problem, values: Values, delay: int) -> float:
    """Return what was fitted of a delay that is held [s]."""
    held = delay in problem.doubt.which
    return float(values[delay] - problem.parameters.fixed[delay]) if held else 0.0


def corrected(problem: Problem, values: Values, *, back: bool = False) -> Values:
    """Return values without what a motor of the mean share adds; `back`: with it again, as they were fitted."""
    out = values.copy()
    every = _shifts(problem)
    for pick in ("damping", "mass") if back else ("mass", "damping"):
        moved = np.zeros(len(values))
        for part, weights in every:
            i = getattr(part, pick)
            by = part.stiffness if pick == "damping" else part.damping
            off = MEAN * part.share * found_late(problem, values, part.delay)
            moved[i] += weights[i] * off * out[by]
        out += moved if back else -moved
    return out


def with_any_share(
    problem: Problem, values: Values, covariance: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the covariance of the free parameters, `corrected`, from that of all that moved."""
    free, moved = len(problem.parameters.free), problem.moved.tolist()
    dt = max(r.dt for r in problem.recordings)
    turn, more = np.eye(free, len(moved)), np.zeros((free, free))
    common, drag = np.zeros(free), np.zeros(free)  # of one k and one B_h
    for part, weights in _shifts(problem):
        along, mass = np.zeros(free), np.zeros(free)  # per second
        if weights[part.mass]:
            mass[moved.index(part.mass)] = weights[part.mass]
            along[moved.index(part.mass)] = weights[part.mass] * values[part.damping]
        if weights[part.damping]:
            along[moved.index(part.damping)] = weights[part.damping] * values[part.stiffness]
        if part.delay in problem.doubt.which:
            column = moved.index(part.delay)
            turn[:, column] -= MEAN * part.share * along
            late_by = part.share * found_late(problem, values, part.delay)
            common += late_by * along
            drag += late_by * mass
            known = part.share**2 * covariance[column, column]
            other = part.share * (APART * dt) ** 2
        else:  # of a delay that is fitted itself, nobody knows which part is a motor's
            known, other = 0.0, (part.motor * dt) ** 2
        more += (VARIANCE * known + SQUARE * other) * np.outer(along, along)
        more += SQUARE * DRAG**2 * (known + other) * np.outer(mass, mass)
    more += VARIANCE * np.outer(common, common) + SQUARE * DRAG**2 * np.outer(drag, drag)
    with np.errstate(invalid="ignore"):  # of a search that came to nothing
        return np.asarray(turn @ covariance @ turn.T + more)


def _shifts(problem: Problem) -> list[tuple[Part, Values]]:
    """Return each part whose motor is unknown, and its weight in each free parameter: its share of the rows."""
    p = problem.parameters
    every = parts(problem.recordings, p)
    rows = np.zeros(len(p.names))
    for part in every:
        rows[[part.mass, part.damping]] += part.rows
    out = []
    for part in every:
        weights = np.zeros(len(p.names))
        for i in (part.mass, part.damping):
            if i in p.free:
                weights[i] = part.rows / rows[i]
        if part.motor:
            out.append((part, weights))
    return out


def notes(
    recordings: Sequence[Recording], parameters: Parameters, values: NDArray[np.float64]
) -> tuple[str, ...]:
    """Return a sentence about motors that were not recorded; none where they change no result."""
    dt = max(r.dt for r in recordings)
    found = [
        float(values[part.delay] - np.nan_to_num(parameters.fixed[part.delay]))
        for part in parts(recordings, parameters)
        if part.motor * dt * values[part.stiffness] > MATTERS * values[part.damping]
    ]
    if not found:
        return ()
    named = name_if_unread("motor", recordings, ", or")
    text = (
        "The log has no motor force. If a motor moved the handle, its steps fall somewhere between two rows, and the "
        f"hand's force reads late by a part of one: {1e3 * max(found, key=abs):+.2g} ms by this fit. The intervals "
        f"hold what that leaves open; record the motor force too for narrower ones{named}."
    )
    return (text,)
