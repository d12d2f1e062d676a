"""Pictures of a fit of an arm or a device."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ebac.plot.style import dress, legend, line, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ebac.identify.device import DeviceResult
    from ebac.identify.result import ArmResult
    from ebac.plot.style import Picture


def plot_arm(result: ArmResult, recording: int = 0) -> Picture:
    """Draw motion and model, force, errors, their correlations and the frequency response, of one recording."""
    figure = new_figure(10, 13)
    motion, force, left, auto, size, follows = figure.subplots(
        6, 1, height_ratios=[2, 1.2, 1.2, 1.2, 1.6, 0.8]
    )
    r = result.recordings[recording]
    assert r.force is not None
    model = result.simulated(recording)
    line(motion, r.t, 1e3 * r.x, color="0.35", lw=1.6, label="measured")
    line(
        motion,
        r.t,
        1e3 * model,
        color="#009e73",
        lw=1.0,
        ls="--",
        label="hand, from the force alone",
    )
    dress(motion, "position [mm]")
    legend(motion)
    line(force, r.t, r.force, color="#0072b2", lw=0.8)
    dress(force, "force [N]")
    line(left, r.t, 1e3 * (r.x - model), color="#d55e00", lw=0.8)
    dress(left, "error [mm]")
    left.set_xlabel("time [s]")
    _correlations(auto, result, r.name)
    _response(size, follows, result, recording)
    figure.suptitle(
        f"{r.name}: " + ", ".join(str(e) for e in list(result.estimates.values())[:3]),
        fontsize="medium",
    )
    return figure


def _response(size: Axes, follows: Axes, result: ArmResult, recording: int) -> None:
    """Draw |Z(f)| as measured and as fitted, and the coherence; a log too short for it stays without."""
    from ebac.identify.response import frequency_response

    r, target = result.recordings[recording], result.problem.targets[recording]
    theta = result.values[result.parameters.places[recording]]
    mass, damping, stiffness = theta[:3].tolist()
    levels = theta[result.parameters.before_levels :]
    try:
        z = frequency_response(r, target, levels, stiffness)
    except ValueError as error:
        for ax in (size, follows):
            ax.text(0.5, 0.5, str(error), ha="center", transform=ax.transAxes, fontsize="small")
        return
    f = z.frequency
    size.errorbar(
        f,
        np.abs(z.stiffness),
        yerr=z.deviation(),
        fmt=".",
        color="0.45",
        ecolor="0.8",
        label="H1, one deviation",
    )
    if z.by_target is not None:
        size.plot(f, np.abs(z.by_target), "+", color="#0072b2", ms=5, label="target as instrument")
    size.plot(
        f, np.abs(z.model(mass, damping, stiffness)), color="#009e73", label="eq. (4) as fitted"
    )
    size.set(xscale="log", yscale="log")
    model = np.abs(z.model(mass, damping, stiffness))
    size.set_ylim(0.2 * model.min(), 5 * model.max())
    dress(size, "|Z| = |K0 + B0 s + M0 s²|\n[N/m]")
    legend(size)
    follows.plot(f, z.coherence, color="0.3", lw=1)
    follows.axhline(
        z.significant, color="#d55e00", lw=0.8, ls="--", label="by chance, 5 % of lines"
    )
    follows.set(xscale="log", ylim=(0, 1.05))
    follows.set_xlabel("frequency [Hz]")
    dress(follows, "coherence")
    legend(follows)


def plot_device(result: DeviceResult) -> Picture:
    """Draw motion, force and model, and friction over speed: what is left when inertia and weight are taken off."""
    from ebac.identify.device_problem import columns_of

    figure = new_figure(10, 9)
    motion, force, friction = figure.subplots(3, 1, height_ratios=[1, 1.2, 1.6])
    r, drive = result.recording, result.drive
    line(motion, r.t, 1e3 * r.x, color="0.35", lw=1.2)
    dress(motion, "position [mm]")
    on = drive.slides
    columns = columns_of(drive, result.stribeck_speed)
    model = np.full(len(r.t), np.nan)
    model[on] = columns @ result.values
    line(force, r.t, -drive.smooth_force, color="0.35", lw=1.4, label="measured, smoothed")
    force.plot(
        r.t, model, color="#009e73", lw=1.0, ls="--", label="eq. (6) with friction, where it slides"
    )
    dress(force, "driving force [N]")
    force.set_xlabel("time [s]")
    legend(force)
    left = -drive.smooth_force[on] - columns[:, [0, 3]] @ result.values[[0, 3]]
    v = drive.velocity[on]
    friction.plot(1e3 * v, left, ".", ms=1.5, color="0.7", label="force less inertia and weight")
    for side in (v > 0, v < 0):
        order = np.argsort(v[side])
        parts = np.delete(columns, [0, 3], axis=1)[side] @ np.delete(result.values, [0, 3])
        friction.plot(1e3 * v[side][order], parts[order], color="#d55e00", lw=1.6)
    friction.plot([], [], color="#d55e00", label="damping and friction as fitted")
    dress(friction, "friction [N]")
    friction.set_xlabel("velocity [mm/s]")
    legend(friction)
    words = ", ".join(str(e) for e in list(result.estimates.values())[:3])
    figure.suptitle(f"{r.name}: {words}", fontsize="medium")
    return figure


def _correlations(ax: Axes, result: ArmResult, name: str) -> None:
    tests = result.tests[name]
    ax.axhspan(-tests.band, tests.band, color="0.9", label="95 % of white errors")
    ax.plot(np.arange(1, len(tests.auto) + 1), tests.auto, color="#0072b2", label="with themselves")
    ax.plot(np.arange(len(tests.cross)), tests.cross, color="#d55e00", label="with the force")
    ax.set_xlabel("lag [readings]")
    dress(ax, "correlation of\nthe errors")
    legend(ax)
