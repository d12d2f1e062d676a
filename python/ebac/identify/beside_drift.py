"""What a drift of the forces does to a fit: values and drift in turns, by total least squares."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values
from ebac.identify.bias import largest_drift, likely_drift, likely_noise
from ebac.identify.intervals import loose_inverse
from ebac.identify.problem import Problem
from ebac.identify.search import least_squares

#: Rounds of: values, then drift; settled when it changes by less than this share.
DRIFT_ROUNDS, SAME_DRIFT = 4, 0.1
#: So near the largest drift it is none.
NOT_A_DRIFT = 0.95
#: A drift is known to about this share: this many times larger, it moves the values by what the intervals hold.
DOUBTED_DRIFT = 1.25
#: Least fall of the cost that a step must promise [deviations squared].
SMALL_FALL = 5e-2


#: Problem, values and noise without what a drift does to them, and how far they are off by its doubt.
BesideDrift: TypeAlias = tuple[Problem, Values, Values, Values]


def beside_drift(
    problem: Problem, values: Values, noise: Values, robust: float | None
) -> BesideDrift | None:
    """Return problem, values and noise without what a drift does to them, and how far they are off by its doubt.

    None where the errors ask for more than a drift.

    A drift is noise of the input, and strong where a hand hardly moves. With the filters held, it is taken for force
    that moved nothing. With filters made anew for each change, the sum of squared errors is least at the truth: it is
    that of the smallest noise of both signals that explains them (total least squares).
    """
    p, which = problem.parameters, problem.moved

    def full(part: Values) -> Values:
        out = values.copy()
        out[which] = part
        return out

    def model(part: Values) -> tuple[Values, NDArray[np.float64]]:
        return problem.renewed(full(part), noise)

    for _ in range(DRIFT_ROUNDS):
        found = least_squares(
            model,
            values[which],
            p.low[which],
            p.high[which],
            robust=robust,
            tolerance=SMALL_FALL,
        )
        values = full(found.values)
        before, drift = problem.drift, likely_drift(problem, values, noise, robust)
        if not drift:
            return None
        problem = problem.drifting(drift)
        if abs(problem.drift / before - 1) < SAME_DRIFT:
            break
        noise = likely_noise(problem, values, noise, robust)
    if problem.drift > NOT_A_DRIFT * largest_drift(problem):
        return None
    wider = problem.drifting(DOUBTED_DRIFT * problem.drift)
    e, J = wider.renewed(values, noise)
    scale = np.sqrt(np.einsum("ik,ik->i", J, J))
    scale[scale == 0] = 1.0  # without influence
    inverse = loose_inverse(np.einsum("ik,jk->ij", J, J) / np.outer(scale, scale))
    moves = -inverse @ (np.einsum("ik,k->i", J, e) / scale) / scale
    return problem, values, noise, moves
