"""The times of the rows of a recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def not_rising(step: NDArray[np.float64], first: int) -> str:
    """Return where times do not rise, from the steps between them, and the remedy; rows are counted from `first`."""
    row = int(np.argmin(step > 0)) + 1 + first
    if (step >= 0).all():
        same = int((step == 0).sum())
        rows = f"in {same} rows, first in row {row}" if same > 1 else f"in row {row}"
        return (
            f"t is that of the row before {rows}; give the rows a second (rate=, --rate), times with more digits, or "
            "leave out what was written twice"
        )
    return f"t goes back in row {row}; sort the log by time"
