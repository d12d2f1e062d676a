"""The way from a problem to estimates: search, noise of the input taken off, intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac.identify.bias import without_noise
from ebac.identify.intervals import covariance
from ebac.identify.likelihood import likely_noise, shown_noise
from ebac.identify.parameters import Parameters
from ebac.identify.problem import Problem
from ebac.identify.search import Found, least_squares

Values = NDArray[np.float64]

#: Rounds of: filter for the guess, search with that filter.
MOST_ROUNDS = 6
#: Settled when the last round moved by less than this, in deviations squared.
SETTLED = 1e-2


@dataclass(frozen=True, kw_only=True, eq=False)
class Fitted:
    """Values of all parameters, covariance of the free ones, and what is left over."""

    values: Values
    optimum: Values  # of the search, before the noise of the input is taken off
    force_noise: Values
    errors: Values
    covariance: NDArray[np.float64]
    cost: float
    converged: bool
    evaluations: int


def fitted(
    problem: Problem, guesses: Sequence[Values], *, starts: int, robust: float | None, seed: int
) -> Fitted:
    """Search from every guess and from `starts` - 1 random points around the best; then judge the best.

    Parameters
    ----------
    problem : Problem
        What is fitted.
    guesses : sequence of arrays
        Values of all parameters to start from.
    starts : int
        How many points in all, beyond the guesses.
    robust : float or None
        Where Huber's loss begins, in deviations.
    seed : int
        Of the further starts.
    """
    parameters = problem.parameters
    found = [_search(problem, guess, robust) for guess in guesses]
    best = min(found, key=lambda point: point.likelihood)
    draw = np.random.Generator(np.random.PCG64(seed))
    for _ in range(starts - 1):
        other = _search(problem, _elsewhere(best.values, parameters, draw), robust)
        if other.likelihood < best.likelihood - 1e-3:
            best = other
    gains = problem.gains(best.values, best.force_noise)
    values, pretended = without_noise(problem, best.values, best.force_noise, gains)
    errors = problem.errors(values, gains)
    jacobian = problem.jacobian(values, gains, problem.moved)
    unseen = problem.jacobian(values, gains, problem.unseen.which)
    unseen *= problem.unseen.deviation[:, None]
    lengths = [len(r.t) for r in problem.recordings]
    spread = covariance(
        jacobian, errors, lengths, robust, problem.doubt.deviation, pretended, unseen
    )
    return Fitted(
        values=values,
        optimum=best.values,
        force_noise=best.force_noise,
        errors=errors,
        covariance=spread,
        cost=best.likelihood,
        converged=best.found.converged,
        evaluations=best.evaluations,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Point:
    found: Found
    values: Values
    force_noise: Values
    likelihood: float
    evaluations: int


def _search(problem: Problem, start: Values, robust: float | None) -> _Point:
    """Make the filter for the guess, search with it, until the two agree.

    The first filter is made for the noise that the force shows: at a bad guess a far larger one is likelier, and with
    it anything fits.
    """
    values, evaluations = start, 0
    noise = np.array([shown_noise(r) for r in problem.recordings])
    p = problem.parameters
    moved_by = problem.moved
    for i in range(MOST_ROUNDS):
        if i > 0:
            noise = likely_noise(problem, values, noise, robust)
        gains = problem.gains(values, noise)

        def spread(part: Values, base: Values = values) -> Values:
            full = base.copy()
            full[moved_by] = part
            return full

        found = least_squares(
            lambda part, gains=gains, spread=spread: problem.objective(spread(part), gains),  # type: ignore[misc]
            lambda part, gains=gains, spread=spread: problem.slope(spread(part), gains),  # type: ignore[misc]
            values[moved_by],
            p.low[moved_by],
            p.high[moved_by],
            robust=robust,
        )
        evaluations += found.evaluations
        moved = found.values - values[moved_by]
        values = spread(found.values)
        if i > 0 and float(moved @ found.information @ moved) < SETTLED:
            break
    gains = problem.gains(values, noise)
    likelihood = found.cost + sum(g.log_sum for g in gains)
    return _Point(
        found=found,
        values=values,
        force_noise=noise,
        likelihood=likelihood,
        evaluations=evaluations,
    )


def _elsewhere(values: Values, parameters: Parameters, draw: np.random.Generator) -> Values:
    """Return another start: M0, B0, K0 up to four times larger or smaller."""
    out = values.copy()
    for i, name in enumerate(parameters.names):
        if name[0] in "MBK":
            out[i] = max(abs(values[i]), 1e-2) * 4 ** draw.uniform(-1, 1)
    return parameters.clip(out)
