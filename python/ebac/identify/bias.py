"""Noise of an input: its most likely size, what it does to an estimate, and how to correct for that."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ebac._core import ArmGains, ArmRecord
from ebac._util.arrays import Values
from ebac.identify.problem import Problem
from ebac.identify.signals import rough

#: The noise that moves a hand is at least what the force signal itself shows, and this many times that at most.
WIDEST = 300.0
#: First step of the logarithm of the noise, and how near is near enough.
STEP, NEAR = 0.1, 0.02


def minus_two_log(
    problem: Problem,
    values: Values,
    noises: Values,
    drifts: Sequence[float],
    robust: float | None = None,
) -> Values:
    """Return -2 log of the likelihood of each of some trials, but for a constant.

    A trial is a row of `noises`, one for each recording [N], and a drift [N/sqrt(s)]; Huber's loss counts beyond
    `robust` deviations. Several trials at once cost little more than one.
    """
    held, out = problem.held(values), np.zeros(len(drifts))
    wander = [problem.wander(float(drift)) for drift in drifts]
    parts = zip(problem.records, problem.parameters.places, noises.T, strict=True)
    for record, place, mine in parts:
        theta, made = (np.tile(v[place], (len(drifts), 1)) for v in (values, held))
        noise = [(float(n), *w) for n, w in zip(mine, wander, strict=True)]
        out += record.judge(theta, made, noise, robust or 0.0)
    return out


def likely_noise(
    problem: Problem, values: Values, before: Values, robust: float | None = None
) -> Values:
    """Return the standard deviation of each recording's force [N] that makes its errors likeliest, from one before on.

    It stands for all that moves a hand beside eq. (4), tremor too, as far as that is white.
    """
    found = []
    held, wander = problem.held(values), problem.wander(problem.drift)
    parts = zip(problem.records, problem.parameters.places, np.log(problem.shown), strict=True)
    for i, (record, place, shown) in enumerate(parts):

        def unlikely(
            z: Values, record: ArmRecord = record, place: NDArray[np.intp] = place
        ) -> Values:
            theta, made = (np.tile(v[place], (len(z), 1)) for v in (values, held))
            noise = [(n, *wander) for n in np.exp(z).tolist()]
            return record.judge(theta, made, noise, robust or 0.0)

        limits = float(shown), float(shown + np.log(WIDEST))
        found.append(float(np.exp(lowest(unlikely, float(np.log(before[i])), STEP, *limits))))
    return np.array(found)


#: Drifts of a force that are tried, in deviations of the force over one second; a fit that ends beyond the last has no
#: drift but a wrong model, such as a force of the wrong sign.
DRIFTS, LARGEST_DRIFT = (0.003, 0.03, 0.3), 0.4
#: By how much -2 log of the likelihood must fall for a drift to be believed.
BELIEVED = 10.0
#: Noise that is this many times the shown one may be a drift.
LOUD = 1.2


def drifting(
    problem: Problem, values: Values, noise: Values, robust: float | None = None
) -> tuple[float, Values] | None:
    """Return a drift of the forces [N/sqrt(s)] and a noise for it, of those in `DRIFTS`; None without.

    It is believed where it is clearly likelier than none. A random walk is the slow part of a reading that a hand does
    not follow: the sensor warms, or the place the hand wants to be wanders. Fitted without it, the noise is too large;
    so each drift is tried with the noise shown, too.
    """
    scale = largest_drift(problem) / LARGEST_DRIFT
    noises = [noise] if (noise < LOUD * problem.shown).all() else [noise, problem.shown]
    tried = [(0.0, noise), *((d * scale, n) for n in noises for d in DRIFTS)]
    cost = minus_two_log(
        problem, values, np.array([n for _, n in tried]), [d for d, _ in tried], robust
    )
    best = int(np.argmin(cost))
    return tried[best] if cost[best] <= cost[0] - BELIEVED else None


def likely_drift(
    problem: Problem, values: Values, noise: Values, robust: float | None = None
) -> float:
    """Return the drift of the forces [N/sqrt(s)] that makes the errors likeliest; 0 where none is clearly likelier.

    At most `largest_drift`.
    """
    largest = largest_drift(problem)
    start = problem.drift
    if not start:
        found = drifting(problem, values, noise, robust)
        if found is None:
            return 0.0
        start, noise = found

    def unlikely(drifts: Values) -> Values:
        return minus_two_log(
            problem, values, np.tile(noise, (len(drifts), 1)), drifts.tolist(), robust
        )

    low, high = np.log(0.1 * DRIFTS[0] * largest / LARGEST_DRIFT), np.log(largest)
    at = float(np.clip(np.log(start), low, high))
    drift = float(np.exp(lowest(lambda z: unlikely(np.exp(z)), at, STEP, low, high)))
    if problem.drift:
        with_it, without = unlikely(np.array([drift, 0.0]))
        return drift if with_it < without - BELIEVED else 0.0
    return drift


def largest_drift(problem: Problem) -> float:
    """Return beyond which a drift is none, but a wrong model [N/sqrt(s)]."""
    forces = [float(np.std(r.force)) for r in problem.recordings if r.force is not None]
    return LARGEST_DRIFT * max(forces)


#: Where a search along a line begins, and how it goes on beyond what was tried, in steps.
BEGIN, BEYOND = (-1, 0, 1, 4, 16), (1, 3, 9, 27)
#: Of three places no farther apart, a parabola is near enough.
CLOSE = 5.5 * NEAR
#: Calls after which it stays where it is.
MOST_CALLS = 12


def lowest(
    f: Callable[[Values], Values], start: float, step: float, low: float, high: float
) -> float:
    """Return where f is least between two bounds: downhill in growing steps, then by parabolas, to `NEAR`.

    f has one valley, and takes up to four places at once: every call costs a filter over the whole log, for four
    hardly more than for one.
    """
    at, height = np.zeros(0), np.zeros(0)
    new = np.unique(np.clip([start + step * k for k in BEGIN], low, high))[:4]
    for _ in range(MOST_CALLS):
        at, height = np.append(at, new), np.append(height, f(new))
        order = np.argsort(at)
        at, height = at[order], height[order]
        best = int(np.argmin(height))
        b, last = float(at[best]), len(at) - 1
        if best in (0, last):
            bound, to = (low, 1) if best == 0 else (high, -1)
            if b != bound:
                width = abs(b - float(at[best + to]))
                new = np.unique(np.clip([b - to * width * k for k in BEYOND], low, high))
            elif abs(float(at[best + to]) - b) < 1.01 * NEAR:
                return b
            else:  # is it the bound, or something before it?
                room = float(at[best + to]) - b
                new = b + np.array([to * NEAR, 0.25 * room, 0.5 * room, 0.75 * room])
                new = new[np.abs(new - b) < 0.99 * abs(room)]
            continue
        a, c = float(at[best - 1]), float(at[best + 1])
        left, right = (
            (b - a) * (height[best] - height[best + 1]),
            (b - c) * (height[best] - height[best - 1]),
        )
        if left == right:  # flat
            return b
        bottom = b - 0.5 * float(((b - a) * left - (b - c) * right) / (left - right))
        if max(b - a, c - b) < CLOSE:
            return bottom
        middle = 0.5 * (b + (a if b - a > c - b else c))
        new = np.array([bottom - 2 * NEAR, bottom, bottom + 2 * NEAR, middle])
        new = new[(np.abs(new - b) > 0.1 * NEAR) & (new > a) & (new < c)]
        if not new.size:
            return bottom
    return b


#: Logs of noise that are averaged over.
DRAWS = 4
#: Largest correction, as a share of what is left of a parameter's information.
LARGEST_SHARE = 0.5
#: Least information, as a share of the best direction's, by which anything is corrected.
LEAST_SHARE = 1e-9


def without_noise(
    problem: Problem, values: Values, force_noise: Values, gains: list[ArmGains]
) -> tuple[Values, Values]:
    """Return the values without the bias of a noisy input, and the Jacobian of the noise.

    The force reading drives the model, noise and all: noise is taken for force that moved nothing, so the hand comes
    out too heavy (errors in variables, attenuation). The score that noise alone gives is known, it is that of a log
    of noise; taken off, the score has mean zero at the truth (Nakamura 1990). One Newton step from the optimum does it.
    A fit with a drift has no such bias: its values stay as they are.

    Only what the sensor itself shows counts, not what else disturbs a hand.
    """
    noise = np.array(
        [
            min(found, rough(r.force))
            for r, found in zip(problem.recordings, force_noise.tolist(), strict=True)
            if r.force is not None
        ]
    )
    moved = problem.moved
    if problem.drift:
        return values, problem.of_noise(values, gains, noise, moved)[0]
    score = np.zeros(len(moved))
    information = np.zeros((len(moved), len(moved)))
    pretended = np.zeros((len(moved), 0))
    for seed in range(DRAWS):
        J, e = problem.of_noise(values, gains, noise, moved, seed)
        score += np.einsum("ik,k->i", J, e) / DRAWS
        information += np.einsum("ik,jk->ij", J, J) / DRAWS
        pretended = J
    S = problem.slope(values, gains)
    H = np.einsum("ik,jk->ij", S, S)
    scale = np.sqrt(np.diag(H))
    scale[scale == 0] = 1.0
    known = (H - information) / np.outer(scale, scale)
    least = np.linalg.eigvalsh(H / np.outer(scale, scale))[0]
    if np.linalg.eigvalsh(known)[0] < max(LARGEST_SHARE * least, LEAST_SHARE):
        return values, pretended  # noise is most of what there is: nothing to correct by
    out = values.copy()
    out[moved] += np.linalg.solve(known, score / scale) / scale
    return problem.parameters_within(out), pretended
