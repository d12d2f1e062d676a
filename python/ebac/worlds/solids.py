"""Solids made of solids: placed elsewhere, united, cut out of one another, turned into a cavity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ebac import _core
from ebac._core import Box, Capsule, Cylinder, Plane, Sphere, Torus

Shape: TypeAlias = Box | Capsule | Cylinder | Plane | Sphere | Torus
_SHAPES = (Box, Capsule, Cylinder, Plane, Sphere, Torus)


@dataclass(frozen=True)
class Placed:
    """A solid at another place, turned.

    Parameters
    ----------
    solid : solid
        What is placed.
    at : tuple of float
        Where its origin lies [m].
    turned : tuple of float
        By how much it is turned: a rotation vector [rad].
    """

    solid: Solid
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turned: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        """Check the place."""
        _check_solid(self.solid, "Placed.solid")
        for name, unit, most in (("at", "m", 10.0), ("turned", "rad", 6.3)):
            given = getattr(self, name)
            numbers = np.asarray(given, float)
            if numbers.shape != (3,) or not (np.abs(numbers) <= most).all():
                raise ValueError(
                    f"Placed.{name} = {given!r} {unit}: must be three numbers in [-{most:g}, {most:g}] {unit}"
                )
            object.__setattr__(self, name, tuple(float(one) for one in numbers))


@dataclass(frozen=True)
class Cavity:
    """The space inside a solid is free, and all around it is solid."""

    solid: Solid

    def __post_init__(self) -> None:
        """Check the solid."""
        _check_solid(self.solid, "Cavity.solid")


class _Several:
    solids: tuple[Solid, ...]

    def __init__(self, *solids: Solid) -> None:
        kind = type(self).__name__
        if len(solids) < 2:
            raise ValueError(f"{kind}: {len(solids)} solids: must be two at least")
        for solid in solids:
            _check_solid(solid, kind)
        object.__setattr__(self, "solids", solids)


@dataclass(frozen=True, init=False)
class Union(_Several):
    """All that belongs to any of several solids."""

    solids: tuple[Solid, ...]


@dataclass(frozen=True, init=False)
class Intersection(_Several):
    """What belongs to all of several solids."""

    solids: tuple[Solid, ...]


@dataclass(frozen=True, init=False)
class Difference(_Several):
    """The first solid without all others."""

    solids: tuple[Solid, ...]


Solid: TypeAlias = Shape | Placed | Cavity | Union | Intersection | Difference
SOLIDS = (*_SHAPES, Placed, Cavity, Union, Intersection, Difference)


def _check_solid(solid: object, name: str) -> None:
    if not isinstance(solid, SOLIDS):
        names = ", ".join(kind.__name__ for kind in SOLIDS)
        raise TypeError(f"{name} = {solid!r}: must be a solid: {names}")


def made(solid: Solid) -> _core._Solid:
    """Return a solid as the core has it."""
    match solid:
        case Placed():
            return _core._placed(made(solid.solid), solid.at, solid.turned)
        case Cavity():
            return _core._inverted(made(solid.solid))
        case Union():
            return _core._union([made(one) for one in solid.solids])
        case Intersection():
            return _core._intersection([made(one) for one in solid.solids])
        case Difference():
            first, *others = solid.solids
            return _core._intersection(
                [made(first), *(_core._inverted(made(one)) for one in others)]
            )
        case _:
            return _core._solid(solid)


def distance(
    solid: Solid, points: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how far points are from the surface of a solid, and in which direction it is left.

    Parameters
    ----------
    solid : solid
        Any of this package.
    points : array_like, shape (n, 3)
        Points [m].

    Returns
    -------
    distances : array, shape (n,)
        Negative inside [m]. Outside never more than the true distance, near the surface that distance.
    normals : array, shape (n, 3)
        Unit vectors away from the solid.
    """
    return made(solid).distances(np.atleast_2d(np.asarray(points, float)))
