"""Hands of the families of `worst` that cannot change their force at once: what a person can do, or a law expects."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac._core import Recorded
from ebac.studies.families import Family, Values

if TYPE_CHECKING:
    from ebac.scenario import Scenario

#: Points of a path per tick: a change of the target is seen within a quarter of one.
PER_TICK = 4
#: Place from which a target is seen [m]: every path lies on one side of it.
AWAY = -20.0


def no_quicker(family: Family, rate: float) -> Family:
    """Return the family with hands whose own force K0 X0 of eq. (4) changes by at most `rate` [N/s].

    A hand begins without force at zero. What it makes of the motion of the handle, -K0 x - B0 v - M0 a, is not bounded,
    and one that lets go does so at once.
    """

    def make(s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
        return _slowed(family.make(s, v, seconds), rate)

    return replace(family, make=make)


def _slowed(scenario: Scenario, rate: float) -> Scenario:
    hand = scenario.hand
    step = scenario.timing.dt / PER_TICK
    t = np.arange(0.0, scenario.seconds + step, step)
    pull = hand.replace(release_at=np.inf).pull(t, np.full(len(t), AWAY))
    wanted = pull / hand.stiffness + AWAY
    path = _followed(wanted, rate / hand.stiffness * step)
    if np.array_equal(path, wanted):
        return scenario
    bends = np.abs(np.diff(path, 2)) > 1e-12  # between two of them it is straight
    kept = np.concatenate([[True], bends, [True]])
    slow = Recorded(t=t[kept].tolist(), x=path[kept].tolist())
    return scenario.replace(hand=hand.replace(path=slow))


def _followed(wanted: NDArray[np.float64], most: float) -> NDArray[np.float64]:
    """Return what follows from zero on, by at most `most` from one value to the next."""
    at, path = 0.0, []
    for target in wanted.tolist():
        at = min(max(target, at - most), at + most)
        path.append(at)
    return np.array(path)
