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
