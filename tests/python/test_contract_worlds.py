"""The contract of every law in every world of bodies, on three axes; golden traces of a few worlds."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ebac
from ebac.metrics import world_contact
from ebac.testing import Tolerance, assert_passive
from ebac.testing.golden import TraceRegression
from ebac.worlds import PRESETS, Body, Elastic, Placed, Sphere, Swing, World, preset

GOLDEN = Path(__file__).parents[1] / "golden"
DEVICE = ebac.Device(kinematics=ebac.Linear(axes=3), sensor=ebac.ForceSensor(noise=0.03))
#: Presses to 20 mm inside and slides to and fro by 15 mm at up to 0.3 m/s, then leaves.
HAND = ebac.Hand(
    path=[
        ebac.Recorded(t=[0.0, 0.1, 0.3, 0.35], x=[-2e-3, 0.02, 0.02, -0.02]),
        ebac.Sine(centre=0.0, amplitude=0.015, frequency=3.0),
        ebac.Sine(centre=0.0, amplitude=0.01, frequency=4.0),
    ]
)
#: Presets that need no extra, and a body that moves.
MOVING = World(
    Body(
        solid=Placed(Sphere(), (0.025, 0.0, 0.0)),
        material=Elastic(stiffness=5e3, damping=5.0),
        friction=0.3,
        motion=Swing(amplitude_x=6e-3, frequency=3.0),
    )
)
WORLDS = [*(name for name, known in PRESETS.items() if not known.extra), "moving"]


def scenario_in(name: str, **changes: Any) -> ebac.Scenario:
    world = MOVING if name == "moving" else preset(name, friction=0.3)
    known = {"device": DEVICE, "hand": HAND, "environment": world, "seconds": 0.45}
    return ebac.Scenario(**(known | changes))


@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize("name", ebac.LAWS)
def test_the_contract_of_every_law_holds_in_every_world(name: str, world: str) -> None:
    scenario = scenario_in(world)
    law: Any = ebac.design(name, DEVICE, scenario.timing)
    trace = ebac.simulate(scenario, law)

    assert not trace["fault"].any()
    for column in trace:
        undefined = column.startswith(("law.beta", "lateness"))
        assert undefined or np.isfinite(trace[column]).all(), column
    assert np.abs(trace["f_cmd"]).max() <= getattr(law, "peak_force", math.inf)

    again = ebac.simulate(scenario, law)  # it and its world have forgotten everything
    assert trace["f_cmd"].tobytes() == again["f_cmd"].tobytes()
    assert trace["true.x"].tobytes() == again["true.x"].tobytes()

    there = world_contact(trace)
    assert there.touched_share > 0.1
    assert there.came_through == 0
    if law.passive and world != "moving":  # whose motion is work of its own
        assert_passive(trace, reserve=getattr(law, "reserve", 0.0))


@pytest.mark.parametrize("name", ["corner", "edge", "lumen", "moving", "texture", "tissue"])
def test_a_world_gives_its_golden_trace(name: str, ebac_trace: TraceRegression) -> None:
    device = DEVICE.replace(sensor=ebac.ForceSensor())  # no digits but those of world and law
    ebac_trace.check(
        ebac.simulate(scenario_in(name, device=device), "ebac"),
        name=f"world-{name}",
        columns=("x", "f_env", "f_cmd"),
        every=10,
        until=0.3,
        metrics=False,
        tolerances={
            "x": Tolerance(absolute=1e-9),
            "f_env": Tolerance(absolute=1e-4),
            "f_cmd": Tolerance(absolute=1e-4),
        },
    )
