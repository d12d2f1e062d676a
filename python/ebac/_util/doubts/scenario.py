"""What of a scenario is possible, but more likely not meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac._util.doubts import device, motor, start, wall

if TYPE_CHECKING:
    from ebac.scenario import Scenario


def doubts(scenario: Scenario, *, quick: bool = False) -> tuple[str, ...]:
    """Return a sentence for each number that is doubtful, with the remedy.

    With `quick` it is the likely ones: that the motor gets hot is left out, and that it is too weak is looked for only
    at a rest that takes no search, that of a wall on straight axes.
    """
    from ebac._core import Linear, Wall

    simple = isinstance(scenario.environment, Wall) and isinstance(
        scenario.device.kinematics, Linear
    )
    found = [
        *device.doubts(scenario.device),
        wall.of_world(scenario.environment),
        wall.behind_stops(scenario),
        start.inside(scenario),
        motor.too_weak(scenario) if simple or not quick else "",
        "" if quick else motor.too_hot(scenario),
    ]
    return tuple(filter(None, found))
