"""Pictures of a fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ebac.plot.style import dress, legend, line, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ebac.identify.result import ArmResult
    from ebac.plot.style import Picture


def plot_arm(result: ArmResult, recording: int = 0) -> Picture:
    """Draw motion and model, force, errors, and their correlations, of one recording."""
    figure = new_figure(10, 9)
    motion, force, left, auto = figure.subplots(4, 1, height_ratios=[2, 1.2, 1.2, 1.2])
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
    figure.suptitle(
        f"{r.name}: " + ", ".join(str(e) for e in list(result.estimates.values())[:3]),
        fontsize="medium",
    )
    return figure


def _correlations(ax: Axes, result: ArmResult, name: str) -> None:
    tests = result.tests[name]
    ax.axhspan(-tests.band, tests.band, color="0.9", label="95 % of white errors")
    ax.plot(np.arange(1, len(tests.auto) + 1), tests.auto, color="#0072b2", label="with themselves")
    ax.plot(np.arange(len(tests.cross)), tests.cross, color="#d55e00", label="with the force")
    ax.set_xlabel("lag [readings]")
    dress(ax, "correlation of\nthe errors")
    legend(ax)
