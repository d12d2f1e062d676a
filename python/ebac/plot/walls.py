"""Several laws against one wall: the paper's Fig. 11."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from ebac._util.sequences import require_each
from ebac.metrics import STILL_SWING, TAIL_SHARE, ideal_rest
from ebac.plot.marks import for_laws, heading
from ebac.plot.style import Picture, colours, dress, figure_legend, landmarks, new_figure
from ebac.plot.wall_panels import (
    ROWS,
    Direction,
    Run,
    begin_and_end,
    beyond_rest,
    draw_near,
    draw_row,
    first_contact,
    has_beta,
    positions,
)
from ebac.scenario import Scenario
from ebac.trace import Trace

#: More laws than this get panels of their own.
TOGETHER = 3


def plot_walls(traces: Trace | Sequence[Trace] | Mapping[str, Trace]) -> Picture:
    """Draw the paper's Fig. 11: several laws against one wall, how they meet it and where they end.

    Parameters
    ----------
    traces : Trace, sequence of Trace, or mapping of names to traces
        One run per law, of the same scenario. Give names where laws have none of their own or the same, as variants of
        one law have; in a sequence the second of one name is called "tca-damped (2)".

    Returns
    -------
    Figure
        Position, force and beta over time, up to three laws together and more in panels of their
        own; below, the end at the scale of encoder counts, where a law comes near an ideal rest. Of several axes it
        shows the first, or another where a law swings more, and its labels say which.

    Raises
    ------
    ValueError
        When there is no trace or one is too short.
    """
    each = [traces] if isinstance(traces, Trace) else traces
    each = list(each.values()) if isinstance(each, Mapping) else each
    require_each(each, Trace, "ebac.plot.plot_walls", "a Trace, or several")
    named = _named(traces)
    if not named or min(map(len, named.values())) < 10:
        raise ValueError("a figure of walls needs at least one trace, each of at least 10 rows")
    shades, axis = colours(named), _axis_shown(list(named.values()))
    runs = [Run(name, shades[name], _along(trace, axis)) for name, trace in named.items()]
    several = any(trace.axes > 1 for trace in named.values())
    return _draw(runs, Direction(axis, "xyz"[axis] if several else ""), narrow=False)


def _named(traces: Trace | Sequence[Trace] | Mapping[str, Trace]) -> dict[str, Trace]:
    """Return traces by name; those that go by one name are counted."""
    if isinstance(traces, Mapping):
        return dict(traces)
    met: Counter[str] = Counter()
    named: dict[str, Trace] = {}
    for trace in [traces] if isinstance(traces, Trace) else traces:
        name = trace.law or "a run"
        met[name] += 1
        named[f"{name} ({met[name]})" if met[name] > 1 else name] = trace
    return named


def _axis_shown(traces: Sequence[Trace]) -> int:
    """Return the axis on which a law swings most at the end of its run; the first where all are still."""
    swings = [0.0] * min(trace.axes for trace in traces)
    for trace in traces:
        end = trace[float(trace["t"][-1] - TAIL_SHARE * np.ptp(trace["t"])) :]
        for axis in range(len(swings)):
            if trace.axis("f_env", axis).any():
                swings[axis] = max(swings[axis], float(np.ptp(positions(end, axis))))
    most = int(np.argmax(swings))
    return most if swings[most] > STILL_SWING else 0


def _along(trace: Trace, axis: int) -> Trace:
    """Return one axis of a trace."""
    if trace.axes == 1:
        return trace
    return trace._with({name: trace.axis(name, axis) for name in trace})


def _draw(runs: Sequence[Run], way: Direction, *, narrow: bool) -> Picture:
    traces = [run.trace for run in runs]
    ideal = ideal_rest(traces[0].scenario) if traces[0].scenario and way.axis == 0 else None
    contact = first_contact(traces)
    begun = [begin_and_end(trace, contact)[0] for trace in traces]
    rows = [row for row in ROWS if row != "beta" or any(map(has_beta, begun))]
    draw = _together if len(runs) <= TOGETHER else _apart
    rests = ideal is not None and any(beyond_rest(trace, ideal) is not None for trace in traces)
    figure, near = draw(runs, rows, way, near=rests, narrow=narrow)
    figure.narrow = partial(_draw, runs, way, narrow=True)
    if ideal is not None and near is not None:
        draw_near(near, runs, ideal, way, named=draw is _apart)
    if traces[0].scenario is not None:
        figure.suptitle(_heading(traces, traces[0].scenario), fontsize="medium")
    figure.align_ylabels()
    return figure


def _heading(traces: Sequence[Trace], scenario: Scenario) -> str:
    """Return device, hand, wall and time; with a state observer, which of the laws use it."""
    return for_laws(heading(scenario, traces[0].origin), traces)


def _together(
    runs: Sequence[Run], rows: list[str], way: Direction, *, near: bool, narrow: bool
) -> tuple[Picture, Axes | None]:
    """Draw all laws in the same panels: the beginning on the left, the end on the right."""
    names: list[Any] = [[row, f"{row} end"] for row in ("x", "f")]
    abreast = "beta" in rows and near and not narrow
    if "beta" in rows:
        names.append(["beta", "near" if abreast else "."])  # at rest there is no beta
    if near and not abreast:
        names.append(["near", "near"])
    figure = new_figure(5 if narrow else 11, (1.9 if narrow else 2.7) * len(names) + 1.0)
    axes = figure.subplot_mosaic(names, width_ratios=[2, 1])
    first, contact = runs[0].trace, first_contact([run.trace for run in runs])
    for run in sorted(runs, key=lambda run: _restlessness(run.trace)):
        begin, end = begin_and_end(run.trace, contact)
        for row in rows:
            draw_row(axes[row], row, begin, run.shade, label=run.label)
            if row != "beta":
                draw_row(axes[f"{row} end"], row, end, run.shade, label="_")
    for row in rows:
        dress(axes[row], way.label(ROWS[row]))
    for row in ("x", "f"):
        dress(axes[f"{row} end"], "")
        axes[f"{row} end"].sharey(axes[row])
        axes[f"{row} end"].tick_params(labelleft=False)
    if "beta" in rows:
        axes["beta"].sharex(axes["x"])
    if way.axis == 0:
        landmarks(axes["x"], first)
        landmarks(axes["x end"], first)
    axes["x"].set_title("first contact with the wall", fontsize="medium")
    axes["x end"].set_title("the end of the run", fontsize="medium")
    for name in (rows[-1], "f end"):
        axes[name].set_xlabel("time [s]")
    marks = _marks(axes["x"]) | _marks(axes["f"]) | _marks(axes["f end"])
    order = [run.label for run in runs]
    order += [label for label in marks if label not in order]
    figure_legend(figure, [marks[label] for label in order], order)
    return figure, axes.get("near")


def _apart(
    runs: Sequence[Run], rows: list[str], way: Direction, *, near: bool, narrow: bool
) -> tuple[Picture, Axes | None]:
    """Draw each law in panels of its own, three or four laws abreast; few panels of beta stand beside the end."""
    abreast = 2 if narrow else min((3, 4), key=lambda n: -len(runs) % n)  # fewest empty places
    bands = [runs[i : i + abreast] for i in range(0, len(runs), abreast)]
    beside = [run for run in runs if has_beta(run.trace)] if near and "beta" in rows else []
    if narrow or len(beside) > abreast // 2:
        beside = []
    if beside:
        rows = [row for row in rows if row != "beta"]
    lines = [
        (band, row)
        for band in bands
        for row in rows
        if row != "beta" or any(has_beta(run.trace) for run in band)
    ]
    figure = new_figure(
        5 if narrow else 11, 1.6 * len(lines) + 0.4 * len(bands) + (2.2 if near else 0) + 1.0
    )
    heights = [1.0] * len(lines) + ([1.4] if near else [])
    grid = figure.add_gridspec(len(heights), abreast, height_ratios=heights)
    contact = first_contact([run.trace for run in runs])
    first: dict[str, Axes] = {}
    for place, (band, row) in enumerate(lines):
        for column, run in enumerate(band):
            trace = run.trace
            if row == "beta" and not has_beta(trace):
                continue
            ax = figure.add_subplot(
                grid[place, column], sharey=first.get(row), sharex=first.get("x")
            )
            left = column == 0 or (not has_beta(band[column - 1].trace) and row == "beta")
            first.setdefault(row, ax)
            draw_row(ax, row, begin_and_end(trace, contact)[0], run.shade, label="_")
            dress(ax, way.label(ROWS[row]) if left else "")
            if row == "x" and way.axis == 0:
                landmarks(ax, trace)
            if row == "x":
                ax.set_title(run.label, color=run.shade, fontweight="bold")
            last = row == ("beta" if "beta" in rows and has_beta(trace) else "f")
            ax.tick_params(labelbottom=last, labelleft=left)
            if last:
                ax.set_xlabel("time [s]")
    for place, run in enumerate(beside, abreast - len(beside)):
        ax = figure.add_subplot(grid[-1, place], sharey=first.get("beta"), sharex=first["x"])
        left = "beta" not in first
        first.setdefault("beta", ax)
        draw_row(ax, "beta", begin_and_end(run.trace, contact)[0], run.shade, label="_")
        dress(ax, way.label(ROWS["beta"]) if left else "")
        ax.tick_params(labelleft=left)
        ax.set_title(run.label, color=run.shade, fontweight="bold")
        ax.set_xlabel("time [s]")
    marks = {label: mark for ax in figure.axes for label, mark in _marks(ax).items()}
    if marks:
        figure_legend(figure, list(marks.values()), list(marks))
    return figure, figure.add_subplot(grid[-1, : abreast - len(beside)]) if near else None


def _marks(ax: Axes) -> dict[str, Artist]:
    return dict(zip(*reversed(ax.get_legend_handles_labels()), strict=True))


def _restlessness(trace: Trace) -> float:
    """Return by what to sort so that a swinging law is drawn below a quiet one."""
    return -float(np.ptp(positions(trace)[len(trace) // 2 :]))
