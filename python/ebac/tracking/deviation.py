"""Distances from a fitted path in numbers, each with its definition."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ebac._util.arrays import Values

#: What is smaller is printed as 0: errors of rounding [mm or degrees].
LEAST = 1e-9


def digits(value: float, count: int) -> str:
    """Return a number with few digits, and 0 for an error of rounding."""
    return f"{value if abs(value) >= LEAST else 0:.{count}g}"


@dataclass(frozen=True, kw_only=True)
class Deviation:
    """How far points lie from their fitted path: n distances d_i from p fitted numbers.

    Attributes
    ----------
    n : int
        Points that count; outliers of a robust fit do not.
    sd_m : float
        Standard deviation sqrt(sum d_i^2 / (n - p)) [m]; the "SD" of Table I.
    error_m : float
        Path error, the mean absolute distance sum |d_i| / n [m]; the "Error" of Table I, see `ebac.tracking.table`.
    rms_m : float
        Root mean square sqrt(sum d_i^2 / n) [m].
    largest_m : float
        Largest |d_i| [m].
    outliers : int
        Points a robust fit did not count.
    independent : float
        How many independent points the n are worth: n / (1 + 2 sum of the residuals' autocorrelation). A path recorded
        at 1 kHz repeats itself from row to row; the uncertainty of a fit counts with these.
    """

    n: int
    sd_m: float
    error_m: float
    rms_m: float
    largest_m: float
    outliers: int
    independent: float


def measure(distances: Values, counts: NDArray[np.bool_], fitted: int) -> Deviation:
    """Measure distances [m] in the order of recording, shape (n,) or (n, 2); `fitted` is p."""
    kept = distances[counts]
    size = np.abs(kept) if kept.ndim == 1 else np.hypot(kept[:, 0], kept[:, 1])
    n, square = len(size), float((size**2).sum())
    return Deviation(
        n=n,
        sd_m=float(np.sqrt(square / max(n - fitted, 1))),
        error_m=float(size.mean()),
        rms_m=float(np.sqrt(square / n)),
        largest_m=float(size.max()),
        outliers=len(distances) - n,
        independent=_independent(kept if kept.ndim == 1 else kept[:, 0]),
    )


def _independent(residuals: Values) -> float:
    """Return n over the integrated autocorrelation, summed up to its first zero; at least 2."""
    n = len(residuals)
    centred = residuals - residuals.mean()
    power = float(centred @ centred)
    if n < 4 or power <= 0:
        return float(n)
    length = 1 << (2 * n - 1).bit_length()
    spectrum = np.fft.rfft(centred / np.sqrt(power), length)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2, length)[1 : n // 2]
    negative = np.flatnonzero(correlation <= 0)
    end = int(negative[0]) if len(negative) else len(correlation)
    return float(np.clip(n / (1 + 2 * correlation[:end].sum()), 2.0, n))


def checked(points: ArrayLike, least: int, what: str) -> Values:
    """Return points as an array, shape (n, 2) or (n, 3).

    Raises
    ------
    ValueError
        For masked points, another shape, fewer than `least` points, a coordinate that is not finite, or points that
        are all one.
    """
    if np.ma.is_masked(points):
        raise ValueError("points: some are masked, which a fit does not know; leave them out")
    try:
        array: Any = np.array(points, float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(
            f"points: must be numbers of the shape (n, 2) or (n, 3), for {what}"
        ) from None
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise ValueError(f"points have the shape {array.shape}: must be (n, 2) or (n, 3) [m]")
    if len(array) < least:
        raise ValueError(f"{len(array)} points: {what} needs at least {least}")
    bad = ~np.isfinite(array).all(axis=1)
    if bad.any():
        row = int(bad.argmax())
        raise ValueError(
            f"point {row} is {tuple(map(float, array[row]))}: every coordinate must be finite [m]"
        )
    if not (np.ptp(array, axis=0) > 0).any():
        raise ValueError(
            f"all {len(array)} points are the same: the signal is constant, {what} needs motion"
        )
    return np.asarray(array, float)
