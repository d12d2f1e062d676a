"""A handle that begins inside the virtual world."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.scenario import Scenario


def inside(scenario: Scenario, name: str = "environment") -> str:
    """Return that the handle begins inside the world, which pushes it; else nothing. `name` is what gives the world."""
    from ebac._core import Wall
    from ebac._util.foreign_worlds import foreign
    from ebac._util.surfaces import GRAZE, PUSH, distances_at, push_at

    world, at = scenario.environment, [0.0] * scenario.device.axes
    if (isinstance(world, Wall) and world.position >= -GRAZE) or foreign(world) is not None:
        return ""
    if (force := push_at(world, at)) < PUSH:  # before the distances: that to a mesh takes 30 ms
        return ""
    deep = {body: -way for body, way in distances_at(world, at).items() if way < -GRAZE}
    if not deep:
        return ""
    bodies = " and ".join(
        f"{1e3 * way:.3g} mm inside {body if body.startswith('body') else f'the {body}'}"
        for body, way in deep.items()
    )
    return (
        f"{name}: the handle begins {bodies} and is pushed with {force:.3g} N at once; energy that nobody has put in "
        "would push it out, which `ebac` does not give, so that it stays inside: place the world beside the start of "
        "the handle"
    )
