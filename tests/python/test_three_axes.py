"""Three axes: a gimbal whose lever slides. Its kinematics, its limits, and every law in a world it moves in."""

import json
from math import pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.datasets import joystick_text
from ebac.hardware import Configuration
from ebac.hardware.axis_positions import AxisPosition, PositionError, check_workspace
from ebac.metrics import world_contact
from ebac.testing import assert_passive
from ebac.worlds import Body, Elastic, Placed, Plane, Sphere, Union, World

STICK = ebac.presets.device("joystick-3")
TARGET = np.array([0.03, 0.02, 0.015])
HAND = ebac.Hand(path=[ebac.Step(target=x) for x in TARGET.tolist()])
EXACT = ebac.metrics.EXACT_COUNTS * STICK.facts.count
CORNER = Union(
    Plane(),
    Placed(Plane(), (0.0, 0.0, 0.0), (0.0, 0.0, pi / 2)),
    Placed(Plane(), (0.0, 0.0, 0.0), (0.0, -pi / 2, 0.0)),
)

levers = st.builds(
    ebac.SlidingGimbal,
    radius=st.floats(0.05, 0.5),
    limit=st.floats(0.1, 1.4),
    slide_radius=st.floats(0.025, 1.0),
    slide_limit=st.floats(0.005, 0.025),
)
shares = st.tuples(*[st.floats(-1, 1)] * 3).map(np.array)
vectors = st.tuples(*[st.floats(-10, 10)] * 3).map(np.array)


# --- kinematics ---


@given(k=levers, share=shares)
def test_inverse_undoes_forward(k: Any, share: Any) -> None:
    q = share * k.stops
    assert k.inverse(k.forward(q)) == pytest.approx(q, abs=1e-12)
    assert k.within_limits(0.999 * q)


@given(k=levers, share=shares)
def test_jacobian_is_the_slope_of_forward(k: Any, share: Any) -> None:
    q, h = share * k.stops, 1e-5
    columns = [(k.forward(q + h * e) - k.forward(q - h * e)) / (2 * h) for e in np.eye(3)]
    assert k.jacobian(q) == pytest.approx(np.array(columns).T, abs=1e-8)
    assert abs(np.linalg.det(k.jacobian(q))) > 0


@given(k=levers, share=shares, rates=vectors, force=vectors)
def test_power_at_the_joints_is_power_at_the_handle(
    k: Any, share: Any, rates: Any, force: Any
) -> None:
    q = share * k.stops
    assert k.transpose(q, force) @ rates == pytest.approx(
        force @ (k.jacobian(q) @ rates), abs=1e-10
    )


@given(share=shares)
def test_with_the_slide_in_its_middle_it_is_the_gimbal(share: Any) -> None:
    slides, plain = ebac.SlidingGimbal(), ebac.Gimbal()
    q = share * slides.stops * [1, 1, 0]
    assert list(slides.forward(q)[:2]) == list(plain.forward(q[:2]))
    assert slides.forward(q)[2] == plain.height(q[:2]) - plain.radius


def test_every_joint_has_its_own_limit() -> None:
    k = ebac.SlidingGimbal(limit=0.5, slide_radius=0.08, slide_limit=0.04)
    assert k.within_limits([0.5, -0.5, 0.5])
    for axis in range(3):
        q = np.zeros(3)
        q[axis] = -0.5001
        assert not k.within_limits(q)


# --- masses, counts and forces of each axis ---


def test_a_law_is_designed_for_the_worst_axis_and_the_longest_lever() -> None:
    def facts(slide_radius: float, slide_limit: float) -> ebac.DeviceFacts:
        lever = ebac.SlidingGimbal(slide_radius=slide_radius, slide_limit=slide_limit)
        return ebac.Device(kinematics=lever).facts

    plain = ebac.Device().facts
    long = facts(0.1, 0.04)
    assert long.count == pytest.approx(1.4 * plain.count)
    assert long.peak_force == pytest.approx(plain.peak_force / 1.4)
    assert long.mass < plain.mass
    geared = facts(0.2, 0.01)
    assert geared.count == pytest.approx(2 * plain.count)
    assert geared.peak_force == pytest.approx(plain.peak_force / 2)


def test_the_spec_sheet_has_the_slide() -> None:
    device = STICK.replace(kinematics=ebac.SlidingGimbal(slide_radius=0.05, slide_limit=0.03))
    sheet = {spec.name: spec.value for spec in ebac.spec_sheet(device)}
    assert sheet["slide, travel"] == pytest.approx(0.06)
    assert sheet["slide, resolution"] == pytest.approx(sheet["resolution"] / 2)
    assert sheet["slide, peak force"] == pytest.approx(2 * sheet["peak force"])
    assert sheet["slide, mass"] == pytest.approx(0.114 + 4 * sheet["of which rotor"])
    assert not any("slide" in spec.name for spec in ebac.spec_sheet(ebac.Device()))


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (
            lambda: ebac.Device(kinematics=ebac.SlidingGimbal(slide_limit=0.06)),
            r"SlidingGimbal.slide_limit = 0.06 m: must lie in \[0.0001, 0.05\] m, half of the lever",
        ),
        (
            lambda: ebac.Device(kinematics=ebac.SlidingGimbal(slide_radius=0.03)),
            r"SlidingGimbal.slide_radius = 0.03 m: must lie in \[0.05, 0.2\] m",
        ),
        (lambda: ebac.SlidingGimbal(limit=2.0), r"SlidingGimbal.limit = 2 rad: must lie in"),
        (lambda: STICK.kinematics.forward([0.0, 0.0]), "q has 2 values: must have 3"),
        (
            lambda: ebac.simulate(
                ebac.Scenario(device=ebac.Device(kinematics=ebac.SlidingGimbal(slide_limit=0.004))),
                limits=True,
            ),
            "Limits.edge = .* leaves the slide no way; raise edge or SlidingGimbal.slide_limit",
        ),
    ],
)
def test_what_cannot_be_is_refused(make: Any, text: str) -> None:
    with pytest.raises(ValueError, match=text):
        make()


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_the_end_of_each_axis_is_a_fault(axis: int) -> None:
    """A strong hand pulls one joint beyond its end; the soft wall before it does not hold."""
    lever = STICK.kinematics
    ways = np.array(lever.travel * lever.stops)
    target = [0.0, 0.0, 0.0]
    target[axis] = float(ways[axis]) + 0.02
    hand = ebac.Hand(stiffness=5000, damping=60, path=[
        ebac.MinimumJerk(target=x, at=0.1, duration=0.4) for x in target
    ])  # fmt: skip
    scenario = ebac.Scenario(device=STICK, hand=hand, environment=ebac.Free(), seconds=1)
    with pytest.raises(ebac.LoopFault) as ended:
        ebac.simulate(scenario, "direct", limits=True)
    assert ended.value.fault is ebac.Fault.WORKSPACE
    trace = ended.value.trace
    row = int((trace["fault"] != 0).argmax())
    end = ebac.Limits.of(STICK).end - ways[0] + ways[axis]
    assert trace["q"][row, axis] * lever.travel[axis] == pytest.approx(end, abs=1.5e-3)


# --- simulation ---


def corner(stiffness: float) -> World:
    return World(Body(solid=CORNER, material=Elastic(stiffness=stiffness)))


@pytest.mark.parametrize("name", sorted(ebac.LAWS))
def test_every_law_keeps_its_word_on_three_axes(name: str) -> None:
    """In a corner of three planes: finite, felt on every axis, the same twice; no energy where none is promised."""
    scenario = ebac.Scenario(
        device=STICK, hand=HAND, environment=corner(5e3), seconds=0.6, timing=ebac.Timing(delay=2)
    )
    law = ebac.design(name, STICK, scenario.timing)
    trace = ebac.simulate(scenario, law)
    for column in ("x", "f_cmd", "f_applied", "true.energy"):
        assert trace[column].shape == (len(trace), 3)
        assert np.isfinite(trace[column]).all()
    again = ebac.simulate(scenario, law)
    assert trace["f_cmd"].tobytes() == again["f_cmd"].tobytes()
    assert np.abs(trace["f_cmd"]).max(axis=0).min() > 0  # the world is felt on every axis
    if law.passive:
        assert_passive(trace, reserve=1e-3)


@pytest.mark.parametrize("stiffness", [2e3, 10e3])
def test_a_corner_of_three_planes_is_quiet_and_exact(stiffness: float) -> None:
    noisy = STICK.replace(sensor=ebac.ForceSensor(noise=0.03))
    scenario = ebac.Scenario(device=noisy, hand=HAND, environment=corner(stiffness), seconds=4)
    trace = ebac.simulate(scenario, "ebac")
    end = trace[2.8:]
    ideal = HAND.stiffness * TARGET / (HAND.stiffness + stiffness)
    assert np.abs(end["true.x"].mean(axis=0) - ideal).max() <= EXACT
    assert all(ebac.contact(trace, axis=axis).quiet for axis in range(3))  # in force, too
    assert end["true.energy"].sum(axis=1).min() >= -1e-3


def test_a_ball_is_felt_along_its_radius() -> None:
    at = (0.03, 0.006, -0.008)
    ball = World(Placed(Sphere(), at))
    hand = HAND.replace(path=[ebac.Step(target=x) for x in (0.03, 0.0, 0.0)])
    trace = ebac.simulate(ebac.Scenario(device=STICK, hand=hand, environment=ball), "ebac")
    end = trace[2.8:]
    inwards = np.array(at) - end["true.x"].mean(axis=0)
    force = end["f_applied"].mean(axis=0)
    cosine = force @ inwards / np.linalg.norm(force) / np.linalg.norm(inwards)
    assert np.degrees(np.arccos(cosine)) < 2
    assert np.linalg.norm(force) / 10e3 == pytest.approx(0.02 - np.linalg.norm(inwards), abs=EXACT)
    measured = world_contact(trace)
    assert measured.came_through == 0
    assert ebac.contact(trace).ideal_m == pytest.approx(end["true.x"][:, 0].mean(), abs=EXACT)


def test_a_handle_that_slid_around_a_ball_and_grazes_its_far_side_has_left_it() -> None:
    """The target of the reference hand, 40 mm, is the last point of the ball of 40 mm."""
    ball = ebac.worlds.preset("sphere")
    scenario = ebac.Scenario(device=STICK, environment=ball, seconds=2)
    for law, drawn in (("tca", "draws 144 mJ: "), ("ebac", "")):
        found = ebac.contact(ebac.simulate(scenario, law))
        assert found.rest_m == pytest.approx(0.04, abs=1e-4)
        assert found.verdict == f"{drawn}left the surface: no contact at rest"
    box = scenario.replace(environment=ebac.worlds.preset("box"))
    assert ebac.contact(ebac.simulate(box, "ebac")).verdict == "exact and quiet"


def test_a_light_touch_is_no_graze() -> None:
    light = ebac.Hand(path=[ebac.Step(target=1e-4)])  # m into the wall: 0.03 N
    found = ebac.contact(ebac.simulate(ebac.Scenario(hand=light, seconds=2), "ebac"))
    assert found.touched_at_rest is True


def test_the_observer_knows_the_slide() -> None:
    device = STICK.replace(
        kinematics=ebac.SlidingGimbal(slide_radius=0.06), sensor=ebac.ForceSensor(noise=0.03)
    )
    scenario = ebac.Scenario(
        device=device, hand=HAND, environment=ebac.Free(), observer=True, seconds=1
    )
    trace = ebac.simulate(scenario, "ebac")
    assert (trace["est.fallback"] == 0).all()
    away = np.abs(trace["est.x"] - trace["true.x"]).max(axis=0)
    assert (away < 1.5 * device.facts.count).all()


def test_the_bus_with_three_drives_changes_no_bit() -> None:
    scenario = ebac.Scenario(
        device=STICK,
        hand=HAND,
        environment=corner(5e3),
        seconds=0.3,
        timing=ebac.Timing(dt=1.25e-3),
    )
    drive = STICK.drive.replace(permille=True)
    direct = ebac.simulate(scenario.replace(device=STICK.replace(drive=drive)), "ebac")
    through = ebac.simulate(scenario, "ebac", through="can")
    for name in direct:
        assert through[name].tobytes() == direct[name].tobytes(), name


# --- configuration ---


def test_the_configuration_of_three_axes_runs_on_a_virtual_clock() -> None:
    known = Configuration.from_toml(joystick_text("joystick-3"))
    assert known.device.axes == len(known.drives.nodes) == 3
    trace = known.simulate(seconds=3.5)
    assert not trace["fault"].any()
    assert trace["f_env"].any(axis=0).all()
    swept = np.ptp(trace["true.x"], axis=0)
    assert (swept > 0.004).all()


@pytest.mark.real_time
@pytest.mark.slow
def test_the_command_runs_three_simulated_drives_in_a_mesh(tmp_path: Any) -> None:
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("igl")
    trimesh.creation.icosphere(subdivisions=2, radius=20).export(tmp_path / "ball.stl")
    ball = 'solid = { type = "Sphere", radius = 0.02 }'
    mesh = f'solid = {{ type = "Mesh", file = "{tmp_path / "ball.stl"}", scale = 1e-3 }}'
    assert ball in joystick_text("joystick-3")
    file = tmp_path / "three.toml"
    patient = "[limits]\nforce_age = 0.2\noverruns = 1000\npause = 5.0\n"
    text = (
        joystick_text("joystick-3")
        .replace(ball, mesh)
        .replace("[limits]", patient)
        .replace("[bus]", "[bus]\nsilent = 500")
    )
    file.write_text(text, encoding="utf-8")
    asked = ["run", str(file), "--simulated", "--seconds", "2", "--no-files", "--json"]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    assert told["ended_by"] == "time"
    assert told["rows"][0]["rest_m"] is not None


def test_an_axis_outside_its_own_workspace_is_refused() -> None:
    known = Configuration.from_toml(joystick_text("joystick-3"))

    def at(*metres: float) -> list[AxisPosition]:
        return [
            AxisPosition(axis=i, node=i + 1, counts=0, zero_counts=0, angle_rad=0.0, position_m=x)
            for i, x in enumerate(metres)
        ]

    check_workspace(known, at(0.05, 0.05, 0.04))
    with pytest.raises(PositionError, match=r"axis 2 \(node 3\).*must lie within 45 mm"):
        check_workspace(known, at(0.0, 0.0, 0.05))
