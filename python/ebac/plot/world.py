"""A world of bodies: seen from a side, and cut through where the handle moves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from ebac.plot.style import Numbers, Picture, colour, dress, legend, new_figure
from ebac.trace import Trace
from ebac.worlds import World, distance

#: Half of the side of what is shown [m].
HALF = 0.05
#: Points along each side of a picture.
PIXELS = 320
#: From where it is seen: to the left of, before and above the handle.
EYE = np.array([-0.75, -0.55, 0.45])
#: Most steps of a ray, and how near to a surface it ends [m].
STEPS, NEAR = 120, 2e-5
BODY, INSIDE = np.array([0.72, 0.77, 0.83]), "#c9d3df"


def plot_world(world: World, traces: Sequence[Trace] = ()) -> Picture:
    """Draw a world: its surface as seen from the left, and a cut through the plane z = 0.

    Parameters
    ----------
    world : World
        At the time 0; what moves is drawn where it begins.
    traces : sequence of Trace
        Runs whose paths are drawn into the cut, one colour per law.

    Returns
    -------
    Figure
    """
    figure = new_figure(11, 4.9)
    view, cut = figure.subplots(1, 2)
    _view(view, world)
    _cut(cut, world, traces)
    figure.suptitle(
        "; ".join(type(body.solid).__name__ for body in world.bodies), fontsize="medium"
    )
    return figure


def nearest(world: World, points: Numbers) -> tuple[Numbers, Numbers]:
    """Return distance to and direction away from the nearest body at the time 0, shapes (n,) and (n, 3)."""
    best = np.full(len(points), np.inf)
    out = np.zeros((len(points), 3))
    for body in world.bodies:
        d, direction = distance(body.solid, points)
        closer = d < best
        best[closer], out[closer] = d[closer], direction[closer]
    return best, out


def _view(ax: Axes, world: World) -> None:
    """Follow parallel rays until they meet a surface; what is nearer than the cut of a cavity is left out."""
    forward = -EYE / np.linalg.norm(EYE)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    u = np.linspace(-1.35 * HALF, 1.35 * HALF, PIXELS)
    across, along = (one.ravel() for one in np.meshgrid(u, u))
    start = across[:, None] * right + along[:, None] * up - 3 * HALF * forward
    depth, shown = _cube_entry(start, forward)
    end = depth + 4 * HALF
    alive = shown.copy()
    for _ in range(STEPS):
        d, _out = nearest(world, start[alive] + depth[alive, None] * forward)
        depth[alive] += np.maximum(d, 0)
        going = np.flatnonzero(alive)
        alive[going] = (d > NEAR) & (depth[going] < end[going])
        if not alive.any():
            break
    places = start + depth[:, None] * forward
    d, out = nearest(world, places)
    met = shown & (d <= 4 * NEAR) & (np.abs(places) <= HALF + 1e-6).all(axis=1)
    light = np.clip(out @ -forward, 0, 1)
    sawn = met & (d < -NEAR)  # the edge of what is shown runs through a body
    image = np.ones((len(places), 3))
    image[met] = BODY * (0.35 + 0.65 * light[met, None])
    image[sawn] = 0.55 * BODY
    size = 1e3 * np.array([u[0], u[-1], u[0], u[-1]])
    ax.imshow(
        image.reshape(PIXELS, PIXELS, 3),
        origin="lower",
        extent=tuple(size),
        interpolation="bilinear",
    )
    tip, tail = (
        [1e3 * p @ right, 1e3 * p @ up] for p in (np.zeros(3), np.array([-0.025, 0.0, 0.0]))
    )
    ax.annotate("", tip, tail, arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 1.6})
    ax.text(tail[0], tail[1] + 2, "handle, +x", fontsize="small", ha="center")
    ax.set_title("from the left, in front and above", fontsize="medium")
    dress(ax, "[mm]")
    ax.set_xlabel("[mm]")
    ax.grid(visible=False)


def _cube_entry(start: Numbers, forward: Numbers) -> tuple[Numbers, np.ndarray]:
    """Return where rays enter the cube that is shown, and whether they do."""
    sides = np.stack([(-HALF - start) / forward, (HALF - start) / forward])
    first = sides.min(axis=0).max(axis=1)
    last = sides.max(axis=0).min(axis=1)
    return np.maximum(first, 0), first < last


def _cut(ax: Axes, world: World, traces: Sequence[Trace]) -> None:
    u = np.linspace(-HALF, HALF, PIXELS)
    x, y = np.meshgrid(u, u)
    d, _ = nearest(world, np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1))
    field = 1e3 * d.reshape(x.shape)
    ax.contourf(1e3 * u, 1e3 * u, field, levels=[-1e6, 0], colors=[INSIDE])
    ax.contour(1e3 * u, 1e3 * u, field, levels=[0], colors="black", linewidths=1.0)
    for trace in traces:
        places = trace["true.x" if "true.x" in trace else "x"].reshape(len(trace), -1)
        across = places[:, 1] if trace.axes > 1 else np.zeros(len(trace))
        ax.plot(1e3 * places[:, 0], 1e3 * across, color=colour(trace.law), lw=1.2, label=trace.law)
    if not traces:
        ax.annotate(
            "", (0, 0), (-25, 0), arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 1.6}
        )
    ax.set_aspect("equal")
    ax.set_title("cut at z = 0", fontsize="medium")
    dress(ax, "y [mm]")
    ax.set_xlabel("x [mm]")
    if traces:
        legend(ax)
