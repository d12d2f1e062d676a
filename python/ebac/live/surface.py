"""The surface of a virtual world as triangles, whatever it is made of: surface nets over its distance."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Corner, Disc, Free, Wall
from ebac._util.arrays import Values
from ebac._util.foreign_worlds import foreign
from ebac.scenario import Environment

Distance = Callable[[Values], Values]
#: The part of space that is drawn reaches so far from the middle [m], in this many cells.
REACH, CELLS = 0.07, 44
#: How far walls and discs, which have no height, are drawn up and down [m].
_HALF_HEIGHT = 0.03


def surface(world: Environment, *, cells: int = CELLS) -> tuple[Values, NDArray[np.int32]]:
    """Return the surface of a world at the time 0, within 70 mm of the middle.

    Parameters
    ----------
    world : Free, Wall, Corner, Disc, worlds.World or that of an engine
        Which; of an engine the bodies that it computes, nothing where they are not known.
    cells : int
        Along each edge of the space, 8 to 128.

    Returns
    -------
    vertices : array, shape (n, 3)
        Points on it [m].
    triangles : array, shape (m, 3)
        Numbers of their corners.
    """
    distance = distance_of(world)
    if distance is None:
        return np.empty((0, 3)), np.empty((0, 3), np.int32)
    return nets(distance, cells)


def distance_of(world: Environment) -> Distance | None:
    """Return a function of points, shape (n, 3), that is negative inside at the time 0; None where there is no body."""
    engine = foreign(world)
    world = world if engine is None else engine.ideal() or Free()
    if isinstance(world, Free):
        return None
    if isinstance(world, Wall):
        return _upright(_wall(world))
    if isinstance(world, Corner):
        first, second = _wall(world.first), _wall(world.second)
        return _upright(lambda p: np.minimum(first(p), second(p)))
    if isinstance(world, Disc):
        return _upright(lambda p: np.hypot(p[:, 0] - world.x, p[:, 1] - world.y) - world.radius)
    from ebac.worlds.solids import distance
    from ebac.worlds.world import begin_of

    bodies: Any = world.bodies  # type: ignore[attr-defined]  # every other _World is a World
    return lambda p: np.min([distance(one.solid, p - begin_of(one))[0] for one in bodies], axis=0)


def _wall(wall: Wall) -> Distance:
    return lambda p: wall.position - (cos(wall.angle) * p[:, 0] + sin(wall.angle) * p[:, 1])


def _upright(flat: Distance) -> Distance:
    return lambda p: np.maximum(flat(p), np.abs(p[:, 2]) - _HALF_HEIGHT)


def nets(distance: Distance, cells: int) -> tuple[Values, NDArray[np.int32]]:
    """Return surface nets (Gibson 1998): a vertex in every cell that the surface passes, four neighbours a face."""
    line = np.linspace(-REACH, REACH, cells + 1)
    nodes = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1)
    d = distance(nodes.reshape(-1, 3)).reshape(nodes.shape[:3])
    d[[0, -1]] = np.abs(d[[0, -1]]) + 1e-9  # closed where the space ends
    d[:, [0, -1]] = np.abs(d[:, [0, -1]]) + 1e-9
    d[:, :, [0, -1]] = np.abs(d[:, :, [0, -1]]) + 1e-9
    inside: NDArray[np.bool_] = np.asarray(d < 0)
    corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]

    def at(values: NDArray[Any], corner: tuple[int, ...]) -> NDArray[Any]:
        return values[tuple(slice(c, c + cells) for c in corner)]

    count = np.sum([at(inside, c) for c in corners], axis=0)
    crossed: NDArray[np.bool_] = np.asarray((count > 0) & (count < 8))
    total = np.zeros((*crossed.shape, 3))
    crossings = np.zeros(crossed.shape)
    for a in corners:
        for axis in range(3):
            if a[axis]:
                continue
            b = tuple(c + (axis == n) for n, c in enumerate(a))
            da, db = at(d, a), at(d, b)
            cut = (da < 0) != (db < 0)
            share = np.where(cut, da / np.where(cut, da - db, 1.0), 0.0)[..., None]
            point = at(nodes, a) + share * (at(nodes, b) - at(nodes, a))
            total += np.where(cut[..., None], point, 0.0)
            crossings += cut
    number = np.full(crossed.shape, -1, np.int32)
    number[crossed] = np.arange(int(crossed.sum()), dtype=np.int32)
    vertices = total[crossed] / crossings[crossed][:, None]
    faces = [_faces(inside, number, axis, cells) for axis in range(3)]
    return vertices, np.concatenate(faces)


def _faces(
    inside: NDArray[np.bool_], number: NDArray[np.int32], axis: int, cells: int
) -> NDArray[np.int32]:
    """Return the faces across the edges along one axis: two triangles of the four cells around each."""
    inner = [slice(1, cells)] * 3
    inner[axis] = slice(0, cells)
    ahead = list(inner)
    ahead[axis] = slice(1, cells + 1)
    a, b = inside[tuple(inner)], inside[tuple(ahead)]
    u, v = (axis + 1) % 3, (axis + 2) % 3

    def cell(du: int, dv: int) -> NDArray[np.int32]:
        place = [slice(1, cells)] * 3
        place[axis] = slice(0, cells)
        place[u] = slice(1 - du, cells - du)
        place[v] = slice(1 - dv, cells - dv)
        return number[tuple(place)]

    around = [cell(1, 1), cell(0, 1), cell(0, 0), cell(1, 0)]
    found = []
    for cut, order in ((a & ~b, (0, 1, 2, 3)), (~a & b, (3, 2, 1, 0))):
        p, q, r, s = (around[k][cut] for k in order)
        found += [np.stack([p, q, r], axis=1), np.stack([p, r, s], axis=1)]
    return np.concatenate(found)
