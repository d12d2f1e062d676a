"""A stiffness over time: dots, for it is known in few ticks, on a scale of decades where it runs over many."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from ebac._util.arguments import did_you_mean
from ebac._util.arrays import Values

#: The scale ends here [kN/m]: bounds go far beyond.
MOST = 1e4
#: What lies within so many times its median is drawn on a linear scale.
ALIKE = 10.0
SCALES = ("linear", "log")


@dataclass(frozen=True)
class StiffnessScale:
    """Range of a panel [kN/m], at whose ends what is beyond is drawn, and whether it is linear."""

    low: float
    high: float
    linear: bool

    @classmethod
    def of(
        cls, values: Iterable[Values], scale: str | None = None, bounds: Iterable[Values] = ()
    ) -> StiffnessScale:
        """Return the scale of values [kN/m] with room: the given one of `SCALES`, or that which fits them and bounds.

        Raises
        ------
        ValueError
            For another scale.
        """
        if scale not in (None, *SCALES):
            raise ValueError(
                f"scale = {scale!r}: must be 'linear', 'log' or None, by the data{did_you_mean(scale, SCALES)}"
            )
        known = _finite(values)
        least, most = float(known.min(initial=0.0)), float(np.abs(known).max(initial=0.0))
        if scale == "linear" or (scale is None and _alike(np.append(known, _finite(bounds)))):
            limit = _round(1.2 * most)
            return cls(-limit if least < -0.05 * most else 0.0, limit, linear=True)
        limit = float(min(MOST, 10.0 ** np.ceil(np.log10(max(1.0, 5 * most)))))
        return cls(-limit, limit, linear=False)

    def cut(self, values: Values) -> Values:
        """Return values [kN/m], those beyond the range at its ends."""
        return np.clip(values, self.low, self.high)

    def named(self, label: str, values: Values) -> str:
        """Return a label with the end at which values [kN/m] are cut; alone where none is."""
        ends = [self.low] * bool((values < self.low).any()) + [self.high] * bool(
            (values > self.high).any()
        )
        return f"{label}, shown to {_ends(ends)} kN/m" if ends else label

    def set(self, ax: Axes) -> None:
        """Give the scale to an axes; that of decades is linear to 1 kN/m and logarithmic beyond."""
        if self.linear:
            room = 0.06 * (self.high - self.low)
            ax.set_ylim(self.low - room, self.high + room)
            return
        steps = [10.0**n for n in range(round(np.log10(self.high)) + 1)]
        ax.set_yscale("symlog", linthresh=1)
        ax.set_ylim(-6 * self.high, 3 * self.high)
        ax.set_yticks([-step for step in steps] + [0.0] + steps)
        ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def _finite(values: Iterable[Values]) -> Values:
    return np.concatenate([np.empty(0), *(one[np.isfinite(one)] for one in values)])


def _alike(values: Values) -> bool:
    """Return whether all values are within `ALIKE` times their median size."""
    sizes = np.abs(values[values != 0])
    return bool(sizes.size) and float(sizes.max()) <= ALIKE * float(np.median(sizes))


def _ends(ends: Sequence[float]) -> str:
    return (
        f"{max(map(abs, ends)):g}"
        if len(ends) < 2 or ends[0] == -ends[1]
        else f"{ends[0]:g} and {ends[1]:g}"
    )


def _round(most: float) -> float:
    """Return the next larger 1, 1.5, 2, 3, 5 or 7 times a power of ten; 1 for nothing."""
    if not most > 0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(most))
    return float(power * next(step for step in (1, 1.5, 2, 3, 5, 7, 10) if step * power >= most))
