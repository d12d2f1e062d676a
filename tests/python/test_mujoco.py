"""MuJoCo as an engine: a rigid plate on a spring, of which force, stiffness and place are known."""

from __future__ import annotations

import copy

import numpy as np
import pytest

import ebac
from ebac.worlds import Bridge, EngineTiming, MujocoEngine

pytest.importorskip("mujoco")

#: A plate whose face lies 10 mm before a ball of 5 mm, on a spring.
PLATE = """
<mujoco>
  <option timestep="0.002" gravity="0 0 0"/>
  <worldbody>
    <body name="plate" pos="0.02 0 0">
      <joint type="slide" axis="1 0 0" stiffness="400" damping="20"/>
      <geom type="box" size="0.005 0.05 0.05" mass="0.2" solref="0.004 1"/>
    </body>
    <body name="tip" mocap="true"><geom type="sphere" size="0.005"/></body>
  </worldbody>
</mujoco>
"""
STILL = np.zeros(3)


def test_a_surface_is_seen_before_it_is_touched() -> None:
    model = MujocoEngine(PLATE)(STILL, STILL)
    assert model is not None
    assert model.at == pytest.approx((0.01, 0, 0), abs=1e-6)
    assert model.normal == pytest.approx((1, 0, 0), abs=1e-6)
    assert MujocoEngine(PLATE, reach=0.005)(STILL, STILL) is None


def test_force_and_stiffness_are_those_of_the_spring() -> None:
    engine = MujocoEngine(PLATE)
    for depth in np.linspace(0, 0.005, 60):
        model = engine(np.array([0.01 + depth, 0, 0]), STILL)
    for _ in range(60):
        model = engine(np.array([0.015, 0, 0]), STILL)
    assert model is not None
    force = model.stiffness * (0.015 - model.at[0])
    assert force == pytest.approx(400 * 0.005, rel=0.05)
    assert 300 < model.stiffness < 2000
    fresh = copy.deepcopy(engine)
    assert fresh.data.time == 0


def test_a_run_rests_where_hand_and_spring_balance() -> None:
    world = Bridge(MujocoEngine(PLATE), timing=EngineTiming(rate=60, compute=1 / 60))
    hand = ebac.Hand(stiffness=300, path=[ebac.MinimumJerk(target=0.03)])
    trace = ebac.simulate(ebac.Scenario(environment=world, hand=hand, seconds=2), "ebac")
    rest = (300 * 0.03 + 400 * 0.01) / 700
    assert ebac.contact(trace).rest_m == pytest.approx(rest, abs=5e-4)
    assert ebac.contact(trace).still


def test_what_is_no_tip_is_refused() -> None:
    with pytest.raises(ValueError, match="must be a mocap body with one geom"):
        MujocoEngine(PLATE, tip="plate")
    with pytest.raises(FileNotFoundError, match="no such file"):
        MujocoEngine("nothing.xml")


#: Shapes of a fixed wall, whose face lies 10 mm before a ball of 5 mm.
WALLS = {
    "box": 'type="box" size=".05 .05 .05" pos=".065 0 0"',
    "plate": 'type="box" size=".0005 .05 .05" pos=".0155 0 0"',
    "mesh": 'type="mesh" mesh="cube" pos=".065 0 0"',
    "plane": 'type="plane" size="1 1 1" pos=".015 0 0" zaxis="-1 0 0"',
    "sphere": 'type="sphere" size=".05" pos=".065 0 0"',
    "cylinder": 'type="cylinder" size=".05 .05" pos=".065 0 0"',
    "capsule": 'type="capsule" size=".05 .05" pos=".065 0 0"',
    "ellipsoid": 'type="ellipsoid" size=".05 .05 .05" pos=".065 0 0"',
}
TIP = '<body name="tip" mocap="true"><geom type="sphere" size=".005"/></body>'
CUBE = " ".join(f"{x} {y} {z}" for x in (-0.05, 0.05) for y in (-0.05, 0.05) for z in (-0.05, 0.05))
ASSETS = (
    f'<mesh name="cube" vertex="{CUBE}"/>'
    '<hfield name="hills" nrow="2" ncol="2" size=".05 .05 .01 .01" elevation="0 1 0 1"/>'
)


def fixed(*geoms: str) -> str:
    """A model of fixed geoms around a ball."""
    every = "".join(f"<geom {one}/>" for one in geoms)
    return f"<mujoco><asset>{ASSETS}</asset><worldbody>{every}{TIP}</worldbody></mujoco>"


@pytest.mark.parametrize("shape", WALLS)
def test_a_fixed_wall_holds_however_deep_it_is_pressed(shape: str) -> None:
    """MuJoCo knows no contact of a mocap body with a fixed geom: the wall was gone once it was touched."""
    engine = MujocoEngine(fixed(WALLS[shape]), most_stiffness=4000)
    for x in (0.0, 0.0099, 0.00995, 0.01, 0.0101, 0.013, 0.02, 0.06, 0.1, 0.2, 0.0101, 0.0099):
        model = engine(np.array([x, 0, 0]), STILL)
        assert model is not None, x
        assert model.at == pytest.approx((0.01, 0, 0), abs=2e-5), x
        assert model.normal == pytest.approx((1, 0, 0), abs=5e-3), x
        assert model.stiffness == pytest.approx(4000), x
    assert engine(np.array([-0.02, 0, 0]), STILL) is None


def test_a_run_rests_at_a_fixed_wall() -> None:
    world = Bridge(MujocoEngine(fixed(WALLS["box"])))
    hand = ebac.Hand(stiffness=500, target=0.03)
    trace = ebac.simulate(ebac.Scenario(environment=world, hand=hand, seconds=2), "ebac")
    assert ebac.contact(trace).rest_m == pytest.approx((500 * 0.03 + 5000 * 0.01) / 5500, abs=5e-5)
    assert ebac.contact(trace).still


def test_a_fixed_wall_holds_where_the_tip_slides_along_it_and_around_it() -> None:
    engine = MujocoEngine(fixed(WALLS["sphere"]))
    for angle in np.linspace(0, 1, 60):
        inwards = np.array([np.cos(angle), np.sin(angle), 0])
        model = engine(np.array([0.065, 0, 0]) - 0.04 * inwards, STILL)
    assert model is not None
    assert model.normal == pytest.approx(inwards, abs=0.01)
    assert model.at == pytest.approx(np.array([0.065, 0, 0]) - 0.055 * inwards, abs=5e-4)


def test_two_fixed_walls_hold_in_their_corner_and_as_one_where_they_are_even() -> None:
    floor = 'type="plane" size="1 1 1" pos="0 0 -.015"'
    model = MujocoEngine(fixed(WALLS["box"], floor))(np.array([0.013, 0, -0.014]), STILL)
    assert model is not None
    force = model.stiffness * (np.array([0.013, 0, -0.014]) - model.at)
    assert force == pytest.approx([5000 * 0.003, 0, -5000 * 0.004], abs=0.1)
    halves = [f'type="box" size=".05 .05 .05" pos=".065 {y} 0"' for y in (-0.05, 0.05)]
    model = MujocoEngine(fixed(*halves))(np.array([0.03, 0.0, 0]), STILL)
    assert model is not None
    assert model.at == pytest.approx((0.01, 0, 0), abs=1e-5)
    assert model.stiffness == pytest.approx(5000)


def test_what_moves_and_what_is_fixed_press_together() -> None:
    floor = '<worldbody><geom type="plane" size="1 1 1" pos="0 0 -.015"/>'
    engine = MujocoEngine(PLATE.replace("<worldbody>", floor))
    place = np.array([0.015, 0, -0.012])
    for _ in range(120):
        model = engine(place, STILL)
    assert model is not None
    force = model.stiffness * (place - model.at)
    assert force == pytest.approx([400 * 0.005, 0, -5000 * 0.002], abs=0.3)


def test_a_tip_that_begins_within_a_fixed_geom_is_let_out() -> None:
    engine = MujocoEngine(fixed('type="box" size=".05 .05 .05" pos=".048 0 0"'))
    model = engine(STILL, STILL)
    assert model is not None
    assert model.at == pytest.approx((-0.007, 0, 0), abs=1e-5)
    assert model.normal == pytest.approx((1, 0, 0), abs=1e-3)


def test_a_handle_begins_behind_a_wall_whatever_the_place_of_the_tip_in_the_model() -> None:
    engine = MujocoEngine(fixed(WALLS["plate"]))
    assert engine(np.array([0.05, 0, 0]), STILL) is None
    model = engine(np.array([0.01, 0, 0]), STILL)
    assert model is not None
    assert model.at == pytest.approx((0.021, 0, 0), abs=1e-5)
    assert model.normal == pytest.approx((-1, 0, 0), abs=1e-3)


def test_fixed_hills_are_refused_unless_nothing_touches_them() -> None:
    hills = 'name="ground" type="hfield" hfield="hills"'
    with pytest.raises(ValueError, match=r'geom ground is a fixed hfield.*contype="0"'):
        MujocoEngine(fixed(hills))
    far = fixed(hills + ' contype="0" conaffinity="0"')
    assert MujocoEngine(far)(np.array([0, 0, 0.02]), STILL) is None
