"""Measure what a handle did in a world of bodies, from the trace alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ebac._core import TAIL_SHARE, Gimbal
from ebac._util import formatting
from ebac._util.arguments import require
from ebac.trace import Trace
from ebac.worlds import World, distance
from ebac.worlds.world import Touch

#: A handle so far inside a body that does not push it has come through [m].
THROUGH = 1e-4
#: What a table of contacts with bodies shows: label, attribute, unit, what to print where there is none.
LINES = (
    ("depth", "depth_m", "m", "-"),
    ("normal error", "normal_error_deg", "deg", "-"),
    ("friction share", "friction_share", "1", "-"),
    ("in contact", "touched_share", "share", "-"),
    ("stored at most", "stored_J", "J", "-"),
    ("ticks come through", "came_through", "1", "-"),
)


@dataclass(frozen=True, kw_only=True, repr=False)
class WorldContact:
    """A contact with bodies, against the world itself; the port sees what the device can feel of it.

    Attributes
    ----------
    touched_share : float
        Share of the ticks in contact.
    deepest_m : float
        Deepest place behind the surface.
    depth_m : float
        Mean depth in the last 30 % of the run.
    normal_error_deg : float or None
        Largest angle between applied force and the surface's normal in the last 30 %, as far as the device has axes
        for it; None with friction, or without contact then.
    friction_share : float or None
        Largest tangential over normal force of the world; at most the friction coefficient.
    came_through : int
        Ticks in which the handle was inside a body whose surface did not hold it.
    stored_J : float
        Most elastic energy of the world.
    """

    touched_share: float
    deepest_m: float
    depth_m: float
    normal_error_deg: float | None
    friction_share: float | None
    came_through: int
    stored_J: float

    @property
    def touched(self) -> bool:
        """Whether the handle was ever in contact."""
        return self.touched_share > 0

    def __repr__(self) -> str:
        """Return every number with its unit, one a line."""
        return formatting.listed(
            "Contact with the world:", self, (("deepest", "deepest_m", "m", "-"), *LINES)
        )


def world_contact(trace: Trace) -> WorldContact:
    """Measure a run in a `worlds.World` on a device with straight axes or a gimbal with a slide.

    Parameters
    ----------
    trace : Trace
        Of one run.

    Raises
    ------
    ValueError
        When the trace's scenario has no such world, or a gimbal without a slide.
    TypeError
        When it is no trace.
    """
    require(trace, Trace, "ebac.metrics.world_contact", "a trace, as ebac.simulate returns it")
    scenario = trace.scenario
    world = None if scenario is None else scenario.environment
    if scenario is None or not isinstance(world, World):
        raise ValueError(
            "world_contact: the trace is of no run in a worlds.World; ebac.contact measures a wall"
        )
    if isinstance(scenario.device.kinematics, Gimbal):
        raise ValueError(
            "world_contact: the handle of a gimbal without a slide moves on a sphere; give a device with straight axes "
            "or a gimbal with a slide"
        )
    n = len(trace)
    x = np.zeros((n, 3))
    x[:, : trace.axes] = trace["true.x" if "true.x" in trace else "x"].reshape(n, -1)
    touches = world.walk(x, None, trace["t"])
    depth = np.array([touch.depth for touch in touches])
    in_contact = depth > 0
    tail = np.arange(n) >= (1 - TAIL_SHARE) * n
    friction = any(body.friction for body in world.bodies)
    return WorldContact(
        touched_share=float(in_contact.mean()),
        deepest_m=float(depth.max()),
        depth_m=float(depth[tail].mean()),
        normal_error_deg=None if friction else _normal_error(trace, touches, in_contact & tail),
        friction_share=_friction(touches, in_contact) if friction else None,
        came_through=_through(world, x, in_contact),
        stored_J=float(max(touch.stored for touch in touches)),
    )


def _normal_error(trace: Trace, touches: list[Touch], where: np.ndarray) -> float | None:
    applied = trace["f_applied"].reshape(len(trace), -1)
    worst = None
    for i in np.flatnonzero(where):
        normal = touches[i].force[: trace.axes]
        size = np.linalg.norm(normal) * np.linalg.norm(applied[i])
        if size > 0:
            angle = float(np.degrees(np.arccos(np.clip(normal @ applied[i] / size, -1, 1))))
            worst = angle if worst is None else max(worst, angle)
    return worst


def _friction(touches: list[Touch], where: np.ndarray) -> float | None:
    shares = []
    for i in np.flatnonzero(where):
        along = float(touches[i].force @ touches[i].normal)
        across = float(np.linalg.norm(touches[i].force - along * touches[i].normal))
        if along > 0:
            shares.append(across / along)
    return max(shares) if shares else None


def _through(world: World, x: np.ndarray, in_contact: np.ndarray) -> int:
    """Count places inside a body at rest, deeper than `THROUGH`, that no surface holds."""
    inside = np.zeros(len(x), bool)
    for body in world.bodies:
        if body.motion.still():
            inside |= distance(body.solid, x)[0] < -THROUGH
    return int((inside & ~in_contact).sum())
