"""The second opinion in closed loop: two stages, the target as instrument, beside the direct fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac.identify.guess import instruments, regression, solve
from ebac.identify.intervals import Z95
from ebac.identify.parameters import BEFORE_LEVELS, HAND, OWN
from ebac.identify.recording import Recording
from ebac.identify.signals import by_target, every, kernels, ripple, smoothed
from ebac.identify.target import Target, indicators
from ebac.identify.unrecorded_motor import found_late

if TYPE_CHECKING:
    from ebac.identify.result import ArmResult


#: When within a tick a force was read [ticks]: the motor's ripple moves it by 0.01 to 0.06, and so far is it known.
WITHIN_TICK = 0.04


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
    The motor's ripple is taken as the direct fit found it; what a jump of the target does within its tick is a column
    of its own. When within a tick a force was read is in doubt, and widens the deviations.

    Raises
    ------
    ValueError
        When a target never moves: then nothing separates hand from loop, and the direct fit stands alone.
    """
    problem = result.problem
    onset, stair = (BEFORE_LEVELS - len(OWN) + OWN.index(name) for name in ("onset", "stair"))
    pairs = [
        (
            _evened(r, float(result.values[place[stair]])),
            target.late(float(result.values[place[onset]])),
        )
        for r, target, place in zip(
            problem.recordings, problem.targets, result.parameters.places, strict=True
        )
    ]
    values, covariance = _two_stages(pairs)
    known = [
        found_late(problem, result.values, int(place[3])) for place in result.parameters.places
    ]
    late = [
        (replace(r, lag=r.lag + float(np.hypot(WITHIN_TICK * r.dt, delay))), target)
        for (r, target), delay in zip(pairs, known, strict=True)
    ]
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
        for i, name in enumerate(HAND)
        if name in result.estimates
    )


#: A smaller difference between the two methods changes nothing, as a share of the value.
MATTERS = 0.01


def disagreement(result: ArmResult) -> dict[str, float]:
    """Return M0, B0, K0 of a regression on smoothed signals, where they contradict the fit; empty where none does.

    Regression sees a hand below 20 Hz, the fit at all frequencies: they agree where eq. (4) holds at all of them. A
    filter in the log, or a derivative taken by differences, shows the fit another mass. As a specification test
    (Hausman 1978). Where the target moves, the regression is that of the second opinion.
    """
    places = result.parameters.places
    if any((place[:3] != places[0][:3]).any() for place in places):
        return {}  # recordings with hands of their own
    fit = {name: result.estimates[name] for name in HAND}
    if any(e.fixed for e in fit.values()):
        return {}  # a regression knows of no given values
    try:
        found = [(o.name, o.unbiased, o.unbiased_deviation) for o in second_opinion(result)]
    except ValueError:
        pairs = zip(result.problem.recordings, result.problem.targets, strict=True)
        values, covariance = solve([regression(r, target) for r, target in pairs])
        sure = np.sqrt(np.maximum(np.diag(covariance), 0.0))
        found = list(zip(HAND, values[:3].tolist(), sure[:3].tolist(), strict=True))
    out = {}
    for name, value, deviation in found:
        own = (fit[name].high - fit[name].low) / 2
        apart = abs(value - fit[name].value)
        if value > 0 and apart > max(MATTERS * fit[name].value, np.hypot(own, Z95 * deviation)):
            out[name] = value
    return out


def _evened(r: Recording, share: float) -> Recording:
    """Return a recording whose force is the mean of the tick from each row on, as a smooth one would have."""
    if r.force is None:
        return r
    return replace(r, force=r.force + share * ripple(r))


def _two_stages(pairs: Sequence[tuple[Recording, Target]]) -> Any:
    parts, given, folds = [], [], []
    for r, target in pairs:
        part = regression(r, target)
        z = instruments(r, target, part.taps)
        if z is None:
            raise ValueError(
                f"{r.name}: its target never moves, so there is no instrument; "
                "let the hand follow a path or tap, and give the target"
            )
        jumps = _jumps(r, target)
        parts.append(replace(part, columns=np.hstack([part.columns, jumps])))
        given.append(np.hstack([z, jumps]))
        folds.append(by_target(r, target))
    return solve(parts, given, folds)


def _jumps(r: Recording, target: Target) -> NDArray[np.float64]:
    """Return a smoothed pulse where each level but the first begins or ends, shape (rows, levels - 1).

    Samples of a lagged step lie a tenth of a tick later than the step itself: a jump of acceleration, which is taken
    from the places, and that of the force are independent.
    """
    h, step = kernels(r.dt)[0], every(r.dt)
    shares = indicators(r, target)[1:]
    pulses = [smoothed(np.diff(row, prepend=row[0]), h)[::step] for row in shares]
    rows = len(range(0, len(r.t) - len(h) + 1, step))
    return np.array(pulses).reshape(len(pulses), rows).T
