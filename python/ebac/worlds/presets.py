"""Worlds by name, to try a law in: each has its surface at the origin, and is met by a motion along +x."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, cos, pi, sin, sqrt
from typing import Any

import numpy as np

from ebac._core import (
    Box,
    Capsule,
    Cylinder,
    Elastic,
    HuntCrossley,
    Layer,
    Plane,
    Sphere,
    Texture,
    Torus,
)
from ebac._util.arguments import require, unknown
from ebac._util.arrays import Values, length
from ebac.worlds.height_field import HeightField
from ebac.worlds.mesh import Mesh
from ebac.worlds.solids import Cavity, Difference, Placed, Solid, Textured, Tube, Union
from ebac.worlds.world import Body, Layered, World

#: Longest side of a mesh by `mesh:FILE` [m].
MESH_SIZE = 0.04


@dataclass(frozen=True)
class WorldPreset:
    """A world by name: what it is, and its solid or tissue."""

    what: str
    solid: Callable[[], Solid]
    material: Callable[[], HuntCrossley | Layered] | None = None
    extra: bool = False


def _at(solid: Solid, x: float, turned: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Placed:
    return Placed(solid, (x, 0.0, 0.0), turned)


def _corner() -> Union:
    """Return three planes at right angles, alike to a motion along +x."""
    planes: list[Solid] = []
    for k in range(3):
        around = 2 * pi * k / 3
        normal = np.array([-1.0, sqrt(2) * cos(around), sqrt(2) * sin(around)]) / sqrt(3)
        axis = np.cross([-1.0, 0.0, 0.0], normal)
        turned = axis / length(axis) * acos(-normal[0])
        about_x, about_y, about_z = map(float, turned)
        planes.append(Placed(Plane(), (0.0, 0.0, 0.0), (about_x, about_y, about_z)))
    return Union(*planes)


def _ground() -> Placed:
    """Return hills of 4 mm, their middle's top at the origin, upright across the x axis."""
    u = np.linspace(-1, 1, 41)
    hills = 2e-3 * np.cos(2 * pi * u)[:, None] * np.cos(2 * pi * u) + 2e-3
    return Placed(HeightField.of(hills, spacing=1.5e-3), (4e-3, 0.0, 0.0), (0.0, -pi / 2, 0.0))


def _lumen() -> Placed:
    """Return a bent tube of 24 mm from inside; its wall is met 12 mm from the axis."""
    curve = [(0.0, 0.0, z) for z in (-0.08, -0.04, 0.0, 0.04)] + [
        (0.01, 0.0, 0.08),
        (0.03, 0.0, 0.11),
    ]
    return _at(Cavity(Tube.along(curve, 0.012)), -0.012)


def _tissue() -> Layered:
    return Layered(
        Layer(thickness=2e-3, stiffness=1500, damping=2, puncture=3, cutting=0.3),
        Layer(thickness=6e-3, stiffness=400, damping=2, puncture=2, cutting=0.2),
        Layer(thickness=20e-3, stiffness=900, damping=4),
    )


PRESETS: dict[str, WorldPreset] = {
    "plane": WorldPreset("a flat wall", Plane),
    "sphere": WorldPreset("a ball of 40 mm", lambda: _at(Sphere(radius=0.02), 0.02)),
    "box": WorldPreset("a cube of 40 mm, met on a face", lambda: _at(Box(), 0.02)),
    "edge": WorldPreset(
        "the same cube, met on an edge", lambda: _at(Box(), 0.02 * sqrt(2), (0.0, 0.0, pi / 4))
    ),
    "corner": WorldPreset("three planes at right angles, from inside", _corner),
    "cylinder": WorldPreset("a cylinder of 40 mm across the motion", lambda: _at(Cylinder(), 0.02)),
    "inside": WorldPreset(
        "a bore of 60 mm, from inside",
        lambda: _at(Cavity(Cylinder(radius=0.03, length=0.2)), -0.03),
    ),
    "capsule": WorldPreset("a capsule of 40 mm across the motion", lambda: _at(Capsule(), 0.02)),
    "torus": WorldPreset("a ring of 80 mm, met on its outside", lambda: _at(Torus(), 0.04)),
    "slot": WorldPreset(
        "a cube with a slot of 6 mm, whose floor is met",
        lambda: _at(Difference(Box(), _at(Box(width=0.02, depth=6e-3, height=0.05), -0.02)), 0.01),
    ),
    "texture": WorldPreset(
        "a wall with waves of 0.2 mm, 5 mm long", lambda: Textured(Plane(), Texture())
    ),
    "lumen": WorldPreset("a bent tube of 24 mm, from inside", _lumen),
    "soft": WorldPreset("a soft wall after Hunt and Crossley", Plane, HuntCrossley),
    "tissue": WorldPreset(
        "three layers of tissue; two are punctured, at 3 and 2 N", Plane, _tissue
    ),
    "ground": WorldPreset("hills of 4 mm from a height map", _ground, extra=True),
}


def preset(
    name: str,
    *,
    stiffness: float | None = None,
    damping: float | None = None,
    friction: float = 0.0,
    position: float = 0.0,
) -> World:
    """Return a world by its name.

    Parameters
    ----------
    name : str
        One of `ebac worlds`, or `mesh:FILE` for a mesh with its longest side made 40 mm and its leftmost place at the
        origin.
    stiffness : float, optional
        Of its surface [N/m], [0, 1e7], 10 kN/m by default; `soft` and `tissue` have their own.
    damping : float, optional
        Of its surface [N s/m], [0, 1e4], none by default; `soft` and `tissue` have their own.
    friction : float
        Coulomb's coefficient, [0, 2].
    position : float
        How far along x it is moved [m].

    Raises
    ------
    ValueError
        For an unknown name; the message suggests the nearest. For a stiffness or damping of a world that has its own.
    """
    require(name, str, "ebac.worlds.preset", "the name of a world")
    kind, colon, file = name.partition(":")
    solid: Solid
    surface = {"stiffness": stiffness, "damping": damping}
    given = {name: value for name, value in surface.items() if value is not None}
    material: Any = Elastic(**{"stiffness": 10e3, "damping": 0.0} | given)
    if kind == "mesh" and colon:
        solid = _front_at_origin(Mesh(file, size=MESH_SIZE))
    else:
        if kind not in PRESETS or colon:
            raise ValueError(unknown(f"world {name!r}", name, [*PRESETS, "mesh:FILE"], "world"))
        chosen = PRESETS[kind]
        solid = chosen.solid()
        if chosen.material is not None:
            if given:
                raise ValueError(
                    f"world {name!r} has a material of its own: give no {' and no '.join(given)}, or build the world "
                    "in Python or TOML"
                )
            material = chosen.material()
    if position:
        solid = Placed(solid, (position, 0.0, 0.0))
    return World(Body(solid=solid, material=material, friction=friction))


def _front_at_origin(mesh: Mesh) -> Placed:
    """Return a mesh with the middle of its front at the origin, seen along +x; a vertex of it where that is a hole."""
    surface = mesh.surface()
    vertices = surface.vertices
    front = vertices[vertices[:, 0] < vertices[:, 0].min() + 1e-6 * np.ptp(vertices[:, 0])]
    place = np.unique(front, axis=0).mean(axis=0)
    met = _first_on_line(vertices[surface.faces], place[1:])
    place = front[0] if met is None else np.array([met, *place[1:]])
    x, y, z = (-place).tolist()
    return Placed(mesh, (x, y, z))


def _first_on_line(corners: Values, through: Values) -> float | None:
    """Return where a line along x first meets triangles, shape (n, 3, 3); None where it meets none."""
    a, b, c = (corners[:, i, 1:] - through for i in range(3))
    shares = np.stack([_cross(b, c), _cross(c, a), _cross(a, b)], axis=1)
    total = shares.sum(axis=1, keepdims=True)
    flat = np.abs(total[:, 0]) > 0  # not seen edge on
    weights = shares[flat] / total[flat]
    x = (weights * corners[flat, :, 0]).sum(axis=1)[(weights >= -1e-9).all(axis=1)]
    return float(x.min()) if len(x) else None


def _cross(one: Values, two: Values) -> Values:
    return np.asarray(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
