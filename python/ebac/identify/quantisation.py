"""The step of a quantised signal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def count_of(x: NDArray[np.float64]) -> float:
    """Return the step of a quantised signal, or 0 when it has none.

    The least difference that most differences are whole multiples of.
    """
    steps = np.abs(np.diff(x))
    span = float(np.ptp(x))
    steps = steps[steps > 1e-9 * span]
    if steps.size < 5:
        return 0.0
    least = float(steps.min())
    for _ in range(3):  # a refined mean over the multiples
        whole = np.round(steps / least)
        near = np.abs(steps / least - whole) < 0.1
        if near.mean() < 0.95 or whole.max() > 1e7:
            return 0.0
        least = float(np.sum(steps[near]) / np.sum(whole[near]))
    share = np.unique(np.round((x - x.min()) / least)).size
    return least if share < 0.9 * x.size else 0.0
