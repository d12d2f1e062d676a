"""Columns of a trace by name over time, those of one unit in one panel."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ebac._util import formatting
from ebac._util.arguments import require, several
from ebac.plot.marks import mark_end, title
from ebac.plot.style import Numbers, Picture, dress, legend, line, new_figure
from ebac.trace import Trace

#: Okabe and Ito's palette, which every eye distinguishes; then again, dashed.
_SHADES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e6ab02", "#56b4e9", "#000000")


def plot_columns(trace: Trace, names: Sequence[str]) -> Picture:
    """Draw columns over time, one panel for each unit.

    Parameters
    ----------
    trace : Trace
        At least two rows.
    names : sequence of str
        Columns; one of several axes gives a line for each.

    Returns
    -------
    Figure
        Save it with `savefig`.

    Raises
    ------
    KeyError
        For a column that is not there.
    ValueError
        When the trace is too short, or no column is named.
    """
    require(trace, Trace, "ebac.plot.plot_columns", "a Trace")
    names = several("plot_columns: names", names)
    if len(trace) < 2:
        raise ValueError(f"the trace has {len(trace)} rows: a figure needs at least 2")
    panels: dict[str, list[str]] = {}
    for name in dict.fromkeys(names):
        trace[name]  # refuses a column that is not there
        panels.setdefault(trace.columns[name].unit, []).append(name)
    figure = new_figure(9.5, 0.8 + 2.4 * len(panels))
    grid = figure.subplots(len(panels), 1, sharex=True, squeeze=False)
    for ax, (unit, columns) in zip(grid[:, 0], panels.items(), strict=True):
        factor, shown, _ = formatting.SHOWN.get(unit, (1, unit, 0))
        for i, (label, values) in enumerate(_lines(trace, columns)):
            style = "-" if i < len(_SHADES) else "--"
            shade = _SHADES[i % len(_SHADES)]
            line(ax, trace["t"], factor * values, color=shade, ls=style, lw=1.0, label=label)
        dress(
            ax, f"{formatting.QUANTITY_OF.get(unit, '')} [{shown}]".strip() if unit != "1" else ""
        )
        mark_end(ax, trace)
        legend(ax)
    grid[-1, 0].set_xlabel("time [s]")
    figure.align_ylabels()
    figure.suptitle(title(trace), fontsize="medium")
    return figure


def _lines(trace: Trace, columns: Sequence[str]) -> Iterator[tuple[str, Numbers]]:
    for name in columns:
        for axis in range(1 if trace[name].ndim == 1 else trace.axes):
            label = name if trace[name].ndim == 1 else f"{name}, axis {axis}"
            values = trace.axis(name, axis)
            yield label if np.isfinite(values).any() else f"{label}: no numbers", values
