"""How far the handle is from the surfaces of a virtual world, and how hard they push it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ebac._core import Corner, Disc, Wall, _World

if TYPE_CHECKING:
    from ebac.scenario import Environment

#: A handle that stands no deeper than this inside the virtual world counts as outside [m].
GRAZE = 1e-3
#: A handle that is pushed harder [N] where it stands inside the virtual world does not begin outside.
PUSH = 1.0
#: In the centre of a disc its force has no direction; this far beside it, it has [m].
_OFF_CENTRE = 1e-9


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


def push_at(environment: Any, at: Sequence[float]) -> float:
    """Return the force of a virtual world on the handle at rest at a place [N].

    Parameters
    ----------
    environment : Free, Wall, Corner, Disc or worlds.World
        The virtual world.
    at : sequence of float
        Coordinates of the handle, one to three [m].
    """
    if isinstance(environment, _World):
        (touch,) = environment.walk([[*at, 0.0, 0.0][:3]])  # type: ignore[attr-defined]  # it has bodies
        return float(np.linalg.norm(touch.force))
    beside = np.add(at, _OFF_CENTRE)
    return float(np.linalg.norm(environment.force(beside, np.zeros_like(beside))))


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
