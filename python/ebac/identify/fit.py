"""Go from a problem to estimates: search, correct for noise of the input, compute intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values
from ebac.identify import unrecorded_motor
from ebac.identify.beside_drift import NOT_A_DRIFT, BesideDrift, beside_drift
from ebac.identify.bias import drifting, largest_drift, likely_drift, likely_noise, without_noise
from ebac.identify.intervals import covariance
from ebac.identify.level_forces import LevelForces
from ebac.identify.moving_target import of_late_paths
from ebac.identify.parameters import Parameters, kind
from ebac.identify.problem import Problem
from ebac.identify.search import Found, least_squares

#: Rounds of: filter for the guess, search with that filter.
MOST_ROUNDS = 6
#: Rounds with a drift, which are refined beside it anyway.
ROUNDS_BESIDE = 1
#: Rounds of a search without a drift, from values found with one, after which it is near where nothing drifts.
ROUNDS_TO_TELL = 2
ROUGHLY, EXACTLY = 0.1, 1e-4
#: Falls of -2 log of the likelihood by less are rounding.
LIKELIER = 1e-3
#: Settled when the last round moved by less than this, in deviations squared.
SETTLED = 1e-2


@dataclass(frozen=True, kw_only=True, eq=False)
class Fitted:
    """Values of all parameters, covariance of the free ones, and what is left over."""

    problem: Problem  # with the drift that was found
    values: Values
    optimum: Values  # of the search, before the noise of the input is taken off
    force_noise: Values
    errors: Values
    covariance: NDArray[np.float64]
    found: Point


def fitted(
    problem: Problem,
    guesses: Sequence[Values],
    *,
    starts: int,
    robust: float | None,
    seed: int,
    before: Fitted | None = None,
    drifts: bool = True,
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
    before : Fitted, optional
        What was found from the guesses alone; returned where no further start leads to anything likelier.
    drifts : bool
        Whether the forces may drift, as those of a sensor do.
    """
    best, beside = before.found if before else None, None
    if best is None:
        best, beside = _from_guesses(problem, guesses, robust, drifts=drifts)
    within = before.problem if before else beside[0] if beside else problem
    draw, first = np.random.Generator(np.random.PCG64(seed)), best
    for _ in range(starts - 1):
        other = search_from(within, _elsewhere(best.values, problem.parameters, draw), robust)
        if other.likelihood < best.likelihood - (ROUGHLY if within.drift else LIKELIER):
            best = other
    if before is not None and best is first:
        return before
    if within.drift and best is not first:
        beside = beside_drift(within, best.values, best.force_noise, robust)
    values, noise, doubted = best.values, best.force_noise, None
    if beside is not None:
        problem, values, noise, doubted = beside
    gains = problem.gains(values, noise)
    values, pretended = without_noise(problem, values, noise, gains)
    errors = problem.errors(values, gains)
    spread = _spread(problem, values, noise, errors, pretended, robust, doubted)
    return Fitted(
        problem=problem,
        values=problem.parameters_within(unrecorded_motor.corrected(problem, values)),
        optimum=best.values,
        force_noise=noise,
        errors=errors,
        covariance=spread,
        found=best,
    )


def _from_guesses(
    problem: Problem, guesses: Sequence[Values], robust: float | None, *, drifts: bool
) -> tuple[Point, BesideDrift | None]:
    """Return the likeliest point; with a drift of the forces where the errors ask for one, since it misleads a fit.

    The errors at a guess may ask for one because the guess is bad. So a drift is fitted along, roughly, and is
    believed where a search without it, from there on, asks for it still. Where they ask for the largest, the model is
    wrong, as with a force of the other sign: such a drift would explain anything.
    """
    along: list[tuple[Problem, Point]] = []
    steady: list[Point | None] = []
    for guess in guesses:
        start, drift = guess, likely_drift(problem, guess, problem.shown, robust) if drifts else 0.0
        lasting = 0 < drift < NOT_A_DRIFT * largest_drift(problem)
        if lasting:
            at = problem.drifting(drift)
            along.append((at, search_from(at, guess, robust)))
            start = along[-1][1].values
        steady.append(_unless_drifting(problem, start, robust, drifts=lasting))
    if None in steady:
        at, point = min(along, key=lambda pair: pair[1].likelihood)
        beside = beside_drift(at, point.values, point.force_noise, robust)
        if beside is not None:
            return point, beside
        steady = [search_from(problem, guess, robust) for guess in guesses]
    found = [point for point in steady if point is not None]
    return min(found, key=lambda point: point.likelihood), None


def _spread(
    problem: Problem,
    values: Values,
    noise: Values,
    errors: Values,
    pretended: Values,
    robust: float | None,
    doubted: Values | None = None,
) -> NDArray[np.float64]:
    """Return the covariance of the free parameters at some values; what moved may be off by `doubted`, too."""
    gains = problem.gains(values, noise)
    moved, unseen = problem.moved, problem.unseen
    if problem.drift:
        jacobian = problem.renewed(values, noise)[1][:, : len(errors)]
        beside = problem.jacobian(values, gains, unseen.which)
    else:
        both = problem.jacobian(values, gains, np.concatenate([moved, unseen.which]))
        jacobian, beside = both[: len(moved)], both[len(moved) :]
    beside *= unseen.deviation[:, None]
    beside = np.vstack([beside, of_late_paths(problem, values, gains, errors)])
    lengths = [len(r.t) for r in problem.recordings]
    sure = problem.doubt.deviation
    found = covariance(jacobian, errors, lengths, robust, sure, pretended, beside, problem.folds)
    if doubted is not None:
        found = found + np.outer(doubted, doubted)
    return unrecorded_motor.with_any_share(problem, values, found)


def spread_at(problem: Problem, values: Values) -> NDArray[np.float64]:
    """Return the covariance that a log gives at values that are known, as only a simulation knows them."""
    noise = likely_noise(problem, values, problem.shown)
    gains = problem.gains(values, noise)
    _, pretended = without_noise(problem, values, noise, gains)
    return _spread(problem, values, noise, problem.errors(values, gains), pretended, None)


@dataclass(frozen=True, kw_only=True, eq=False)
class Point:
    """Where a search ended, with the filter for it."""

    converged: bool
    values: Values
    force_noise: Values
    likelihood: float
    evaluations: int


def search_from(problem: Problem, start: Values, robust: float | None) -> Point:
    """Make the filter for the guess, search with it, until the two agree."""
    point = _unless_drifting(problem, start, robust, drifts=False)
    assert point is not None
    return point


def _unless_drifting(
    problem: Problem, start: Values, robust: float | None, *, drifts: bool
) -> Point | None:
    """Do the same; None where forces may drift and the first round shows that they do, which no further one would find.

    The first filter is made for the noise that the force shows: at a bad guess a far larger one is likelier, and with
    it anything fits.
    """
    values, noise, evaluations = start, problem.shown, 0
    forces = LevelForces.of(problem)
    for i in range(ROUNDS_BESIDE if problem.drift else MOST_ROUNDS):
        if i > 0:
            noise = likely_noise(problem, values, noise, robust)
        began = forces.moved(values)
        how = {"tolerance": EXACTLY if i > 0 and not problem.drift else ROUGHLY}
        if i == 0 and drifts:
            how["most"] = ROUNDS_TO_TELL
        found = _with_filter(problem, values, noise, forces, robust, **how)
        evaluations += found.evaluations
        values = forces.full(found.values, values)
        if i == 0 and drifts and drifting(problem, values, noise, robust):
            return None
        step = found.values - began
        if i > 0 and float(step @ found.information @ step) < SETTLED:
            break
    gains = problem.gains(values, noise)
    likelihood = found.cost + sum(g.log_sum for g in gains)
    return Point(
        converged=found.converged,
        values=values,
        force_noise=noise,
        likelihood=likelihood,
        evaluations=evaluations,
    )


def _with_filter(
    problem: Problem,
    values: Values,
    noise: Values,
    forces: LevelForces,
    robust: float | None,
    **how: Any,
) -> Found:
    """Search from some values with the filter made for them."""
    gains = problem.gains(values, noise)
    low, high = forces.bounds
    return least_squares(
        lambda part: forces.linearised(forces.full(part, values), gains),
        forces.moved(values),
        low,
        high,
        robust=robust,
        **how,
    )


#: Where hands are, from fingers to arms: M0 [kg], B0 [N s/m], K0 [N/m].
HANDS = {"M0": (0.01, 3.0), "B0": (0.5, 40.0), "K0": (30.0, 2000.0)}


def _elsewhere(values: Values, parameters: Parameters, draw: np.random.Generator) -> Values:
    """Return another start: a hand as hands are, the rest as it was."""
    out = values.copy()
    for i, name in enumerate(parameters.names):
        if kind(name) in HANDS:
            low, high = HANDS[kind(name)]
            out[i] = low * (high / low) ** draw.random()
    return parameters.clip(out)
