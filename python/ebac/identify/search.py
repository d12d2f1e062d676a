"""Least squares between bounds: NLopt's SLSQP, in coordinates in which the cost is round."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ebac._util.arrays import Matrix, Values

#: A direction flatter than this, as a share of the steepest one, is no way to go [1].
FLATTEST = 1e-12
#: Evaluations after which the coordinates are made anew: they are those of a parabola, and far away it is another one.
ONE_ROUND = 6
#: So much of the fall that the parabola promises ends a round.
ENOUGH = 0.5
#: So near a bound is on it [deviations].
ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Found:
    """Where a search ended."""

    values: Values
    cost: float
    evaluations: int
    converged: bool
    information: Matrix


def least_squares(
    model: Callable[[Values], tuple[Values, Matrix]],
    start: Values,
    low: Values,
    high: Values,
    *,
    robust: float | None = None,
    most: int = 40,
    tolerance: float = 1e-4,
) -> Found:
    """Minimise the sum of squares, or Huber's loss beyond `robust` deviations, within bounds.

    `model` returns errors, shape (rows,), and their Jacobian, shape (parameters, rows).

    Sequential quadratic programming (Kraft 1988) builds its second derivatives up from gradients. It begins with a unit
    matrix, so every round sets coordinates in which that is the Gauss-Newton one: a unit step is a deviation.

    Converged when a full step would lower the cost by less than `tolerance`, a ten-thousandth of what moves a 95 %
    bound; or when a round lowered it by less than that.

    Raises
    ------
    ValueError
        Where errors or derivatives are no finite numbers at the start of a round.
    """
    evaluations = 0

    def at(x: Values) -> _Point:
        nonlocal evaluations
        evaluations += 1
        e, J = model(x)
        return _Point(x=x, errors=e, jacobian=J, cost=loss(e, robust), robust=robust)

    point, before, done = at(np.clip(start, low, high)), np.inf, False
    for _ in range(most):
        if not (np.isfinite(point.cost) and np.isfinite(point.information).all()):
            raise ValueError(
                "no fit: the model runs away from what was recorded; is a force of the wrong sign, or the wrong column?"
            )
        depth = point.depth(low, high)
        done = before - point.cost < tolerance or depth < tolerance
        if done:
            break
        before = point.cost
        point = _round(at, point, low, high, depth, tolerance)
    return Found(
        values=point.x,
        cost=point.cost,
        evaluations=evaluations,
        converged=done,
        information=point.information,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Point:
    x: Values
    errors: Values
    jacobian: Matrix
    cost: float
    robust: float | None

    @cached_property
    def slope(self) -> Values:
        """Half the slope of the cost."""
        weighted = self.errors
        if self.robust is not None:
            weighted = weights(self.errors, self.robust) * self.errors
        return np.asarray(np.einsum("ik,k->i", self.jacobian, weighted))

    @cached_property
    def information(self) -> Matrix:
        """Half the second derivative of the cost, as of a parabola (Gauss-Newton)."""
        weighted = self.jacobian
        if self.robust is not None:
            weighted = self.jacobian * weights(self.errors, self.robust)
        return np.asarray(
            np.einsum("ik,jk->ij", weighted, self.jacobian)
        )  # not by BLAS, see `squares`

    @cached_property
    def axes(self) -> Matrix:
        """Steps of one deviation each: the columns."""
        return axes(self.information)

    def depth(self, low: Values, high: Values) -> float:
        """By how much the bottom of the parabola lies below, as far as bounds let one go there."""
        stuck = ((self.x <= low) & (self.slope > 0)) | ((self.x >= high) & (self.slope < 0))
        if stuck.all():
            return 0.0
        across = axes(self.information[np.ix_(~stuck, ~stuck)]) if stuck.any() else self.axes
        along = across.T @ self.slope[~stuck]
        return float(along @ along)


def axes(H: Matrix) -> Matrix:
    """Return steps of one deviation each, independent of one another: the columns."""
    scale = np.sqrt(np.diag(H))
    scale[scale == 0] = 1.0  # without influence
    sizes, across = np.linalg.eigh(H / np.outer(scale, scale))
    flat = max(FLATTEST * float(sizes[-1]), 1e-300)
    return np.asarray(across / np.sqrt(np.maximum(sizes, flat)) / scale[:, None])


def _round(
    at: Callable[[Values], _Point],
    start: _Point,
    low: Values,
    high: Values,
    depth: float,
    tolerance: float,
) -> _Point:
    """Return the best point that NLopt meets in one round, on a parabola that is `depth` deep."""
    import nlopt

    from ebac._util.nlopt_callbacks import Carried

    across, best = start.axes, start
    optimiser = nlopt.opt(nlopt.LD_SLSQP, len(start.x))
    carried = Carried(optimiser)

    def half_cost(step: Values, gradient: Values) -> float:
        nonlocal best
        point = at(inside(start.x + across @ step)) if step.any() else start
        if not np.isfinite(point.cost):
            return 1e300
        if point.cost < best.cost:
            best = point
        if gradient.size:
            with np.errstate(invalid="ignore"):  # of a model that begins to run away
                gradient[:] = across.T @ point.slope
        return 0.5 * point.cost

    size = np.sqrt(np.einsum("ij,ij->i", across, across))

    def inside(x: Values) -> Values:  # on a bound that a rounding error keeps it from
        x = np.where(x - low < ROUNDING * size, low, x)
        return np.clip(np.where(high - x < ROUNDING * size, high, x), low, high)

    optimiser.set_min_objective(carried.with_gradient(half_cost, instead=np.inf))
    above, below = np.isfinite(high), np.isfinite(low)
    rows = np.vstack([across[above], -across[below]])
    room = np.concatenate([(high - start.x)[above], (start.x - low)[below]])
    length = np.concatenate([size[above], size[below]])
    rows, room = rows / length[:, None], room / length

    def beyond(result: Values, step: Values, gradient: Values) -> None:
        result[:] = rows @ step - room
        if gradient.size:
            gradient[:] = rows

    if room.size:
        optimiser.add_inequality_mconstraint(beyond, np.zeros(room.size))
    optimiser.set_ftol_abs(0.5 * tolerance)
    optimiser.set_stopval(0.5 * (start.cost - ENOUGH * depth))
    optimiser.set_maxeval(ONE_ROUND)
    optimiser.optimize(np.zeros(len(start.x)))
    carried.settle()
    return best


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
