"""Lines that run over one another: where some coincide, they run side by side, so that each remains visible."""

from __future__ import annotations

import numpy as np

from ebac._util.arrays import Values

#: Lines coincide where they differ by less than this share.
NEAR = 0.02


def side_by_side(lines: Values, step: float) -> Values:
    """Return lines of which those that coincide at a place lie below one another there.

    Parameters
    ----------
    lines : array, shape (n, m)
        Values, positive, for a logarithmic axis; NaN is a gap.
    step : float
        By what factor one lies below the other, below 1.

    Returns
    -------
    array, shape (n, m)
        The first of those that coincide keeps its value.
    """
    moved = lines.copy()
    for i in range(1, len(lines)):
        near = np.isclose(lines[:i], lines[i], rtol=NEAR, atol=0)
        moved[i] *= step ** near.sum(axis=0)
    return moved
