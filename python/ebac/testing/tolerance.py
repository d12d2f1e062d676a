"""How far a value may lie from its golden one."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number
from ebac._util.wrong_calls import plain_constructor


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Tolerance:
    """A value passes when |value - golden| <= absolute + relative |golden|. NaN passes for NaN.

    Parameters
    ----------
    absolute : float
        In the SI unit of the column, >= 0.
    relative : float
        Share of the golden value, >= 0.

    Raises
    ------
    ValueError
        When one is negative or not finite.
    """

    absolute: float = 0.0
    relative: float = 0.0

    def __post_init__(self) -> None:
        """Check ranges."""
        for name in ("absolute", "relative"):
            value = getattr(self, name)
            number(f"Tolerance.{name}", value)
            if not (isfinite(value) and value >= 0):
                raise ValueError(f"Tolerance.{name} = {value}: must be finite and not negative")

    def allows(
        self, values: NDArray[Any], golden: NDArray[Any]
    ) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
        """Return which values pass, and how far off each is; what is not finite on one side only is infinitely far."""
        found, wanted = values.astype(float), golden.astype(float)
        same = (found == wanted) | (np.isnan(found) & np.isnan(wanted))
        with np.errstate(invalid="ignore"):
            error = np.where(same, 0.0, np.abs(found - wanted))
        error = np.where(np.isnan(error), np.inf, error)
        size = np.where(np.isfinite(wanted), np.abs(wanted), 0.0)
        return error <= self.absolute + self.relative * size, error


#: A change of compiler or processor moves the last digits, and a stiff wall multiplies them; no more than that.
RELATIVE = 1e-6
#: Smallest difference that means something, by SI unit.
ABSOLUTE = {
    "m": 1e-9,
    "rad": 1e-9,
    "s": 1e-12,
    "m/s": 1e-6,
    "rad/s": 1e-6,
    "N": 1e-5,
    "N m": 1e-7,
    "A": 1e-6,
    "J": 1e-9,
    "N/m": 1e-3,
    "N s/m": 1e-3,
}


def default_tolerance(unit: str, kind: str = "f") -> Tolerance:
    """Return the tolerance of a column that has none of its own.

    Parameters
    ----------
    unit : str
        SI unit of the column; one that is not known gets 1e-9.
    kind : str
        NumPy's letter for its type; whole numbers and switches must be equal.
    """
    if kind in "iub":
        return Tolerance()
    return Tolerance(absolute=ABSOLUTE.get(unit, 1e-9), relative=RELATIVE)
