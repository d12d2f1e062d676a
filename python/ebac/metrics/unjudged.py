"""Why a contact is judged neither exact nor good: what keeps it from having an ideal rest."""

from __future__ import annotations

import numpy as np

from ebac._core import Free, Linear, Wall, _World
from ebac._util.foreign_worlds import foreign
from ebac.hands import is_own
from ebac.metrics.ideal import ideal_rest
from ebac.metrics.lever_rest import comes_to_rest
from ebac.scenario import Scenario


def no_ideal_rest(scenario: Scenario) -> str:
    """Return why there is no ideal rest, in a few words; nothing where there is one."""
    if ideal_rest(scenario) is not None:
        return ""
    world, hand = scenario.environment, scenario.hand
    engine = foreign(world)
    if engine is not None and engine.ideal() is None:
        return "what the world does is a function"
    if isinstance(world, Free):
        return "there is no wall"
    if isinstance(world, Wall):
        if world.motion_amplitude != 0:
            return "the wall moves"
        if world.angle != 0:
            return "the wall is not straight across the first axis"
    elif engine is None and not isinstance(world, _World):
        return "it is no wall; `ebac shapes` judges corners and discs"
    if np.isfinite(hand.release_at):
        return "the hand lets go"
    lever = not isinstance(scenario.device.kinematics, Linear)
    paths = hand.path[: scenario.device.axes] if lever else hand.path[:1]
    if not all(comes_to_rest(path, scenario.seconds) for path in paths):
        return "the target of the hand keeps moving"
    if is_own(hand.model):
        return "the hand is your own: where it rests is not known"
    if hand.model is None and hand.stiffness == 0:
        return "the hand has no stiffness"
    if isinstance(world, Wall):
        return "hand and wall do not balance within reach of the device"
    return "the world has friction, moves or breaks, or the hand comes to no rest in it"
