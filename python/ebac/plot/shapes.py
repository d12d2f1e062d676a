"""Laws at several shapes: what every run came to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from ebac.plot.legends import figure_legend
from ebac.plot.maps import VERDICT_COLOURS
from ebac.plot.style import Picture, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies.shapes import ShapeRow, Shapes

#: What a run came to, best first.
VERDICTS = ("exact, quiet and passive", "gives out energy", "not exact", "not quiet", "swings")


@takes_its_class("ebac.studies.shapes")
def plot_shapes(found: Shapes) -> Picture:
    """Draw a panel for each stiffness: a line for each world and device, a column for each law.

    Parameters
    ----------
    found : Shapes
        What `ebac.studies.shapes` returned.

    Returns
    -------
    Figure
        The number in each field is the swing [mm].
    """
    laws = list(dict.fromkeys(row.law for row in found.rows))
    stiffnesses = list(dict.fromkeys(row.stiffness_N_per_m for row in found.rows))
    groups = {k: [row for row in found.rows if row.stiffness_N_per_m == k] for k in stiffnesses}
    longest = max(len(rows) for rows in groups.values()) // len(laws)
    figure = new_figure(2.2 + (0.6 + 0.85 * len(laws)) * len(stiffnesses), 1.6 + 0.22 * longest)
    panels = figure.subplots(1, len(stiffnesses), squeeze=False)[0]
    colours = ListedColormap(VERDICT_COLOURS)
    norm = BoundaryNorm(np.arange(len(VERDICTS) + 1) - 0.5, colours.N)
    for ax, (stiffness, rows) in zip(panels, groups.items(), strict=True):
        grid = np.array([verdict(row) for row in rows]).reshape(-1, len(laws))
        ax.imshow(grid, cmap=colours, norm=norm, aspect="auto")
        for i, row in enumerate(rows):
            swing = "fault" if row.swing_m is None else f"{1e3 * row.swing_m:.2f}"
            dark = grid.flat[i] in (0, len(VERDICTS) - 1)
            ax.text(
                i % len(laws), i // len(laws), swing, ha="center", va="center", fontsize=6.5,
                color="white" if dark else "black",
            )  # fmt: skip
        first = rows[:: len(laws)]
        ax.set_yticks(range(len(first)), [f"{row.world}, {row.axes} ax." for row in first])
        ax.set_xticks(range(len(laws)), laws, rotation=30, ha="right")
        ax.tick_params(length=0, labelsize="small")
        title = "own material" if stiffness is None else f"{1e-3 * stiffness:g} kN/m"
        ax.set_title(f"{title}; swing [mm]", fontsize="medium")
    patches = [Patch(color=c, label=v) for c, v in zip(VERDICT_COLOURS, VERDICTS, strict=True)]
    figure_legend(figure, patches, VERDICTS)
    late = found.timing.delay
    figure.suptitle(
        f"A hand of 300 N/m presses shapes, simulated; {1e-3 / found.timing.dt:g} kHz, "
        f"{late} {'sample' if late == 1 else 'samples'} of delay",
        fontsize="medium",
    )
    return figure


def verdict(row: ShapeRow) -> int:
    """Return which of `VERDICTS` a run came to, the worst that holds."""
    if not row.still:
        return 4
    if not row.quiet:
        return 3
    if row.exact is False:
        return 2
    return 0 if row.passive else 1
