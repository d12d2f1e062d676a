"""Solids: simple shapes, tubes, and solids made of solids."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ebac import _core
from ebac._core import Box, Capsule, Cylinder, Plane, Sphere, Texture, Torus
from ebac._util.serialisation import SHAPES
from ebac._util.wrong_calls import plain_constructor
from ebac.worlds.height_field import HeightField
from ebac.worlds.mesh import Mesh
from ebac.worlds.part import Part, array, three

Shape: TypeAlias = Box | Capsule | Cylinder | Plane | Sphere | Torus
#: Solids within each other: each costs a call of its own in every tick.
DEEPEST = 64


@plain_constructor
@dataclass(frozen=True)
class Placed(Part):
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
        _check_solids(self, "Placed.solid", self.solid)
        object.__setattr__(self, "at", three("Placed.at", self.at, "m", 10.0))
        object.__setattr__(self, "turned", three("Placed.turned", self.turned, "rad", 6.3))


@plain_constructor
@dataclass(frozen=True)
class Cavity(Part):
    """The space inside a solid is free, and all around it is solid."""

    solid: Solid

    def __post_init__(self) -> None:
        """Check the solid."""
        _check_solids(self, "Cavity.solid", self.solid)


@plain_constructor
@dataclass(frozen=True)
class Textured(Part):
    """A solid with waves on its surface, (sin kx + sin ky + sin kz) / 3 of the place.

    Its distance is the height above the waves, divided near them by their slope: exact to first order, and outside up
    to half the amplitude more than the true distance.

    Parameters
    ----------
    solid : solid
        The smooth one.
    texture : Texture
        Amplitude [m] and wavelength [m]; no steeper than 30 degrees: 2 pi amplitude / wavelength at most 1.
    """

    solid: Solid
    texture: Texture = field(default_factory=Texture)

    def __post_init__(self) -> None:
        """Check the waves."""
        _check_solids(self, "Textured.solid", self.solid)
        if not isinstance(self.texture, Texture):
            raise TypeError(f"Textured.texture = {self.texture!r}: must be a Texture")
        steep = 2 * np.pi * self.texture.amplitude / self.texture.wavelength
        if steep > 1:
            raise ValueError(
                f"Textured.texture = {self.texture!r}: 2 pi amplitude / wavelength is {steep:.3g}, must be 1 at most; "
                "give longer or lower waves"
            )


@plain_constructor
@dataclass(frozen=True)
class Tube(Part):
    """All that is near a curve; `Cavity(Tube(...))` is a lumen.

    Parameters
    ----------
    points : sequence of (x, y, z)
        Of the curve [m], 2 to 256, with straight lines between them; `Tube.along` bends them smoothly.
    radius : float or sequence of float
        Of the tube [m], (0, 1]: everywhere, or at each point, changing evenly in between.
    """

    points: tuple[tuple[float, float, float], ...]
    radius: float | tuple[float, ...] = 0.01

    def __post_init__(self) -> None:
        """Check points and radius."""
        points = array("Tube.points", self.points, "numbers, shape (n, 3)")
        if points.ndim != 2 or points.shape[1:] != (3,) or not 2 <= len(points) <= 256:
            raise ValueError(f"Tube.points: shape {points.shape}: must be (n, 3), n from 2 to 256")
        if not (np.abs(points) <= 10).all():
            raise ValueError("Tube.points: must lie in [-10, 10] m")
        radii = array("Tube.radius", self.radius, "a number, or one for each point")
        if radii.shape not in ((), (len(points),)):
            raise ValueError(
                f"Tube.radius = {self.radius!r}: shape {radii.shape}: must be one number, or one for each of the "
                f"{len(points)} points"
            )
        radii = np.broadcast_to(radii, len(points))
        if not ((radii > 0) & (radii <= 1)).all():
            raise ValueError(f"Tube.radius = {self.radius!r} m: must lie in (0, 1] m")
        ways = np.linalg.norm(np.diff(points, axis=0), axis=1)
        if not (np.abs(np.diff(radii)) < 0.9 * ways).all():
            raise ValueError(
                "Tube: between two points the radius changes by more than 0.9 of the way; "
                "give points farther apart, or none twice"
            )
        object.__setattr__(
            self, "points", tuple(three("Tube.points", p, "m", 10.0) for p in points)
        )
        if np.ndim(self.radius):
            object.__setattr__(self, "radius", tuple(float(one) for one in radii))
        else:
            object.__setattr__(self, "radius", float(self.radius))  # type: ignore[arg-type]

    @classmethod
    def along(cls, points: ArrayLike, radius: float = 0.01, *, parts: int = 8) -> Self:
        """Return a tube along a smooth curve (Catmull-Rom) through the points, `parts` pieces between two of them."""
        given = array("Tube.along: points", points, "numbers, shape (n, 3)")
        if given.ndim != 2 or given.shape[1:] != (3,) or len(given) < 2:
            raise ValueError(
                f"Tube.along: points: shape {given.shape}: must be (n, 3), n at least 2"
            )
        slope = np.gradient(given, axis=0)
        u = np.linspace(0, len(given) - 1, parts * (len(given) - 1) + 1)
        i = np.minimum(u.astype(int), len(given) - 2)
        s = (u - i)[:, None]
        ends = given[i] * (1 + 2 * s) * (1 - s) ** 2 + given[i + 1] * (3 - 2 * s) * s**2
        return cls(ends + slope[i] * s * (1 - s) ** 2 - slope[i + 1] * (1 - s) * s**2, radius)


@plain_constructor
class _Several(Part):
    solids: tuple[Solid, ...]

    def __init__(self, *solids: Solid) -> None:
        kind = type(self).__name__
        if len(solids) < 2:
            raise ValueError(f"{kind}: {len(solids)} solids: must be two at least")
        _check_solids(self, kind, *solids)
        object.__setattr__(self, "solids", solids)

    @classmethod
    def from_table(cls, solids: tuple[Solid, ...]) -> Self:
        """Return it from its parts by name."""
        return cls(*solids)


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


Solid: TypeAlias = (
    Shape
    | Placed
    | Cavity
    | Textured
    | Tube
    | Union
    | Intersection
    | Difference
    | Mesh
    | HeightField
)
SOLIDS = (
    *SHAPES, Placed, Cavity, Textured, Tube, Union, Intersection, Difference, Mesh, HeightField,
)  # fmt: skip


def check_solid(name: str, solid: object) -> None:
    """Refuse what is no solid."""
    if not isinstance(solid, SOLIDS):
        names = ", ".join(kind.__name__ for kind in SOLIDS)
        raise TypeError(f"{name} = {solid!r}: must be a solid: {names}")


def _check_solids(whole: Part, name: str, *solids: object) -> None:
    for solid in solids:
        check_solid(name, solid)
    depth = 1 + max(getattr(solid, "_depth", 0) for solid in solids)
    if depth > DEEPEST:
        raise ValueError(
            f"{name}: {depth} solids within each other: must be {DEEPEST} at most; put them side by side in one Union"
        )
    object.__setattr__(whole, "_depth", depth)


def made(solid: Solid) -> _core._Solid:
    """Return a solid as the core has it."""
    match solid:
        case Placed():
            return _core._placed(made(solid.solid), solid.at, solid.turned)
        case Cavity():
            return _core._inverted(made(solid.solid))
        case Textured():
            return _core._textured(made(solid.solid), solid.texture)
        case Tube():
            radii = np.broadcast_to(np.asarray(solid.radius, float), len(solid.points))
            return _core._tube(np.array(solid.points), radii.tolist())
        case Mesh() | HeightField():
            return solid.grid().made()
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


def distance(solid: Solid, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
        Negative inside [m]. Outside never more than the true distance, near the surface that distance; of a `Textured`
        solid exact to first order near the surface, and outside up to half the amplitude of the waves too long.
    normals : array, shape (n, 3)
        Unit vectors away from the solid.

    Raises
    ------
    TypeError
        For what is no solid, or no array of numbers.
    """
    check_solid("distance: solid", solid)
    places = array("distance: points", points, "numbers, shape (n, 3)")
    return made(solid).distances(np.atleast_2d(places))
