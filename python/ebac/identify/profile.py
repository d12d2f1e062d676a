"""Profile likelihood: how far a parameter can go when all others make up for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac.identify.intervals import loose_inverse
from ebac.identify.search import least_squares, squares

if TYPE_CHECKING:
    from ebac.identify.result import ArmResult


def profile(result: ArmResult, name: str, level: float) -> tuple[float, float]:
    """Return where the cost has risen by `level` deviations squared on either side.

    The rise is scaled as the local interval is, so that autocorrelated errors count. A side that never rises ends at
    the bound of the parameter.
    """
    p = result.parameters
    if name not in p.names or p.names.index(name) not in p.free:
        raise ValueError(f"profile of {name}: must be a fitted parameter")
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
        found = least_squares(
            lambda part: result.problem.objective(spread(part), gains),
            lambda part: result.problem.slope(spread(part), gains)[rows],
            full[others],
            p.low[others],
            p.high[others],
            robust=result.robust,
            tolerance=1e-3,
        )
        return found.cost, spread(found.values)

    best, _ = refit(float(result.values[index]), result.values)
    rise = level * _inflation(result, index, gains)
    ends = [_end(refit, result, index, sign, best, rise) for sign in (-1, 1)]
    return ends[0], ends[1]


def _inflation(result: ArmResult, index: int, gains: list) -> float:  # type: ignore[type-arg]
    """Return how much wider the local variance is than that of white errors of unit size."""
    J = result.problem.slope(result.values, gains)
    scale = np.sqrt((J**2).sum(axis=1)) + 1e-300
    plain = loose_inverse(np.einsum("ik,jk->ij", J, J) / np.outer(scale, scale))
    place = int(np.flatnonzero(result.problem.moved == index)[0])
    white = float(plain[place, place] / scale[place] ** 2)
    return float(result.deviation[index]) ** 2 / white if white > 0 else 1.0


def _end(refit, result, index: int, sign: int, best: float, rise: float) -> float:  # type: ignore[no-untyped-def]
    p, centre = result.parameters, float(result.values[index])
    bound = float(p.low[index] if sign < 0 else p.high[index])
    width = max(1.96 * float(result.deviation[index]), 1e-9 * max(abs(centre), 1.0))
    inner, outer, at = 0.0, None, result.values
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
