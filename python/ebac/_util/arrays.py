"""Types of the arrays that computations pass on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

#: float64 of any shape; the docstring has shape and unit.
Values = NDArray[np.float64]
#: float64, shape (rows, columns).
Matrix = NDArray[np.float64]
