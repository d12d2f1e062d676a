"""Columns of a trace by name over time, those of one unit in one panel."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes

from ebac._util import formatting
from ebac._util.arguments import require
from ebac._util.arrays import Values
from ebac._util.gaps import alone
from ebac._util.plural import plural
from ebac._util.sequences import require_each, several
from ebac.plot.decades import StiffnessScale
from ebac.plot.marks import mark_end, no_beta, title
from ebac.plot.style import Picture, dress, legend, line, new_figure
from ebac.trace import Trace

#: Okabe and Ito's palette, which every eye distinguishes; then again, dashed.
_SHADES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e6ab02", "#56b4e9", "#000000")

#: Endings of columns that are bounds of another.
_BOUNDS = ("_min", "_max")


def plot_columns(trace: Trace, names: Sequence[str], *, scale: str | None = None) -> Picture:
    """Draw columns over time, one panel for each unit.

    Parameters
    ----------
    trace : Trace
        At least two rows.
    names : sequence of str
        Columns; one of several axes gives a line for each, and NAME_AXIS, as "x_0", that axis alone.
    scale : "linear", "log" or None
        Of columns in N/m, such as `law.beta`: linear, or logarithmic beyond 1 kN/m; default: linear where all are
        within 10 times their median. Bounds, `law.beta_max` and `law.beta_min`, are cut where what they bound ends.

    Returns
    -------
    Figure
        Save it with `savefig`.

    Raises
    ------
    KeyError
        For a column that is not there.
    ValueError
        When the trace is too short, no column is named, one has no such axis, or for another scale.
    """
    require(trace, Trace, "ebac.plot.plot_columns", "a Trace")
    names = several("plot_columns: names", names)
    if len(trace) < 2:
        raise ValueError(f"the trace has {plural(len(trace), 'row')}: a figure needs at least 2")
    panels: dict[str, list[str]] = {}
    require_each(names, str, "ebac.plot.plot_columns", "names of columns")
    for name in dict.fromkeys(names):
        column, _ = _axes(trace, name)
        panels.setdefault(trace.columns[column].unit, []).append(name)
    figure = new_figure(9.5, 0.8 + 2.4 * len(panels))
    grid = figure.subplots(len(panels), 1, sharex=True, squeeze=False)
    for ax, (unit, columns) in zip(grid[:, 0], panels.items(), strict=True):
        factor, shown, _ = formatting.SHOWN.get(unit, (1, unit, 0))
        if unit == "N/m":
            shown = "kN/m"
            _dots(ax, trace, columns, scale)
        else:
            lines = list(_lines(trace, columns))
            ink = [float(np.nansum(np.abs(np.diff(values)))) for _, values in lines]
            for i, (label, values) in enumerate(lines):
                covers = sum(other > ink[i] for other in ink)  # the longest line lies below
                _line(ax, trace["t"], factor * values, i, label, above=2 + covers / len(ink))
        dress(
            ax, f"{formatting.QUANTITY_OF.get(unit, '')} [{shown}]".strip() if unit != "1" else ""
        )
        mark_end(ax, trace)
        legend(ax)
    first, last = float(trace["t"][0]), float(trace["t"][-1])
    room = 0.01 * (last - first)
    grid[-1, 0].set_xlim(first - room, last + room)  # all of it, where a column has no number, too
    grid[-1, 0].set_xlabel("time [s]")
    figure.align_ylabels()
    figure.suptitle(title(trace), fontsize="medium")
    return figure


def _line(ax: Axes, t: Values, values: Values, i: int, label: str, above: float) -> None:
    """Draw a column as a line, and as dots what stands between two gaps."""
    style = "-" if i < len(_SHADES) else "--"
    shade = _SHADES[i % len(_SHADES)]
    line(ax, t, values, color=shade, ls=style, lw=1.0, label=label, zorder=above)
    dots = alone(values)
    if np.isfinite(dots).any():
        ax.plot(t, dots, ".", ms=2.5, color=shade)


def _dots(ax: Axes, trace: Trace, columns: Sequence[str], given: str | None) -> None:
    """Draw columns in N/m as the panel of beta of a run: as far as what lies between bounds goes, bounds cut."""
    drawn = {label: values / 1e3 for label, values in _lines(trace, columns)}
    inner = [v for label, v in drawn.items() if not label.partition(",")[0].endswith(_BOUNDS)]
    scale = StiffnessScale.of(inner or drawn.values(), given, drawn.values())
    for i, (label, values) in enumerate(drawn.items()):
        shade = _SHADES[i % len(_SHADES)]
        ax.plot(
            trace["t"],
            scale.cut(values),
            ".",
            ms=3,
            color=shade,
            label=scale.named(label, values),
            zorder=2.5 - 0.01 * i,  # a bound often equals what it bounds
        )
    scale.set(ax)


def _axes(trace: Trace, given: str) -> tuple[str, range]:
    """Return the column that a name means, and its axes: NAME_AXIS, as files have it, means one of several."""
    name, _, axis = given.rpartition("_")
    if given in trace.columns or not axis.isdecimal() or name not in trace.columns:
        return given, range(1 if trace[given].ndim == 1 else trace.axes)
    axes = 1 if trace[name].ndim == 1 else trace.axes
    if int(axis) >= axes:
        last = "only axis 0" if axes == 1 else f"axes 0 to {axes - 1}"
        raise ValueError(f"{given}: {name} has {last}")
    return name, range(int(axis), int(axis) + 1)


def _lines(trace: Trace, columns: Sequence[str]) -> Iterator[tuple[str, Values]]:
    for given in columns:
        name, axes = _axes(trace, given)
        for axis in axes:
            label = name if trace[name].ndim == 1 else f"{name}, axis {axis}"
            values = trace.axis(name, axis)
            if not np.isfinite(values).any():
                label += f": {no_beta(trace)}" if name.startswith("law.beta") else ": no numbers"
            yield label, values
