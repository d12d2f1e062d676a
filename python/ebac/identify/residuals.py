"""Are the errors white, and free of the input? Tests of what a model left over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac.identify.intervals import normal_tail

#: How far errors are compared with each other and with the input [samples].
LAGS = 40


@dataclass(frozen=True, kw_only=True, eq=False)
class ResidualTests:
    """Correlation of the errors with themselves and with the force.

    `auto` and `cross` have the shape (LAGS,); without structure 95 % of them lie within +-`band`.
    """

    auto: NDArray[np.float64]
    cross: NDArray[np.float64]
    band: float
    whiteness_p: float
    independence_p: float

    @property
    def white(self) -> bool:
        """Whether autocorrelation is small, |r| < 0.1 at every lag, or not significant."""
        return self.whiteness_p > 0.01 or float(np.abs(self.auto).max()) < 0.1

    @property
    def independent(self) -> bool:
        """Whether the force tells nothing more about the errors, |r| < 0.1, or not significantly."""
        return self.independence_p > 0.01 or float(np.abs(self.cross).max()) < 0.1


def residual_tests(errors: NDArray[np.float64], force: NDArray[np.float64]) -> ResidualTests:
    """Test the errors of one recording, shape (rows,), against themselves and the force [N]."""
    told = np.flatnonzero(errors)[
        5:
    ]  # rows with a reading, but for those in which the filter settles
    if told.size < 8:
        raise ValueError(f"{told.size} readings that tell something: too few to test errors on")
    e = errors[told] - errors[told].mean()
    u = np.diff(force[told], prepend=force[told[0]])
    u = u - u.mean()
    n = len(e)
    lags = min(LAGS, n // 4)
    own = float(e @ e) + 1e-300
    auto = np.array([e[k:] @ e[: n - k] / own for k in range(1, lags + 1)])
    both = np.sqrt(own * (float(u @ u) + 1e-300))
    cross = np.array([e[k:] @ u[: n - k] / both for k in range(lags)])
    return ResidualTests(
        auto=auto,
        cross=cross,
        band=1.96 / np.sqrt(n),
        whiteness_p=_chi_square_tail(n * float(auto @ auto), lags),
        independence_p=_chi_square_tail(n * float(cross @ cross), lags),
    )


def _chi_square_tail(q: float, degrees: int) -> float:
    """Return the probability of a chi-square beyond q, by Wilson and Hilferty's cube root."""
    k = float(degrees)
    z = ((q / k) ** (1 / 3) - (1 - 2 / (9 * k))) / np.sqrt(2 / (9 * k))
    tail = 0.5 * normal_tail(float(z))
    return tail if z > 0 else 1 - tail


def vaf(measured: NDArray[np.float64], model: NDArray[np.float64]) -> float:
    """Return the variance accounted for, 1 - var(error)/var(measured); 1 is perfect."""
    return 1 - float(np.var(measured - model) / np.var(measured))


def nrmse(measured: NDArray[np.float64], model: NDArray[np.float64]) -> float:
    """Return the root of the mean squared error over the range of what was measured."""
    return float(np.sqrt(np.mean((measured - model) ** 2)) / np.ptp(measured))
