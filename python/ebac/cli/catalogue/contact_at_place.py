"""`ebac worlds NAME --at X,Y,Z`: what a handle meets at a place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import typer

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.worlds import World

#: Farthest place along each axis, and longest stride of the handle on its way [m].
FARTHEST, STRIDE = 1.0, 2.5e-4
#: A place so far away [m] is more likely meant in millimetres: no handle of the package gets there.
FAR = 0.2


def show(name: str, world: World, given: Sequence[str], *, as_json: bool) -> None:
    """Print what a handle meets at each place, which it reaches slowly from the origin."""
    rows = [{"name": name, **met(world, _numbers(text))} for text in given]
    if as_json:
        typer.echo(output.document("worlds", rows))
        return
    grid = output.table(["place", "distance", "depth", "force", "normal", "stiffness"])
    for row in rows:
        touching = row["normal"] is not None
        grid.add_row(
            f"{_three(row['place_m'], 1e3)} mm",
            f"{1e3 * row['distance_m']:.3f} mm",
            f"{1e3 * row['depth_m']:.3f} mm",
            f"{_three(row['force_N'])} N",
            _three(row["normal"]) if touching else "-",
            f"{row['stiffness_N_per_m']:g} N/m" if touching else "-",
        )
    output.show(grid)
    output.say(
        "Distance to the nearest surface, negative inside. Force as the handle presses, at rest; normal into the body, "
        "of length 1. The handle comes from the origin, slowly and straight."
    )


def met(world: World, place: tuple[float, float, float]) -> dict[str, Any]:
    """Return distance, depth, force, normal and stiffness at a place [m]."""
    import numpy as np

    from ebac.worlds import distance
    from ebac.worlds.world import begin_of

    end = np.array(place)
    steps = max(1, int(np.ceil(np.linalg.norm(end) / STRIDE)))
    touch = world.walk(np.linspace(0, 1, steps + 1)[:, None] * end)[-1]
    touching = touch.stiffness > 0 or bool(touch.force.any())
    return {
        "place_m": list(place),
        "distance_m": min(
            float(distance(body.solid, end - begin_of(body))[0][0]) for body in world.bodies
        ),
        "depth_m": touch.depth,
        "force_N": touch.force.tolist(),
        "normal": touch.normal.tolist() if touching else None,
        "stiffness_N_per_m": touch.stiffness,
        "stored_J": touch.stored,
    }


def _numbers(text: str) -> tuple[float, float, float]:
    try:
        x, y, z = (float(word) for word in text.split(","))
    except ValueError:
        raise ValueError(
            f"--at {text}: must be three numbers in m, without a unit; 1 mm along x is 0.001,0,0"
        ) from None
    if not all(abs(one) <= FARTHEST for one in (x, y, z)):
        raise ValueError(f"--at {text}: each must lie in [-{FARTHEST:g}, {FARTHEST:g}] m")
    if any(abs(one) >= FAR for one in (x, y, z)):
        meant = ",".join(f"{one / 1e3:g}" for one in (x, y, z))
        output.note(
            f"--at {text}: farther away than a handle gets; positions are in metres, these in mm are {meant}"
        )
    return x, y, z


def _three(values: Sequence[float], scale: float = 1.0) -> str:
    return " ".join(f"{round(scale * one, 3) + 0.0:g}" for one in values)
