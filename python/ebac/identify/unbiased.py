"""The second opinion in closed loop: two stages, the target as instrument, beside the direct fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ebac.identify.guess import instruments, regression, solve
from ebac.identify.parameters import BEFORE_LEVELS, OWN
from ebac.identify.recording import Recording
from ebac.identify.target import Target

if TYPE_CHECKING:
    from ebac.identify.result import ArmResult


#: When within a tick a force was read [ticks]: here nothing is known of the ripple of the motor.
WITHIN_TICK = 0.1


@dataclass(frozen=True, kw_only=True)
class Opinion:
    """One parameter by both methods, with standard deviations, and how far they lie apart in these."""

    name: str
    unit: str
    direct: float
    direct_deviation: float
    unbiased: float
    unbiased_deviation: float

    @property
    def apart(self) -> float:
        """Difference in standard deviations of the wider one."""
        wider = np.hypot(self.direct_deviation, self.unbiased_deviation)
        return float((self.direct - self.unbiased) / max(wider, 1e-300))


def second_opinion(result: ArmResult) -> tuple[Opinion, ...]:
    """Identify M0, B0, K0 again from what the target moved alone.

    First stage: position, velocity, acceleration are projected on delayed copies of the target; second stage:
    regression on what is
    left of them. What a law feeds back of noise and tremor does not follow the target and drops out.
    When within a tick a force was read is in doubt, and widens the deviations.

    Raises
    ------
    ValueError
        When a target never moves: then nothing tells hand from loop, and the direct fit stands alone.
    """
    problem = result.problem
    onset = BEFORE_LEVELS - len(OWN)
    pairs = [
        (r, target.late(float(result.values[place[onset]])))
        for r, target, place in zip(
            problem.recordings, problem.targets, result.parameters.places, strict=True
        )
    ]
    values, covariance = _two_stages(pairs)
    late = [(replace(r, lag=r.lag + WITHIN_TICK * r.dt), target) for r, target in pairs]
    apart = _two_stages(late)[0] - values
    covariance = covariance + np.outer(apart, apart)
    return tuple(
        Opinion(
            name=name,
            unit=result[name].unit,
            direct=result[name].value,
            direct_deviation=float(result.deviation[result.parameters.names.index(name)]),
            unbiased=float(values[i]),
            unbiased_deviation=float(np.sqrt(max(covariance[i, i], 0))),
        )
        for i, name in enumerate(("M0", "B0", "K0"))
        if name in result.estimates
    )


def _two_stages(pairs: Sequence[tuple[Recording, Target]]) -> Any:
    parts, given = [], []
    for r, target in pairs:
        part = regression(r, target)
        z = instruments(r, target, part.taps)
        if z is None:
            raise ValueError(
                f"{r.name}: its target never moves, so there is no instrument; "
                "let the hand follow a path or tap, and give the target"
            )
        parts.append(part)
        given.append(z)
    return solve(parts, given)
