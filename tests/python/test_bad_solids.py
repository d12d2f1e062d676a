"""Solids that cannot be: refused in words, by name."""

from __future__ import annotations

import copy
import pickle

import pytest

from ebac.worlds import Cavity, Mesh, Placed, Plane, Sphere, Union, World
from ebac.worlds.solids import DEEPEST, Solid


@pytest.mark.parametrize("file", [5, None, b"ball.stl"])
def test_a_file_that_is_no_path_is_refused(file: object) -> None:
    with pytest.raises(TypeError, match=r"Mesh\.file = .*: must be the path of a file"):
        Mesh(file)  # type: ignore[arg-type]


@pytest.mark.parametrize("file", ["", "."])
def test_a_folder_is_no_mesh(file: str) -> None:
    with pytest.raises(ValueError, match=r"Mesh\.file = .*: is a folder"):
        Mesh(file)


def test_solids_within_each_other_have_a_limit() -> None:
    """The deepest that may be is usable; without a limit 2000 ended in a RecursionError."""
    solid: Solid = Sphere()
    for _ in range(DEEPEST):
        solid = Placed(solid, (1e-4, 0.0, 0.0))
    world = World(solid)
    assert pickle.loads(pickle.dumps(world)) == world
    assert hash(copy.deepcopy(solid)) == hash(solid)
    assert repr(solid).count("Placed") == DEEPEST
    for deeper in (lambda: Placed(solid), lambda: Cavity(solid), lambda: Union(Plane(), solid)):
        with pytest.raises(ValueError, match=r"65 solids within each other: must be 64 at most"):
            deeper()
