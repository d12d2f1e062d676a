"""Several laws against one wall: the paper's Fig. 11."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from ebac.metrics import EXACT_COUNTS, TAIL_SHARE, allowed_deviation, ideal_rest
from ebac.plot.style import (
    IDEAL,
    Numbers,
    Picture,
    colour,
    dress,
    landmarks,
    legend,
    line,
    new_figure,
)
from ebac.trace import Trace

#: The panels: position and force when meeting the wall and at the end, and the end near the ideal.
PANELS = {"x": "a", "x end": "b", "f": "c", "f end": "d", "near": "e"}


def plot_walls(traces: Sequence[Trace]) -> Picture:
    """Draw the paper's Fig. 11: several laws against one wall, how they meet it and where they end.

    Parameters
    ----------
    traces : sequence of Trace
        One run per law, of the same scenario.

    Returns
    -------
    Figure
        Position and force over time; below, the end at the scale of encoder counts, where the
        scenario has an ideal point of rest.

    Raises
    ------
    ValueError
        When there is no trace or one is too short.
    """
    if not traces or min(len(trace) for trace in traces) < 10:
        raise ValueError("a figure of walls needs at least one trace, each of at least 10 rows")
    ideal = ideal_rest(traces[0].scenario) if traces[0].scenario else None
    names = "ab;cd" if ideal is None else "ab;cd;ee"
    rows = names.count(";") + 1
    figure = new_figure(11, 3.1 * rows + 0.8)
    panels = figure.subplot_mosaic(names, width_ratios=[2, 1], height_ratios=[1, 1, 0.7][:rows])
    axes = {name: panels[letter] for name, letter in PANELS.items() if letter in panels}
    swinging_first = sorted(
        traces, key=lambda trace: -float(np.ptp(_place(trace)[len(trace) // 2 :]))
    )
    for trace in swinging_first:
        _wall_lines(axes, trace, _first_contact(traces))
    _wall_frames(axes, traces[0])
    if ideal is not None:
        _near(axes["near"], traces, ideal)
    marks = dict(zip(*reversed(axes["x"].get_legend_handles_labels()), strict=True))
    order = [trace.law for trace in traces]
    order += [label for label in marks if label not in order]
    handles = [marks[label] for label in order]
    figure.legend(handles, order, loc="outside upper center", ncols=len(order), frameon=False)
    return figure


def _place(trace: Trace) -> Numbers:
    return trace.axis("true.x" if "true.x" in trace else "x")


def _first_contact(traces: Sequence[Trace]) -> float:
    """When the first law touches anything [s]; the start of the runs when none ever does."""
    touched = [t[0] for trace in traces if len(t := trace["t"][trace.axis("f_env") != 0])]
    return float(min(touched, default=traces[0]["t"][0]))


def _wall_lines(axes: dict[str, Axes], trace: Trace, contact: float) -> None:
    t = trace["t"]
    length = float(t[-1] - t[0])
    parts = {"": trace[contact - 0.01 * length : contact + 0.25 * length]}
    parts[" end"] = trace[float(t[-1]) - 0.05 * length :]
    for name, part in parts.items():
        style = {"color": colour(trace.law), "lw": 1.3, "label": trace.law}
        line(axes["x" + name], part["t"], 1e3 * _place(part), **style)
        line(axes["f" + name], part["t"], part.axis("f_applied"), **style)


def _wall_frames(axes: dict[str, Axes], trace: Trace) -> None:
    for name, label in (("x", "position [mm]"), ("f", "applied force [N]")):
        dress(axes[name], label)
        dress(axes[name + " end"], "")
        axes[name + " end"].sharey(axes[name])
        axes[name + " end"].tick_params(labelleft=False)
    for name in ("x", "x end"):
        landmarks(axes[name], trace)
    axes["x"].set_title("meeting the wall", fontsize="medium")
    axes["x end"].set_title("the end of the run", fontsize="medium")
    for name in ("f", "f end"):
        axes[name].set_xlabel("time [s]")


def _near(ax: Axes, traces: Sequence[Trace], ideal: float) -> None:
    """Draw the last 30 % around the ideal point, at the scale of encoder counts."""
    scenario = traces[0].scenario
    band = 1e3 * (allowed_deviation(scenario) if scenario else 0.0)
    friction = scenario is not None and band > 1.001e3 * EXACT_COUNTS * scenario.device.count
    more = " and friction" if friction else ""
    ax.axhspan(-band, band, color="0.92", label=f"within {EXACT_COUNTS} encoder counts{more}")
    ax.axhline(0, **IDEAL)
    ax.set_ylim(-5 * band, 5 * band)
    away = []
    for trace in traces:
        t = trace["t"]
        part = trace[float(t[-1] - TAIL_SHARE * (t[-1] - t[0])) :]
        offset = 1e3 * (_place(part) - ideal)
        if np.ptp(offset) < 10 * band and abs(offset.mean()) < 5 * band:
            line(ax, part["t"], offset, color=colour(trace.law), lw=1.2)
        else:
            away.append(trace.law)
    dress(ax, "beyond the\nideal [mm]")
    ax.set_xlabel("time [s]")
    ax.set_title(
        f"off this scale: {', '.join(away)}" if away else "", fontsize="small", loc="right"
    )
    legend(ax)
