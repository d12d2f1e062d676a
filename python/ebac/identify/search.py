"""Least squares between bounds: Levenberg and Marquardt's steps, the best point kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]

#: A direction flatter than this, as a share of the steepest one, is no way to go [1].
FLATTEST = 1e-12


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

    Converged when a full step would lower the cost by less than `tolerance`, a ten-thousandth of what moves a 95 %
    bound; or when the last one lowered it by what was
    predicted, to that, and nearly to the bottom.
    """
    x = np.clip(start, low, high)
    e = errors(x)
    cost, damping, evaluations = loss(e, robust), 1e-4, 1
    for _ in range(most):
        J = jacobian(x)
        evaluations += 1
        if not (np.isfinite(cost) and np.isfinite(J).all()):
            raise ValueError(
                "no fit: the model runs away from what was recorded; is a force of the wrong sign, or the wrong column?"
            )
        w = weights(e, robust)
        Jw = J * w
        H = np.einsum("ik,jk->ij", Jw, J)  # not by BLAS: its threads cost more than they save
        g = np.einsum("ik,k->i", Jw, e)
        near = _Parabola(H, g, ~(((x <= low) & (g > 0)) | ((x >= high) & (g < 0))))
        done = near.depth < tolerance
        while not done:
            full = near.step(damping)
            step = np.clip(x + full, low, high) - x
            inside = bool(np.allclose(step, full, rtol=1e-9, atol=0.0))
            predicted = near.lowers(step)
            e_trial = errors(x + step)
            evaluations += 1
            gain = cost - loss(e_trial, robust)
            if gain >= 0:
                left = abs(gain - predicted) + near.depth - predicted
                done = left < tolerance or (gain < tolerance and inside)
                x, e, cost, damping = x + step, e_trial, cost - gain, max(damping / 10, 1e-9)
                break
            # A step that a bound has bent may lead up; along the slope, by much damping, none does.
            done = abs(predicted) < tolerance and (inside or damping > 1)
            damping *= 8
        if done:
            return Found(
                values=x, cost=cost, evaluations=evaluations, converged=True, information=H
            )
    return Found(values=x, cost=cost, evaluations=evaluations, converged=False, information=H)


class _Parabola:
    """The cost near a point: 2 g s + s H s for a step s of what may move."""

    def __init__(self, H: NDArray[np.float64], g: Values, move: NDArray[np.bool_]) -> None:
        self.H, self.g, self.move = H, g, move
        self.scale = np.sqrt(np.diag(H))[move]
        self.scale[self.scale == 0] = 1.0  # without influence
        inner = H[np.ix_(move, move)] / np.outer(self.scale, self.scale)
        self.sizes, self.axes = np.linalg.eigh(inner)

    def step(self, damping: float) -> Values:
        """Return Levenberg and Marquardt's step; without damping, the one to the bottom."""
        out = np.zeros_like(self.g)
        if self.move.any():
            along = self.axes.T @ (self.g[self.move] / self.scale)
            along /= np.maximum(self.sizes + damping, max(FLATTEST * self.sizes[-1], 1e-300))
            out[self.move] = -(self.axes @ along) / self.scale
        return out

    def lowers(self, step: Values) -> float:
        """Return by how much a step lowers the cost."""
        return -float(2 * self.g @ step + step @ self.H @ step)

    @property
    def depth(self) -> float:
        """How far the bottom lies below."""
        return self.lowers(self.step(0.0))


def weights(e: Values, robust: float | None) -> Values:
    """Return Huber's weights."""
    if robust is None:
        return np.ones_like(e)
    return np.minimum(1.0, robust / np.maximum(np.abs(e), 1e-300))


def loss(e: Values, robust: float | None) -> float:
    """Return the sum of squares; beyond `robust` it grows straight (Huber)."""
    if robust is None:
        return squares(e)
    a = np.abs(e)
    return float(np.where(a <= robust, a**2, 2 * robust * a - robust**2).sum())


def squares(e: Values) -> float:
    """Return the sum of squares: not by BLAS, which beyond 10,000 rows waits for threads longer than it adds."""
    return float(np.einsum("i,i->", e, e))
