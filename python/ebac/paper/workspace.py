"""Fig. 6 and 7: where the handle of the joystick can go."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ebac import presets
from ebac._core import Gimbal
from ebac._util.arrays import Values
from ebac.paper.finding import Finding, judge, row

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ebac.plot import Picture

STEPS = 41


def joystick() -> Gimbal:
    """Return the kinematics of the paper's device."""
    kinematics = presets.device("joystick").kinematics
    if not isinstance(kinematics, Gimbal):
        raise TypeError("the joystick is no gimbal")
    return kinematics


def angles(gimbal: Gimbal) -> Values:
    """Return joint angles over the whole range of eq. (11) [rad], shape (STEPS, STEPS, 2)."""
    q = np.linspace(-gimbal.limit, gimbal.limit, STEPS)
    return np.stack(np.meshgrid(q, q, indexing="ij"), axis=-1)


def surface(gimbal: Gimbal) -> Values:
    """Return the handle positions x, y, z [m] over the whole range, shape (STEPS, STEPS, 3)."""
    grid = angles(gimbal).reshape(-1, 2)
    points = [(*gimbal.forward(q), gimbal.height(q)) for q in grid.tolist()]
    return np.array(points).reshape(STEPS, STEPS, 3)


def fig6() -> Finding:
    """Check the workspace in space: two crossed axes, no singularity, a unique inverse."""
    gimbal = joystick()
    grid, points = angles(gimbal), surface(gimbal)
    off = float(np.abs(points - _turned(grid, gimbal.radius)).max())
    flat: list[list[float]] = grid.reshape(-1, 2).tolist()
    gain = min(float(np.linalg.svd(gimbal.jacobian(q)).S[-1]) for q in flat)
    back = max(float(np.abs(gimbal.inverse(list(gimbal.forward(q))) - q).max()) for q in flat)
    return Finding(
        name="fig6",
        title="Fig. 6: the workspace in space",
        claim="The handle moves on a sphere of 100 mm radius, +-30 deg about both axes, eq. (11), "
        "without a singularity and with a unique mapping.",
        rows=[
            row("largest distance from two rotations of a lever, multiplied out", off, "m"),
            row("lowest point below the top", gimbal.radius - float(points[..., 2].min()), "m"),
            row("smallest singular value of the Jacobian", gain, "m/rad"),
            row("largest error of inverse after forward", back, "rad"),
        ],
        verdict=judge(off < 1e-12, gain > 0.01, back < 1e-12),
        why="Radius and limits are inputs, so they are not compared with the paper. What follows from "
        "them does hold: the Jacobian keeps full rank up to the limits (its smallest singular value "
        "is far from zero), and the inverse gives every joint angle back.",
        figure=_draw_surface(points),
    )


def _turned(grid: Values, radius: float) -> Values:
    """Return where two rotations about crossed axes, multiplied out, take the end of a lever [m]."""
    first, second = np.moveaxis(grid, -1, 0)
    tip = np.zeros((*first.shape, 3))
    tip[..., 2] = radius
    inner = np.stack(  # about x, so that the tip leans along y
        [tip[..., 0], np.sin(second) * tip[..., 2], np.cos(second) * tip[..., 2]], axis=-1
    )
    return np.stack(  # then about y, so that it leans along x
        [
            np.cos(first) * inner[..., 0] + np.sin(first) * inner[..., 2],
            inner[..., 1],
            -np.sin(first) * inner[..., 0] + np.cos(first) * inner[..., 2],
        ],
        axis=-1,
    )


def fig7() -> Finding:
    """Check the workspace seen from above: its reach."""
    gimbal = joystick()
    points = surface(gimbal)
    width = float(np.ptp(points[..., 0]))
    depth = float(np.ptp(points[..., 1]))
    corner = float(np.ptp(points[[0, -1], [0, -1], 0]))
    return Finding(
        name="fig7",
        title="Fig. 7: the workspace seen from above",
        claim="It has a large working space, 200 mm in translation.",
        rows=[
            row("reach along x, chord", width, "m", 0.2),
            row("reach along y, chord", depth, "m", 0.2),
            row("reach along x with y at its limit", corner, "m"),
            row("arc of either joint", 2 * gimbal.radius * gimbal.limit, "m"),
            row("diameter of the whole sphere, twice the lever", 2 * gimbal.radius, "m"),
        ],
        verdict=judge(width >= 0.2, depth >= 0.2),
        why="+-30 deg on a lever of 100 mm span a chord of 100 mm along either axis. The paper's "
        "200 mm are the diameter of the whole sphere, which the handle cannot reach.",
        figure=_draw_plan(points, gimbal.radius),
    )


def _draw_surface(points: Values) -> Picture:
    from ebac.plot import new_figure

    x, y, z = 1e3 * np.moveaxis(points, -1, 0)
    figure = new_figure(8, 5.2)
    ax = figure.add_subplot(projection="3d")
    ax.plot_surface(x, y, z, cmap="viridis", rstride=2, cstride=2, edgecolor="white", lw=0.3)
    ax.set(xlabel="x [mm]", ylabel="y [mm]", zlabel="z [mm]", zticks=[80, 90, 100])
    ax.xaxis.labelpad = ax.yaxis.labelpad = 12
    ax.set_box_aspect((np.ptp(x), np.ptp(y), np.ptp(z)), zoom=1.25)
    ax.view_init(elev=28, azim=-55)
    figure.suptitle(
        "computed: handle positions of the joystick, lever of 100 mm, ±30° about each axis",
        fontsize="medium",
    )
    return figure


def _draw_plan(points: Values, radius: float) -> Picture:
    from ebac.plot import dress, new_figure

    x, y, _ = 1e3 * np.moveaxis(points, -1, 0)
    figure = new_figure(7.5, 7.5)
    ax = figure.add_subplot()
    for i in range(0, STEPS, 5):
        ax.plot(x[i], y[i], color="#009e73", lw=0.8)
        ax.plot(x[:, i], y[:, i], color="#009e73", lw=0.8)
    turn = np.linspace(0, 2 * np.pi, 361)
    ax.plot(1e3 * radius * np.cos(turn), 1e3 * radius * np.sin(turn), color="0.4", ls="--")
    middle = STEPS // 2
    _measure(
        ax, float(x[0, middle]), float(x[-1, middle]), -62, "reach: chord of 100 mm", "#007a59"
    )
    _measure(ax, -1e3 * radius, 1e3 * radius, -112, "sphere: diameter of 200 mm", "0.25")
    figure.suptitle(
        "computed: handle positions of the joystick from above, ±30° about each axis",
        fontsize="medium",
    )
    ax.set_aspect("equal")
    ax.set(xlim=(-125, 125), ylim=(-125, 125), xlabel="x [mm]")
    dress(ax, "y [mm]")
    return figure


def _measure(ax: Axes, left: float, right: float, y: float, text: str, shade: str) -> None:
    """Draw a dimension line from `left` to `right` with its text below [mm]."""
    ax.annotate(
        "",
        (left, y),
        (right, y),
        arrowprops={"arrowstyle": "<->", "color": shade, "shrinkA": 0, "shrinkB": 0},
    )
    for end in (left, right):
        ax.plot([end, end], [0, y], color=shade, lw=0.7, ls=":")
    ax.text((left + right) / 2, y - 2, text, ha="center", va="top", color=shade)
