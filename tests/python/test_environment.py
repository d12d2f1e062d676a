"""The virtual world: eq. (12) and its shapes."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ebac

places = st.floats(-0.1, 0.1)
speeds = st.floats(-5, 5)
walls = st.builds(
    ebac.Wall,
    stiffness=st.floats(0, 1e6),
    damping=st.floats(0, 1e3),
    position=st.floats(-0.05, 0.05),
    angle=st.floats(-math.pi, math.pi),
)


@given(wall=walls, x=st.tuples(places, places), v=st.tuples(speeds, speeds))
def test_a_wall_is_equation_12_along_its_normal_and_never_pulls(
    wall: ebac.Wall, x: tuple[float, float], v: tuple[float, float]
) -> None:
    normal = np.array([math.cos(wall.angle), math.sin(wall.angle)])
    depth, speed = normal @ x - wall.position, normal @ v
    force = wall.force(x, v)
    along = normal @ force
    assert along >= 0
    assert force == pytest.approx(along * normal, abs=1e-9 * (1 + along))
    if depth < -1e-12:
        assert (force == 0).all()
    elif depth > 1e-12:
        expected = max(0.0, wall.stiffness * depth + wall.damping * speed)
        assert along == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_a_damper_does_not_hold_back_what_leaves() -> None:
    wall = ebac.Wall(stiffness=1000.0, damping=100.0)
    assert wall.force([0.001], [-0.005]).tolist() == [0.5]
    assert wall.force([0.001], [-1.0]).tolist() == [0.0]
    assert wall.force([-0.001], [1.0]).tolist() == [0.0]


@given(x=places, v=speeds)
def test_nothing_is_not_felt(x: float, v: float) -> None:
    assert (ebac.Free().force([x, -x], [v, v]) == 0).all()


@given(first=walls, second=walls, x=st.tuples(places, places), v=st.tuples(speeds, speeds))
def test_a_corner_is_the_sum_of_its_walls(first: Any, second: Any, x: Any, v: Any) -> None:
    corner = ebac.Corner(first=first, second=second)
    assert corner.force(x, v) == pytest.approx(first.force(x, v) + second.force(x, v), abs=1e-9)


def test_the_default_corner_has_a_wall_across_each_axis() -> None:
    corner = ebac.Corner()
    assert corner.force([-0.001, -0.001], [0, 0]).tolist() == [0, 0]
    assert corner.force([0.001, -0.001], [0, 0]) == pytest.approx([10, 0], abs=1e-12)
    assert corner.force([-0.001, 0.002], [0, 0]) == pytest.approx([0, 20], abs=1e-12)
    assert corner.force([0.001, 0.002], [0, 0]) == pytest.approx([10, 20], abs=1e-12)


@pytest.mark.parametrize(("x", "v"), [([], []), ([0.0] * 4, [0.0] * 4), ([0.0], [0.0, 0.0])])
def test_a_point_with_a_wrong_number_of_axes_is_refused(x: list[float], v: list[float]) -> None:
    with pytest.raises(ValueError, match="one for each axis"):
        ebac.Wall().force(x, v)


# --- in a run ---


@pytest.mark.parametrize(
    "device", [ebac.Device(kinematics=ebac.Linear(axes=2)), ebac.presets.device("joystick")]
)
@pytest.mark.parametrize("angle", [0.5, -2.0])
def test_an_oriented_wall_pushes_along_its_normal_on_two_axes(
    device: ebac.Device, angle: float
) -> None:
    normal = np.array([math.cos(angle), math.sin(angle)])
    hand = ebac.Hand(path=[ebac.Step(target=0.03 * n) for n in normal])
    wall = ebac.Wall(stiffness=2000.0, angle=angle)
    scenario = ebac.Scenario(device=device, hand=hand, environment=wall, seconds=1.0)
    trace = ebac.simulate(scenario, "direct")
    force, depth = trace["f_env"], trace["x"] @ normal
    across = force @ np.array([-normal[1], normal[0]])
    assert np.abs(across).max() < 1e-12 * np.abs(force).max()
    assert force @ normal == pytest.approx(np.maximum(0, 2000 * depth), abs=1e-9)
    assert (force @ normal).max() > 5


@pytest.mark.parametrize(
    "wall", [ebac.Wall(stiffness=3e3, damping=20.0, position=0.004), ebac.Wall()]
)
def test_f_env_of_a_trace_is_what_the_wall_asks(wall: ebac.Wall) -> None:
    trace = ebac.simulate(ebac.Scenario(environment=wall, seconds=1.0), "eba")
    expected = [wall.force([x], [v])[0] for x, v in zip(trace["x"], trace["v"], strict=True)]
    assert trace["f_env"].tolist() == expected
    assert max(expected) > 1


def test_free_air_asks_for_nothing() -> None:
    trace = ebac.simulate(ebac.Scenario(environment=ebac.Free(), seconds=0.5), "ebac")
    assert (trace["f_env"] == 0).all()
    assert (trace["f_cmd"] == 0).all()
    assert trace["true.x"][-1] > 0.03


@pytest.mark.parametrize("law", ["direct", "ebac"])
def test_a_soft_wall_rests_where_it_must(law: str) -> None:
    scenario = ebac.Scenario(environment=ebac.Wall(stiffness=500.0, position=0.01), seconds=3.0)
    trace = ebac.simulate(scenario, law)
    assert ebac.ideal_rest(scenario) == pytest.approx((300 * 0.04 + 500 * 0.01) / 800)
    assert trace["true.x"][-1] == pytest.approx(ebac.ideal_rest(scenario), abs=1.5e-4)
