"""Meshes as grids of signed distance, kept in a cache."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, fields
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._util.arrays import Values
from ebac._util.atomic_file import draft
from ebac._util.progress import Progress

Ints = NDArray[np.int64]

#: Cells of a brick along each edge, as the core has them.
BRICK = 8
#: Points asked for their distance at a time.
MANY = 100_000
#: Most nodes of a grid: 16 bytes each.
MOST_NODES = 40_000_000
#: Most bricks, also of those without a surface.
MOST_BRICKS = 1_000_000
#: Changes when the numbers of a grid would.
VERSION = 1


_watching: ContextVar[Progress | None] = ContextVar("watching", default=None)


@contextmanager
def watching(progress: Progress) -> Iterator[None]:
    """Call `progress` with nodes done and all nodes while any grid is made, wherever that happens."""
    token = _watching.set(progress)
    try:
        yield
    finally:
        _watching.reset(token)


@dataclass(frozen=True)
class Grid:
    """Signed distance to a mesh; fine in bricks near its surface, coarse elsewhere.

    Attributes
    ----------
    origin : array, shape (3,)
        First node [m].
    cell : float
        Edge of a cell [m].
    margin : float
        Distance of the mesh from the grid's edge [m].
    far : array of float32
        Distance at the corners of the bricks [m].
    index : array of int32, shape (bricks along x, y, z)
        Number of each brick in `nodes`, or -1 where no surface is.
    nodes : array of float32, shape (bricks, 9, 9, 9, 4)
        Direction and distance [m] at each node.
    """

    origin: Values
    cell: float
    margin: float
    far: NDArray[np.float32]
    index: NDArray[np.int32]
    nodes: NDArray[np.float32]

    def made(self) -> _core._Solid:
        """Return the solid."""
        values = {one.name: getattr(self, one.name) for one in fields(self)}
        return _core._grid(**values)


class Surface:
    """Triangles, asked for distance and direction by libigl.

    Parameters
    ----------
    vertices : array, shape (n, 3)
        Corners [m].
    faces : array of int, shape (m, 3)
        Triangles.
    thickness : float
        0 for the surface of a solid; that of a shell whose middle the triangles are [m].
    """

    def __init__(self, vertices: Values, faces: Ints, thickness: float = 0.0) -> None:
        corners = vertices[faces]
        volume = np.einsum("ni,ni->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
        if volume < 0 and not thickness:  # a solid turned inside out
            faces = np.ascontiguousarray(faces[:, ::-1])
            corners = vertices[faces]
        self.vertices, self.faces, self.thickness = vertices, faces, thickness
        self._igl = needed("igl", "libigl")
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self._normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)

    def distance(self, points: Values) -> tuple[Values, Values]:
        """Return signed distances [m], shape (n,), and unit vectors away from the solid, shape (n, 3)."""
        kind = self._igl.SignedDistanceType
        way = (
            kind.SIGNED_DISTANCE_TYPE_UNSIGNED
            if self.thickness
            else kind.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
        )
        d, face, nearest, _ = self._igl.signed_distance(points, self.vertices, self.faces, way)
        off = points - nearest
        length = np.linalg.norm(off, axis=1)
        sure = length > 1e-9
        out = self._normals[face]
        sign = np.where(d < 0, -1.0, 1.0)
        out[sure] = (sign[:, None] * off)[sure] / length[sure, None]
        return d - 0.5 * self.thickness, out


def needed(module: str, project: str, *, what: str = "meshes", extra: str = "worlds") -> ModuleType:
    """Import a module of an extra."""
    from importlib import import_module

    try:
        return import_module(module)
    except ImportError as error:
        raise ImportError(
            f"{what} need {project}: pip install 'ebac[{extra}]'", name=module
        ) from error


def grid_of(
    surface: Surface, cell: float, progress: Progress | None = None, *, owner: str = "Mesh"
) -> Grid:
    """Return the grid of a surface; `owner` is whose cell it is, for messages.

    `progress`, or that of `watching`, is called with nodes done and all.
    """
    low = surface.vertices.min(axis=0) - 0.5 * surface.thickness
    high = surface.vertices.max(axis=0) + 0.5 * surface.thickness
    edge = BRICK * cell
    bricks = np.ceil((high - low) / edge + 2).astype(int)
    if (count := np.prod(bricks.astype(float))) > MOST_BRICKS:
        raise ValueError(
            f"{owner}.cell = {cell:g} m: the grid would have {count:,.0f} bricks of {BRICK} cells a side, "
            f"{MOST_BRICKS:,} at most; give a larger cell"
        )
    origin = 0.5 * (low + high - bricks * edge)
    far = surface.distance(origin + edge * _cells(bricks + 1))[0].reshape(bricks + 1)
    centres = origin + edge * (_cells(bricks) + 0.5)
    nearby = np.abs(surface.distance(centres)[0]) <= 0.5 * np.sqrt(3) * edge + cell
    near = _cells(bricks)[nearby]
    if len(near) * (BRICK + 1) ** 3 > MOST_NODES:
        raise ValueError(
            f"{owner}.cell = {cell:g} m: the grid would have {len(near) * (BRICK + 1) ** 3:,} nodes, "
            f"{MOST_NODES:,} at most; give a larger cell"
        )
    index = np.full(bricks, -1, np.int32)
    index[tuple(near.T)] = np.arange(len(near))
    # Neighbours share the nodes of their common face: each is asked for once.
    within = _cells(np.full(3, BRICK + 1))
    places = (BRICK * near[:, None, :] + within[None]).reshape(-1, 3)
    size = BRICK * bricks + 1
    number = (places[:, 0] * size[1] + places[:, 1]) * size[2] + places[:, 2]
    _, first, which = np.unique(number, return_index=True, return_inverse=True)
    out, d = _asked(surface, origin, cell, places[first], progress or _watching.get())
    nodes = np.column_stack([out, d]).astype(np.float32)[which.ravel()]
    shape = (len(near), *(BRICK + 1,) * 3, 4)
    return Grid(
        origin,
        cell,
        float((low - origin).min()),
        far.astype(np.float32),
        index,
        nodes.reshape(shape),
    )


def _cells(size: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the numbers of all cells of a block, the last coordinate first, shape (n, 3)."""
    return np.stack(np.meshgrid(*map(np.arange, size), indexing="ij"), axis=-1).reshape(-1, 3)


def _asked(
    surface: Surface,
    origin: Values,
    step: float,
    places: NDArray[np.int64],
    progress: Progress | None = None,
) -> tuple[Values, Values]:
    """Return directions and distances at nodes of a lattice."""
    out, d = np.empty((len(places), 3)), np.empty(len(places))
    for start in range(0, len(places), MANY):
        part = slice(start, start + MANY)
        d[part], out[part] = surface.distance(origin + step * places[part])
        if progress is not None:
            progress(min(start + MANY, len(places)), len(places))
    return out, d


def cache_folder() -> Path:
    """Return where grids are kept: `$EBAC_CACHE`, or `ebac/worlds` in the user's cache."""
    if given := os.environ.get("EBAC_CACHE"):
        return Path(given)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "ebac" / "worlds"


def cached_grid(
    surface: Surface, cell: float, progress: Progress | None = None, *, owner: str = "Mesh"
) -> Grid:
    """Return the grid of a surface, from the cache if it is there; arguments as of `grid_of`."""
    code = hashlib.sha256()
    for part in (surface.vertices, surface.faces, np.array([surface.thickness, cell, VERSION])):
        code.update(np.ascontiguousarray(part).tobytes())
    path = cache_folder() / f"{code.hexdigest()[:32]}.npz"
    try:
        with path.open("rb") as file, np.load(file) as kept:
            values: dict[str, Any] = {name: kept[name] for name in kept.files}
        return Grid(**values | {name: float(values[name]) for name in ("cell", "margin")})
    except Exception:  # not there, or damaged, which has a dozen errors: made anew
        pass
    grid = grid_of(surface, cell, progress, owner=owner)
    _keep(grid, path)
    return grid


def _keep(grid: Grid, path: Path) -> None:
    """Write a grid; a folder that cannot be written to costs the cache, not the grid."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with draft(path) as name, name.open("wb") as file:
            np.savez(file, **{one.name: getattr(grid, one.name) for one in fields(grid)})
    except OSError:
        return
