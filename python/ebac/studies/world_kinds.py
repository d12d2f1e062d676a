"""Kinds of worlds of several bodies: which solids there are, and how one is drawn at random."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, atan2, degrees, pi

import numpy as np

from ebac._core import Cylinder, Plane, Sphere
from ebac._util.arrays import Values, length
from ebac.worlds.solids import Cavity, Placed, Solid

#: Least and largest angle between two directions [deg]: neither the same plane twice nor two planes face to face.
APART = (5.0, 175.0)


@dataclass(frozen=True, kw_only=True)
class WorldKind:
    """Worlds of one kind.

    Attributes
    ----------
    name, summary : str
        How it is called, and what it is in a line.
    draw : callable
        A random generator and the number of axes of the device in, 2 or 3; the solids out. They leave at least 1 mm
        around the origin free, where the handle begins. With 2 axes they are drawn in the plane of the device.
    """

    name: str
    summary: str
    draw: Callable[[np.random.Generator, int], tuple[Solid, ...]]


def direction(random: np.random.Generator, axes: int) -> Values:
    """Return a unit vector, shape (3,), evenly over all directions of 2 or 3 axes."""
    vector = np.zeros(3)
    vector[:axes] = random.normal(size=axes)
    return vector / length(vector)


def _two_directions(random: np.random.Generator, axes: int) -> tuple[Values, Values]:
    """Return two directions that are neither nearly the same nor nearly opposite."""
    one = direction(random, axes)
    while True:
        other = direction(random, axes)
        if APART[0] < degrees(acos(np.clip((one * other).sum(), -1, 1))) < APART[1]:
            return one, other


def _planes(random: np.random.Generator, axes: int) -> tuple[Solid, ...]:
    return tuple(_plane(random, n) for n in _two_directions(random, axes))


def _three_planes(random: np.random.Generator, axes: int) -> tuple[Solid, ...]:
    return *_planes(random, axes), _plane(random, direction(random, axes))


def _balls(random: np.random.Generator, axes: int) -> tuple[Solid, ...]:
    radius = random.uniform(5e-3, 30e-3)
    centre = radius + random.uniform(2e-3, 6e-3)
    ball = Sphere(radius=radius)
    return tuple(_at(ball, centre * n) for n in _two_directions(random, axes))


def _ball_and_plane(random: np.random.Generator, axes: int) -> tuple[Solid, ...]:
    towards_ball, towards_plane = _two_directions(random, axes)
    radius = random.uniform(3e-3, 20e-3)
    ball = _at(Sphere(radius=radius), (radius + random.uniform(2e-3, 8e-3)) * towards_ball)
    return ball, _plane(random, towards_plane)


def _cavity(random: np.random.Generator, axes: int) -> tuple[Solid, ...]:
    radius = random.uniform(8e-3, 20e-3)
    away = radius * random.uniform(0.4, 0.8)
    thick = random.uniform(2e-3, min(6e-3, away - 1e-3))
    column = Cylinder(radius=thick, length=50e-3)  # across the plane of two axes
    return Cavity(Sphere(radius=radius)), _at(column, away * direction(random, 2))


def _plane(random: np.random.Generator, into: Values) -> Placed:
    """Return all that lies 2 to 8 mm from the origin and beyond, in a direction."""
    return Placed(Plane(), at=_floats(random.uniform(2e-3, 8e-3) * into), turned=_turned(into))


def _turned(into: Values) -> tuple[float, float, float]:
    """Return the rotation vector [rad] that turns the x axis, into which a `Plane` begins, to a direction."""
    axis = np.cross([1.0, 0.0, 0.0], into)
    sine = length(axis)
    if sine < 1e-9:
        return (0.0, 0.0, 0.0 if into[0] > 0 else pi)
    return _floats(axis / sine * atan2(sine, into[0]))


def _at(solid: Solid, place: Values) -> Placed:
    return Placed(solid, at=_floats(place))


def _floats(vector: Values) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z


#: Every kind by its name.
KINDS: dict[str, WorldKind] = {
    kind.name: kind
    for kind in (
        WorldKind(name="planes", summary="two planes", draw=_planes),
        WorldKind(name="balls", summary="two balls of the same radius", draw=_balls),
        WorldKind(name="ball-and-plane", summary="a ball and a plane", draw=_ball_and_plane),
        WorldKind(name="three-planes", summary="three planes", draw=_three_planes),
        WorldKind(name="cavity", summary="a cylinder in a round cavity", draw=_cavity),
    )
}
