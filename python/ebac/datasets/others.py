"""Simulated paths, a population of hands, and the configuration of the joystick."""

from __future__ import annotations

from errno import ENOENT
from importlib.resources import files
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ebac.hardware import Configuration
    from ebac.operators import Operators

#: Points of a path, and the hand's deviation from it [m]; it lasts for some points.
POINTS, DEVIATION, LASTS = 400, 1e-4, 5
#: Radius of the circle, half the length of the line, and its angle [m, m, rad].
RADIUS, HALF_LINE, ANGLE = 0.040, 0.040, np.pi / 6


def line() -> NDArray[np.float64]:
    """Return a path along a ruler of 80 mm at 30 degrees, there and back; shape (400, 2) [m].

    The hand deviates by 0.1 mm (standard deviation), the encoder shows steps of 0.031 mm.
    """
    along = HALF_LINE * np.cos(np.linspace(0, 2 * np.pi, POINTS, endpoint=False))
    return _shown(np.outer(along, [np.cos(ANGLE), np.sin(ANGLE)]), seed=1)


def circle() -> NDArray[np.float64]:
    """Return a path once around a circle of 40 mm radius; shape (400, 2) [m]. The hand deviates as in `line`."""
    turn = np.linspace(0, 2 * np.pi, POINTS, endpoint=False)
    return _shown(RADIUS * np.column_stack([np.cos(turn), np.sin(turn)]), seed=2)


def _shown(path: NDArray[np.float64], *, seed: int) -> NDArray[np.float64]:
    """Return the encoder readings of a hand that follows a path with small deviations."""
    from ebac._core import Device

    count = Device().count
    window = np.ones(LASTS) / np.sqrt(LASTS)
    noise = np.random.default_rng(seed).normal(0, DEVIATION, (2, POINTS + LASTS - 1))
    off = np.column_stack([np.convolve(axis, window, mode="valid") for axis in noise])
    return np.asarray(count * np.rint((path + off) / count))


def hands() -> Operators:
    """Return a population of twelve random hands, each with the depth it wants to reach."""
    from ebac.operators import Operators

    return Operators.sample(12, seed=1)


def joystick() -> Configuration:
    """Return the configuration of the paper's joystick: two drives, a wall, and a simulated hand."""
    from ebac.hardware import Configuration

    return Configuration.from_toml(joystick_text(), name="joystick.toml")


def joystick_text(name: str = "joystick") -> str:
    """Return a configuration, "handle", "joystick" or "joystick-3" with 1, 2 or 3 axes, as TOML text with comments.

    Parameters
    ----------
    name : str
        `handle`, `joystick` or `joystick-3`.

    Raises
    ------
    FileNotFoundError
        For another name.
    """
    known = {f.name.removesuffix(".toml"): f for f in files("ebac.datasets").iterdir()}
    if str(name) not in known:
        raise FileNotFoundError(ENOENT, "no configuration has this name", str(name))
    return known[name].read_text(encoding="utf-8")
