"""Where a recorded force alone moves a hand, from the start that fits best."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.identify.parameters import BEFORE_LEVELS


def best_start(
    record: Any, theta: NDArray[np.float64], x: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Simulate a hand under a recorded force from the initial state that fits best."""
    none = record.simulate(theta, 0.0, 0.0)
    parts = np.array([record.simulate(theta, *z) - none for z in ((1.0, 0.0), (0.0, 1.0))])
    state, *_ = np.linalg.lstsq(parts.T, x - none, rcond=1e-12)
    return np.asarray(none + state @ parts)


def best_levels(
    record: Any, base: NDArray[np.float64], x: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Simulate as `best_start`, with the target's levels fitted too."""
    none = record.simulate(base, 0.0, 0.0)
    moves = [record.simulate(base, *z) - none for z in ((1.0, 0.0), (0.0, 1.0))]
    for j in range(BEFORE_LEVELS, len(base)):
        other = base.copy()
        other[j] += 1.0
        moves.append(record.simulate(other, 0.0, 0.0) - none)
    found, *_ = np.linalg.lstsq(np.array(moves).T, x - none, rcond=1e-12)
    return np.asarray(none + found @ np.array(moves))
