"""A handle that begins inside the virtual world."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.scenario import Scenario


def inside(scenario: Scenario, name: str = "environment") -> str:
    """Return that the handle begins inside the world, which pushes it; else nothing. `name` is what gives the world."""
    from ebac._util.surfaces import GRAZE, PUSH, distances_at, push_at

    kinematics = scenario.device.kinematics
    at = list(kinematics.forward([0.0] * scenario.device.axes))
    deep = {body: -way for body, way in distances_at(scenario.environment, at).items()}
    if max(deep.values(), default=0.0) <= GRAZE:
        return ""
    if (force := push_at(scenario.environment, at)) < PUSH:
        return ""
    bodies = " and ".join(
        f"{1e3 * way:.3g} mm inside {body if body.startswith('body') else f'the {body}'}"
        for body, way in deep.items()
        if way > GRAZE
    )
    return (
        f"{name}: the handle begins {bodies} and is pushed with {force:.3g} N at once; energy that nobody has put in "
        "would push it out, which `ebac` does not give, so that it stays inside: place the world beside the start of "
        "the handle"
    )
