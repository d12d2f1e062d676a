"""How sure an estimate is: local intervals with autocorrelated errors, and profiles."""

from __future__ import annotations

from collections.abc import Sequence
from math import erf, sqrt

import numpy as np
from numpy.typing import NDArray

from ebac.identify.folds import Fold, folded
from ebac.identify.search import weights

#: How many times what noise alone seems to tell is taken off what a log tells.
PRETENCE = 2.0


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
    """Return the covariance of the free parameters, shape (free, free).

    The last rows of the Jacobian may be nuisances: held, but known only to the standard deviations `sure`.
    `pretended` is the
    Jacobian that noise alone gives; `unseen` that of what is held in doubt, by one deviation each.

    The largest one of three, parameter by parameter: the inverse of the information, scaled by the errors where they
    are larger than foretold; the sandwich around it, with the scores summed over lags of growing length (Newey and
    West 1987), which also holds when the errors are autocorrelated; and the same along a log that is folded, one fold
    for each recording, which also holds when its errors repeat.
    """
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
    free = len(H) - (0 if sure is None else sure.size)
    every = plain * np.outer(wider, wider)
    if (
        unseen is not None and unseen.size
    ):  # held where they are: what they may be off by is carried over
        carried = inverse @ np.einsum("ik,jk->ij", jacobian * w / scale[:, None], unseen)
        every = every + carried @ carried.T
    every = every / np.outer(scale, scale)
    return np.asarray(every[:free, :free])


def loose_inverse(H: NDArray[np.float64]) -> NDArray[np.float64]:
    """Invert an information matrix; what it says nothing about comes out very loose, not sure."""
    values, vectors = np.linalg.eigh(H)
    return np.asarray((vectors / np.maximum(values, 1e-14 * values[-1])) @ vectors.T)


def newey_west(scores: NDArray[np.float64], reach: int | None = None) -> NDArray[np.float64]:
    """Return the long-run covariance of scores, shape (parameters, rows), by Bartlett's window of some reach [rows]."""
    n = scores.shape[1]
    reach = min(int(4 * (n / 100) ** (2 / 9)) + 12 if reach is None else reach, n - 1)
    out = np.einsum("ik,jk->ij", scores, scores)
    for lag in range(1, reach + 1):
        part = np.einsum("ik,jk->ij", scores[:, lag:], scores[:, :-lag])
        out += (1 - lag / (reach + 1)) * (part + part.T)
    return np.asarray(out)


def normal_tail(z: float) -> float:
    """Return the two-sided probability of a standard normal beyond z."""
    return 1 - erf(abs(z) / sqrt(2))
