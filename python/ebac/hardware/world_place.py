"""Whether the handle can reach the virtual world, and how far it is from it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Corner, Device, Disc, Limits, Wall, _World
from ebac.scenario import Environment

#: A handle that stands no deeper than this inside the virtual world counts as outside [m].
GRAZE = 1e-3
#: Positions of an axis from stop to stop, for the farthest places of the handle.
_POSITIONS = 5


def ends_of(device: Device, limits: Limits) -> NDArray[np.float64]:
    """Return how far each axis may be from its zero [m], shape (axes,), as the loop holds them."""
    ways = device.kinematics.travel * device.kinematics.stops
    ends: NDArray[np.float64] = limits.end - (ways[0] - ways)
    return ends


def never_reached(
    device: Device, limits: Limits, environment: Environment
) -> tuple[tuple[str, ...], str] | None:
    """Return the key that puts a wall or disc where no handle gets, as one in millimetres is, and what is wrong.

    None where the handle can reach them, and for a world of bodies, which has no position.
    """
    walls: dict[tuple[str, ...], Wall]
    match environment:
        case Wall() as wall:
            walls = {(): wall}
        case Corner(first=first, second=second):
            walls = {("first",): first, ("second",): second}
        case Disc() as disc:
            return _disc_never_reached(disc, _places(device, limits), limits)
        case _:
            return None
    for within, wall in walls.items():
        path = ("environment", *within, "position")
        along = _places(device, limits) @ [math.cos(wall.angle), math.sin(wall.angle)]
        most = float(along.max()) + wall.motion_amplitude
        if wall.position >= most:
            return path, (
                f"{'.'.join(path)} = {wall.position:g} m: must be less than {most:.4g} m, or the handle never reaches "
                f"the wall: {_workspace(limits)}"
            )
    return None


def _disc_never_reached(
    disc: Disc, places: NDArray[np.float64], limits: Limits
) -> tuple[tuple[str, ...], str] | None:
    centre = np.array([disc.x, disc.y])
    beyond = centre - np.clip(centre, places.min(axis=0), places.max(axis=0))
    if np.hypot(*beyond) < disc.radius:
        return None
    key = "xy"[int(np.argmax(np.abs(beyond)))]
    return ("environment", key), (
        f"environment.{key} = {getattr(disc, key):g} m: the handle never reaches this disc of radius "
        f"{disc.radius:g} m: {_workspace(limits)}"
    )


def _workspace(limits: Limits) -> str:
    return (
        f"the workspace ends at limits.end = {limits.end:.4g} m; positions are in metres, 10 mm are 0.01; for no wall "
        'at all set environment.type = "Free"'
    )


def _places(device: Device, limits: Limits) -> NDArray[np.float64]:
    """Return places all over the workspace in the plane of walls and discs [m], shape (n, 2), with its corners."""
    most = ends_of(device, limits) / device.kinematics.travel
    angles = product(*(np.linspace(-one, one, _POSITIONS) for one in most))
    return np.array([[*device.kinematics.forward(one), 0.0][:2] for one in angles])


def check_reached(device: Device, limits: Limits, environment: Environment) -> None:
    """Raise ValueError for a wall or a disc that the handle never reaches."""
    if (found := never_reached(device, limits, environment)) is not None:
        raise ValueError(found[1])


def distances_at(environment: Environment, at: Sequence[float]) -> dict[str, float]:
    """Return how far the handle at a place is from each surface [m], by its name; negative inside.

    A moving wall counts as at rest, a moving body as where it is at the time 0. The surface of an engine is not known
    before it answers.

    Parameters
    ----------
    environment : Free, Wall, Corner, Disc or worlds.World
        The virtual world.
    at : sequence of float
        Coordinates of the handle, one to three [m].
    """
    place = [float(one) for one in (*at, 0.0, 0.0)][:3]
    x, y = place[:2]

    def before(wall: Wall) -> float:
        return wall.position - (math.cos(wall.angle) * x + math.sin(wall.angle) * y)

    match environment:
        case Wall() as wall:
            return {"wall": before(wall)}
        case Corner(first=first, second=second):
            return {"first wall": before(first), "second wall": before(second)}
        case Disc() as disc:
            return {"disc": math.hypot(x - disc.x, y - disc.y) - disc.radius}
        case _World() as world:
            return _to_bodies(world, place)
        case _:
            return {}


def check_stays_outside(before: Environment, after: Environment, at: Sequence[float]) -> None:
    """Refuse another world whose surface would stand deeper behind the handle than that of the present one.

    Raises
    ------
    ValueError
        For more than `GRAZE`, with the depth.
    """
    now = max(0.0, -min(distances_at(before, at).values(), default=0.0))
    for name, way in distances_at(after, at).items():
        if -way > now + GRAZE:
            raise ValueError(
                f"the handle would stand {-1e3 * way:.3g} mm inside the {name}, which would throw it out; it stands "
                f"{1e3 * now:.3g} mm deep now, and a change may add {1e3 * GRAZE:g} mm: let the hand go out first"
            )


def _to_bodies(world: Any, at: Sequence[float]) -> dict[str, float]:
    """Return the distance to each body at the time 0; of a gimbal's handle in its plane, a little less or more."""
    from ebac.worlds import distance
    from ebac.worlds.world import begin_of

    if not hasattr(world, "bodies"):
        return {}
    place = np.array([at], float)
    named = {f"body {i + 1}": body for i, body in enumerate(world.bodies)}
    return {
        name: float(distance(body.solid, place - begin_of(body))[0][0])
        for name, body in named.items()
    }
