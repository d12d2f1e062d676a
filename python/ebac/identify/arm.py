"""Identify the human arm of eq. (4) from logs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import erf, exp, pi, sqrt
from time import perf_counter
from types import NoneType

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number, require, whole
from ebac._util.sequences import several
from ebac._util.wrong_calls import plain_function
from ebac.identify.fit import Fitted
from ebac.identify.informativeness import FASTEST
from ebac.identify.intervals import Z95
from ebac.identify.late_force import Late, late_force
from ebac.identify.parameters import BEFORE_LEVELS, HAND, Parameters, kind, lay_out
from ebac.identify.problem import Problem
from ebac.identify.recording import Recording
from ebac.identify.recording_list import refuse_copies, require_recordings, with_own_names
from ebac.identify.result import ArmResult
from ebac.identify.sign import likely_flip
from ebac.identify.start import better_guess
from ebac.identify.target import Target, require_target
from ebac.identify.unbiased import disagreement
from ebac.identify.validation import POOR
from ebac.identify.whole_ticks import fitted_over_ticks

#: Starts of a search whose first outcome determines a part of the hand only, or one that answers within a few rows.
AGAIN = 4


@plain_function
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

    The recorded force of the hand drives the model, and the predicted position is compared with the recorded one. The
    other side of the force sensor (device, law and wall) need not be known. The force reading is an input with noise,
    so the errors are those of a Kalman filter one tick ahead; its initial state is free. The noise of the force is
    estimated, too.

    Parameters
    ----------
    recordings : Recording or sequence of them
        Recordings with position and force of the hand.
    targets : Target or sequence of them, optional
        Target of the hand in each recording; default: the target that a recording has, else held in one place.
    fixed : mapping, optional
        Values that are not fitted, by name: `{"M0": 0.2}` [kg], B0 [N s/m], K0 [N/m], X0, X0/2 [m], delay, onset [s].
        If a log lacks the motor's force, the delay that its steps cause is fitted all the same; see `ArmResult.notes`.
        For a parameter of one recording, append the number of the recording: `X0@2`.
    bounds : mapping, optional
        (low, high) by name.
    free : sequence of str, optional
        Also fit `delay` or `onset`, which are otherwise 0.
    own : sequence of str, optional
        Which of M0, B0, K0 and delay are fitted separately for every recording.
    starts : int
        Number of points from which the search starts, at least 1. It starts from at least 4 if the first one determines
        only a part of the hand, or a hand that responds within two rows.
    robust : float, optional
        Errors beyond this many standard deviations count linearly (Huber); 1.345 keeps 95 % of the efficiency.
    seed : int
        Seed of the further starts.

    Returns
    -------
    ArmResult

    Raises
    ------
    ValueError
        For a recording without force, or there twice, an unknown name, a value out of range, or a single recording
        whose encoder count hardly changes, so that its fit cannot be tested.
    """
    began = perf_counter()
    require_recordings(recordings, "fit_arm", several=True)
    if isinstance(recordings, Recording):
        recordings = [recordings]
    if targets is None:
        targets = [Target.recorded(r) for r in recordings]
    else:
        wanted = "a Target, such as Target.held(), or one for each recording"
        require(targets, (Target, Sequence), "ebac.identify.fit_arm", wanted)
        targets = [targets] * len(recordings) if isinstance(targets, Target) else targets
    free, own = several("free", free, least=0), several("own", own, least=0)
    require(fixed, (Mapping, NoneType), "fit_arm", "fixed values by name, as {'M0': 0.5}")
    require(bounds, (Mapping, NoneType), "fit_arm", "bounds by name, as {'M0': (0.1, 1)}")
    _check(recordings, targets, starts, robust, seed)
    recordings = with_own_names(recordings)
    parameters = lay_out(
        [t.levels for t in targets],
        fixed=fixed or {},
        bounds=bounds or {},
        free=free,
        own=own,
    )
    problem = _without_pauses(recordings, targets, parameters)
    guesses = [better_guess(problem)]
    fit = fitted_over_ticks(problem, guesses, starts=starts, robust=robust, seed=seed)
    result = _result(fit, robust, began)
    if starts < AGAIN and (_partly_determined(result) or _too_fast(result)):
        again = fitted_over_ticks(
            problem, guesses, starts=AGAIN, robust=robust, seed=seed, before=fit
        )
        if again is not fit:
            result = _result(again, robust, began)
    if result.explained < POOR or result.nothing_determined:
        turned = replace(problem, recordings=tuple(r.flipped() for r in problem.recordings))
        guesses = [better_guess(turned)]
        other = _result(
            fitted_over_ticks(turned, guesses, starts=starts, robust=robust, seed=seed),
            robust,
            began,
            late=False,
        )
        result = replace(
            result,
            other_sign=other.explained,
            flip=likely_flip(recordings, targets, result, other),
        )
    return result


def _without_pauses(
    recordings: Sequence[Recording], targets: Sequence[Target], parameters: Parameters
) -> Problem:
    """Return the problem of all stretches between pauses; those of a recording share all of its parameters."""
    parts: list[Recording] = []
    wanted: list[Target] = []
    places: list[NDArray[np.intp]] = []
    for r, target, place in zip(recordings, targets, parameters.places, strict=True):
        if len(r.stretches) == 1:
            parts.append(r)
            wanted.append(target)
            places.append(place)
            continue
        for i, rows in enumerate(r.stretches, 1):
            cut, levels = target.cut(r, rows)
            parts.append(replace(r.rows(rows), name=f"{r.name} ({i} of {len(r.stretches)})"))
            wanted.append(cut)
            places.append(np.append(place[:BEFORE_LEVELS], place[BEFORE_LEVELS:][list(levels)]))
    return Problem(
        recordings=tuple(parts),
        targets=tuple(wanted),
        parameters=replace(parameters, places=tuple(places)),
    )


def _result(fit: Fitted, robust: float | None, began: float, *, late: bool = True) -> ArmResult:
    result = ArmResult(
        problem=fit.problem,
        values=fit.values,
        optimum=fit.optimum,
        force_noise=fit.force_noise,
        errors=fit.errors,
        covariance=with_counts(fit.problem, fit.covariance),
        robust=robust,
        converged=fit.found.converged,
        evaluations=fit.found.evaluations,
        seconds=perf_counter() - began,
    )
    found = late_force(fit, robust, determined=not result.nothing_determined) if late else None
    return _widened(result, found)


def _widened(result: ArmResult, late: Late | None) -> ArmResult:
    """Return the result with intervals that hold the values of a late force too, or of a contradicting regression."""
    if late is not None:
        off = (late.values - result.values)[result.parameters.free]
        return replace(result, covariance=result.covariance + np.diag(off**2), late=late)
    if all(t.white and t.independent for t in result.tests.values()):
        return result
    if {result.parameters.names[i] for i in result.parameters.free}.issubset(result.undetermined):
        return result  # nothing that another estimate could contradict
    other = disagreement(result)
    apart = [
        other[name] - float(result.values[i])
        if (name := result.parameters.names[i]) in other
        else 0.0
        for i in result.parameters.free
    ]
    return replace(result, covariance=result.covariance + np.outer(apart, apart), regression=other)


def _partly_determined(result: ArmResult) -> bool:
    """Return whether some of M0, B0, K0 are determined and others not: often an optimum beside the true one."""
    p = result.parameters
    hand = {p.names[i] for i in p.free if kind(p.names[i]) in HAND}
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
    seed: int,
) -> None:
    if not recordings:
        raise ValueError("no recordings: give at least one")
    refuse_copies(recordings, [r.name for r in recordings])
    for r, target in zip(recordings, targets, strict=False):
        require_target(r, target, "fit_arm")
    if len(targets) != len(recordings):
        raise ValueError(
            f"{len(targets)} targets for {len(recordings)} recordings: give one each, or one for all"
        )
    if whole("starts", starts) < 1:
        raise ValueError(f"starts = {starts}: must be at least 1")
    if whole("seed", seed) < 0:
        raise ValueError(f"seed = {seed}: must be at least 0")
    if robust is not None and not number("robust", robust) > 0:
        raise ValueError(f"robust = {robust}: must be positive, in standard deviations")


def with_counts(problem: Problem, found: NDArray[np.float64]) -> NDArray[np.float64]:
    """Add what the encoder leaves open of every place: its zero lies anywhere within a count.

    A place is off by the sum of a normal error and of one that is uniform over a count, the same one for all places.
    What is added makes it the normal error whose 95 % are as wide as those of that sum.
    """
    p = problem.parameters
    count = max(r.count for r in problem.recordings)
    out = found.copy()
    more = np.zeros(len(p.free))
    for row, i in enumerate(p.free):
        if kind(p.names[i]) == "X0":
            variance = max(float(found[row, row]), 0.0)
            half = half_width(sqrt(variance), count)
            more[row] = sqrt(max((half / Z95) ** 2 - variance, 0.0))
    return np.asarray(out + np.outer(more, more))


def half_width(deviation: float, count: float) -> float:
    """Return h such that 95 % of the sum of a normal and of an error uniform over a count lie within +-h.

    The widths do not add as squares: where both are alike, that would be 6 % too short and hold 93 %.
    """
    if deviation <= 1e-6 * count:
        return 0.475 * count
    if deviation > 100 * count:  # a count more or less is nothing
        return Z95 * deviation
    low, high = 0.0, Z95 * deviation + 0.5 * count
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = 2 * _mean_below(middle / deviation, count / deviation) - 1
        low, high = (middle, high) if inside < 0.95 else (low, middle)
    return high


def _below(z: float) -> float:
    """Return the probability of a standard normal below z."""
    return 0.5 * (1 + erf(z / sqrt(2)))


def _mean_below(z: float, width: float) -> float:
    """Return the probability below z of a normal whose centre lies anywhere within +-width/2."""

    def area(to: float) -> float:  # under the distribution function
        return to * _below(to) + exp(-0.5 * to * to) / sqrt(2 * pi)

    return (area(z + 0.5 * width) - area(z - 0.5 * width)) / width
