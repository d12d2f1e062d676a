"""A delay of the force: searched over whole ticks first, for the objective bends where it passes half a tick.

A delay shifts the force by whole ticks, and what is left of it is put on the motion: at half a tick one gives way to
the other. A search from the wrong side ends at that bend.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from ebac._util.arrays import Values
from ebac.identify.fit import Fitted, Point, fitted, search_from
from ebac.identify.parameters import BOUNDS, kind
from ebac.identify.problem import Problem
from ebac.identify.start import better_guess

#: Delays that are tried first; then their neighbours, downhill [ticks].
TRIED = (0, -1, 1, -2, 2, 3, 5, -5, 8, -10, 12, 20, 35)
#: So near half a tick a delay is at the bend [ticks].
AT_BEND = 0.02
#: An optimum whose force is this many times as loud as another's is that of a model which nearly ignores it.
LOUDER = 5.0
#: Bends that a search goes beyond.
MOST_CELLS = 8


def delays(problem: Problem) -> tuple[int, ...]:
    """Return which of all parameters are delays that are fitted."""
    p = problem.parameters
    return tuple(i for i in p.free.tolist() if kind(p.names[i]) == "delay")


def loudness(point: Point, problem: Problem) -> float:
    """Return the noise of the force that was found, as a multiple of what the signal shows."""
    return float((point.force_noise / problem.shown).max())


def with_delays(problem: Problem, at: dict[int, float], within: float | None = None) -> Problem:
    """Return the problem with delays held [s], or free within so much of these."""
    p = problem.parameters
    low, high, fixed = p.low.copy(), p.high.copy(), p.fixed.copy()
    for i, value in at.items():
        if not np.isnan(p.fixed[i]):  # of one that was held: what it may be, if it is late
            low[i], high[i] = BOUNDS["delay"]
        fixed[i] = value
        if within is not None:
            low[i], high[i] = max(low[i], value - within), min(high[i], value + within)
            fixed[i] = np.nan
    return replace(problem, parameters=replace(p, low=low, high=high, fixed=fixed))


@dataclass(frozen=True, kw_only=True, eq=False)
class Tried:
    """Where a search with delays of whole ticks ended."""

    ticks: dict[int, int]  # by parameter
    at: dict[int, float]  # s
    point: Point


def profile(
    problem: Problem, which: Sequence[int], robust: float | None, tried: Sequence[int] = TRIED
) -> Tried:
    """Return the likeliest of delays of whole ticks beyond those held, one delay after the other."""
    dt = max(r.dt for r in problem.recordings)
    p = problem.parameters
    base = np.nan_to_num(p.fixed)
    low = np.where(np.isnan(p.fixed), p.low, BOUNDS["delay"][0])
    high = np.where(np.isnan(p.fixed), p.high, BOUNDS["delay"][1])
    known: dict[tuple[int, ...], Point | None] = {}

    def look(ticks: tuple[int, ...]) -> Point | None:
        if ticks not in known:
            at = {i: float(base[i]) + k * dt for i, k in zip(which, ticks, strict=True)}
            inside = all(low[i] <= value <= high[i] for i, value in at.items())
            known[ticks] = _searched(with_delays(problem, at), robust) if inside else None
        return known[ticks]

    def likeliest(every: list[tuple[int, ...]]) -> tuple[int, ...]:
        points = {ticks: point for ticks in every if (point := look(ticks)) is not None}
        quiet = min((loudness(p, problem) for p in known.values() if p is not None), default=inf)
        return min(
            (t for t, point in points.items() if loudness(point, problem) <= LOUDER * quiet),
            key=lambda ticks: points[ticks].likelihood,
            default=best,
        )

    best = (0,) * len(which)
    for j in range(len(which)):
        best = likeliest([_with(best, j, k) for k in tried])
        while (lower := likeliest([_with(best, j, best[j] + k) for k in (0, -1, 1)])) != best:
            best = lower
    point = known[best]
    if point is None:
        raise ValueError("delay: its bounds contain no whole tick; give wider ones")
    ticks = dict(zip(which, best, strict=True))
    at = {i: float(base[i]) + k * dt for i, k in ticks.items()}
    return Tried(ticks=ticks, at=at, point=point)


def fitted_over_ticks(
    problem: Problem,
    guesses: Sequence[Values],
    *,
    starts: int,
    robust: float | None,
    seed: int,
    before: Fitted | None = None,
) -> Fitted:
    """Return the same as `fitted`; where a delay is free, the likeliest within half a tick of a whole one.

    From the likeliest whole ticks and from none; where that ends at a bend, from the tick beyond, too. Where it is at
    a bend still, the intervals hold what was found beyond.
    """
    which = delays(problem)
    if not which or before is not None:
        return fitted(problem, guesses, starts=starts, robust=robust, seed=seed, before=before)
    dt = max(r.dt for r in problem.recordings)
    known: dict[tuple[int, ...], Fitted] = {}

    def look(ticks: tuple[int, ...], start: Values) -> float:
        if ticks not in known:
            cell = with_delays(
                problem, {i: k * dt for i, k in zip(which, ticks, strict=True)}, 0.5 * dt
            )
            start = cell.parameters.clip(start)
            known[ticks] = fitted(cell, [start], starts=starts, robust=robust, seed=seed)
        return known[ticks].found.likelihood

    tried = profile(problem, which, robust)
    first, none = tuple(tried.ticks[i] for i in which), (0,) * len(which)
    look(first, tried.point.values)
    look(none, guesses[0])
    quiet = min(loudness(fit.found, problem) for fit in known.values())
    best = min(
        (ticks for ticks, fit in known.items() if loudness(fit.found, problem) <= LOUDER * quiet),
        key=lambda ticks: known[ticks].found.likelihood,
    )
    beyond = best
    for _ in range(MOST_CELLS):
        values = known[best].optimum
        aside = np.array([values[i] / dt - k for i, k in zip(which, best, strict=True)])
        steps = np.where(np.abs(aside) > 0.5 - AT_BEND, np.sign(aside), 0).astype(int)
        beyond = tuple((np.array(best) + steps).tolist())
        if beyond in known or look(beyond, values) >= known[best].found.likelihood:
            break
        best = beyond
    fit = known[best]
    off = (
        (known[beyond].values - fit.values)[problem.parameters.free]
        if beyond in known
        else np.zeros(0)
    )
    whole = copy(fit.problem)  # only its bounds are others
    object.__setattr__(whole, "parameters", problem.parameters)
    return replace(fit, problem=whole, covariance=fit.covariance + np.outer(off, off))


def in_cell(problem: Problem, tried: Tried, robust: float | None) -> Point | None:
    """Return where a search ends that moves the delays by half a tick from where they were tried."""
    dt = max(r.dt for r in problem.recordings)
    cell = with_delays(problem, tried.at, 0.5 * dt)
    try:
        return search_from(cell, cell.parameters.clip(tried.point.values), robust)
    except ValueError:
        return None


def _with(ticks: tuple[int, ...], which: int, value: int) -> tuple[int, ...]:
    return (*ticks[:which], value, *ticks[which + 1 :])


def _searched(problem: Problem, robust: float | None) -> Point | None:
    try:
        return search_from(problem, better_guess(problem), robust)
    except ValueError:  # the model runs away
        return None
