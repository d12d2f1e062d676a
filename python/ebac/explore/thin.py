"""Thinning that loses no peak: of each bin the least and the most."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values

#: Bins across the first picture, before the browser knows its width.
BINS = 1000


@dataclass(frozen=True, kw_only=True)
class Bands:
    """What is drawn of a column: one place a bin, or one a row; `least` is NaN where a place is one row."""

    t: Values
    least: Values
    most: Values


def bands(values: NDArray[np.float32], t: Values, bins: int = BINS) -> Bands:
    """Return what to draw: every row up to four a bin, else the least and the most of each bin.

    What `thin.js` does with the window on the screen. A bin without a number gives NaN, so that a gap stays one.

    Parameters
    ----------
    values : array, shape (rows,)
    t : array, shape (rows,)
        Times [s].
    bins : int
        At least 1; about one for each pixel.
    """
    rows = len(values)
    if rows <= 4 * bins:
        return Bands(t=t, least=np.full(rows, np.nan), most=values.astype(float))
    edges = np.arange(bins + 1) * rows // bins
    starts = edges[:-1]
    return Bands(
        t=t[(starts + edges[1:] - 1) // 2],
        least=np.fmin.reduceat(values, starts).astype(float),
        most=np.fmax.reduceat(values, starts).astype(float),
    )
