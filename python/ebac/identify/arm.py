"""Identify the human arm of eq. (4) from logs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from ebac.identify.counts import with_counts
from ebac.identify.fit import fitted
from ebac.identify.guess import regression, solve
from ebac.identify.likelihood import minus_two_log
from ebac.identify.parameters import BEFORE_LEVELS, kind, lay_out
from ebac.identify.problem import Problem
from ebac.identify.recording import Recording
from ebac.identify.response import guess_by_response
from ebac.identify.result import ArmResult
from ebac.identify.target import Target
from ebac.identify.verdict import FASTEST

Values = NDArray[np.float64]

#: Starts of a search whose first outcome determines a part of the hand only, or one that answers within a few rows.
AGAIN = 4


def fit_arm(
    recordings: Recording | Sequence[Recording],
    targets: Target | Sequence[Target] | None = None,
    *,
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    free: Sequence[str] = (),
    own: Sequence[str] = (),
    starts: int = 1,
    robust: float | None = None,
    seed: int = 1,
) -> ArmResult:
    """Fit M0, B0, K0 and the targets X0 of eq. (4) to one or more recordings of one arm.

    The force of the hand drives the model, the position is compared: what lies on the other side of the force sensor,
    device, law and
    wall, need not be known. The force reading is an input with noise, so the errors are those of a Kalman filter one
    tick ahead; its
    initial state is free. The noise of the force is estimated along.

    Parameters
    ----------
    recordings : Recording or sequence of them
        With position and force of the hand.
    targets : Target or sequence of them, optional
        One for each recording; default: held in one place.
    fixed : mapping, optional
        Values that are not fitted, by name: `{"M0": 0.2}` [kg], B0 [N s/m], K0 [N/m], X0, X0/2 [m], delay, onset [s].
        A name of one recording carries its number: `X0@2`.
    bounds : mapping, optional
        (low, high) by name.
    free : sequence of str, optional
        Fit `delay` or `onset` too, which are 0 otherwise.
    own : sequence of str, optional
        Which of M0, B0, K0, delay every recording has for itself.
    starts : int
        From how many points the search starts, at least 1; from 4 at least where the first one tells a part of the
        hand only, or a hand that answers within two rows.
    robust : float, optional
        Errors beyond so many standard deviations count linearly (Huber); 1.345 keeps 95 % of the efficiency.
    seed : int
        Of the further starts.

    Returns
    -------
    ArmResult

    Raises
    ------
    ValueError
        For a recording without force, a name that does not exist, a value out of range.
    """
    began = perf_counter()
    if isinstance(recordings, Recording):
        recordings = [recordings]
    if targets is None or isinstance(targets, Target):
        targets = [targets or Target.held()] * len(recordings)
    _check(recordings, targets, starts, robust)
    parameters = lay_out(
        [t.levels for t in targets],
        fixed=fixed or {},
        bounds=bounds or {},
        free=free,
        own=own,
    )
    problem = Problem(recordings=tuple(recordings), targets=tuple(targets), parameters=parameters)
    result = _searched(problem, starts, robust, seed, began)
    if starts < AGAIN and (_partly_told(result) or _too_fast(result)):
        result = _searched(problem, AGAIN, robust, seed, began)
    return result


def _searched(
    problem: Problem, starts: int, robust: float | None, seed: int, began: float
) -> ArmResult:
    fit = fitted(problem, [better_guess(problem)], starts=starts, robust=robust, seed=seed)
    return ArmResult(
        problem=problem,
        values=fit.values,
        optimum=fit.optimum,
        force_noise=fit.force_noise,
        errors=fit.errors,
        covariance=with_counts(problem, fit.covariance),
        robust=robust,
        converged=fit.converged,
        evaluations=fit.evaluations,
        seconds=perf_counter() - began,
    )


def _partly_told(result: ArmResult) -> bool:
    """Return whether some of M0, B0, K0 are determined and others not: often an optimum beside the true one."""
    p = result.parameters
    hand = {p.names[i] for i in p.free if kind(p.names[i]) in ("M0", "B0", "K0")}
    return 0 < len(hand.intersection(result.undetermined)) < len(hand)


def _too_fast(result: ArmResult) -> bool:
    """Return whether a hand answers within a few rows: in free air the errors between rows make such an optimum."""
    dt = max(r.dt for r in result.recordings)
    return any(
        result.values[p[0]] < FASTEST * dt * result.values[p[1]] for p in result.parameters.places
    )


def _check(
    recordings: Sequence[Recording],
    targets: Sequence[Target],
    starts: int,
    robust: float | None,
) -> None:
    if not recordings:
        raise ValueError("no recordings: give at least one")
    if len(targets) != len(recordings):
        raise ValueError(
            f"{len(targets)} targets for {len(recordings)} recordings: give one each, or one for all"
        )
    if starts < 1:
        raise ValueError(f"starts = {starts}: must be at least 1")
    if robust is not None and not robust > 0:
        raise ValueError(f"robust = {robust}: must be positive, in standard deviations")


def better_guess(problem: Problem) -> Values:
    """Return the likelier one of two guesses: by regression over time, and by the spectra of the first recording."""
    by_time = first_guess(problem)
    place = problem.parameters.places[0]
    recording, target = problem.recordings[0], problem.targets[0]
    try:
        found = guess_by_response(recording, target, by_time[place[BEFORE_LEVELS:]])
    except ValueError:  # too short for spectra
        return by_time
    if found is None or not (found > 0).all():
        return by_time
    other = by_time.copy()
    other[place[:3]] = found
    other = problem.parameters.clip(other)
    noise, record = float(problem.shown[0]), problem.records[0]
    costs = [minus_two_log(record, g[place], g[place], noise) for g in (by_time, other)]
    return other if costs[1] < costs[0] else by_time


def first_guess(problem: Problem) -> Values:
    """Return where a search starts, by linear regression, within the bounds."""
    parts = [regression(r, t) for r, t in zip(problem.recordings, problem.targets, strict=True)]
    found, _ = solve(parts)
    found = np.where(np.isfinite(found), found, 0.0)
    values = np.zeros(len(problem.parameters.names))
    positive = [(0.02, 5.0), (0.3, 100.0), (5.0, 5e3)]
    hand = [float(np.clip(v, *limits)) for v, limits in zip(found[:3], positive, strict=True)]
    before = 3
    for place, part, r in zip(problem.parameters.places, parts, problem.recordings, strict=True):
        count = part.columns.shape[1] - 3
        reach = float(np.abs(r.x).max()) + 0.5
        levels = np.clip(found[before : before + count], -reach, reach)
        values[place] = [*hand, *np.zeros(BEFORE_LEVELS - 3), *levels]
        before += count
    return problem.parameters.clip(values)
