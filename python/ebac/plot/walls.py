"""Several laws against one wall: the paper's Fig. 11."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import partial
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from ebac._util.arrays import Values
from ebac.metrics import EXACT_COUNTS, STILL_SWING, TAIL_SHARE, allowed_deviation, ideal_rest
from ebac.plot.marks import fault_name, for_laws, heading, mark_end
from ebac.plot.style import (
    IDEAL,
    Picture,
    colours,
    dress,
    figure_legend,
    landmarks,
    legend,
    line,
    new_figure,
)
from ebac.scenario import Scenario
from ebac.trace import Trace

#: More laws than this get panels of their own.
TOGETHER = 3
#: The rows of panels: key, label of the axis.
ROWS = {"x": "position [mm]", "f": "applied force [N]", "beta": r"$\beta$ [kN/m]"}


class _Run(NamedTuple):
    """A trace, what it is called, and its colour."""

    name: str
    shade: str
    trace: Trace

    @property
    def label(self) -> str:
        fault = fault_name(self.trace)
        return f"{self.name}, ended by {fault}" if fault else self.name


class _Direction(NamedTuple):
    """The axis of the device that is drawn, and its letter; none where there is but one."""

    axis: int
    letter: str

    def label(self, quantity: str) -> str:
        """Return a label that says which axis it shows."""
        return quantity.replace(" [", f" {self.letter} [") if self.letter else quantity


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
    named = _named(traces)
    if not named or min(map(len, named.values())) < 10:
        raise ValueError("a figure of walls needs at least one trace, each of at least 10 rows")
    shades, axis = colours(named), _axis_shown(list(named.values()))
    runs = [_Run(name, shades[name], _along(trace, axis)) for name, trace in named.items()]
    several = any(trace.axes > 1 for trace in named.values())
    return _draw(runs, _Direction(axis, "xyz"[axis] if several else ""), narrow=False)


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
                swings[axis] = max(swings[axis], float(np.ptp(_place(end, axis))))
    most = int(np.argmax(swings))
    return most if swings[most] > STILL_SWING else 0


def _along(trace: Trace, axis: int) -> Trace:
    """Return one axis of a trace."""
    if trace.axes == 1:
        return trace
    return trace._with({name: trace.axis(name, axis) for name in trace})


def _draw(runs: Sequence[_Run], way: _Direction, *, narrow: bool) -> Picture:
    traces = [run.trace for run in runs]
    ideal = ideal_rest(traces[0].scenario) if traces[0].scenario and way.axis == 0 else None
    contact = _first_contact(traces)
    begun = [_parts(trace, contact)[0] for trace in traces]
    rows = [row for row in ROWS if row != "beta" or any(map(_has_beta, begun))]
    draw = _together if len(runs) <= TOGETHER else _apart
    rests = ideal is not None and any(_offset(trace, ideal) is not None for trace in traces)
    figure, near = draw(runs, rows, way, near=rests, narrow=narrow)
    figure.narrow = partial(_draw, runs, way, narrow=True)
    if ideal is not None and near is not None:
        _near(near, runs, ideal, way, named=draw is _apart)
    if traces[0].scenario is not None:
        figure.suptitle(_heading(traces, traces[0].scenario), fontsize="medium")
    figure.align_ylabels()
    return figure


def _heading(traces: Sequence[Trace], scenario: Scenario) -> str:
    """Return device, hand, wall and time; with a state observer, which of the laws use it."""
    return for_laws(heading(scenario, traces[0].origin), traces)


def _together(
    runs: Sequence[_Run], rows: list[str], way: _Direction, *, near: bool, narrow: bool
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
    first, contact = runs[0].trace, _first_contact([run.trace for run in runs])
    for run in sorted(runs, key=lambda run: _restlessness(run.trace)):
        begin, end = _parts(run.trace, contact)
        for row in rows:
            _lines(axes[row], row, begin, run.shade, label=run.label)
            if row != "beta":
                _lines(axes[f"{row} end"], row, end, run.shade, label="_")
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
    runs: Sequence[_Run], rows: list[str], way: _Direction, *, near: bool, narrow: bool
) -> tuple[Picture, Axes | None]:
    """Draw each law in panels of its own, three or four laws abreast; few panels of beta stand beside the end."""
    abreast = 2 if narrow else min((3, 4), key=lambda n: -len(runs) % n)  # fewest empty places
    bands = [runs[i : i + abreast] for i in range(0, len(runs), abreast)]
    beside = [run for run in runs if _has_beta(run.trace)] if near and "beta" in rows else []
    if narrow or len(beside) > abreast // 2:
        beside = []
    if beside:
        rows = [row for row in rows if row != "beta"]
    lines = [
        (band, row)
        for band in bands
        for row in rows
        if row != "beta" or any(_has_beta(run.trace) for run in band)
    ]
    figure = new_figure(
        5 if narrow else 11, 1.6 * len(lines) + 0.4 * len(bands) + (2.2 if near else 0) + 1.0
    )
    heights = [1.0] * len(lines) + ([1.4] if near else [])
    grid = figure.add_gridspec(len(heights), abreast, height_ratios=heights)
    contact = _first_contact([run.trace for run in runs])
    first: dict[str, Axes] = {}
    for place, (band, row) in enumerate(lines):
        for column, run in enumerate(band):
            trace = run.trace
            if row == "beta" and not _has_beta(trace):
                continue
            ax = figure.add_subplot(
                grid[place, column], sharey=first.get(row), sharex=first.get("x")
            )
            left = column == 0 or (not _has_beta(band[column - 1].trace) and row == "beta")
            first.setdefault(row, ax)
            _lines(ax, row, _parts(trace, contact)[0], run.shade, label="_")
            dress(ax, way.label(ROWS[row]) if left else "")
            if row == "x" and way.axis == 0:
                landmarks(ax, trace)
            if row == "x":
                ax.set_title(run.label, color=run.shade, fontweight="bold")
            last = row == ("beta" if "beta" in rows and _has_beta(trace) else "f")
            ax.tick_params(labelbottom=last, labelleft=left)
            if last:
                ax.set_xlabel("time [s]")
    for place, run in enumerate(beside, abreast - len(beside)):
        ax = figure.add_subplot(grid[-1, place], sharey=first.get("beta"), sharex=first["x"])
        left = "beta" not in first
        first.setdefault("beta", ax)
        _lines(ax, "beta", _parts(run.trace, contact)[0], run.shade, label="_")
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


def _place(trace: Trace, axis: int = 0) -> Values:
    return trace.axis("true.x" if "true.x" in trace else "x", axis)


def _restlessness(trace: Trace) -> float:
    """Return by what to sort so that a swinging law is drawn below a quiet one."""
    return -float(np.ptp(_place(trace)[len(trace) // 2 :]))


def _has_beta(trace: Trace) -> bool:
    return "law.beta" in trace and bool(np.isfinite(trace.axis("law.beta")).any())


def _first_contact(traces: Sequence[Trace]) -> float:
    """Return when the first law touches anything [s]; the start of the runs when none ever does."""
    touched = [t[0] for trace in traces if len(t := trace["t"][trace.axis("f_env") != 0])]
    return float(min(touched, default=traces[0]["t"][0]))


def _parts(trace: Trace, contact: float) -> tuple[Trace, Trace]:
    """Return a quarter of the run from the first contact on, and its last twentieth."""
    t = trace["t"]
    length = float(t[-1] - t[0])
    begin = max(float(t[0]), min(contact - 0.01 * length, float(t[-1]) - 0.1 * length))
    return trace[begin : contact + 0.25 * length], trace[float(t[-1]) - 0.05 * length :]


def _lines(ax: Axes, row: str, part: Trace, shade: str, label: str) -> None:
    style: dict[str, Any] = {"color": shade, "label": label}
    if row == "x":
        line(ax, part["t"], 1e3 * _place(part), lw=1.3, **style)
    elif row == "f":
        force = part.axis("f_applied")
        line(ax, part["t"], force, lw=1.3, **style)
        peak = part.scenario.device.peak_force if part.scenario else np.inf
        for edge in (peak, -peak):
            if np.any(np.sign(edge) * force > 0.999 * peak):
                text = f"peak force of the motor, {peak:.3g} N"
                ax.axhline(edge, color="0.35", lw=1, ls=":", zorder=1.9, label=text)
    elif _has_beta(part):
        ax.plot(part["t"], 1e-3 * part.axis("law.beta"), ".", ms=2.5, **style)
    mark_end(ax, part, label=False)


def _band(trace: Trace) -> float:
    """Return what an exact law may be off [mm]."""
    return 1e3 * (allowed_deviation(trace.scenario) if trace.scenario else 0.0)


def _offset(trace: Trace, ideal: float) -> tuple[Values, Values] | None:
    """Return times [s] and places beyond the ideal rest [mm] of the last 30 %; None where they are off the scale."""
    t, band = trace["t"], _band(trace)
    part = trace[float(t[-1] - TAIL_SHARE * (t[-1] - t[0])) :]
    offset = 1e3 * (_place(part) - ideal)
    near = np.ptp(offset) < 10 * band and abs(offset.mean()) < 5 * band
    return (part["t"], offset) if near else None


def _near(ax: Axes, runs: Sequence[_Run], ideal: float, way: _Direction, *, named: bool) -> None:
    """Draw the last 30 % around the ideal point, at the scale of encoder counts; its legend may name the laws."""
    first = runs[0].trace
    scenario, band = first.scenario, _band(first)
    friction = scenario is not None and band > 1.001e3 * EXACT_COUNTS * scenario.device.count
    more = " and friction" if friction else ""
    ax.axhspan(-band, band, color="0.92", label=f"within {EXACT_COUNTS} encoder counts{more}")
    ax.axhline(0, **IDEAL)
    ax.set_ylim(-5 * band, 5 * band)
    away = []
    for run in runs:
        offset = _offset(run.trace, ideal)
        if offset is None:
            away.append(run.name)
        else:
            line(ax, *offset, color=run.shade, lw=1.2, label=run.name if named else "_")
    dress(ax, way.label("beyond the\nideal rest [mm]"))
    ax.set_xlabel("time [s]")
    if away:
        names = fill(f"off this scale: {', '.join(away)}", 60)
        ax.text(0.01, 0.03, names, fontsize="small", transform=ax.transAxes)
    legend(ax)
