"""Presses on a wall under many hands at once, in C++: what a pair of gains comes to."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from ebac._core import Hand, RunLimits, SweepProgress
from ebac._util.arrays import Values
from ebac._util.cores import thread_count
from ebac.identify.intervals import Z95
from ebac.identify.parameters import HAND
from ebac.identify.result import ArmResult
from ebac.laws import LAWS, design
from ebac.metrics import ideal_rest
from ebac.scenario import Scenario


def force_loop_laws() -> list[str]:
    """Return the names of the laws that have the force loop of eq. (2)."""
    return [name for name, law in LAWS.items() if hasattr(law, "_press")]


def noise_gain(kp: float, kd: float, filter_s: float, dt: float) -> float:
    """Return the noise of the command per noise of a white force reading [1], of the PD part of eq. (2).

    The root of the sum of squares of its answer to one reading, with the derivative filtered as the laws do.
    """
    a = dt / (filter_s + dt)
    first = kp + kd * a / dt
    later = (kd * a * a / dt) ** 2 / (1 - (1 - a) ** 2)
    return float(np.sqrt(first**2 + later))


def arms_around(result: ArmResult, vary: float) -> list[Hand]:
    """Return the identified hand, the ends of its interval, and corners `vary` (a share) away.

    The ends lie on the principal axes of M0, B0, K0; a hand grips anew each day, which no interval of one log knows:
    that is what the corners are for.
    """
    hand = result.hand
    best = np.array([hand.mass, hand.damping, hand.stiffness])
    free = [result.parameters.names[i] for i in result.parameters.free]
    which = [free.index(n) for n in HAND if n in free]
    rows = [i for i, n in enumerate(HAND) if n in free]
    points = [best]
    if which:
        part = result.covariance[np.ix_(which, which)] / np.outer(best[rows], best[rows])
        sizes, axes = np.linalg.eigh(part)
        for size, axis in zip(sizes, axes.T, strict=True):
            for sign in (-1, 1):
                point = best.copy()
                point[rows] *= 1 + sign * Z95 * np.sqrt(max(size, 0.0)) * axis
                points.append(point)
    if vary > 0:
        points += [best * (1 + vary) ** np.array(c) for c in product((-1, 1), repeat=3)]
    low, high = np.array([1e-3, 0.0, 1.0]), np.array([10.0, 1e3, 1e5])
    return [
        hand.replace(mass=m, damping=b, stiffness=k)
        for m, b, k in (np.clip(p, low, high).tolist() for p in points)
    ]


@dataclass(frozen=True, kw_only=True, eq=False)
class Presses:
    """Numbers of every press under one pair of gains, one row each, and what stands for all of them."""

    columns: dict[str, Values]
    goals: Values

    @property
    def overshoot(self) -> Values:
        """How much deeper than an ideal wall would rest [m]."""
        return np.asarray(self.columns["peak"] - self.goals)

    @property
    def whole(self) -> Values:
        """Whether each press came to its end."""
        return np.asarray((self.columns["fault"] == 0) & (self.columns["diverged"] == 0))

    @property
    def settled(self) -> Values:
        """Settling times [s]; infinite where it never does."""
        return np.where(np.isnan(self.columns["settled"]), np.inf, self.columns["settled"])

    def numbers(self) -> dict[str, float]:
        """Return the numbers of a table."""
        c = self.columns
        return {
            "settled_median_s": float(np.median(self.settled)),
            "settled_share": float(np.isfinite(self.settled).mean()),
            "swing_mean_m": float(np.mean(c["swing"])),
            "swing_worst_m": float(np.max(c["swing"])),
            "noise_mean_N": float(np.mean(c["noise"])),
            "overshoot_worst_m": float(np.max(self.overshoot)),
            "force_worst_N": float(np.max(c["most_force"])),
            "current_worst_A": float(np.max(c["most_current"])),
            "least_energy_J": float(np.min(c["least_energy"])),
            "ended_share": float(self.whole.mean()),
        }


def run_presses(
    scenarios: list[Scenario], law: str, changes: dict[str, Any], threads: int | None = None
) -> Presses:
    """Simulate every press under one law with some parameters changed, in threads of the core, the GIL released."""
    laws = [design(law, s.device, s.timing, **changes) for s in scenarios]
    goals = np.array([_goal(s) for s in scenarios])
    columns = LAWS[law]._press(  # type: ignore[attr-defined]
        [s.setup() for s in scenarios],
        laws,
        goals.tolist(),
        thread_count(threads),
        RunLimits(),
        SweepProgress(),
    )
    return Presses(columns=columns, goals=goals)


def _goal(scenario: Scenario) -> float:
    goal = ideal_rest(scenario)
    if goal is None:
        raise ValueError("a press needs a straight wall and a hand that rests behind it")
    return goal
