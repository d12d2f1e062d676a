"""Solids from mesh files."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from errno import ENOENT
from pathlib import Path
from typing import Any, Self

import numpy as np

from ebac._util.arguments import number
from ebac._util.wrong_calls import plain_constructor
from ebac.worlds.grid import Surface
from ebac.worlds.mesh_file import read
from ebac.worlds.part import keep
from ebac.worlds.triangles import Triangles, check_cell

#: A mesh that is longer was probably drawn in millimetres, and read as metres [m].
LONGEST = 2.5


@plain_constructor
@dataclass(frozen=True)
class Mesh(Triangles):
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
        scale = number("Mesh.scale", self.scale)
        if not 1e-6 <= scale <= 1e3:
            raise ValueError(f"Mesh.scale = {self.scale!r} m: must lie in [1e-06, 1000] m")
        size = None if self.size is None else number("Mesh.size", self.size)
        if size is not None and not 1e-3 <= size <= 10:
            raise ValueError(f"Mesh.size = {self.size!r} m: must lie in [0.001, 10] m")
        cell = check_cell("Mesh", self.cell)
        thickness = number("Mesh.thickness", self.thickness)
        if thickness != 0 and not 1e-4 <= thickness <= 0.1:
            raise ValueError(
                f"Mesh.thickness = {self.thickness!r} m: must be 0 or lie in [0.0001, 0.1] m"
            )
        keep(self, scale=scale, size=size, cell=cell, thickness=thickness)
        longest = float(np.ptp(self.surface().vertices, axis=0).max())
        if longest > LONGEST:
            warnings.warn(
                f"{self.file}: its longest side is {longest:.4g} m; a file in millimetres needs scale=0.001, or "
                "size=0.1 makes that side 0.1 m long",
                stacklevel=4,  # past the constructor: the dataclass's own, and that which checks the call
            )

    def surface(self) -> Surface:
        """Return the triangles in metres."""
        path = Path(self.file)
        if not path.exists():
            raise FileNotFoundError(ENOENT, "Mesh.file: there is no such file", self.file)
        vertices, faces, open_edges = read(self.file, path.stat().st_mtime_ns)
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
