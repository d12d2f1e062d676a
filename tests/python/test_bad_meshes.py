"""Meshes that are wrong, and places that are none: refused by name, or met as what they are."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from ebac.cli import app
from ebac.worlds import HeightField, Mesh, Sphere, World

pytestmark = pytest.mark.skipif(
    not (find_spec("trimesh") and find_spec("igl")), reason="needs trimesh and libigl"
)


@pytest.fixture(autouse=True)
def here(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("EBAC_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)


def box() -> Any:
    """A box of 40 mm, in millimetres."""
    from trimesh.creation import box

    return box((40, 40, 40))


def test_triangles_without_any_area_are_refused() -> None:
    Path("point.obj").write_text("v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n")
    with pytest.raises(ValueError, match=r"point\.obj: holds no triangles with an area"):
        Mesh("point.obj", size=0.04)


def test_cells_too_fine_are_refused_at_once() -> None:
    box().export("box.stl")
    with pytest.raises(ValueError, match=r"Mesh.cell = 1e-05 m: .* bricks .* give a larger cell"):
        World(Mesh("box.stl", scale=1e-3, cell=1e-5))


def test_cells_of_ground_that_are_too_fine_are_refused_by_their_own_name() -> None:
    ground = HeightField.of(np.zeros((2, 2)), spacing=0.1, cell=1e-5)
    with pytest.raises(ValueError, match=r"^HeightField.cell = 1e-05 m: .* give a larger cell"):
        ground.grid()


def test_cells_too_coarse_are_refused() -> None:
    box().export("box.stl")
    with pytest.raises(ValueError, match=r"cell = 0.05 m: .* 0.01 m at most"):
        World(Mesh("box.stl", scale=1e-3, cell=0.05))


def test_a_mesh_turned_inside_out_is_met_as_any_other() -> None:
    one = box()
    one.export("box.stl")
    one.invert()
    one.export("inverted.stl")
    way = np.linspace([-0.02, 0.001, 0.002], [-0.022, 0.001, 0.002], 21)  # from the surface out
    for file in ("box.stl", "inverted.stl"):
        last = World(Mesh(file, scale=1e-3, cell=2e-3)).walk(way)[-1]
        assert last.depth == 0, file
        assert not last.force.any(), file


def test_a_file_that_is_not_there_is_named_in_words() -> None:
    result = CliRunner().invoke(app, ["worlds", "mesh:none.stl"])
    assert result.exit_code == 2
    assert "none.stl: there is no such file" in result.output
    assert "Errno" not in result.output


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_a_place_that_is_no_number_is_no_contact_and_is_forgotten(wrong: float) -> None:
    world = World(Sphere(radius=0.02))
    outside, none, inside = world.walk([[-0.03, 0, 0], [wrong, 0, 0], [-0.019, 0, 0]])
    assert not outside.force.any()
    assert np.isnan(none.force).all()
    assert inside.force == pytest.approx([10, 0, 0])


def test_a_mesh_in_millimetres_is_warned_about_with_the_remedy(
    recwarn: pytest.WarningsRecorder,
) -> None:
    from trimesh.creation import icosphere

    icosphere(radius=20).export("ball.stl")  # 40 mm, read as metres
    with pytest.warns(
        UserWarning, match=r"ball\.stl: its longest side is 40 m; .*scale=0\.001"
    ) as told:
        Mesh("ball.stl")
    assert told[0].filename == __file__
    recwarn.clear()
    for right in ({"scale": 1e-3}, {"size": 0.04}, {"scale": 2.4 / 40}):
        Mesh("ball.stl", **right)
    assert not recwarn.list
