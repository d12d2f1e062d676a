"""A tracked path with its fit, its deviation exaggerated, and a histogram; an error budget beside the table."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from ebac._util.arrays import Values
from ebac.plot.style import Picture, dress, legend, new_figure
from ebac.plot.takes import takes_its_class
from ebac.tracking.circle import CircleFit
from ebac.tracking.line import LineFit
from ebac.tracking.table import TABLE_I

if TYPE_CHECKING:
    from ebac.tracking.budget import Budget
    from ebac.tracking.evaluate import Tracking

FIT, PATH, PAPER = "#d55e00", "#0072b2", "#000000"
#: The largest deviation is drawn as about this share of the path.
SHOWN = 0.15


@takes_its_class("ebac.tracking.evaluate")
def plot_tracking(tracking: Tracking) -> Picture:
    """Draw a path with its fit as in Fig. 8 and 9, its deviation exaggerated, and its deviations as a histogram.

    Parameters
    ----------
    tracking : Tracking
        What `ebac.tracking.evaluate` returned.
    """
    return _draw_tracking(tracking, narrow=False)


def _draw_tracking(tracking: Tracking, *, narrow: bool) -> Picture:
    figure = new_figure(5, 10) if narrow else new_figure(14, 5)
    figure.narrow = partial(_draw_tracking, tracking, narrow=True)
    left, middle, right = figure.subplots(3, 1) if narrow else figure.subplots(1, 3)
    flat, draw, across = _flat(tracking)
    fit, d = tracking.fit, tracking.fit.deviation
    counted = fit.inliers
    simulated = tracking.path.remark == "simulated"
    left.plot(
        *(1e3 * flat[counted].T),
        ".",
        ms=3,
        color="black",
        label="simulated path" if simulated else "path",
    )
    if d.outliers:
        left.plot(*(1e3 * flat[~counted].T), "x", ms=5, color="#cc79a7", label="outliers")
    left.plot(*(1e3 * draw.T), color=FIT, lw=1.4, label="fit")
    factor = _factor(float(np.ptp(flat[counted], axis=0).max()), d.largest_m)
    nearest = flat - across
    shown = (nearest + factor * across)[counted]
    middle.plot(*(1e3 * draw.T), color=FIT, lw=1.2, label="fit")
    middle.plot(*(1e3 * shown.T), color=PATH, lw=0.8, label=f"deviation {factor:g} times as large")
    names = _axis_names(tracking)
    for ax in (left, middle):
        ax.set_aspect("equal", adjustable="datalim")
        dress(ax, names[1])
        ax.set_xlabel(names[0])
        legend(ax, columns=3)
    _histogram(right, fit)
    what = f"circle of radius {1e3 * fit.radius:.3f} mm" if isinstance(fit, CircleFit) else "line"
    if isinstance(fit, CircleFit) and len(fit.centre) == 3:
        what += f", out of its plane {1e3 * fit.out_of_plane_rms_m:.3f} mm rms"
    left_out = f" and {d.outliers} outliers" if d.outliers else ""
    figure.suptitle(
        f"{tracking.path.name}: {what}, SD {1e3 * d.sd_m:.3f} mm, path error {1e3 * d.error_m:.3f} mm, "
        f"largest {1e3 * d.largest_m:.3f} mm, {d.n} points{left_out}",
        fontsize="medium",
    )
    return figure


def _axis_names(tracking: Tracking) -> tuple[str, str]:
    """Return what the axes show: those of the file, or in space two of the fit."""
    if tracking.path.points.shape[1] == 2:
        return "x [mm]", "y [mm]"
    if isinstance(tracking.fit, LineFit):
        return "along the fit [mm]", "across the fit, one of two directions [mm]"
    return "in the plane of the fit [mm]", "in the plane, across [mm]"


def _factor(size: float, largest: float) -> float:
    """Return 1, 2 or 5 times a power of ten."""
    if largest <= 0:
        return 1.0
    wanted = max(SHOWN * size / largest, 1.0)
    decade = float(10 ** np.floor(np.log10(wanted)))
    return float(max(step for step in (1, 2, 5) if step * decade <= wanted) * decade)


def _flat(tracking: Tracking) -> tuple[Values, Values, Values]:
    """Return the path in the plane of its fit, the fit to draw, and the vectors from the fit to the path [m]."""
    fit, points = tracking.fit, tracking.path.points
    if isinstance(fit, CircleFit):
        out = np.stack([np.cos(fit.angle), np.sin(fit.angle)], axis=1)
        centre = fit.centre if len(fit.centre) == 2 else np.zeros(2)
        turn = np.linspace(0, 2 * np.pi, 361)
        draw = centre + fit.radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return (
            centre + (fit.radius + fit.residuals)[:, None] * out,
            draw,
            fit.residuals[:, None] * out,
        )
    ends = np.array([fit.along[fit.inliers].min(), fit.along[fit.inliers].max()])
    if points.shape[1] == 2:
        normal = np.array([-fit.direction[1], fit.direction[0]])
        draw = fit.point + ends[:, None] * fit.direction
        return points, draw, fit.residuals[:, None] * normal
    across = np.stack([np.zeros(len(points)), fit.residuals[:, 0]], axis=1)
    along = np.stack([fit.along, np.zeros(len(points))], axis=1)
    return along + across, np.stack([ends, np.zeros(2)], axis=1), across


def _histogram(ax: Axes, fit: LineFit | CircleFit) -> None:
    d, in_space = fit.deviation, fit.residuals.ndim == 2
    kept = 1e3 * fit.residuals[fit.inliers]
    if in_space:  # two directions across a line: the distance has no sign and no normal curve
        kept = np.hypot(kept[:, 0], kept[:, 1])
    ax.hist(kept, bins=min(60, max(10, len(kept) // 20)), density=True, color="0.8")
    sd = 1e3 * d.sd_m
    if sd > 0 and not in_space:
        x = np.linspace(-4 * sd, 4 * sd, 200)
        normal = np.exp(-0.5 * (x / sd) ** 2) / (sd * np.sqrt(2 * np.pi))
        ax.plot(x, normal, color="0.35", lw=1, label="normal, same SD")
    sign = "" if in_space else "±"
    for value, colour, name in ((sd, FIT, "SD"), (1e3 * d.error_m, PATH, "path error")):
        ax.axvline(value, color=colour, lw=1.2, label=sign + name)
        if not in_space:
            ax.axvline(-value, color=colour, lw=1.2)
    dress(ax, "density [1/mm]")
    sides = (
        "outside (+), inside (-) [mm]" if isinstance(fit, CircleFit) else "left (+), right (-) [mm]"
    )
    ax.set_xlabel("distance from the line [mm]" if in_space else sides)
    legend(ax, columns=3)


@takes_its_class("ebac.tracking.budget")
def plot_budget(budget: Budget) -> Picture:
    """Draw the standard deviation of each source beside the paper's, for the line and the circle.

    Parameters
    ----------
    budget : Budget
        What `ebac.tracking.error_budget` returned.
    """
    return _draw_budget(budget, narrow=False)


def _draw_budget(budget: Budget, *, narrow: bool) -> Picture:
    figure = new_figure(5, 6.5) if narrow else new_figure(11, 4.6)
    figure.narrow = partial(_draw_budget, budget, narrow=True)
    panels = figure.subplots(2, 1) if narrow else figure.subplots(1, 2, sharey=True)
    names = list(dict.fromkeys(r.source for r in budget.rows))
    for ax, shape in zip(panels, ("line", "circle"), strict=True):
        rows = [budget.row(shape, name) for name in names]
        at = np.arange(len(rows))
        low = [1e3 * (r.sd_m - r.sd_low_m) for r in rows]
        high = [1e3 * (r.sd_high_m - r.sd_m) for r in rows]
        ax.bar(at, [1e3 * r.sd_m for r in rows], yerr=[low, high], width=0.6, color=PATH, alpha=0.8,
               capsize=4, label="simulated: median, 5 % to 95 %")  # fmt: skip
        paper = [1e3 * e.sd_m for e in TABLE_I if e.shape == shape]
        ax.plot(
            len(rows) + np.linspace(-0.15, 0.15, len(paper)),
            paper,
            "o",
            color=PAPER,
            label="paper, Table I",
        )
        ax.set_xticks([*at, len(rows)], [*names, "paper"], rotation=15)
        dress(ax, f"SD about the {shape} [mm]")
        legend(ax, columns=2)
    figure.suptitle(
        f"Error budget of {budget.runs} simulated joysticks; sizes of the errors are assumptions",
        fontsize="medium",
    )
    return figure
