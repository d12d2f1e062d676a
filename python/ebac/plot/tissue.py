"""Soft materials: force over depth beside the closed form, and what the handle feels of them under each law."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from ebac.plot.style import Picture, colour, dress, figure_legend, line, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies.tissue import Tissue
    from ebac.trace import Trace
    from ebac.worlds.force_depth import ForceDepth

IN, OUT, EXACT = "#0072b2", "#d55e00", "0.7"
#: A force that goes further than this many times its range to and fro is drawn pale, and as its mean over a time [s].
BUZZ, MEAN = 20, 0.01


@takes_its_class("ebac.studies.tissue")
def plot_tissue(found: Tissue) -> Picture:
    """Draw a column for each material: its curves, and below them a row for the force under each law.

    Parameters
    ----------
    found : Tissue
        What `ebac.studies.tissue` returned.

    Returns
    -------
    Figure
        With the first row alone where no law was run.
    """
    names, laws = list(found.curves), list(dict.fromkeys(row.law for row in found.rows))
    heights = [1.5, *[1.0] * len(laws)]
    figure = new_figure(1.0 + 3.1 * len(names), 1.2 + 1.7 * sum(heights))
    grid = figure.subplots(
        len(heights), len(names), squeeze=False, sharex="col", height_ratios=heights
    )
    for name, ax in zip(names, grid[0], strict=True):
        _curve(ax, found.curves[name])
        ax.set_title(name, fontsize="medium")
    for row, trace in zip(found.rows, found.traces, strict=True):
        _felt(grid[1 + laws.index(row.law), names.index(row.material)], trace, row.law)
    for column in grid.T:
        _one_scale(column[1:])
    for ax in grid.flat:
        dress(ax, "")
    for ax in grid[-1]:
        ax.set_xlabel("depth [mm]")
    grid[0, 0].set_ylabel("material\nforce [N]")
    for law, ax in zip(laws, grid[1:, 0], strict=True):
        ax.set_ylabel(f"{law}\nmotor force [N]")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure_legend(figure, handles, labels, columns=len(labels))
    speed = next(iter(found.curves.values())).speed
    title = f"Soft materials, pressed and let out at {1e3 * speed:g} mm/s"
    if laws:
        title += (
            "; below, simulated: a hand of 300 N/m presses and lets go;\n"
            f"a force that goes to and fro is pale, its mean over {1e3 * MEAN:g} ms is a line"
        )
    figure.suptitle(title, fontsize="medium")
    return figure


def _one_scale(axes: Sequence[Axes]) -> None:
    """Give the laws of a material the same range of force."""
    ranges = np.array([ax.get_ylim() for ax in axes])
    for ax in axes:
        ax.set_ylim(ranges[:, 0].min(), ranges[:, 1].max())


def _curve(ax: Axes, curve: ForceDepth) -> None:
    depth, half = 1e3 * curve.depth, len(curve.depth) // 2
    line(ax, depth, curve.force_exact, color=EXACT, lw=4.5, label="closed form")
    line(ax, depth[:half], curve.force[:half], color=IN, lw=1.2, label="in")
    line(ax, depth[half:], curve.force[half:], color=OUT, lw=1.2, label="out")
    text = f"{1e3 * curve.taken:.1f} mJ in\n{1e3 * curve.back:.1f} mJ back"
    ax.text(0.05, 0.95, text, transform=ax.transAxes, va="top", fontsize="small")


def _felt(ax: Axes, trace: Trace, law: str) -> None:
    from ebac.studies.tissue import SURFACE

    depth = 1e3 * (trace["true.x"] - SURFACE)
    shown = depth > -1
    force = trace["true.f_motor"][shown]
    way = float(np.abs(np.diff(force)).sum())  # N
    if way > BUZZ * float(np.ptp(force)):
        line(ax, depth[shown], force, color=colour(law), lw=0.3, alpha=0.25)
        rows = max(1, round(MEAN / float(trace["t"][1] - trace["t"][0])))
        force = np.convolve(trace["true.f_motor"], np.full(rows, 1 / rows), "same")[shown]
    line(ax, depth[shown], force, color=colour(law), lw=0.9)
