"""Solids that cannot be: refused in words, by name."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable

import pytest

from ebac.worlds import Body, Cavity, Layered, Mesh, Placed, Plane, Sphere, Union, World
from ebac.worlds.solids import DEEPEST, Solid


@pytest.mark.parametrize("file", [5, None, b"ball.stl"])
def test_a_file_that_is_no_path_is_refused(file: object) -> None:
    with pytest.raises(TypeError, match=r"Mesh\.file = .*: must be the path of a file"):
        Mesh(file)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: Body(Sphere(radius=0.02)),  # type: ignore[misc]
            "Body takes its parameters by name, not Sphere(radius=0.02) (Sphere); "
            "it has: solid, material, friction, motion",
        ),
        (
            lambda: Body(soild=Sphere()),  # type: ignore[call-arg]
            "Body has no parameter 'soild', did you mean 'solid'; it has: solid, material",
        ),
        (lambda: World(body=3), "World takes its bodies in order, not by name: body"),  # type: ignore[call-arg]
        (lambda: Union(solid=3), "Union takes its solids in order, not by name: solid"),  # type: ignore[call-arg]
        (lambda: Layered(layer=3), "Layered takes its layers in order, not by name: layer"),  # type: ignore[call-arg]
        (lambda: Cavity(), "Cavity needs solid; it has: solid"),  # type: ignore[call-arg]
        (
            lambda: Placed(Sphere(), to=(0.0, 0.0, 0.0)),  # type: ignore[call-arg]
            "Placed has no parameter 'to'; it has: solid, at, turned",
        ),
        (
            lambda: Mesh("ring.stl", scal=1e-3),  # type: ignore[call-arg]
            "Mesh has no parameter 'scal', did you mean 'scale'; it has: file, scale",
        ),
        (
            lambda: Mesh(path="ring.stl"),  # type: ignore[call-arg]
            "Mesh has no parameter 'path': did you mean 'file'; it has: file, scale",
        ),
    ],
)
def test_a_wrong_call_is_refused_with_the_names_it_takes(
    call: Callable[[], object], message: str
) -> None:
    with pytest.raises(TypeError) as refused:
        call()
    assert str(refused.value).startswith(message)


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
