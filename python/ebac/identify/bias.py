"""Noise of an input: its most likely size, what it does to an estimate, and how to correct for that."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ebac._core import ArmGains, ArmRecord
from ebac.identify.problem import Problem
from ebac.identify.search import loss
from ebac.identify.signals import rough

#: The noise that moves a hand is at least what the force signal itself shows, and so many times that at most.
WIDEST = 300.0
#: First step of the logarithm of the noise, and how near is near enough.
STEP, NEAR = 0.1, 0.02

Values = NDArray[np.float64]


def minus_two_log(
    record: ArmRecord,
    theta: Values,
    held: Values,
    force_noise: float,
    robust: float | None = None,
    wander: tuple[float, float] = (0.0, 0.0),
) -> float:
    """Return -2 log of the likelihood, but for a constant; with Huber's loss beyond `robust` deviations.

    `held` is what the filter is made for, see `Problem.held`, `wander` the drift of the force, see `Problem.wander`.
    """
    e, log_sum = record.filtered(theta, held, (force_noise, *wander))
    return loss(e, robust) + log_sum


def likely_noise(
    problem: Problem, values: Values, before: Values, robust: float | None = None
) -> Values:
    """Return the standard deviation of each recording's force [N] that makes its errors likeliest, from one before on.

    It stands for all that moves a hand beside eq. (4), tremor too, as far as that is white.
    """
    found = []
    quiet, wander = problem.held(values), problem.wander(problem.drift)
    parts = zip(problem.records, problem.parameters.places, np.log(problem.shown), strict=True)
    for i, (record, place, shown) in enumerate(parts):

        def unlikely(
            z: float,
            record: ArmRecord = record,
            theta: Values = values[place],
            held: Values = quiet[place],
        ) -> float:
            return minus_two_log(record, theta, held, float(np.exp(z)), robust, wander)

        limits = float(shown), float(shown + np.log(WIDEST))
        found.append(float(np.exp(lowest(unlikely, float(np.log(before[i])), STEP, *limits))))
    return np.array(found)


#: Drifts of a force that are tried, in deviations of the force over one second; a fit that ends beyond the last has no
#: drift but a wrong model, such as a force of the wrong sign.
DRIFTS, LARGEST_DRIFT = (0.003, 0.03, 0.3), 0.4
#: By how much -2 log of the likelihood must fall for a drift to be believed.
BELIEVED = 10.0
#: Noise that is so many times the shown one may be a drift.
LOUD = 1.2


def likely_drift(
    problem: Problem, values: Values, noise: Values, robust: float | None = None
) -> float:
    """Return the drift of the forces [N/sqrt(s)] that makes the errors likeliest; 0 where none is clearly likelier.

    At most `largest_drift`.

    A random walk is the slow part of a reading that a hand does not follow: the sensor warms, or the place the hand
    wants to be wanders. Fitted without it, the noise is too large; so each drift is tried with the noise shown, too.
    """
    held = problem.held(values)
    largest = largest_drift(problem)
    scale = largest / LARGEST_DRIFT

    def unlikely(drift: float, noise: Values) -> float:
        parts = zip(problem.records, problem.parameters.places, noise, strict=True)
        wander = problem.wander(drift)
        return sum(
            minus_two_log(r, values[p], held[p], float(n), robust, wander) for r, p, n in parts
        )

    noises = [noise] if (noise < LOUD * problem.shown).all() else [noise, problem.shown]
    start = problem.drift
    if not start:
        tried = [(unlikely(d * scale, n), d, i) for d in DRIFTS for i, n in enumerate(noises)]
        cost, share, which = min(tried)
        if cost > unlikely(0.0, noise) - BELIEVED:
            return 0.0
        start, noise = share * scale, noises[which]
    low, high = np.log(0.1 * DRIFTS[0] * scale), np.log(largest)
    at = float(np.clip(np.log(start), low, high))
    found = float(np.exp(lowest(lambda z: unlikely(float(np.exp(z)), noise), at, STEP, low, high)))
    believed = not problem.drift or unlikely(found, noise) < unlikely(0.0, noise) - BELIEVED
    return found if believed else 0.0


def largest_drift(problem: Problem) -> float:
    """Return beyond which a drift is none, but a wrong model [N/sqrt(s)]."""
    forces = [float(np.std(r.force)) for r in problem.recordings if r.force is not None]
    return LARGEST_DRIFT * max(forces)


def lowest(
    f: Callable[[float], float], start: float, step: float, low: float, high: float
) -> float:
    """Return where f is least between two bounds: downhill in growing steps, then by parabolas, to `NEAR`.

    f has one valley. Every call costs a filter over the whole log, which is why it is not golden section.
    """
    a, b = start, min(start + step, high)
    fa, fb = f(a), f(b)
    if fb > fa:
        a, b, fa, fb = b, a, fb, fa
    while True:  # b is below a; c is beyond b
        c = min(max(b + 2 * (b - a), low), high)
        if c == b:  # a bound: is it the lowest, or something before it?
            while abs(b - a) > NEAR:
                middle = 0.5 * (a + b)
                fm = f(middle)
                if fm < fb:
                    c, fc, b, fb = b, fb, middle, fm
                    break
                a, fa = middle, fm
            else:
                return b
            break
        fc = f(c)
        if fc >= fb:
            break
        a, b, fa, fb = b, c, fb, fc
    for _ in range(12):
        left, right = (b - a) * (fb - fc), (b - c) * (fb - fa)
        if left == right:  # flat
            return b
        bottom = b - 0.5 * ((b - a) * left - (b - c) * right) / (left - right)
        if abs(bottom - b) < NEAR:
            far = a if abs(a - b) > abs(c - b) else c
            if abs(far - b) < 5 * NEAR:
                return bottom
            bottom = b + float(np.copysign(2 * NEAR, far - b))  # a parabola creeps from the side
        fn = f(bottom)
        if fn < fb:  # the lowest of three, and its neighbours
            a, fa = (b, fb) if (bottom - b) * (a - b) < 0 else (a, fa)
            c, fc = (b, fb) if (bottom - b) * (c - b) < 0 else (c, fc)
            b, fb = bottom, fn
        elif (bottom - b) * (a - b) > 0:
            a, fa = bottom, fn
        else:
            c, fc = bottom, fn
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

    Only what the sensor itself shows counts, not what else disturbs a hand.
    """
    noise = []
    for r, found in zip(problem.recordings, force_noise.tolist(), strict=True):
        assert r.force is not None
        noise.append(min(found, rough(r.force)))
    moved = problem.moved
    score = np.zeros(len(moved))
    information = np.zeros((len(moved), len(moved)))
    pretended = np.zeros((len(moved), 0))
    for seed in range(DRAWS):
        J, e = problem.of_noise(values, gains, np.array(noise), moved, seed)
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
