"""Whether the handle can reach the virtual world, and whether another world leaves it outside."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ebac._core import Corner, Device, Disc, Limits, Wall
from ebac._util.surfaces import GRAZE, distances_at
from ebac.scenario import Environment

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
