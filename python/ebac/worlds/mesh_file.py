"""The triangles of a mesh file, as trimesh reads it."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ebac._util.arrays import Values
from ebac.worlds.grid import Ints, needed


@lru_cache(maxsize=4)
def read(file: str, changed: int) -> tuple[Values, Ints, int]:
    """Return vertices, triangles and the number of open edges of a file.

    Parameters
    ----------
    file : str
        Path of the file.
    changed : int
        When it was written [ns]: what was read is kept until then.

    Raises
    ------
    ValueError
        When it holds no triangles with an area.
    ImportError
        Without trimesh.
    """
    del changed  # a file that was written anew is read anew
    trimesh = needed("trimesh", "trimesh")
    try:
        mesh = trimesh.load_mesh(file)
        if len(mesh.faces):  # a corner has a copy for each of its normals and places in a picture
            mesh.merge_vertices(merge_tex=True, merge_norm=True)
        vertices, faces = np.array(mesh.vertices, float), np.array(mesh.faces, np.int64)
    except Exception as error:
        raise ValueError(f"{file}: cannot be read as a mesh ({error})") from error
    if len(faces) == 0 or not np.isfinite(vertices).all():
        raise ValueError(f"{file}: holds no triangles with finite corners")
    corners = vertices[faces]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    faces = faces[area > 0]
    if len(faces) == 0:
        raise ValueError(f"{file}: holds no triangles with an area")
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    return vertices, faces, int((count == 1).sum())
