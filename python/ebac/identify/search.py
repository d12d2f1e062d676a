"""Least squares between bounds: Levenberg and Marquardt's steps, the best point kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Found:
    """Where a search ended."""

    values: Values
    cost: float
    evaluations: int
    converged: bool
    information: NDArray[np.float64]


def least_squares(
    errors: Callable[[Values], Values],
    jacobian: Callable[[Values], NDArray[np.float64]],
    start: Values,
    low: Values,
    high: Values,
    *,
    robust: float | None = None,
    most: int = 40,
    tolerance: float = 1e-4,
) -> Found:
    """Minimise the sum of squares, or Huber's loss beyond `robust` deviations.

    Converged when a full step would lower the cost by less than `tolerance`: a ten-thousandth of what moves a 95 %
    bound.
    """
    x = np.clip(start, low, high)
    e = errors(x)
    cost, damping, evaluations = loss(e, robust), 1e-4, 1
    for _ in range(most):
        J = jacobian(x)
        evaluations += 1
        w = weights(e, robust)
        Jw = J * w
        H = np.einsum("ik,jk->ij", Jw, J)  # not by BLAS: its threads cost more than they save
        g = np.einsum("ik,k->i", Jw, e)
        scale = np.sqrt(np.diag(H))
        scale[scale == 0] = 1.0  # without influence
        held = ((x <= low) & (g > 0)) | ((x >= high) & (g < 0))
        move = ~held
        if not move.any():
            return Found(
                values=x, cost=cost, evaluations=evaluations, converged=True, information=H
            )
        Hs = H[np.ix_(move, move)] / np.outer(scale[move], scale[move])
        gs = g[move] / scale[move]
        for _ in range(12):
            step = np.zeros_like(x)
            step[move] = -np.linalg.solve(Hs + damping * np.eye(len(gs)), gs) / scale[move]
            trial = np.clip(x + step, low, high)
            e_trial = errors(trial)
            evaluations += 1
            now = loss(e_trial, robust)
            if now <= cost and np.isfinite(now):
                break
            damping *= 8
        else:
            return Found(
                values=x, cost=cost, evaluations=evaluations, converged=True, information=H
            )
        gain = cost - now
        x, e, cost, damping = trial, e_trial, now, max(damping / 10, 1e-9)
        if gain < tolerance:
            return Found(
                values=x, cost=cost, evaluations=evaluations, converged=True, information=H
            )
    return Found(values=x, cost=cost, evaluations=evaluations, converged=False, information=H)


def weights(e: Values, robust: float | None) -> Values:
    """Return Huber's weights."""
    if robust is None:
        return np.ones_like(e)
    return np.minimum(1.0, robust / np.maximum(np.abs(e), 1e-300))


def loss(e: Values, robust: float | None) -> float:
    """Return the sum of squares; beyond `robust` it grows straight (Huber)."""
    if robust is None:
        return float(e @ e)
    a = np.abs(e)
    return float(np.where(a <= robust, a**2, 2 * robust * a - robust**2).sum())
