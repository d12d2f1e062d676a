"""A gastroscopy from outside, through its camera and over time; the study of feedback."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from ebac.plot.style import Picture, colour, dress, legend, line, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.gastroscope import Gastroscopy, GastroscopyStudy

#: Before a touch, at which the camera still sees more than the wall [s].
BEFORE = 3.0
#: Points of a ring in the picture, and how far beyond the picture's edge it is drawn, where it is cut, in its radius.
AROUND, BEYOND = 241, 1.2
#: Fewer values than this are drawn one by one: they make no box.
FEW = 5
WALL, WAY, TARGET, LIMIT = "#c98c8c", "#0072b2", "#d55e00", "#cc0000"


@takes_its_class("ebac.gastroscope")
def plot_gastroscopy(run: Gastroscopy) -> Picture:
    """Draw the way from outside, the view of the camera, and the forces over time.

    Parameters
    ----------
    run : Gastroscopy
        What `gastroscope.gastroscopy` returned.

    Returns
    -------
    Figure
        The camera's views are those after a third of the time and 3 s before the last touch, or at the end.
    """
    figure = new_figure(11.5, 7.5)
    grid = figure.add_gridspec(2, 3, height_ratios=(1.5, 1), width_ratios=(1.15, 1, 1))
    _outside(figure.add_subplot(grid[:, 0], projection="3d"), run)
    rows = run.rows
    touches = np.flatnonzero(np.diff(rows["touched"]) > 0)
    last = rows["t"][touches[-1]] - BEFORE if len(touches) else rows["t"][-1]
    shown = (len(rows["t"]) // 3, int(np.searchsorted(rows["t"], last)))
    for column, row in enumerate(np.minimum(shown, len(rows["t"]) - 1)):
        _camera(figure.add_subplot(grid[0, 1 + column]), run, row)
    _forces(figure.add_subplot(grid[1, 1:]), run)
    found = run.findings
    figure.suptitle(
        f"Gastroscopy under {run.law}, simulated: {found['touched']:g} targets touched, pylorus "
        f"{'passed' if found['reached'] else 'not passed'} after {found['seconds']:.1f} s",
        fontsize="medium",
    )
    return figure


def _places(run: Gastroscopy) -> NDArray[np.float64]:
    return np.linspace(0.0, run.procedure.lumen.landmarks()["end"], 120)


def _rings(run: Gastroscopy, t: float, around: int = 25) -> NDArray[np.float64]:
    """Return rings of the wall, shape (places, around, 3) [m]."""
    points, axes, radius = run.procedure.lumen.line(_places(run), t)
    angle = np.linspace(0, 2 * np.pi, around)
    out = np.cos(angle)[:, None] * axes[:, None, 0] + np.sin(angle)[:, None] * axes[:, None, 1]
    rings: NDArray[np.float64] = points[:, None] + radius[:, None, None] * out
    return rings


def _outside(ax: Any, run: Gastroscopy) -> None:
    rings = 1e2 * _rings(run, 0.0)
    ax.plot_surface(*np.moveaxis(rings, 2, 0), color=WALL, alpha=0.22, linewidth=0, shade=True)
    rows = run.rows
    way = 1e2 * np.column_stack([rows["x"], rows["y"], rows["z"]])
    ax.plot(*way.T, color=WAY, lw=1.2, label="camera")
    lumen = run.procedure.lumen
    targets = np.array([lumen.target(p.place, p.angle) for p in run.procedure.polyps()])
    if len(targets):
        ax.scatter(*(1e2 * targets.T), color=TARGET, s=35, label="target", depthshade=False)
    ax.set_box_aspect(np.ptp(rings.reshape(-1, 3), axis=0), zoom=1.25)
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MaxNLocator(3))
    ax.set_xlabel("front [cm]", labelpad=12)
    ax.set_ylabel("left [cm]", labelpad=8)
    ax.set_zlabel("head [cm]", labelpad=16)
    ax.tick_params(axis="z", pad=7)
    ax.view_init(elev=12, azim=25)
    ax.legend(loc="upper left", bbox_to_anchor=(0.0, 1.26), fontsize="small")
    ax.set_title("from outside", fontsize="medium", y=1.18)


def _camera(ax: Axes, run: Gastroscopy, row: int) -> None:
    """Draw rings of the wall and targets as the camera sees them: a round picture, equidistant as of a wide lens."""
    rows = run.rows
    at = np.array([rows[k][row] for k in ("x", "y", "z")])
    ahead = np.array([rows[f"ahead_{k}"][row] for k in "xyz"])
    right = np.array([rows[f"right_{k}"][row] for k in "xyz"])
    down = np.cross(ahead, right)
    half = 0.5 * run.procedure.physician.field_of_view
    t = float(rows["t"][row])
    rings, place = _rings(run, t, AROUND), _places(run)
    picture = Circle((0, 0), 1, fc="0.12", lw=0)
    ax.add_patch(picture)

    def seen(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        own = (points - at) @ np.column_stack([right, down, ahead])
        aside = np.hypot(own[..., 0], own[..., 1])
        off = np.arctan2(aside, own[..., 2])
        share = np.where(off < BEYOND * half, off / np.maximum(aside, 1e-9) / half, np.nan)
        return share * own[..., 0], share * own[..., 1]

    for k in np.flatnonzero(
        (place > rows["place"][row] - 0.01) & (place < rows["place"][row] + 0.2)
    )[::-1]:
        distance = max(place[k] - float(rows["place"][row]), 0.0)
        (ring,) = ax.plot(
            *seen(rings[k]), color=WALL, lw=2.5, alpha=float(np.exp(-distance / 0.08))
        )
        ring.set_clip_path(picture)
    lumen = run.procedure.lumen
    for polyp in run.procedure.polyps():
        if abs(polyp.place - rows["place"][row]) < 0.1:
            u, v = seen(lumen.target(polyp.place, polyp.angle, t)[None])
            (mark,) = ax.plot(u, v, "o", color=TARGET, ms=11)
            mark.set_clip_path(picture)
    ax.spines[:].set_visible(False)
    ax.set_xlim(-1, 1)
    ax.set_ylim(1, -1)
    ax.set_aspect("equal")
    ax.set_xticks([])
    ax.set_yticks([])
    ax.set_title(f"camera at {t:.1f} s, {1e2 * rows['place'][row]:.0f} cm", fontsize="medium")


def _forces(ax: Axes, run: Gastroscopy) -> None:
    rows = run.rows
    line(ax, rows["t"], rows["section_force"], color=WAY, lw=0.9, label="tip and bending section")
    line(ax, rows["t"], rows["tube_force"], color="0.5", lw=0.9, label="tube")
    marks = run.procedure.lumen.landmarks()
    if marks["end"] > marks["behind"]:  # a lumen of a user's own may have no pylorus
        narrow = rows["t"][rows["place"] >= marks["pylorus"]]
        if len(narrow) > 1:  # it presses until the run ends behind it
            ax.axvspan(*narrow[[0, -1]], color="0.9", lw=0, zorder=0, label="in the pylorus")
    limit = run.procedure.lumen.patient.force_limit
    ax.axhline(limit, color=LIMIT, lw=1, ls="--", label=f"limit, {limit:g} N")
    dress(ax, "force of the wall [N]")
    ax.set_xlabel("time [s]")
    legend(ax)


@takes_its_class("ebac.gastroscope")
def plot_gastroscopy_study(found: GastroscopyStudy) -> Picture:
    """Draw the largest tissue force of every physician without and with feedback, and the effect.

    Parameters
    ----------
    found : GastroscopyStudy
        What `gastroscope.gastroscopy_study` returned.
    """
    figure = new_figure(11, 4.5)
    left, right = figure.subplots(1, 2, width_ratios=(1.7, 1))
    _largest(left, found)
    for k, effect in enumerate(found.effects):
        own = colour(effect.law)
        right.plot([effect.low_N, effect.high_N], [k, k], color=own, lw=2)
        right.plot(effect.difference_N, k, "o", color=own)
    right.axvline(0, color="0.4", lw=0.8)
    names = [f"{one.law}, {1e3 * one.delay_s:g} ms" for one in found.effects]
    right.set_yticks(range(len(names)), names)
    right.invert_yaxis()
    dress(right, "")
    right.margins(x=0.08)
    right.set_xlabel("change by feedback [N], mean and 95 % interval")
    count = len(next(iter(found.runs.values()))["most_section"])
    figure.suptitle(
        f"{count} simulated physicians, each with and without force feedback, by law and delay of the link",
        fontsize="medium",
    )
    return figure


def _largest(ax: Axes, found: GastroscopyStudy) -> None:
    """Draw the largest forces beside each other, without feedback in grey and with it in the colour of the law."""
    pairs = list(dict.fromkeys((law, delay) for law, delay, _ in found.runs))
    for place, (law, delay) in enumerate(pairs):
        for fed, aside in ((False, -0.18), (True, 0.18)):
            values = found.runs[law, delay, fed]["most_section"]
            own, at = colour(law) if fed else "0.6", place + aside
            if len(values) < FEW:
                ax.plot(np.full(len(values), at), values, ".", ms=8, color=own)
                continue
            box = ax.boxplot(
                values,
                positions=[at],
                widths=0.3,
                sym=".",
                patch_artist=True,
                boxprops={"facecolor": own, "alpha": 0.5},
                medianprops={"color": "black", "lw": 1.5},
                flierprops={"markerfacecolor": own, "markeredgecolor": own},
            )
            box["boxes"][0].set_edgecolor(own)
    for law in dict.fromkeys(law for law, _ in pairs):
        ax.plot([], [], "s", color=colour(law), label=f"with feedback, {law}")
    ax.plot([], [], "s", color="0.6", label="without")
    limit = found.force_limit_N
    ax.axhline(limit, color=LIMIT, lw=1, ls="--", label=f"limit, {limit:g} N")
    ax.set_xticks(range(len(pairs)), [f"{law}\n{1e3 * delay:g} ms" for law, delay in pairs])
    ax.set_xlabel("law and delay of the link")
    dress(ax, "largest force on tissue [N]")
    ax.set_xlim(-0.5, len(pairs) - 0.5)
    ax.set_ylim(bottom=0)
    legend(ax)
