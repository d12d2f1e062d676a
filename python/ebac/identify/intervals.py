"""Uncertainty of an estimate: local intervals with autocorrelated errors, and profile likelihood."""

from __future__ import annotations

from collections.abc import Sequence
from math import erf, sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number
from ebac.identify import unrecorded_motor
from ebac.identify.search import least_squares, squares, weights
from ebac.identify.signals import Fold, folded

if TYPE_CHECKING:
    from ebac.identify.result import ArmResult

#: Of a standard normal, two-sided 95 %.
Z95 = 1.959963984540054
#: Multiple of the apparent information of pure noise that is subtracted from that of a log.
PRETENCE = 2.0
#: Errors and their derivatives of a model that runs away are larger: nothing is known of it.
RUN_AWAY = 1e100


def covariance(
    jacobian: NDArray[np.float64],
    errors: NDArray[np.float64],
    lengths: Sequence[int],
    robust: float | None = None,
    sure: NDArray[np.float64] | None = None,
    pretended: NDArray[np.float64] | None = None,
    unseen: NDArray[np.float64] | None = None,
    folds: Sequence[Fold | None] | None = None,
) -> NDArray[np.float64]:
    """Return the covariance of the parameters of the Jacobian, shape (parameters, parameters).

    Its last rows may be nuisances: held, but known only to the standard deviations `sure`.
    `pretended` is the
    Jacobian that noise alone gives; `unseen` that of what is held in doubt, by one deviation each.

    The largest one of three, parameter by parameter: the inverse of the information, scaled by the errors where they
    are larger than predicted; the sandwich around it, with the scores summed over lags of growing length (Newey and
    West 1987), which also holds when the errors are autocorrelated; and the same along a log that is folded, one fold
    for each recording, which also holds when its errors repeat.
    """
    if not max(np.abs(jacobian).max(), np.abs(errors).max()) < RUN_AWAY:
        return np.diag(np.full(len(jacobian), np.inf))
    w = weights(errors, robust)
    scores = jacobian * (w * errors)
    scale = np.sqrt((jacobian**2).sum(axis=1))
    scale[scale == 0] = 1.0
    H = np.einsum("ik,jk->ij", jacobian * w, jacobian) / np.outer(scale, scale)
    if pretended is not None:
        H = H - PRETENCE * np.einsum("ik,jk->ij", pretended, pretended) / np.outer(scale, scale)
    known = np.zeros(len(H))
    if sure is not None and sure.size:
        known[-sure.size :] = sure**-2.0 / scale[-sure.size :] ** 2
    H = H + np.diag(known)
    inverse = loose_inverse(H)
    used = max(int(np.count_nonzero(errors)) - len(H), 1)
    plain = inverse * max(float((w * errors**2).sum()) / used, 1.0)
    scores = scores / scale[:, None]
    straight, repeated = np.diag(known), np.diag(known)
    start = 0
    for length, fold in zip(lengths, folds or [None] * len(lengths), strict=True):
        mine = scores[:, start : start + length]
        along = newey_west(mine)
        straight = straight + along
        repeated = repeated + (along if fold is None else newey_west(folded(mine, fold)))
        start += length
    wider = np.ones(len(H))
    for middle in (straight, repeated):
        sandwich = np.diag(inverse @ middle @ inverse)
        times = sandwich / np.maximum(np.diag(plain), 1e-300)
        wider = np.maximum(wider, np.sqrt(np.maximum(times, 1.0)))
    every = plain * np.outer(wider, wider)
    if (
        unseen is not None and unseen.size
    ):  # held where they are: what they may be off by is carried over
        carried = inverse @ np.einsum("ik,jk->ij", jacobian * w / scale[:, None], unseen)
        every = every + carried @ carried.T
    return np.asarray(every / np.outer(scale, scale))


def loose_inverse(H: NDArray[np.float64]) -> NDArray[np.float64]:
    """Invert an information matrix; directions without information come out very loose, not certain."""
    values, vectors = np.linalg.eigh(H)
    return np.asarray((vectors / np.maximum(values, 1e-14 * values[-1])) @ vectors.T)


def newey_west(scores: NDArray[np.float64], reach: int | None = None) -> NDArray[np.float64]:
    """Return the long-run covariance of scores, shape (parameters, rows), by Bartlett's window of some reach [rows].

    That window is the mean product of sums over `reach` + 1 rows, so no lag is computed on its own.
    """
    parameters, n = scores.shape
    reach = min(int(4 * (n / 100) ** (2 / 9)) + 12 if reach is None else reach, n - 1)
    sums = np.zeros((parameters, n + 2 * reach + 1))
    np.cumsum(scores, axis=1, out=sums[:, reach + 1 : reach + 1 + n])
    sums[:, reach + 1 + n :] = sums[:, [reach + n]]
    sums = sums[:, reach + 1 :] - sums[:, : -reach - 1]
    return np.asarray(np.einsum("ik,jk->ij", sums, sums) / (reach + 1))


def normal_tail(z: float) -> float:
    """Return the two-sided probability of a standard normal beyond z."""
    return 1 - erf(abs(z) / sqrt(2))


def profile(result: ArmResult, name: str, level: float) -> tuple[float, float]:
    """Return where the cost has risen by `level` deviations squared on either side.

    The rise is scaled as the local interval is, so that autocorrelated errors count. A side that never rises ends at
    the bound of the parameter.
    """
    p = result.parameters
    if name not in p.names or p.names.index(name) not in p.free:
        raise ValueError(f"profile of {name}: must be a fitted parameter")
    if not 0 < number("level", level) < np.inf:
        raise ValueError(f"level = {level:g}: must be positive and finite, in deviations squared")
    index = p.names.index(name)
    gains = result.problem.gains(result.values, result.force_noise)
    moved = result.problem.moved
    others = moved[moved != index]

    def refit(value: float, start: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        full = start.copy()
        full[index] = value
        if not others.size:
            e = result.problem.objective(full, gains)
            return squares(e), full

        def spread(part: NDArray[np.float64]) -> NDArray[np.float64]:
            out = full.copy()
            out[others] = part
            return out

        rows = np.flatnonzero(moved != index)

        def linearised(
            part: NDArray[np.float64],
        ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
            errors, slope = result.problem.linearised(spread(part), gains)
            return errors, slope[rows]

        found = least_squares(
            linearised,
            full[others],
            p.low[others],
            p.high[others],
            robust=result.robust,
            tolerance=1e-3,
        )
        return found.cost, spread(found.values)

    began = unrecorded_motor.corrected(result.problem, result.values, back=True)
    best, _ = refit(float(began[index]), began)
    rise = level * _inflation(result, index, gains)
    off = float(result.values[index] - began[index])
    ends = [off + _end(refit, result, began, index, sign, best, rise) for sign in (-1, 1)]
    return ends[0], ends[1]


def _inflation(result: ArmResult, index: int, gains: list) -> float:  # type: ignore[type-arg]
    """Return how much wider the local variance is than that of white errors of unit size."""
    J = result.problem.slope(result.values, gains)
    scale = np.sqrt((J**2).sum(axis=1)) + 1e-300
    plain = loose_inverse(np.einsum("ik,jk->ij", J, J) / np.outer(scale, scale))
    place = int(np.flatnonzero(result.problem.moved == index)[0])
    white = float(plain[place, place] / scale[place] ** 2)
    return float(result.deviation[index]) ** 2 / white if white > 0 else 1.0


def _end(refit, result, began, index: int, sign: int, best: float, rise: float) -> float:  # type: ignore[no-untyped-def]
    p, centre = result.parameters, float(began[index])
    bound = float(p.low[index] if sign < 0 else p.high[index])
    width = max(1.96 * float(result.deviation[index]), 1e-9 * max(abs(centre), 1.0))
    inner, outer, at = 0.0, None, began
    step = min(width, abs(bound - centre))
    for _ in range(14):
        cost, found = refit(centre + sign * step, at)
        if cost - best > rise:
            outer = step
            share = np.sqrt(rise / (cost - best))  # a parabola through the optimum
            guess = max(step * float(share), 0.5 * (inner + step)) if inner else step * float(share)
            if outer - inner < 0.02 * outer:
                break
            step = guess if inner < guess < outer else 0.5 * (inner + outer)
            if abs(share - 1) < 0.01:
                break
        else:
            inner, at = step, found
            if step >= abs(bound - centre):
                return bound
            if cost > best and abs((cost - best) / rise - 1) < 0.02:
                break
            step = min(step * 2, abs(bound - centre)) if outer is None else 0.5 * (inner + outer)
    return centre + sign * step
