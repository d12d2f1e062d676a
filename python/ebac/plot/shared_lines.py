"""Lines that run over one another: where some coincide, their dashes take turns, so that each remains visible."""

from __future__ import annotations

from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ebac._util.arrays import Values

#: Lines coincide where they differ by less than this share.
NEAR = 0.02
#: Length of a dash, in widths of its line.
DASH = 4


def draw_shared(ax: Axes, x: Values, lines: list[Values], shades: list[str], width: float) -> None:
    """Draw lines over the same places; NaN is a gap, and a point between two gaps is a dot.

    Parameters
    ----------
    ax : Axes
        Empty or not.
    x : array, shape (m,)
        Places.
    lines : list of array, shape (m,)
        What to draw, positive.
    shades : list of str
        Colours.
    width : float
        Of a line [points].
    """
    values = np.array(lines)
    for i, shade in enumerate(shades):
        steps = [(j, _together(values, i, slice(j, j + 2))) for j in range(len(x) - 1)]
        for sharing, run in groupby(steps, key=lambda step: step[1]):
            places = [j for j, _ in run]
            if sharing:
                part = slice(places[0], places[-1] + 2)
                ax.plot(x[part], values[i, part], color=shade, lw=width, **_turn(sharing, i))
        known = np.isfinite(np.concatenate([[np.nan], values[i], [np.nan]]))
        for j in np.flatnonzero(known[1:-1] & ~known[:-2] & ~known[2:]):
            sharing = _together(values, i, slice(j, j + 1))
            size = 2 * width + 2.5 * (len(sharing) - 1 - sharing.index(i))
            ax.plot(x[j], values[i, j], "o", ms=size, mew=0, color=shade)


def _together(values: Values, i: int, places: slice) -> tuple[int, ...]:
    """Return which lines coincide with line i at places, itself too; none where it has a gap."""
    near = np.isclose(values[:, places], values[i, places], rtol=NEAR, atol=0)
    return tuple(np.flatnonzero(near.all(axis=1)).tolist())


def _turn(sharing: tuple[int, ...], i: int) -> dict[str, Any]:
    """Return the style of line i where it shares its place with others."""
    count = len(sharing)
    if count == 1:
        return {}
    start = (count - sharing.index(i)) % count * DASH
    return {"ls": (start, (DASH, (count - 1) * DASH)), "dash_capstyle": "butt"}
