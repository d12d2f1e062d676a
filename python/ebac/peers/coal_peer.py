"""coal: the distance of a point to the same triangles, by a tree of oriented boxes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values
from ebac.peers.row import program, quickest

#: Radius of the ball that stands for a point [m]: coal has no points.
POINT = 1e-9


def distance(
    vertices: Values, faces: NDArray[np.int64], places: Values, repeats: int
) -> tuple[float, float]:
    """Return the time of a distance and of the call from Python around it [s].

    Raises
    ------
    ImportError
        Without coal.
    """
    coal: Any = program("coal")
    mesh = coal.BVHModelOBBRSS()
    mesh.beginModel(len(faces), len(vertices))
    mesh.addVertices(vertices)
    mesh.addTriangles(faces)
    mesh.endModel()
    taken = quickest(repeats, _asking(coal, mesh, places)) / len(places)
    empty = quickest(repeats, _asking(coal, coal.Sphere(POINT), places)) / len(places)
    return taken - empty, empty


def _asking(coal: Any, solid: Any, places: Values) -> Callable[[], None]:
    """Return a function that asks for the distance of every place."""
    ball, here, there = coal.Sphere(POINT), coal.Transform3s(), coal.Transform3s()
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    rows = list(places)

    def ask() -> None:
        move, forget, measure = there.setTranslation, result.clear, coal.distance
        for place in rows:
            move(place)
            forget()
            measure(solid, here, ball, there, request, result)

    return ask
