"""A stiffness over time: dots, for it is known in few ticks, on a scale of decades, for it runs over many."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from ebac._util.arrays import Values

#: The scale ends here [kN/m]: bounds go far beyond.
MOST = 1e4


def limit_of(values: Iterable[Values]) -> float:
    """Return the power of ten [kN/m] that all values [kN/m] are below, with room, at most `MOST`."""
    largest = max((np.abs(one[np.isfinite(one)]).max(initial=0.0) for one in values), default=0.0)
    return float(min(MOST, 10.0 ** np.ceil(np.log10(max(1.0, 5 * largest)))))


def set_decades(ax: Axes, limit: float) -> None:
    """Give an axes a scale that is linear to 1 kN/m and logarithmic beyond, to a limit on both sides."""
    steps = [10.0**n for n in range(round(np.log10(limit)) + 1)]
    ax.set_yscale("symlog", linthresh=1)
    ax.set_ylim(-6 * limit, 3 * limit)
    ax.set_yticks([-step for step in steps] + [0.0] + steps)
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
