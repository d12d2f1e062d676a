"""Virtual worlds in space: bodies of any shape and material, which may move, with friction."""

from ebac._core import (
    Box,
    Capsule,
    Cylinder,
    Elastic,
    HuntCrossley,
    Layer,
    Plane,
    Sphere,
    Swing,
    Torus,
)
from ebac.worlds.solids import Cavity, Difference, Intersection, Placed, Union
from ebac.worlds.world import Body, Layered, World

__all__ = [
    "Body",
    "Box",
    "Capsule",
    "Cavity",
    "Cylinder",
    "Difference",
    "Elastic",
    "HuntCrossley",
    "Intersection",
    "Layer",
    "Layered",
    "Placed",
    "Plane",
    "Sphere",
    "Swing",
    "Torus",
    "Union",
    "World",
]
