"""Meshes and height maps as worlds: grids of signed distance against exact distances."""

from __future__ import annotations

from functools import partial
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import ebac
from ebac.metrics import world_contact
from ebac.worlds import (
    Body,
    Elastic,
    HeightField,
    LocalModel,
    Mesh,
    Placed,
    World,
    distance,
    preset,
)
from ebac.worlds.presets import MESH_SIZE

pytestmark = pytest.mark.skipif(
    not (find_spec("trimesh") and find_spec("igl")), reason="needs trimesh and libigl"
)


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("EBAC_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def ball(tmp_path: Path) -> Path:
    """A ball of 20 mm radius, in millimetres, 1280 triangles."""
    from trimesh.creation import icosphere

    file = tmp_path / "ball.stl"
    icosphere(subdivisions=3, radius=20).export(file)
    return file


@pytest.fixture
def cube(tmp_path: Path) -> Path:
    """A cube of 40 mm, in metres."""
    from trimesh.creation import box

    file = tmp_path / "cube.ply"
    box((0.04, 0.04, 0.04)).export(file)
    return file


def test_a_grid_is_near_the_triangles(ball: Path) -> None:
    error = Mesh(str(ball), scale=1e-3, cell=1e-3).error()
    assert error.depth_rms_m < 2e-5
    assert error.depth_max_m < 1e-4
    assert error.normal_median_deg < 3  # facets are 4 degrees apart


def test_a_plane_face_is_exact(cube: Path) -> None:
    mesh = Mesh(str(cube), cell=1e-3)
    points = np.array([[0.0203, 0.003, 0.004], [0.0197, 0.003, -0.004], [-0.0201, 0.001, 0.0]])
    d, out = distance(mesh, points)
    assert d == pytest.approx([0.3e-3, -0.3e-3, 0.1e-3], abs=1e-8)
    assert out == pytest.approx(np.array([[1, 0, 0], [1, 0, 0], [-1, 0, 0]]), abs=1e-6)


def test_far_away_a_distance_is_never_too_long(ball: Path) -> None:
    mesh = Mesh(str(ball), scale=1e-3, cell=1e-3)
    points = np.random.default_rng(3).uniform(-0.1, 0.1, (5000, 3))
    d, _ = distance(mesh, points)
    exact = np.linalg.norm(points, axis=1) - 0.0198  # the facets lie a little inside the ball
    outside = exact > 0
    assert (d[outside] <= exact[outside] + 0.5e-3).all()
    assert (d[exact < -1e-3] < 0).all()


def test_a_grid_is_kept_and_a_damaged_one_is_made_anew(cube: Path, tmp_path: Path) -> None:
    mesh = Mesh(str(cube), cell=5e-3)
    made = []
    first = mesh.grid(lambda done, all_of_them: made.append((done, all_of_them)))
    assert made[-1][0] == made[-1][1]
    (file,) = (tmp_path / "cache").glob("*.npz")
    assert np.array_equal(mesh.grid(lambda *_: pytest.fail("made anew")).nodes, first.nodes)
    whole = file.read_bytes()
    flags = bytearray(whole)
    flags[whole.rindex(b"PK\x01\x02") + 8] |= 1  # as if a password were needed
    for damaged in (whole[:1000], b"", b"PK", whole[:-200], bytes(flags)):
        file.write_bytes(damaged)
        assert np.array_equal(mesh.grid().nodes, first.nodes), damaged[:10]
        assert file.read_bytes() == whole


def test_a_grid_that_cannot_be_kept_leaves_nothing_behind(
    cube: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    assert Mesh(str(cube), cell=2e-3).grid().cell == 2e-3
    assert not list((tmp_path / "cache").iterdir())


@pytest.mark.slow
@pytest.mark.weekly
def test_ebac_is_exact_and_quiet_on_a_mesh(ball: Path) -> None:
    world = preset(f"mesh:{ball}")
    for axes in (1, 2, 3):
        device = ebac.Device(kinematics=ebac.Linear(axes=axes))
        trace = ebac.simulate(ebac.Scenario(device=device, environment=world, seconds=4), "ebac")
        assert ebac.contact(trace).verdict == "exact and quiet"
        assert world_contact(trace).came_through == 0


def test_a_mesh_goes_to_toml_and_back(cube: Path) -> None:
    scenario = ebac.Scenario(environment=World(Body(solid=Mesh(str(cube), cell=2e-3))), seconds=0.1)
    assert ebac.Scenario.from_toml(scenario.to_toml()) == scenario


def test_numbers_of_numpy_are_kept_as_plain_ones_and_written(cube: Path, tmp_path: Path) -> None:
    single = np.float32
    mesh = Mesh(
        str(cube), scale=np.int64(1), size=single(0.05), cell=single(2e-3), thickness=np.int8(0)
    )
    flat = np.zeros((3, 3), np.float32)
    ground = HeightField.of(flat, spacing=single(0.01), base=single(0.01), cell=single(2e-3))
    for part in (mesh, ground):
        kinds = {type(value) for value in part.as_dict().values()}
        assert kinds <= {float, str, tuple}, part
        scenario = ebac.Scenario(environment=World(part), seconds=0.1)
        assert ebac.Scenario.from_toml(scenario.to_toml()) == scenario
    ebac.simulate(scenario, "direct").save(tmp_path / "run.npz")
    model = LocalModel(at=(0, 0, 0), normal=(1, 0, 0), stiffness=single(300), radius=single(0.1))
    assert type(model.stiffness) is type(model.radius) is float


def test_a_log_is_read_without_the_mesh_of_its_run(cube: Path, tmp_path: Path) -> None:
    scenario = ebac.Scenario(environment=World(Mesh(str(cube), cell=2e-3)), seconds=0.1)
    trace = ebac.simulate(scenario, "ebac")
    for name in ("run.npz", "run.mcap"):
        trace.save(tmp_path / name)
    cube.unlink()
    with pytest.warns(UserWarning, match=r"the scenario in the log is not used: .*cube\.ply"):
        assert np.array_equal(ebac.load(tmp_path / "run.npz")["x"], trace["x"])
    log = ebac.logs.read(tmp_path / "run.mcap")
    assert np.array_equal(log.trace["x"], trace["x"])
    assert any("cube.ply" in remark for remark in log.condition.remarks)


def test_an_open_surface_needs_a_thickness(tmp_path: Path) -> None:
    file = tmp_path / "sheet.obj"
    file.write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n", encoding="utf-8")
    with pytest.raises(ValueError, match="open, 4 edges"):
        Mesh(str(file), size=0.05)
    sheet = Mesh(str(file), size=0.05, cell=1e-3, thickness=2e-3)
    d, out = distance(sheet, [[0, 0, 3e-3], [0, 0, 0.5e-3], [0, 0, -3e-3]])
    assert d == pytest.approx([2e-3, -0.5e-3, 2e-3], abs=1e-6)
    assert out[0] == pytest.approx([0, 0, 1], abs=1e-5)
    path = np.column_stack([np.zeros((300, 2)), np.linspace(5e-3, -20e-3, 300)])
    touch = World(Body(solid=sheet, material=Elastic(stiffness=500))).walk(path)[-1]
    assert touch.force == pytest.approx([0, 0, -500 * 21e-3], abs=0.05)  # a thin sheet holds


@pytest.mark.parametrize("kind", ["v//vn", "v/vt", "glb", "ply"])
def test_corners_that_are_kept_apart_for_their_look_leave_a_mesh_closed(
    tmp_path: Path, kind: str
) -> None:
    """A closed box was refused as open: each face had corners of its own, with a normal or a place in a picture."""
    import trimesh

    box = trimesh.creation.box((0.04, 0.04, 0.04))
    file = tmp_path / f"box.{kind if kind in ('glb', 'ply') else 'obj'}"
    apart = trimesh.Trimesh(
        box.triangles.reshape(-1, 3),
        np.arange(36).reshape(-1, 3),
        vertex_normals=np.repeat(box.face_normals, 3, axis=0),
        process=False,
    )
    if kind == "glb":
        apart.export(file, include_normals=True)
    elif kind == "ply":
        apart.export(file, vertex_normal=True)
    else:
        mark, name = ("//", "vn") if kind == "v//vn" else ("/", "vt")
        count, size = (12, 3) if name == "vn" else (4, 2)
        look = box.face_normals if name == "vn" else np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        rows = [f"v {x} {y} {z}" for x, y, z in box.vertices]
        rows += [" ".join([name, *map(str, one[:size])]) for one in look[:count]]
        for i, face in enumerate(box.faces):
            marks = [i + 1] * 3 if name == "vn" else [1 + (i + k) % 4 for k in range(3)]
            rows.append(
                "f " + " ".join(f"{v + 1}{mark}{k}" for v, k in zip(face, marks, strict=True))
            )
        file.write_text("\n".join(rows), encoding="utf-8")
    surface = Mesh(str(file), cell=2e-3).surface()
    assert len(surface.vertices) == 8
    assert np.ptp(surface.vertices, axis=0) == pytest.approx([0.04] * 3)
    trimesh.Trimesh(apart.vertices[:-3], apart.faces[:-1], process=False).export(file)
    with pytest.raises(ValueError, match="open, 3 edges"):
        Mesh(str(file), cell=2e-3)


def test_what_is_no_mesh_is_refused(tmp_path: Path) -> None:
    text = tmp_path / "text.stl"
    text.write_text("hello", encoding="utf-8")
    with pytest.raises(ValueError, match=r"text\.stl"):
        Mesh(str(text))
    with pytest.raises(FileNotFoundError, match=r"Mesh\.file: there is no such file: .*gone\.stl"):
        Mesh(str(tmp_path / "gone.stl"))
    with pytest.raises(ValueError, match=r"Mesh.cell = 1.0 m: must lie in"):
        Mesh(str(text), cell=1.0)


@pytest.mark.slow
def test_hills_are_where_the_heights_say() -> None:
    u = np.linspace(-1, 1, 31)
    heights = 3e-3 * np.cos(np.pi * u)[:, None] * np.cos(np.pi * u)
    ground = HeightField.of(heights, spacing=2e-3, cell=1e-3)
    x, y = 2e-3 * 4, -2e-3 * 7
    top = heights[15 + 4, 15 - 7]
    d, out = distance(ground, [[x, y, top + 1e-3], [x, y, top - 1e-3], [0, 0, 1.0]])
    assert d[0] == pytest.approx(1e-3 * out[0][2], abs=5e-5)
    assert d[1] < 0 < d[2]
    with pytest.raises(ValueError, match=r"HeightField.heights: shape \(3,\)"):
        HeightField((1.0, 2.0, 3.0))  # type: ignore[arg-type]
    for height in (2.0, np.nan):  # the message was that of a wrong shape
        with pytest.raises(ValueError, match=rf"heights: {height:g} m is in it: must all lie in"):
            HeightField(((0.0, height), (0.0, 0.0)))


@pytest.mark.slow
@pytest.mark.weekly
def test_more_triangles_make_the_same_grid(tmp_path: Path) -> None:
    from trimesh.creation import icosphere

    fine = tmp_path / "fine.ply"
    icosphere(subdivisions=5, radius=0.02).export(fine)
    coarse = tmp_path / "coarse.ply"
    icosphere(subdivisions=4, radius=0.02).export(coarse)
    points = np.random.default_rng(1).normal(size=(500, 3))
    points *= 0.02 / np.linalg.norm(points, axis=1, keepdims=True)
    one, other = (distance(Mesh(str(file), cell=1e-3), points)[0] for file in (fine, coarse))
    assert np.abs(one - other).max() < 6e-5
    assert Placed(Mesh(str(coarse)), (0.02, 0, 0)).at == (0.02, 0, 0)


def test_the_file_of_a_mesh_is_named_from_its_document(
    cube: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenario = ebac.Scenario(environment=World(Mesh(str(cube), cell=2e-3)), seconds=0.1)
    file = cube.parent / "scenario.toml"
    scenario.save(file)
    assert f'file = "{cube.name}"' in file.read_text()
    there = tmp_path / "there"
    monkeypatch.chdir(cube.parent)
    cube.parent.joinpath("other").mkdir()
    monkeypatch.chdir("other")
    assert ebac.Scenario.load(file) == scenario
    assert (
        ebac.Scenario.load("../scenario.toml").environment.bodies[0].solid.file.endswith(cube.name)
    )
    there.mkdir()
    scenario.save(there / "scenario.toml")  # the mesh lies elsewhere: by its whole path
    assert ebac.Scenario.load(there / "scenario.toml") == scenario
    with pytest.raises(FileNotFoundError):
        ebac.Scenario.from_toml(file.read_text())  # text has no folder


def test_the_file_of_a_mesh_is_named_from_a_configuration(cube: Path) -> None:
    example = (Path(__file__).parents[2] / "examples" / "joystick.toml").read_text(encoding="utf-8")
    begin, end = example.index("[environment]"), example.index("[law]")
    body = (
        f'[[environment.bodies]]\nsolid = {{ type = "Mesh", file = "{cube.name}", cell = 2e-3 }}\n'
    )
    file = cube.parent / "mine.toml"
    file.write_text(f'{example[:begin]}[environment]\ntype = "World"\n{body}\n{example[end:]}')
    world = ebac.hardware.Configuration.load(file).environment
    assert world.bodies[0].solid.file == str(cube)


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """A preset of a mesh has few cells: it is placed by its triangles."""
    monkeypatch.setattr("ebac.worlds.presets.Mesh", partial(Mesh, cell=4e-3))


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("turned", range(4))
def test_a_mesh_is_met_in_the_middle_of_its_front_whatever_the_order_of_its_vertices(
    tmp_path: Path, turned: int
) -> None:
    """One of the four corners of the front of a cube stood at the origin, and the handle passed it by."""
    import trimesh

    box = trimesh.creation.box((0.04, 0.04, 0.04))
    order = np.roll(np.arange(8), 2 * turned)
    file = tmp_path / "cube.ply"
    trimesh.Trimesh(box.vertices[order], np.argsort(order)[box.faces], process=False).export(file)
    solid = preset(f"mesh:{file}").bodies[0].solid
    assert isinstance(solid, Placed)
    assert solid.at == pytest.approx((MESH_SIZE / 2, 0.0, 0.0), abs=1e-9)


@pytest.mark.usefixtures("coarse")
def test_a_mesh_with_a_hole_in_its_front_is_met_at_its_edge(tmp_path: Path) -> None:
    import trimesh

    ring = trimesh.creation.annulus(r_min=0.01, r_max=0.02, height=0.01)
    ring.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [0, 1, 0]))
    file = tmp_path / "ring.ply"
    ring.export(file)
    solid = preset(f"mesh:{file}").bodies[0].solid
    assert isinstance(solid, Placed)
    x, y, z = solid.at
    assert x > 0
    assert np.hypot(y, z) >= 0.25 * MESH_SIZE - 1e-9
