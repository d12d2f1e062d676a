"""The noise that makes the errors most likely, given the hand."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ebac._core import ArmRecord
from ebac.identify.problem import Problem
from ebac.identify.search import loss

#: The noise that moves a hand is at least what the force signal itself shows, and so many times that at most.
WIDEST = 300.0
#: First step of the logarithm of the noise, and how near is near enough.
STEP, NEAR = 0.1, 0.02

Values = NDArray[np.float64]


def minus_two_log(
    record: ArmRecord, theta: Values, held: Values, force_noise: float, robust: float | None = None
) -> float:
    """Return -2 log of the likelihood, but for a constant; with Huber's loss beyond `robust` deviations.

    `held` is what the filter is made for, see `Problem.held`.
    """
    gains = record.gains(held, force_noise)
    e = record.innovations(theta, gains)
    return loss(e, robust) + gains.log_sum


def likely_noise(
    problem: Problem, values: Values, before: Values, robust: float | None = None
) -> Values:
    """Return the standard deviation of each recording's force [N] that makes its errors likeliest, from one before on.

    It stands for all that moves a hand beside eq. (4), tremor too, as far as that is white.
    """
    found = []
    quiet = problem.held(values)
    parts = zip(problem.records, problem.parameters.places, np.log(problem.shown), strict=True)
    for i, (record, place, shown) in enumerate(parts):

        def unlikely(
            z: float,
            record: ArmRecord = record,
            theta: Values = values[place],
            held: Values = quiet[place],
        ) -> float:
            return minus_two_log(record, theta, held, float(np.exp(z)), robust)

        limits = float(shown), float(shown + np.log(WIDEST))
        found.append(float(np.exp(lowest(unlikely, float(np.log(before[i])), STEP, *limits))))
    return np.array(found)


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
