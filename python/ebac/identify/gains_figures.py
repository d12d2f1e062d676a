"""Pictures of a choice of gains."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ebac.plot.style import dress, legend, line, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ebac.identify.gains import GainsResult
    from ebac.identify.gains_trial import Candidate
    from ebac.plot.style import Picture

COLOURS = {"default": "#d55e00", "step-response": "#0072b2", "chosen": "#009e73"}


def plot_gains(result: GainsResult) -> Picture:
    """Draw the press of the identified hand under default, rule and choice, and what was tried."""
    from ebac.laws import Variant
    from ebac.simulation import simulate

    figure = new_figure(10, 9)
    motion, force, tried = figure.subplots(3, 1, height_ratios=[1.2, 1.2, 1.4])
    scenario = result.scenario.replace(seconds=1.5)
    for c in (result.default, *result.rules, result.chosen):
        trace = simulate(scenario, Variant(result.name, {"kp": c.kp, "kd": c.kd}))
        style = {"color": COLOURS[c.name], "lw": 1.0, "label": _label(c)}
        surface = scenario.environment.position  # type: ignore[union-attr]
        line(motion, trace["t"], 1e3 * (trace["true.x"] - surface), **style)
        line(force, trace["t"], trace["f_applied"], **style)
    motion.axhline(0, color="0.6", lw=0.8)
    dress(motion, "depth in the wall [mm]")
    motion.set_ylim(bottom=-4)
    legend(motion, columns=3)
    dress(force, "force [N]")
    force.set_xlabel("time [s]")
    _map(tried, result)
    figure.suptitle(
        f"{result.name}: gains of eq. (2), simulated on the loop of the log", fontsize="medium"
    )
    return figure


def _label(c: Candidate) -> str:
    return f"{c.name}: Kp {c.kp:.3g}, Kd {1e3 * c.kd:.3f} ms"


def _map(ax: Axes, result: GainsResult) -> None:
    kept = [c for c in result.tried if not c.broken]
    lost = [c for c in result.tried if c.broken]
    ax.plot(
        [c.kp for c in lost],
        [1e3 * c.kd for c in lost],
        "x",
        color="0.6",
        label="breaks a constraint",
    )
    cost = np.log10([c.cost for c in kept])
    dots = ax.scatter(
        [c.kp for c in kept],
        [1e3 * c.kd for c in kept],
        c=cost,
        cmap="viridis_r",
        s=28,
        label="keeps all",
    )
    bar = ax.figure.colorbar(dots, ax=ax)
    bar.set_label("log10 of the cost, 0: default")
    chosen = result.chosen
    ax.plot(
        chosen.kp,
        1e3 * chosen.kd,
        "o",
        mfc="none",
        ms=14,
        mew=2,
        color=COLOURS["chosen"],
        label="chosen",
    )
    ax.set_xlabel("Kp [1]")
    dress(ax, "Kd [ms]")
    ax.margins(0.05)
    legend(ax, columns=3)
