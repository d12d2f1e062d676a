"""Values beside gaps: a column that is not a number in some rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def alone(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return what stands between two gaps, of which no line shows anything; elsewhere NaN."""
    known = np.isfinite(np.concatenate([[np.nan], values, [np.nan]]))
    return np.where(known[:-2] | known[2:], np.nan, values)
