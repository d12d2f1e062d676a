"""Where the handle of a device can be: its workspace from above and from the side."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from ebac._core import Device, Gimbal, Linear, SlidingGimbal
from ebac._util.arguments import require
from ebac._util.arrays import Values
from ebac.plot.style import Picture, dress, legend, new_figure

#: Points along each side of a surface of joint angles.
STEPS = 60
FILL, EDGE = "#c9d3df", "#0072b2"


def plot_workspace(device: Device) -> Picture:
    """Draw where the handle of a device can be, and its lever in the middle and at the stops.

    Parameters
    ----------
    device : Device
        Of two or three axes.

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        For a device of one axis.
    """
    require(device, Device, "ebac.plot.plot_workspace", "a Device")
    if device.axes < 2:
        raise ValueError(
            "plot_workspace: a device of 1 axis moves along a line; give one of 2 or 3"
        )
    figure = new_figure(11, 4.9)
    above, side = figure.subplots(1, 2)
    _from_above(above, device)
    _from_the_side(side, device)
    figure.suptitle("workspace, computed from the kinematics", fontsize="medium")
    return figure


def _place(device: Device, q: Values) -> Values:
    """Return x, y, z of the handle [mm] over its place in the middle, at the angles of all joints."""
    k = device.kinematics
    at = np.zeros(3)
    at[: device.axes] = k.forward(q[: device.axes].tolist())
    if isinstance(k, Gimbal):
        at[2] = k.height(q[:2].tolist()) - k.radius
    return 1e3 * at


def _outline(device: Device, first: int, second: int, fixed: float = 0.0) -> Values:
    """Return the places around the range of two joints, the third at `fixed` of its stop, shape (n, 3)."""
    u, one = np.linspace(-1, 1, STEPS), np.ones(STEPS)
    around = np.concatenate([(u, -one), (one, u), (-u, one), (-one, -u)], axis=1)
    stops = np.pad(device.kinematics.stops, (0, 3 - device.axes))
    share = np.full((around.shape[1], 3), fixed)
    share[:, first], share[:, second] = around
    return np.array([_place(device, q) for q in share * stops])


def _from_above(ax: Axes, device: Device) -> None:
    slides = isinstance(device.kinematics, SlidingGimbal)
    for fixed, style, label in (
        (1.0, "--", "slide out"),
        (0.0, "-", "in its middle"),
        (-1.0, ":", "in"),
    ):
        if fixed and not slides:
            continue
        edge = _outline(device, 0, 1, fixed)
        ax.plot(edge[:, 0], edge[:, 1], style, color=EDGE, label=label)
        if fixed == 0:
            ax.fill(edge[:, 0], edge[:, 1], color=FILL)
    ax.set_aspect("equal")
    ax.set_title("from above", fontsize="medium", pad=22 if slides else None)
    dress(ax, "y [mm]")
    ax.set_xlabel("x [mm]")
    if slides:
        legend(ax)


def _from_the_side(ax: Axes, device: Device) -> None:
    edge = _outline(device, 0, 2)
    ax.fill(edge[:, 0], edge[:, 2], color=FILL)
    ax.plot(edge[:, 0], edge[:, 2], color=EDGE)
    if not isinstance(device.kinematics, Linear):
        foot = -1e3 * device.radius
        stop = float(device.kinematics.stops[0])
        for angle in (-stop, 0.0, stop):
            top = _place(device, np.array([angle, 0.0, 0.0]))
            ax.plot([0, top[0]], [foot, top[2]], color="black", lw=1.0)
        ax.plot([0], [foot], "o", color="black")
    ax.set_aspect("equal")
    ax.set_title("from the side, at y = 0", fontsize="medium")
    dress(ax, "z [mm]")
    ax.set_xlabel("x [mm]")
