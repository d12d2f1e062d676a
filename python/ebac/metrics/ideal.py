"""Where hand and ideal wall balance, and how far from there a rest is still exact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ebac._core import Free, Hand, Linear, Recorded, Wall, _World
from ebac._util.arguments import require
from ebac._util.foreign_worlds import foreign
from ebac.metrics.balance import balance
from ebac.metrics.lever_rest import (
    comes_to_rest,
    held_by_friction,
    left_weight,
    lever_rest,
    tipping,
)
from ebac.scenario import Scenario

if TYPE_CHECKING:
    from ebac.metrics.world_rest import Rest

#: Rest within this many encoder counts of the ideal, and the band that friction holds, is exact.
EXACT_COUNTS = 2
#: A hand with a model balances within so far from zero, or has no rest [m].
LARGEST_REST = 10.0
#: Half of the way over which the slope of a steady force is taken [m].
SMALL = 1e-6


def without_engine(scenario: Scenario) -> Scenario:
    """Return the scenario with the bodies that an engine computes, or with nothing where that is not known."""
    world = foreign(scenario.environment)
    return scenario if world is None else scenario.replace(environment=world.ideal() or Free())


def allowed_deviation(scenario: Scenario) -> float:
    """Return how far from the ideal a rest still is exact: 2 counts + f_c / (K0 + K) [m].

    Friction of up to f_c holds a hand and an *ideal* wall anywhere within f_c / (K0 + K) of their balance, so a rest
    within that band is no fault of a law. f_c is the friction at standstill; K counts only where the ideal rest
    lies inside the wall. Friction is in the joints: on a lever that leans it holds a little more than f_c.

    Parameters
    ----------
    scenario : Scenario
        Hand, wall or world, and device.

    Returns
    -------
    float
        Distance [m], at least two counts.
    """
    require(scenario, Scenario, "ebac.metrics.allowed_deviation", "a Scenario")
    scenario = without_engine(scenario)
    mechanics, wall = scenario.device.mechanics, scenario.environment
    counts = EXACT_COUNTS * scenario.device.count
    friction = max(mechanics.coulomb, mechanics.breakaway)
    ideal = ideal_rest(scenario) if friction > 0 else None
    if ideal is None:
        return counts
    hand = scenario.hand
    stiffness = hand.stiffness
    if hand.model is not None:
        stiffness = (hand.steady(ideal - SMALL) - hand.steady(ideal + SMALL)) / (2 * SMALL)
    if isinstance(wall, Wall) and ideal > wall.position:
        stiffness += wall.stiffness
    place = lever_rest(scenario)
    if place is not None:
        stiffness -= tipping(scenario.device, place)
    if isinstance(wall, _World) and (rest := _in_world(scenario)) is not None:
        stiffness, place = rest.stiffness, rest.place
    if place is not None:
        friction = held_by_friction(scenario.device, place)
    return counts + friction / stiffness


def ideal_rest(scenario: Scenario) -> float | None:
    """Return where hand and ideal wall balance, x* = (K0 X0 + K p + weight) / (K0 + K) [m].

    None where there is no such point: no straight wall at rest across the first axis, or a hand without rest. With a
    model of `ebac.hands` it is where the steady force of the model and the wall balance; None for a hand of your own.
    On a gimbal weight pulls the handle away from the middle, see `lever_rest`; None there too where the target of
    another axis does not come to rest, or where the weight tips the lever over.
    In a `worlds.World` it is where a slow hand comes to rest; None with friction, motion or puncture. Behind a
    `worlds.Bridge` it is that of the world the engine computes; None for a function.

    Parameters
    ----------
    scenario : Scenario
        Hand, wall or world, and device.

    Returns
    -------
    float or None
        Position on the first axis [m].

    Raises
    ------
    TypeError
        When it is no scenario.
    """
    require(scenario, Scenario, "ebac.ideal_rest", "a Scenario")
    world = foreign(scenario.environment)
    if world is not None and world.ideal() is None:
        return None
    scenario = without_engine(scenario)
    wall, hand = scenario.environment, scenario.hand
    if isinstance(wall, _World):
        rest = _in_world(scenario)
        return None if rest is None else rest.x
    path = hand.path[0]
    if not isinstance(wall, Wall) or wall.angle != 0 or wall.motion_amplitude != 0:
        return None
    if np.isfinite(hand.release_at) or not comes_to_rest(path, scenario.seconds):
        return None
    if not isinstance(scenario.device.kinematics, Linear):
        place = lever_rest(scenario)
        return None if place is None else float(place[0])
    weight = left_weight(scenario.device)
    if hand.model is not None:
        return _balance(hand, wall, weight)
    target = path.x[-1] if isinstance(path, Recorded) else getattr(path, "target", np.nan)
    pull = hand.stiffness * target + weight
    if hand.stiffness == 0 or pull <= hand.stiffness * wall.position:
        return pull / hand.stiffness if hand.stiffness > 0 else None
    return (pull + wall.stiffness * wall.position) / (hand.stiffness + wall.stiffness)


def _in_world(scenario: Scenario) -> Rest | None:
    from ebac.metrics.world_rest import world_rest

    return world_rest(scenario)


def _balance(hand: Hand, wall: Wall, weight: float) -> float | None:
    """Return where a hand with a model, a wall and a weight balance, by bisection of a falling force."""

    def left(x: float) -> float:
        depth = max(x - wall.position, 0.0)
        return hand.steady(x) + weight - wall.stiffness * depth

    return balance(left, -LARGEST_REST, LARGEST_REST)
