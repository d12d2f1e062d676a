"""Where a hand and an ideal wall balance on a lever, whose handle moves on a sphere or in space."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from ebac._core import (
    Device,
    Gimbal,
    Hand,
    Linear,
    MinimumJerk,
    Recorded,
    SlidingGimbal,
    Step,
    Wall,
)
from ebac.metrics.balance import balance
from ebac.scenario import Scenario

#: Rounds in which one coordinate after the other is balanced; the weight that couples them is small beside a hand.
ROUNDS = 100
#: A round that moves no coordinate by more is the last [m].
SAME = 1e-12
#: A balance is looked for within so much of the lever either way, 64 degrees; no device leans as far.
REACH = 0.9
#: Lowest handle of a gimbal over its joints, as a share of the lever; the core's (`PortSpace`).
FLATTEST = 1e-2


def lever_rest(scenario: Scenario) -> NDArray[np.float64] | None:
    """Return where the handle of a gimbal rests, with or without a slide, shape (axes,) [m].

    The Jacobian is regular there, so at rest the forces on the handle balance along each coordinate: hand,
    wall and weight. A gimbal turns the weight W into W x/h and W y/h away from the middle, h the height over the
    joints; where it has a slide, the weight only pulls that down.

    None where a coordinate's target does not come to rest, where there is no balance within `REACH`, as where the
    weight tips the lever over. Like a straight axis it knows no stops.
    """
    wall, device, hand = scenario.environment, scenario.device, scenario.hand
    lever = device.kinematics
    if not isinstance(wall, Wall) or isinstance(lever, Linear):
        return None
    paths = [hand.path[i] if i < len(hand.path) else Step(target=0) for i in range(device.axes)]
    if not all(comes_to_rest(path, scenario.seconds) for path in paths):
        return None
    hands = [hand.replace(path=path) for path in paths]
    weight = left_weight(device)
    place = np.zeros(device.axes)
    for _ in range(ROUNDS):
        before = place.copy()
        for axis, one in enumerate(hands):
            found = _along(axis, one, wall, lever, weight, place)
            if found is None:
                return None
            place[axis] = found
        if np.abs(place - before).max() <= SAME:
            return place
    return None


def comes_to_rest(path: object, seconds: float) -> bool:
    """Return whether a target stands still before a run of so many seconds ends."""
    if isinstance(path, Recorded):
        return bool(path.t[-1] < seconds)
    if isinstance(path, MinimumJerk):
        return path.at + path.duration < seconds
    return isinstance(path, Step) and path.at < seconds


def left_weight(device: Device) -> float:
    """Return the weight of the handle that the motors do not carry [N]."""
    mechanics, given = device.mechanics, device.compensation
    return (mechanics.handle_mass - given.gravity_mass) * mechanics.gravity


def held_by_friction(device: Device, place: NDArray[np.float64]) -> float:
    """Return the largest force along the first axis that friction in the joints holds at a place of the handle [N]."""
    mechanics, lever = device.mechanics, device.kinematics
    friction = max(mechanics.coulomb, mechanics.breakaway)
    if isinstance(lever, Linear):
        return friction
    q = lever.inverse(place.tolist())
    torque = friction * np.diag(lever.jacobian(np.zeros(device.axes).tolist()))
    return float(np.abs(np.linalg.inv(lever.jacobian(q.tolist()).T)[0]) @ torque)


def tipping(device: Device, place: NDArray[np.float64]) -> float:
    """Return by how much a gimbal's weight softens the first axis at a place of the handle [N/m]."""
    lever = device.kinematics
    if not isinstance(lever, Gimbal):
        return 0.0
    height = sqrt(max(lever.radius**2 - float(place @ place), (FLATTEST * lever.radius) ** 2))
    return left_weight(device) * float(height**2 + place[0] ** 2) / height**3


def _along(
    axis: int,
    hand: Hand,
    wall: Wall,
    lever: Gimbal | SlidingGimbal,
    weight: float,
    place: NDArray[np.float64],
) -> float | None:
    """Return where the forces along one coordinate balance, the others being where they are [m]."""
    r = lever.radius
    others = float(place @ place - place[axis] ** 2)
    reach = REACH * (sqrt(r**2 - others) if isinstance(lever, Gimbal) else r)

    def left(x: float) -> float:
        push = wall.stiffness * max(x - wall.position, 0.0) if axis == 0 else 0.0
        if isinstance(lever, Gimbal):
            fall = weight * x / sqrt(max(r**2 - others - x**2, (FLATTEST * r) ** 2))
        else:
            fall = -weight if axis == 2 else 0.0
        return hand.steady(x) + fall - push

    return balance(left, -reach, reach)
