"""Many runs at a glance: how far each rests from the ideal, and by how much it swings."""

from __future__ import annotations

import numpy as np

from ebac.metrics import STILL_SWING
from ebac.plot.style import Picture, colours, dress, legend, new_figure
from ebac.plot.takes import takes_its_class
from ebac.studies.sweeps import SweepResult

#: Swings below this [m] are drawn at it: the axis is logarithmic.
LEAST_SWING = 1e-7


@takes_its_class("ebac.studies.sweeps")
def plot_sweep(result: SweepResult) -> Picture:
    """Draw each run of a sweep by its deviation and its swing, a colour per law.

    Parameters
    ----------
    result : SweepResult
        With at least one run that has an ideal rest and was done.

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        When no run has an ideal rest.
    """
    known = np.isfinite(result.deviation_m) & result["done"] & ~result["diverged"]
    if not known.any():
        raise ValueError("no run has an ideal rest: there is nothing to draw")
    figure = new_figure(9, 4.5)
    ax = figure.subplots()
    for law, shade in colours(result["law"].tolist()).items():
        runs = known & (result["law"] == law)
        swing = np.maximum(result["swing_m"][runs], LEAST_SWING)
        ax.plot(
            1e3 * result.deviation_m[runs],
            1e3 * swing,
            "o",
            ms=5,
            alpha=0.7,
            color=shade,
            label=law,
        )
    ax.axhline(1e3 * STILL_SWING, color="0.35", lw=1, ls="--", label="still below")
    ax.axvline(0, color="0.35", lw=1)
    ax.set_yscale("log")
    ax.set_xlabel("rest minus ideal [mm]")
    dress(ax, "swing, peak to peak [mm]")
    legend(ax, columns=6)
    figure.suptitle(
        f"Sweep, simulated: {int(known.sum())} of {len(result)} runs have an ideal rest",
        fontsize="medium",
    )
    return figure
