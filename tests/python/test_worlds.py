"""Worlds of bodies: solids, materials, proxies, meshes, and laws that meet them."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import ebac
from ebac import Scenario, worlds
from ebac.metrics import world_contact
from ebac.worlds import (
    Body,
    Box,
    Capsule,
    Cavity,
    Cylinder,
    Difference,
    Elastic,
    HuntCrossley,
    Intersection,
    Layer,
    Layered,
    Placed,
    Plane,
    Sphere,
    Swing,
    Texture,
    Textured,
    Torus,
    Tube,
    Union,
    World,
    distance,
    preset,
)

#: Presets that need no extra.
PRESETS = [name for name, known in worlds.PRESETS.items() if not known.extra]
SHAPES = (
    Plane(),
    Sphere(),
    Box(),
    Cylinder(),
    Capsule(),
    Torus(),
    Tube(points=((-0.02, 0, 0), (0.01, 0.01, 0), (0.03, 0, 0.02)), radius=(0.01, 0.006, 0.012)),
    Textured(Sphere(), Texture(amplitude=0.2e-3, wavelength=8e-3)),
)
LENGTH = st.floats(-0.06, 0.06)
PLACES = st.lists(st.tuples(LENGTH, LENGTH, LENGTH), min_size=2, max_size=12)


@st.composite
def solids(draw: st.DrawFn) -> worlds.solids.Solid:
    """A simple shape somewhere, turned, or two of them put together."""

    def one() -> worlds.solids.Solid:
        turn = st.floats(-3, 3)
        at = draw(st.tuples(LENGTH, LENGTH, LENGTH))
        shape = draw(st.sampled_from(SHAPES))
        return Placed(shape, at, draw(st.tuples(turn, turn, turn)))

    kind = draw(st.sampled_from([None, Union, Intersection, Difference, Cavity]))
    if kind is None:
        return one()
    return Cavity(one()) if kind is Cavity else kind(one(), one())


@example(
    worlds.Textured(worlds.Sphere(radius=0.02), worlds.Texture(amplitude=2e-4, wavelength=8e-3)),
    [(0.0, 0.0, 0.0), (0.0, 0.0, 0.00390625)],
)
@given(solids(), PLACES)
def test_a_distance_never_changes_faster_than_the_place(
    solid: worlds.solids.Solid, at: list
) -> None:
    points = np.array(at)
    d, out = distance(solid, points)
    ways = np.linalg.norm(points[:, None] - points[None], axis=-1)
    textured = "Textured" in repr(solid)  # whose distance is one to first order, near its surface
    slack = 3e-4 if textured else 1e-12
    assert (np.abs(d[:, None] - d[None]) <= ways * (1.1 if textured else 1) + slack).all()
    assert np.allclose(np.linalg.norm(out, axis=1), 1, atol=1e-9)


@pytest.mark.parametrize("solid", SHAPES, ids=lambda solid: type(solid).__name__)
def test_the_direction_is_the_slope_of_the_distance(solid: worlds.solids.Solid) -> None:
    random = np.random.default_rng(7)
    points = random.uniform(-0.05, 0.05, (2000, 3))
    d, out = distance(solid, points)
    textured = isinstance(solid, Textured)
    points = points[np.abs(d) < 5e-4] if textured else points
    h = 1e-7
    slope = np.stack(
        [(distance(solid, points + h * e)[0] - distance(solid, points - h * e)[0]) / (2 * h) for e in np.eye(3)],
        axis=1,
    )  # fmt: skip
    out = distance(solid, points)[1]
    off = np.linalg.norm(slope - out, axis=1)
    assert (
        np.quantile(off, 0.98) < 1e-5 + 0.1 * textured
    )  # but where it jumps: edges, middle planes


@example(
    Union(
        Placed(worlds.Plane(), (0, 0, 0), (0, 0, 2.0)),
        Placed(worlds.Plane(), (-0.03125, 0, 0), (0, 0, 0)),
    ),
    [(0.0, 0.0, 0.0), (0.0, -0.03125, 0.0)],
)
@given(solids(), PLACES)
@settings(max_examples=40)
def test_a_world_pushes_with_what_it_keeps(solid: worlds.solids.Solid, at: list) -> None:
    """In a crease the force has a part of each face, and the normal is that of one of them."""
    corners = np.array([[-0.2, 0, 0], *at, [-0.2, 0, 0]])
    u = np.linspace(0, len(corners) - 1, 1000)
    path = np.stack([np.interp(u, np.arange(len(corners)), c) for c in corners.T], axis=1)
    for touch in World(Body(solid=solid, material=Elastic(stiffness=1000))).walk(path):
        assert np.isfinite(touch.force).all()
        assert touch.stored == pytest.approx(touch.force @ touch.force / 2000, abs=1e-9)


@given(st.sampled_from([solid for solid in SHAPES if not isinstance(solid, Tube)]), PLACES)
@example(Sphere(), [(0, 0, 0)] * 6 + [(0.05, 0, 0), (0, 0, 0.047)] + [(0, 0, 0)] * 3)
@settings(max_examples=40)
def test_a_world_never_pulls(solid: worlds.solids.Solid, at: list) -> None:
    """One that has no creases (there the normal is that of one face), with a handle faster than the proxy."""
    corners = np.array([[-0.2, 0, 0], *at, [-0.2, 0, 0]])
    u = np.linspace(0, len(corners) - 1, 1000)
    path = np.stack([np.interp(u, np.arange(len(corners)), c) for c in corners.T], axis=1)
    for touch in World(Body(solid=solid, material=Elastic(stiffness=1000))).walk(path):
        assert touch.force @ touch.normal >= -1e-9


def test_a_plane_is_the_wall() -> None:
    plane = ebac.simulate(Scenario(environment=World(Plane())), "ebac")
    wall = ebac.simulate(Scenario(), "ebac")
    for name in ("true.x", "f_cmd", "f_applied"):
        assert np.allclose(plane[name], wall[name], rtol=0, atol=1e-9), name
    assert ebac.contact(plane).row() == pytest.approx(ebac.contact(wall).row(), abs=1e-9)


def test_a_thin_plate_holds_whatever_is_pressed() -> None:
    plate = Placed(Box(width=1e-3, depth=0.1, height=0.1), (0.5e-3, 0, 0))
    x = np.linspace(-5e-3, 60e-3, 400)
    path = np.column_stack([x, 0 * x, 0 * x])
    touches = World(Body(solid=plate, material=Elastic(stiffness=500))).walk(path)
    assert touches[-1].depth == pytest.approx(60e-3)
    assert touches[-1].force == pytest.approx([30, 0, 0])


def test_friction_sticks_then_slips_on_its_cone() -> None:
    ground = Body(solid=Plane(), material=Elastic(stiffness=1000), friction=0.4)
    slide = [(2e-3, y, 0) for y in np.linspace(0, 5e-3, 200)]
    touches = World(ground).walk([(-1e-3, 0, 0), *slide])
    across = np.array([touch.force[1] for touch in touches[1:]])
    assert across.max() == pytest.approx(0.4 * 2.0)
    sticks = across < 0.79
    assert across[sticks] == pytest.approx(1000 * np.linspace(0, 5e-3, 200)[sticks], abs=1e-9)


def test_force_over_depth_of_tissue() -> None:
    depth = np.linspace(1e-5, 12e-3, 1200)
    path = np.column_stack([depth, 0 * depth, 0 * depth])
    soft = World(Body(solid=Plane(), material=HuntCrossley(stiffness=2e4, exponent=1.5))).walk(path)
    assert [touch.force[0] for touch in soft] == pytest.approx(2e4 * depth**1.5)
    assert [touch.stored for touch in soft] == pytest.approx(2e4 * depth**2.5 / 2.5)
    skin = Layer(thickness=2e-3, stiffness=1500, puncture=3, cutting=0)
    layers = World(Body(solid=Plane(), material=Layered(skin, Layer(stiffness=400)))).walk(path)
    force = np.array([touch.force[0] for touch in layers])
    whole = depth <= 3 / 1500
    assert force[whole] == pytest.approx(1500 * depth[whole])
    assert force[~whole] == pytest.approx(400 * np.maximum(depth[~whole] - 2e-3, 0), abs=1e-9)


def test_a_moving_body_pushes_a_handle_that_rests() -> None:
    ball = Body(
        solid=Placed(Sphere(radius=0.02), (0.022, 0, 0)),
        motion=Swing(amplitude_x=4e-3, frequency=1),
    )
    t = np.linspace(0, 1, 1001)
    touches = World(ball).walk(np.zeros((1001, 3)), None, t)
    depth = np.array([touch.depth for touch in touches])
    assert depth == pytest.approx(np.maximum(-2e-3 - 4e-3 * np.sin(2 * np.pi * t), 0), abs=1e-9)


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_is_met_at_the_origin(name: str) -> None:
    x = np.linspace(-20e-3, 1e-3, 2000)
    touches = preset(name).walk(np.column_stack([x, 0 * x, 0 * x]))
    met = x[next(i for i, touch in enumerate(touches) if touch.force.any())]
    assert abs(met) < 0.05e-3
    assert touches[-1].normal[0] > 0.5


@pytest.mark.parametrize("name", PRESETS)
def test_a_world_goes_to_toml_and_back(name: str, tmp_path: Path) -> None:
    scenario = Scenario(environment=preset(name, friction=0.2), seconds=0.3)
    scenario.save(tmp_path / "s.toml")
    again = Scenario.load(tmp_path / "s.toml")
    assert again == scenario
    assert pickle.loads(pickle.dumps(scenario)) == scenario
    first, second = (ebac.simulate(one, "ebac") for one in (scenario, again))
    assert np.array_equal(first["true.x"], second["true.x"])
    assert first.scenario == scenario


def test_a_log_brings_its_world_back(tmp_path: Path) -> None:
    scenario = Scenario(environment=preset("sphere"), seconds=0.2)
    for file in ("run.npz", "run.mcap"):
        ebac.simulate(scenario, "ebac").save(tmp_path / file)
        assert ebac.load(tmp_path / file).scenario == scenario


@pytest.mark.parametrize("axes", [1, 2, 3])
@pytest.mark.parametrize("stiffness", [2e3, 10e3])
@pytest.mark.parametrize("name", ["plane", "sphere", "edge", "inside", "corner", "lumen"])
def test_ebac_is_exact_and_quiet_on_every_shape(name: str, stiffness: float, axes: int) -> None:
    device = ebac.Device(kinematics=ebac.Linear(axes=axes))
    scenario = Scenario(device=device, environment=preset(name, stiffness=stiffness), seconds=4)
    trace = ebac.simulate(scenario, "ebac")
    contact, there = ebac.contact(trace), world_contact(trace)
    assert contact.verdict == "exact and quiet", (contact, there)
    assert there.came_through == 0
    if name != "edge":  # where the normal jumps, the ideal is on the edge itself
        assert there.normal_error_deg is None or there.normal_error_deg < 2


def test_a_gimbal_feels_what_does_work_on_its_sphere() -> None:
    device = ebac.presets.device("joystick")
    scenario = Scenario(device=device, environment=preset("sphere"), seconds=3)
    contact = ebac.contact(ebac.simulate(scenario, "ebac"))
    assert contact.quiet
    assert contact.rest_m > 0
    with pytest.raises(ValueError, match=r"straight axes or a gimbal with a slide"):
        world_contact(ebac.simulate(scenario.replace(seconds=0.1), "ebac"))


def test_sweeps_and_threads_share_no_memory() -> None:
    scenario = Scenario(environment=preset("tissue"), seconds=0.8)
    alone = ebac.contact(ebac.simulate(scenario, "ebac"))
    again = [ebac.contact(ebac.simulate(scenario, "ebac")) for _ in range(2)]
    assert all(one == alone for one in again)


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: World(), "0 bodies"),
        (lambda: World(3), "must be a Body or a solid"),
        (lambda: Body(solid=3), "Body.solid = 3"),
        (lambda: Body(solid=Plane(), friction=3), r"Body.friction = 3: must lie in \[0, 2\]"),
        (lambda: Placed(Sphere(), (0, 0)), "three numbers"),
        (lambda: Tube(((0, 0, 0),)), r"must be \(n, 3\)"),
        (lambda: Tube(((0, 0, 0), (0, 0, 0))), "farther apart"),
        (lambda: Textured(Plane(), Texture(amplitude=0.05, wavelength=0.01)), "must be 1 at most"),
        (lambda: Layered(), "0 layers"),
        (lambda: Union(Plane()), "two at least"),
        (lambda: Sphere(radius=-1), "radius"),
        (lambda: preset("spere"), "did you mean 'sphere'"),
        (lambda: Scenario(environment=3), "World"),
    ],
)
def test_what_is_no_world_is_refused(make: object, text: str) -> None:
    with pytest.raises((ValueError, TypeError), match=text):
        make()  # type: ignore[operator]


@pytest.mark.parametrize("friction", [np.int64(1), np.float32(1), 1])
def test_a_number_of_numpy_is_a_friction(friction: float) -> None:
    body = Body(solid=Plane(), friction=friction)
    assert body == Body(solid=Plane(), friction=1.0)
    assert type(body.friction) is float


def test_a_vector_of_text_in_a_file_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "world.toml"
    ebac.Scenario(environment=World(Placed(Sphere(), (0.5, 0.0, 0.0)))).save(path)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("at = [\n    0.5", 'at = [\n    "abc"'), encoding="utf-8")
    with pytest.raises((ValueError, TypeError), match=r"solid\.at = .*must be three numbers"):
        ebac.Scenario.load(path)
