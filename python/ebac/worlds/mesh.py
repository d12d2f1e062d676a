"""Solids from triangles: mesh files and height maps."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ebac._util import formatting
from ebac._util.arguments import number
from ebac._util.wrong_calls import plain_constructor
from ebac.worlds.grid import Grid, Progress, Surface, cached_grid
from ebac.worlds.mesh_file import read
from ebac.worlds.part import Part, array

#: Cells along the longest side of a mesh, unless given.
CELLS = 96
#: A mesh that is longer was probably drawn in millimetres, and read as metres [m].
LONGEST = 2.5
#: Fewest cells along it, of which one may be set: with fewer a body has another shape.
COARSEST = 4


@dataclass(frozen=True, repr=False)
class GridError:
    """How far a grid is from the triangles it was made of.

    Attributes
    ----------
    cell_m : float
        Edge of a cell.
    samples : int
        Points compared, within a cell of the surface.
    depth_rms_m, depth_max_m : float
        Error of the distance.
    normal_median_deg, normal_p99_deg : float
        Error of the direction. At an edge of the mesh the true direction jumps, and the grid's turns within a cell.
    """

    cell_m: float
    samples: int
    depth_rms_m: float
    depth_max_m: float
    normal_median_deg: float
    normal_p99_deg: float

    def __repr__(self) -> str:
        """Return every number with its unit, one a line."""
        title = f"Grid against its triangles at {self.samples} points:"
        return formatting.listed(title, self, _LINES)


#: What a printed error of a grid shows: label, attribute, unit, what to print where there is none.
_LINES = (
    ("cell", "cell_m", "m", "-"),
    ("depth, rms", "depth_rms_m", "m", "-"),
    ("depth, most", "depth_max_m", "m", "-"),
    ("normal, median", "normal_median_deg", "deg", "-"),
    ("normal, 99 %", "normal_p99_deg", "deg", "-"),
)


class _Triangles(Part):
    """What meshes and height maps share: the grid of their surface."""

    cell: float | None

    def surface(self) -> Surface:
        """Return the triangles."""
        raise NotImplementedError

    def grid(self, progress: Progress | None = None) -> Grid:
        """Return the signed distance on a grid, from the cache if it is there.

        Parameters
        ----------
        progress : callable, optional
            Called with nodes done and all nodes, while a grid is made.
        """
        surface = self.surface()
        cell, coarsest = self.cell_m(surface), _longest(surface) / COARSEST
        if cell > coarsest:
            raise ValueError(
                f"{type(self).__name__}.cell = {cell:g} m: must be {coarsest:g} m at most, a quarter of its size"
            )
        return cached_grid(surface, cell, progress)

    def cell_m(self, surface: Surface | None = None) -> float:
        """Return the edge of a cell [m]."""
        if self.cell is not None:
            return self.cell
        given = self.surface() if surface is None else surface
        return float(np.ptp(given.vertices, axis=0).max()) / CELLS

    def error(self, *, samples: int = 4000, seed: int = 1) -> GridError:
        """Compare the grid with the exact distance to the triangles.

        Parameters
        ----------
        samples : int
            Points at random on the surface, moved off it by a cell at most.
        seed : int
            Seed.
        """
        surface, grid = self.surface(), self.grid()
        random = np.random.default_rng(seed)
        corners = surface.vertices[surface.faces]
        sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(sides, axis=1)
        which = random.choice(len(corners), samples, p=area / area.sum())
        weights = random.dirichlet(np.ones(3), samples)
        points = np.einsum("ni,nij->nj", weights, corners[which])
        points += random.uniform(-grid.cell, grid.cell, samples)[:, None] * (
            sides[which] / area[which, None]
        )
        exact, direction = surface.distance(points)
        found, out = grid.made().distances(points)
        angle = np.degrees(np.arccos(np.clip(np.einsum("ni,ni->n", direction, out), -1, 1)))
        off = found - exact
        return GridError(
            cell_m=grid.cell,
            samples=samples,
            depth_rms_m=float(np.sqrt(np.mean(off**2))),
            depth_max_m=float(np.abs(off).max()),
            normal_median_deg=float(np.median(angle)),
            normal_p99_deg=float(np.quantile(angle, 0.99)),
        )


def _longest(surface: Surface) -> float:
    """Return the longest side [m], with that of a shell."""
    return float(np.ptp(surface.vertices, axis=0).max()) + surface.thickness


def _check_cell(name: str, cell: float | None) -> None:
    if cell is not None and not 1e-5 <= number(f"{name}.cell", cell) <= 0.1:
        raise ValueError(f"{name}.cell = {cell!r} m: must lie in [1e-05, 0.1] m")


@plain_constructor
@dataclass(frozen=True)
class Mesh(_Triangles):
    """A solid bounded by triangles, from any file that trimesh reads (STL, OBJ, PLY, OFF, GLB, ...).

    It becomes signed distance on a grid, so that a contact costs the same with a thousand triangles and with a million.
    The grid is made once and kept in the user's cache (`EBAC_CACHE` names another folder). Needs `ebac[worlds]`.

    Parameters
    ----------
    file : str
        Path of the file.
    scale : float
        Metres in a unit of the file, [1e-6, 1e3]: 0.001 for millimetres.
    size : float or None
        Longest side [m], instead of `scale`.
    cell : float or None
        Edge of a cell of the grid [m], [1e-5, 0.1]; None: 1/96 of the longest side.
    thickness : float
        0: a closed surface around a solid. Above: a shell of this thickness [m], (0, 0.1]; a surface that is open must
        be one.

    Raises
    ------
    TypeError
        When it is no path, or a parameter is no number.
    FileNotFoundError
        When there is no such file.
    ValueError
        When it is a folder, holds no triangles, is open without a `thickness`, or a number is out of range.
    ImportError
        Without the extra.

    Warns
    -----
    UserWarning
        When its longest side is above 2.5 m: the file is probably in millimetres.
    """

    file: str
    scale: float = 1.0
    size: float | None = None
    cell: float | None = None
    thickness: float = 0.0

    def __post_init__(self) -> None:
        """Check numbers and file."""
        if not isinstance(self.file, (str, Path)):
            raise TypeError(f"Mesh.file = {self.file!r}: must be the path of a file")
        object.__setattr__(self, "file", str(self.file))
        if Path(self.file).is_dir():  # the empty path, too
            raise ValueError(f"Mesh.file = {self.file!r}: is a folder, must be the path of a file")
        if not 1e-6 <= number("Mesh.scale", self.scale) <= 1e3:
            raise ValueError(f"Mesh.scale = {self.scale!r} m: must lie in [1e-06, 1000] m")
        if self.size is not None and not 1e-3 <= number("Mesh.size", self.size) <= 10:
            raise ValueError(f"Mesh.size = {self.size!r} m: must lie in [0.001, 10] m")
        _check_cell("Mesh", self.cell)
        thickness = number("Mesh.thickness", self.thickness)
        if thickness != 0 and not 1e-4 <= thickness <= 0.1:
            raise ValueError(
                f"Mesh.thickness = {self.thickness!r} m: must be 0 or lie in [0.0001, 0.1] m"
            )
        longest = float(np.ptp(self.surface().vertices, axis=0).max())
        if longest > LONGEST:
            warnings.warn(
                f"{self.file}: its longest side is {longest:.4g} m; a file in millimetres needs scale=0.001, or "
                "size=0.1 makes that side 0.1 m long",
                stacklevel=4,  # past the constructor: the dataclass's own, and that which checks the call
            )

    def surface(self) -> Surface:
        """Return the triangles in metres."""
        vertices, faces, open_edges = read(self.file, Path(self.file).stat().st_mtime_ns)
        if open_edges and not self.thickness:
            raise ValueError(
                f"{self.file}: the surface is open, {open_edges} edges belong to one triangle: it has no inside; "
                "close it, or give it a thickness"
            )
        longest = float(np.ptp(vertices, axis=0).max())
        scale = self.scale if self.size is None else self.size / longest
        return Surface(vertices * scale, faces, self.thickness)

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some parameters changed."""
        return replace(self, **changes)


@plain_constructor
@dataclass(frozen=True)
class HeightField(_Triangles):
    """Ground of given heights: solid from `-base` up to them.

    Parameters
    ----------
    heights : array_like, shape (n, m)
        Height along z [m] at n places along x and m along y, 2 at least; the middle lies at the origin.
    spacing : float
        Between two places [m], [1e-4, 1].
    base : float or None
        How far below z = 0 it reaches [m]; None: 10 mm below the lowest place.
    cell : float or None
        Edge of a cell of the grid [m]; None: 1/96 of the longest side.

    Raises
    ------
    TypeError
        When something is no number.
    ValueError
        When a number is out of range.
    ImportError
        Without the extra `worlds`.
    """

    heights: tuple[tuple[float, ...], ...]
    spacing: float = 2e-3
    base: float | None = None
    cell: float | None = None

    def __post_init__(self) -> None:
        """Check the heights."""
        heights = array("HeightField.heights", self.heights, "numbers, shape (n, m)")
        if heights.ndim != 2 or min(heights.shape) < 2 or not (np.abs(heights) <= 1).all():
            raise ValueError(
                f"HeightField.heights: shape {heights.shape}: must be (n, m), 2 at least each, within [-1, 1] m"
            )
        if not 1e-4 <= number("HeightField.spacing", self.spacing) <= 1:
            raise ValueError(f"HeightField.spacing = {self.spacing!r} m: must lie in [0.0001, 1] m")
        lowest = -heights.min()
        if self.base is not None and not lowest < number("HeightField.base", self.base) <= 10:
            raise ValueError(
                f"HeightField.base = {self.base!r} m: must lie in ({lowest:g}, 10] m, below the lowest place"
            )
        _check_cell("HeightField", self.cell)
        object.__setattr__(self, "heights", tuple(tuple(map(float, row)) for row in heights))

    @classmethod
    def of(cls, heights: ArrayLike, **more: Any) -> Self:
        """Return it from an array."""
        return cls(
            tuple(map(tuple, array("HeightField.of: heights", heights, "numbers, shape (n, m)"))),
            **more,
        )

    def surface(self) -> Surface:
        """Return the triangles: the ground, four sides and the floor."""
        heights = np.asarray(self.heights)
        n, m = heights.shape
        x, y = np.meshgrid(
            self.spacing * (np.arange(n) - (n - 1) / 2),
            self.spacing * (np.arange(m) - (m - 1) / 2),
            indexing="ij",
        )
        base = 0.01 - heights.min() if self.base is None else self.base
        upper = np.stack([x, y, heights], axis=-1).reshape(-1, 3)
        lower = upper * [1, 1, 0] - [0, 0, base]
        number = np.arange(n * m).reshape(n, m)
        a, b, c, d = (
            one.ravel()
            for one in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
        )
        ground = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
        rim = np.concatenate([number[:-1, 0], number[-1, :-1], number[:0:-1, -1], number[0, :0:-1]])
        after = np.roll(rim, -1)
        below = n * m
        sides = np.concatenate(
            [
                np.column_stack([rim, rim + below, after + below]),
                np.column_stack([rim, after + below, after]),
            ]
        )
        faces = np.concatenate([ground, ground[:, ::-1] + below, sides])
        return Surface(np.concatenate([upper, lower]), faces)
