"""Types of the arrays that computations pass on, and what has the same bits on every processor."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

#: float64 of any shape; the docstring has shape and unit.
Values = NDArray[np.float64]
#: float64, shape (rows, columns).
Matrix = NDArray[np.float64]


def length(vector: Values) -> float:
    """Return the length of a vector of three numbers.

    `np.linalg.norm` asks BLAS, whose last bit depends on the processor, and a law that has two walls to choose from
    makes newtons of it.
    """
    x, y, z = vector.tolist()
    return sqrt(x * x + y * y + z * z)
