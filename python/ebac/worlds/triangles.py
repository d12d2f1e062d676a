"""The grid of a surface of triangles, and how far it is from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ebac._util import formatting
from ebac._util.arguments import number, whole
from ebac._util.progress import Progress
from ebac.worlds.grid import Grid, Surface, cached_grid
from ebac.worlds.part import Part

#: Cells along the longest side, unless given.
CELLS = 96
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


class Triangles(Part):
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
        return cached_grid(surface, cell, progress, owner=type(self).__name__)

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
            Points at random on the surface, moved off it by a cell at most; at least 1.
        seed : int
            Seed, at least 0.

        Raises
        ------
        ValueError
            For a number out of its range.
        """
        for name, value, least in (("samples", samples, 1), ("seed", seed, 0)):
            if whole(f"{type(self).__name__}.error: {name}", value) < least:
                raise ValueError(
                    f"{type(self).__name__}.error: {name} = {value}: must be at least {least}"
                )
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


def check_cell(name: str, cell: float | None) -> float | None:
    """Return a cell as a plain number; refuse one that is no number or out of range."""
    if cell is None:
        return None
    value = number(f"{name}.cell", cell)
    if not 1e-5 <= value <= 0.1:
        raise ValueError(f"{name}.cell = {cell!r} m: must lie in [1e-05, 0.1] m")
    return value
