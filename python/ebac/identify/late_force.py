"""A force that was read late, or behind a filter, though nothing was declared: what a fit that knows it would find."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ebac._util.arrays import Values
from ebac.identify.bias import BELIEVED
from ebac.identify.fit import Fitted, Point, search_from
from ebac.identify.parameters import kind
from ebac.identify.problem import Problem
from ebac.identify.whole_ticks import in_cell, profile, with_delays

#: Lags that are tried [s]; a filter of a sensor is one of these, nearly.
LAGS = (2.5e-4, 5e-4, 1e-3, 2e-3, 4e-3, 8e-3, 16e-3, 32e-3)
#: A later force or position belongs to a log that contains nothing about a hand [ticks].
LATEST = 20
#: Rounds in which the steps between lags are halved.
HALVED = 4


@dataclass(frozen=True, kw_only=True, eq=False)
class Late:
    """A delay of the force, or a lag of its sensor, that makes a log clearly likelier [s].

    `delay` is negative where the position comes late. `values` are those of all parameters with it.
    """

    delay: float
    lag: float | None  # in all, instead of the declared one and a delay
    gain: float  # by which -2 log of the likelihood falls
    values: Values

    @property
    def sentence(self) -> str:
        """What seems late, and by how much."""
        if self.lag is not None:
            return f"The force seems to pass a filter with a lag of {1e3 * self.lag:.2g} ms"
        what = "force" if self.delay > 0 else "position"
        return f"The {what} seems to be {1e3 * abs(self.delay):.2g} ms late"

    @property
    def remedy(self) -> str:
        """The options that take it into account."""
        if self.lag is not None:
            return f"--lag {self.lag:.2g}, in Python load(..., lag={self.lag:.2g})"
        return "--free delay, in Python fit_arm(..., free=['delay'])"


def late_force(fit: Fitted, robust: float | None, *, determined: bool) -> Late | None:
    """Return what a log says of a delay that is held; None where a row more or less is not clearly likelier.

    Of a log that does not determine the hand, only a late force is believed: in
    such a log the device, which the position leads, explains the most.
    """
    problem, p = fit.problem, fit.problem.parameters
    held = sorted(
        {
            int(i)
            for place in p.places
            for i in place.tolist()
            if kind(p.names[i]) == "delay" and not np.isnan(p.fixed[i])
        }
    )
    if not held:
        return None
    dt = max(r.dt for r in problem.recordings)
    before, least = fit.found.likelihood, fit.found.likelihood - BELIEVED
    # What a delay leaves may pass for a drift, which hides that a row is likelier.
    if not problem.drift and not any(
        point is not None and point.likelihood < least
        for point in (_search(_moved(problem, held, k * dt), fit.optimum, robust) for k in (1, -1))
    ):
        return None
    steady = problem.drifting(0.0)
    tried = profile(steady, held, robust)
    ticks = max(tried.ticks.values(), key=abs)
    if ticks == 0 or abs(ticks) > LATEST or (ticks < 0 and not determined):
        return None
    found = in_cell(steady, tried, robust)
    if found is None or found.likelihood > least:
        return None
    delay = max((float(found.values[i] - p.fixed[i]) for i in held), key=abs)
    late = Late(delay=delay, lag=None, gain=before - found.likelihood, values=found.values)
    if delay < 0:
        return late
    lag, other = _lag(steady, found.values, robust)
    if other is None or other.likelihood > found.likelihood - BELIEVED:
        return late
    return Late(delay=delay, lag=lag, gain=before - other.likelihood, values=other.values)


def _moved(problem: Problem, which: Sequence[int], by: float) -> Problem:
    """Return the problem with delays held that much later [s]."""
    fixed = problem.parameters.fixed
    return with_delays(problem, {i: float(fixed[i]) + by for i in which})


def _search(problem: Problem, start: Values, robust: float | None) -> Point | None:
    """Return where a search ends; None where the model runs away."""
    try:
        return search_from(problem, problem.parameters.clip(start), robust)
    except ValueError:
        return None


def _lag(problem: Problem, start: Values, robust: float | None) -> tuple[float, Point | None]:
    """Return the likeliest lag of the sensors, and where its search ended."""
    known: dict[float, Point | None] = {}

    def look(lag: float) -> float:
        if lag not in known:
            recordings = tuple(replace(r, lag=lag) for r in problem.recordings)
            known[lag] = _search(replace(problem, recordings=recordings), start, robust)
        point = known[lag]
        return np.inf if point is None else point.likelihood

    best, step = min(LAGS, key=look), 2.0
    for _ in range(HALVED):
        step = step**0.5
        best = min((best / step, best, best * step), key=look)
    return best, known[best]
