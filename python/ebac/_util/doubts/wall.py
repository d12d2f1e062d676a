"""Stiffnesses and places of walls that are possible, but more likely in a wrong unit."""

from __future__ import annotations

from math import cos, sin
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac._core import Device
    from ebac.scenario import Environment, Scenario

#: What walls have [N/m]: a hand has 300, and no device of this package renders half a meganewton per metre.
USUAL = (50.0, 500e3)
#: A wall beyond is refused [N/m].
MOST = 1e7
#: Names of the numbers in a scenario and its file.
STIFFNESS, POSITION = "environment.stiffness", "environment.position"


def unusual(stiffness: float) -> str:
    """Return what is unusual about a stiffness [N/m]; nothing where it is usual."""
    if not (
        0 < stiffness < USUAL[0] or USUAL[1] < stiffness <= MOST
    ):  # others are usual, or refused
        return ""
    return f"a wall of {stiffness:g} N/m: usual are {USUAL[0]:g} to {USUAL[1]:g} N/m"


def doubt(stiffness: float, name: str = STIFFNESS) -> str:
    """Return that a stiffness [N/m] is likely in a wrong unit, by the name of what gives it; else nothing."""
    if not (text := unusual(stiffness)):
        return ""
    other = f", {stiffness:g} kN/m are {1e3 * stiffness:g}" if stiffness < USUAL[0] else ""
    return f"{name}: {text}; it is in N/m{other}"


def of_world(environment: Environment) -> str:
    """Return that the wall of a scenario is likely in a wrong unit; else nothing."""
    from ebac._core import Wall

    return doubt(environment.stiffness) if isinstance(environment, Wall) else ""


def behind_stops(scenario: Scenario, option: float | None = None, name: str = POSITION) -> str:
    """Return that a wall stands behind the stops of the device; else nothing.

    `name` is what gives its place, and `option` the place [m] of a world that is no wall.
    """
    from ebac._core import Wall

    wall = scenario.environment
    if isinstance(wall, Wall):
        end = _end(scenario.device, wall.angle) + wall.motion_amplitude
        place = wall.position
    elif option is not None:
        end, place = _end(scenario.device), option
    else:
        return ""
    if place < end:
        return ""
    return (
        f"{name} = {place:g} m: the handle never reaches the wall, the stops of the device stand at {end:.4g} m "
        f"(device.kinematics.limit){_in_metres(place, end)}"
    )


def before_target(scenario: Scenario, name: str = POSITION, target: str = "hand.path") -> str:
    """Return that a hand does not lead to a wall before the stops; else nothing. For a wall that was not met.

    `name` and `target` are what gives the places of wall and target.
    """
    import numpy as np

    from ebac._core import Wall

    wall, device = scenario.environment, scenario.device
    if not isinstance(wall, Wall):
        return ""
    if wall.angle != 0 or wall.position >= _end(device) + wall.motion_amplitude:  # noted before
        return ""
    times = np.linspace(0, scenario.seconds, 1001)
    most = max(scenario.hand.target(t) for t in times)
    if most >= wall.position:
        return ""
    return (
        f"the wall stands at {wall.position:g} m ({name}), and the target of the hand comes to {most:.4g} m at most: "
        f"the handle does not meet the wall; give a nearer wall, or a target behind it by {target}"
        f"{_in_metres(wall.position, most)}"
    )


def _end(device: Device, angle: float = 0.0) -> float:
    """Return how far the handle comes along the normal of a wall, before its stops [m]."""
    normal = (abs(cos(angle)), abs(sin(angle)))
    ways = device.kinematics.travel * device.kinematics.stops
    return float(sum(share * way for share, way in zip(normal, ways, strict=False)))


def _in_metres(place: float, end: float) -> str:
    """Return what a place [m] would be that was meant in millimetres, where the handle could come to that."""
    shown = f", {place:g} mm are {place / 1e3:g}" if 1 <= place < 1e3 * end else ""
    return f"; positions are in metres{shown}"
