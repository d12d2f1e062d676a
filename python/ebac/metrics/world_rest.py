"""Where a hand and an ideal world of bodies balance."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ebac._core import Device, Gimbal, Layer, Linear, MinimumJerk, Step
from ebac.metrics.lever_rest import FLATTEST, comes_to_rest, left_weight
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
    """A balance of hand and world."""

    place: NDArray[np.float64]  # m, of every port
    stiffness: float  # N/m, of both along the first axis

    @property
    def x(self) -> float:
        """On the first axis [m]."""
        return float(self.place[0])


def world_rest(scenario: Scenario, start: NDArray[np.float64] | None = None) -> Rest | None:
    """Return where a slow hand comes to rest; with `start`, the rest that it finds from there.

    None where there is no such place or more than one: with friction, motion or puncture, or a hand that does not come
    to a target. On facets and waves there are several, of which the way there decides.
    """
    world, hand, device = scenario.environment, scenario.hand, scenario.device
    if not isinstance(world, World) or not all(map(_one_rest, world.bodies)):
        return None
    if hand.model is not None or np.isfinite(hand.release_at) or hand.stiffness == 0:
        return None
    paths = hand.path[: device.axes]
    if not all(
        isinstance(path, (Step, MinimumJerk)) and comes_to_rest(path, scenario.seconds)
        for path in paths
    ):
        return None
    goal = np.zeros(device.axes)
    goal[: len(paths)] = [path.target for path in paths]  # type: ignore[union-attr]
    heavy = left_weight(device)
    straight = isinstance(device.kinematics, Linear)
    weight = heavy * (np.ones(3) if straight else np.array([0.0, 0.0, -1.0]))
    world.reset()
    x = np.zeros(device.axes) if start is None else start
    missing = np.zeros(device.axes)
    for share in np.linspace(0, 1, STEPS + 1)[1:] if start is None else (1.0,):
        for _ in range(MOST_CORRECTIONS if share == 1 else CORRECTIONS):
            force, stiffness = _felt(world, device, x, weight)
            missing = hand.stiffness * (share * goal - x) - force
            if np.abs(missing).max() < BALANCED:
                break
            x = x + missing / (
                hand.stiffness + stiffness
            )  # as through honey, so that it slides off where a hand does
    if np.abs(missing).max() > 1e3 * BALANCED:
        return None
    beside = SMALL * np.eye(len(x))[0]
    after, before = (_felt(world, device, x + way, weight)[0][0] for way in (beside, -beside))
    return Rest(x, hand.stiffness + float(after - before) / (2 * SMALL))


def _one_rest(body: Body) -> bool:
    """Return whether a slow motion ends in the same place whatever came before."""
    material = body.material
    layers: tuple[Layer, ...] = material.layers if isinstance(material, Layered) else ()
    return body.friction == 0 and body.motion.still() and not any(one.puncture for one in layers)


def _felt(
    world: World, device: Device, x: NDArray[np.float64], weight: NDArray[np.float64]
) -> tuple[NDArray[np.float64], float]:
    """Return the force of world and weight that the ports feel [N], against them, and the stiffness [N/m]."""
    place, reach = np.zeros(3), np.eye(3, len(x))
    place[: len(x)] = x
    if isinstance(device.kinematics, Gimbal):  # whose handle moves on a sphere
        radius = device.kinematics.radius
        height = sqrt(max(radius**2 - float(x @ x), (FLATTEST * radius) ** 2))
        place[2] = height - radius
        reach[2] = -x / height
    force, _, _, stiffness, _ = world.contact(place, np.zeros(3), 0.0)
    return reach.T @ (force - weight), stiffness
