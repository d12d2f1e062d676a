"""Smooth signals and their derivatives by one kernel, without edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

#: Width of the kernel [s]: passes a hand's motion, 1/(2 pi 8 ms) = 20 Hz.
WIDTH = 8e-3


#: The kernel ends at so many of its widths: at 4 its second derivative would be off by 1 % at 20 Hz.
TAILS = 6


def kernels(dt: float, width: float = WIDTH) -> NDArray[np.float64]:
    """Return a Gaussian, its first and its second derivative, shape (3, taps).

    Exact on polynomials: the gains for 1, t and t^2 are set to what they must be.
    """
    half = max(3, int(np.ceil(TAILS * width / dt)))
    t = dt * np.arange(-half, half + 1)
    s = max(width, dt)
    g = np.exp(-0.5 * (t / s) ** 2)
    g /= g.sum()
    first = -t * g
    first /= np.sum(first * -t)
    second = (t**2 - np.sum(t**2 * g)) * g
    second /= 0.5 * np.sum(second * t**2)
    return np.array([g, first, second])


def smoothed(values: NDArray[np.float64], kernel: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the part of a convolution that sees no edge, shorter by taps - 1."""
    return np.convolve(values, kernel, mode="valid")
