"""Where a hand and an ideal world of bodies balance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ebac._core import Gimbal, Layer, MinimumJerk, SlidingGimbal, Step
from ebac.scenario import Scenario
from ebac.worlds import Body, Layered, World

#: Places of the hand's target on its way, so that the handle comes in where the hand presses it in.
STEPS = 60
#: Corrections at each of them, and most at the last.
CORRECTIONS, MOST_CORRECTIONS = 20, 5000
#: Left of the forces that balance [N].
BALANCED = 1e-7
#: Half of the way over which a slope is taken [m].
SMALL = 1e-7


class Rest(NamedTuple):
    """A balance of hand and world on the first axis."""

    x: float  # m
    stiffness: float  # N/m, of both


def world_rest(scenario: Scenario) -> Rest | None:
    """Return where a slow hand comes to rest on the first axis.

    None where there is no such place or more than one: with friction, motion or puncture, a hand that does not come to
    a target, or a gimbal.
    """
    world, hand, device = scenario.environment, scenario.hand, scenario.device
    if not isinstance(world, World) or not all(map(_one_rest, world.bodies)):
        return None
    if hand.model is not None or np.isfinite(hand.release_at) or hand.stiffness == 0:
        return None
    paths = hand.path[: device.axes]
    if isinstance(device.kinematics, Gimbal) or not all(
        isinstance(path, (Step, MinimumJerk)) for path in paths
    ):
        return None
    goal = np.zeros(device.axes)
    goal[: len(paths)] = [path.target for path in paths]  # type: ignore[union-attr]
    mechanics, given = device.mechanics, device.compensation
    heavy = (mechanics.handle_mass - given.gravity_mass) * mechanics.gravity
    down = isinstance(device.kinematics, SlidingGimbal)
    weight = heavy * (np.array([0.0, 0.0, -1.0]) if down else np.ones(device.axes))
    world.reset()
    x, missing = np.zeros(device.axes), np.zeros(device.axes)
    for share in np.linspace(0, 1, STEPS + 1)[1:]:
        for _ in range(MOST_CORRECTIONS if share == 1 else CORRECTIONS):
            force, stiffness = _contact(world, x)
            missing = hand.stiffness * (share * goal - x) + weight - force
            if np.abs(missing).max() < BALANCED:
                break
            x = x + missing / (
                hand.stiffness + stiffness
            )  # as through honey, so that it slides off where a hand does
    if np.abs(missing).max() > 1e3 * BALANCED:
        return None
    beside = SMALL * np.eye(len(x))[0]
    slope = (_contact(world, x + beside)[0][0] - _contact(world, x - beside)[0][0]) / (2 * SMALL)
    return Rest(float(x[0]), hand.stiffness + float(slope))


def _one_rest(body: Body) -> bool:
    """Return whether a slow motion ends in the same place whatever came before."""
    material = body.material
    layers: tuple[Layer, ...] = material.layers if isinstance(material, Layered) else ()
    return body.friction == 0 and body.motion.still() and not any(one.puncture for one in layers)


def _contact(world: World, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return force [N] along the axes, and stiffness [N/m]."""
    force, _, _, stiffness, _ = world.contact(np.pad(x, (0, 3 - len(x))), np.zeros(3), 0.0)
    return force[: len(x)], stiffness
