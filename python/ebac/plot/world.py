"""A world of bodies: seen from a side, and cut through where the handle moves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from ebac._util import descriptions
from ebac._util.arguments import require
from ebac._util.arrays import Values
from ebac._util.sequences import require_each
from ebac.plot.style import Picture, colour, dress, legend, new_figure
from ebac.trace import Trace
from ebac.worlds import Body, World, distance

#: Half of the side of what is shown [m]: the least that shows whole every body that the last would.
HALVES = (0.05, 0.06, 0.07, 0.08, 0.09, 0.1)
#: Half of the side of the view, of half of that of what is shown.
WIDER = 1.2
#: Points along each side of a picture.
PIXELS = 480
#: From where it is seen: to the left of, before and above the handle.
EYE = np.array([-0.75, -0.55, 0.45])
#: Most steps of a ray, as one along a surface needs, and how near to a surface it ends [m].
STEPS, NEAR = 600, 2e-6
#: A path that is shorter is shown once more, in a frame of its own, and how much about it [m].
SHORT, AROUND = 0.01, 1e-3
BODY, SAWN, INSIDE = np.array([0.72, 0.77, 0.83]), np.array([0.6, 0.64, 0.69]), "#c9d3df"
#: A path that is farther than this from the plane of a cut only seems to go through what is cut there [m].
BESIDE = 1e-3
AWAY: dict[str, Any] = {"lw": 0.9, "ls": (0, (1, 2))}
#: What shows that a body moves.
MOVES = "#8b4a00"


def plot_world(world: World, traces: Sequence[Trace] = ()) -> Picture:
    """Draw a world: its surface as seen from the left, and a cut through z = 0; for three axes also one through y = 0.

    Parameters
    ----------
    world : World
        What moves is drawn in the middle of its swing; in the cuts, dashed, also at both ends.
    traces : sequence of Trace
        Runs whose paths are drawn, one colour per law.

    Returns
    -------
    Figure
    """
    require(world, World, "ebac.plot.plot_world", "a World")
    require_each(traces, Trace, "ebac.plot.plot_world", "traces, each a Trace")
    directions = (1, 2) if any(trace.axes > 2 for trace in traces) else (1,)
    figure = new_figure(5.5 + 5.5 * len(directions), 4.9)
    view, *cuts = figure.subplots(1, 1 + len(directions))
    half = max(_half(body) for body in world.bodies) if world.bodies else HALVES[0]
    _view(view, world, traces, half)
    for cut, across in zip(cuts, directions, strict=True):
        _cut(cut, world, traces, across, half)
    source = "simulated: " if traces else ""
    figure.suptitle(source + descriptions.world(world), fontsize="medium")
    return figure


def nearest(world: World, points: Values) -> tuple[Values, Values]:
    """Return distance to and direction away from the nearest body, shapes (n,) and (n, 3).

    What swings is in the middle of its swing.
    """
    best = np.full(len(points), np.inf)
    out = np.zeros((len(points), 3))
    for body in world.bodies:
        d, direction = distance(body.solid, points)
        closer = d < best
        best[closer], out[closer] = d[closer], direction[closer]
    return best, out


def _half(body: Body) -> float:
    """Return the least half of a side at which a body is whole; the first for one that goes on beyond the last."""
    u = np.linspace(-1, 1, 41)
    faces = [
        np.insert(np.stack(np.meshgrid(u, u), -1).reshape(-1, 2), axis, side, axis=1)
        for axis in range(3)
        for side in (-1, 1)
    ]
    cube = np.concatenate(faces)
    whole = (half for half in HALVES if (distance(body.solid, 0.95 * half * cube)[0] > 0).all())
    return next(whole, HALVES[0])


def _view(ax: Axes, world: World, traces: Sequence[Trace], half: float) -> None:
    """Draw what parallel rays meet; what hides the handle is cut open at z = 0."""
    forward = -EYE / np.linalg.norm(EYE)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    u = WIDER * np.linspace(-half, half, PIXELS)
    across, along = (one.ravel() for one in np.meshgrid(u, u))
    start = across[:, None] * right + along[:, None] * up - 3 * half * forward
    low, high = np.full(3, -half), np.full(3, half)
    if _hidden(world, forward, half):
        high = np.array([half, half, 0.0])  # cut open
    depth, shown = _entry(start, forward, low, high)
    places = _met(world, start, depth, shown, forward, half)
    d, out = nearest(world, places)
    inside = ((places >= low - 1e-6) & (places <= high + 1e-6)).all(axis=1)
    met = shown & (d <= 4 * NEAR) & inside
    light = np.clip(out @ -forward, 0, 1)
    sawn = met & (d < -NEAR)
    image = np.ones((len(places), 3))
    image[met] = BODY * (0.35 + 0.65 * light[met, None])
    image[sawn] = SAWN
    size = 1e3 * np.array([u[0], u[-1], u[0], u[-1]])
    ax.imshow(
        image.reshape(PIXELS, PIXELS, 3),
        origin="lower",
        extent=tuple(size),
        interpolation="bilinear",
    )
    to_view = 1e3 * np.stack([right, up])
    for trace in traces:  # on top of what hides it
        ax.plot(*(to_view @ _places(trace).T), color=colour(trace.law), lw=1.0)
    for body in world.bodies:
        if (end := to_view @ _swing(body)).any():
            _arrow(ax, -end, end, style="<|-|>", shade=MOVES)
    tail = to_view @ [-0.025, 0, 0]
    _arrow(ax, tail, (0, 0))  # where it comes in
    words = "handle comes in,\nalong x"
    ax.text(tail[0] - 1, tail[1], words, ha="right", va="center", fontsize="small")
    ax.set_xlim(*size[:2])
    ax.set_ylim(*size[2:])
    _frame(ax, to_view, 1e3 * half)
    ax.set_title("from the left, in front and above", fontsize="medium")
    dress(ax, "[mm]")
    ax.set_xlabel("[mm]")
    ax.grid(visible=False)


def _arrow(
    ax: Axes, tail: Values | Sequence[float], head: Values | Sequence[float],
    *, style: str = "-|>", shade: str = "black",
) -> None:  # fmt: skip
    arrow = {"arrowstyle": style, "color": shade, "lw": 1.6, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (head[0], head[1]), (tail[0], tail[1]), arrowprops=arrow)


def _frame(ax: Axes, to_view: Values, half: float) -> None:
    """Draw the three directions in the lower right, each a quarter of `half` [mm] long."""
    corner = half * np.array([0.84, -1.0])
    for name, unit in zip("xyz", np.eye(3), strict=True):
        tip = to_view @ (0.24e-3 * half * unit)
        _arrow(ax, corner, corner + tip)
        x, y = corner + 1.35 * tip
        ax.text(x, y, name, ha="center", va="center", fontsize="small")


def _swing(body: Body) -> Values:
    """Return how far a body swings to each side [m]."""
    motion = body.motion
    return np.array([motion.amplitude_x, motion.amplitude_y, motion.amplitude_z])


def _hidden(world: World, forward: Values, half: float) -> bool:
    """Return whether a body stands between the eye and the place where the handle comes in."""
    way = np.linspace(-3 * half, -1e-3, 300)[:, None] * forward
    way = way[(np.abs(way) <= half).all(axis=1)]
    return bool((nearest(world, way)[0] < -1e-4).any())


def _entry(
    start: Values, forward: Values, low: Values, high: Values
) -> tuple[Values, NDArray[np.bool_]]:
    """Return how far parallel rays go to the block that is shown, and whether they meet it."""
    sides = np.stack([(low - start) / forward, (high - start) / forward])
    first = sides.min(axis=0).max(axis=1)
    last = sides.max(axis=0).min(axis=1)
    return np.maximum(first, 0), first < last


def _met(
    world: World,
    start: Values,
    depth: Values,
    shown: NDArray[np.bool_],
    forward: Values,
    half: float,
) -> Values:
    """Return where rays meet a surface, by steps of the distance to it, or where they have left."""
    depth, going = depth.copy(), np.flatnonzero(shown)
    last = depth + 4 * half
    for _ in range(STEPS):
        d = nearest(world, start[going] + depth[going, None] * forward)[0]
        depth[going] += np.maximum(d, 0)
        going = going[(d > NEAR) & (depth[going] < last[going])]
        if len(going) == 0:
            break
    return start + depth[:, None] * forward


def _cut(ax: Axes, world: World, traces: Sequence[Trace], up: int, half: float) -> None:
    """Draw the plane of x and y (`up` 1) or z (2)."""
    _section(ax, world, up, (0.0, 0.0), half)
    moves = _ends(ax, world, up, half)
    paths = [_path(trace, up) for trace in traces]
    any_beside = False
    for trace, path in zip(traces, paths, strict=True):
        label = f"handle under {trace.law}" if trace.law else "handle"
        beside = np.abs(_places(trace)[:, 3 - up]) > BESIDE
        any_beside |= bool(beside.any())
        near, away = (np.where(hidden, np.nan, 1e3 * path) for hidden in (beside, ~beside))
        ax.plot(*near, color=colour(trace.law), lw=1.2, label=label)
        ax.plot(*away, color=colour(trace.law), alpha=0.6, **AWAY)
    if any_beside:
        ax.plot([], [], color="0.5", label="before or behind the cut", **AWAY)
    ax.plot([], [], "s", color=INSIDE, mec="black", ms=8, label="body")
    if moves:
        ax.plot([], [], color=MOVES, ls="--", lw=1.2, label="ends of its swing")
    if not traces:
        ax.plot([], [], color="black", marker=">", lw=1.6, label="motion along x")
        _arrow(ax, (-25, 0), (0, 0))
    ax.set_aspect("equal")
    ax.text(0.98, 0.98, f"cut at {'zy'[up - 1]} = 0", ha="right", va="top", transform=ax.transAxes)
    dress(ax, f"{'yz'[up - 1]} [mm]")
    ax.set_xlabel("x [mm]")
    legend(ax)
    if paths:
        _close(ax, world, traces, paths, up)


def _section(
    ax: Axes, world: World, up: int, middle: tuple[float, float], half: float, pixels: int = PIXELS
) -> None:
    """Draw a square of a plane, half its side in metres: bodies and their outlines."""
    u = np.linspace(-half, half, pixels)
    x, y = np.meshgrid(middle[0] + u, middle[1] + u)
    points = np.zeros((x.size, 3))
    points[:, 0], points[:, up] = x.ravel(), y.ravel()
    field = 1e3 * nearest(world, points)[0].reshape(x.shape)
    ax.contourf(1e3 * x, 1e3 * y, field, levels=[-1e6, 0], colors=[INSIDE])
    ax.contour(1e3 * x, 1e3 * y, field, levels=[0], colors="black", linewidths=1.0)


def _ends(ax: Axes, world: World, up: int, half: float) -> bool:
    """Draw the outlines of bodies that swing at both ends of it; return whether there are any."""
    u = np.linspace(-half, half, PIXELS // 2)
    x, y = np.meshgrid(u, u)
    points = np.zeros((x.size, 3))
    points[:, 0], points[:, up] = x.ravel(), y.ravel()
    moving = [body for body in world.bodies if _swing(body).any()]
    for body in moving:
        for end in (_swing(body), -_swing(body)):
            field = 1e3 * distance(body.solid, points - end)[0].reshape(x.shape)
            style: Any = {"colors": MOVES, "linewidths": 1.0, "linestyles": "--"}
            ax.contour(1e3 * x, 1e3 * y, field, levels=[0], **style)
    return bool(moving)


def _places(trace: Trace) -> Values:
    """Return where the handle is [m], shape (rows, 3)."""
    places = trace["true.x" if "true.x" in trace else "x"].reshape(len(trace), -1)
    return np.pad(places, ((0, 0), (0, 3 - places.shape[1])))


def _path(trace: Trace, up: int) -> Values:
    """Return the way of the handle in a plane [m], shape (2, rows)."""
    return _places(trace)[:, [0, up]].T


def _close(ax: Axes, world: World, traces: Sequence[Trace], paths: list[Values], up: int) -> None:
    """Show short paths once more from close by, in the lower left of a panel."""
    every = np.concatenate(paths, axis=1)
    low, high = every.min(axis=1), every.max(axis=1)
    size = float((high - low).max())
    if not size < SHORT:
        return
    x, y = (low + high) / 2
    half = size / 2 + AROUND
    ax.add_patch(
        Rectangle((0.02, 0), 0.38, 0.44, transform=ax.transAxes, fc="white", lw=0, zorder=3)
    )
    inset = ax.inset_axes((0.04, 0.06, 0.34, 0.34))
    _section(inset, world, up, (float(x), float(y)), half, PIXELS // 2)
    for trace, path in zip(traces, paths, strict=True):
        inset.plot(*1e3 * path, color=colour(trace.law), lw=1.2)
    inset.set_aspect("equal")
    inset.set_title("from close by, x [mm]", fontsize="small", pad=3)
    inset.tick_params(labelsize="small", left=False, labelleft=False)  # the scale of x
    inset.xaxis.set_major_locator(MaxNLocator(4))
    corner = 1e3 * (x - half), 1e3 * (y - half)
    ax.add_patch(Rectangle(corner, 2e3 * half, 2e3 * half, fc="none", ec="0.3", lw=0.8, zorder=3))
