"""Where the axes of a device stand, for people: a table, and how far the virtual world is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees
from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.hardware import AxisPosition


def show(
    positions: Sequence[AxisPosition], surfaces: Mapping[str, float], *, stderr: bool = False
) -> None:
    """Print where each axis stands, and the distance of each surface of the virtual world [m]."""
    console = output.console(stderr=stderr)
    heads = ["axis", "node", "drive counts", "zero", "from zero", "angle"]
    grid = output.table(heads, numbers=range(6))
    for one in positions:
        grid.add_row(
            str(one.axis),
            str(one.node),
            str(one.counts),
            str(one.zero_counts),
            f"{1e3 * one.position_m:+.2f} mm",
            f"{degrees(one.angle_rad):+.2f}°",
        )
    console.print(grid)
    console.print(world(surfaces), markup=False)


def world(surfaces: Mapping[str, float]) -> str:
    """Return in a sentence how far the handle is from each surface of the virtual world [m]."""
    if not surfaces:
        return "There is nothing to touch in the virtual world."
    parts = [
        f"{1e3 * way:.2f} mm before the {name}"
        if way >= 0
        else f"{-1e3 * way:.2f} mm inside the {name}"
        for name, way in surfaces.items()
    ]
    return f"The handle is {' and '.join(parts)}."
