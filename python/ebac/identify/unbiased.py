"""The second opinion in closed loop: two stages, the target as instrument, beside the direct fit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ebac.identify.guess import instruments, regression, solve

if TYPE_CHECKING:
    from ebac.identify.result import ArmResult


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

    Raises
    ------
    ValueError
        When a target never moves: then nothing tells hand from loop, and the direct fit stands alone.
    """
    problem = result.problem
    parts, given = [], []
    for r, target in zip(problem.recordings, problem.targets, strict=True):
        part = regression(r, target)
        z = instruments(r, target, part.taps)
        if z is None:
            raise ValueError(
                f"{r.name}: its target never moves, so there is no instrument; "
                "let the hand follow a path or tap, and give the target"
            )
        parts.append(part)
        given.append(z)
    values, covariance = solve(parts, given)
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
