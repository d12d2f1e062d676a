"""A trace over a golden one: each channel that differs, its error below, the first divergence marked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ebac._util import formatting
from ebac._util.arguments import require
from ebac._util.sequences import require_each
from ebac.plot.style import Picture, colour, dress, legend, line, new_figure
from ebac.plot.takes import takes_its_class
from ebac.trace import Trace

if TYPE_CHECKING:
    from ebac.testing.compare import Divergence

#: More channels than this are not drawn.
MOST_CHANNELS = 6
#: What is shown before and after a difference, at least [s].
MARGIN = 0.02


@takes_its_class("ebac.trace")
def plot_overlay(found: Trace, golden: Trace, divergences: Sequence[Divergence] = ()) -> Picture:
    """Draw a trace over a golden one.

    Parameters
    ----------
    found, golden : Trace
        Of the same rows, or not: each is drawn over its own time.
    divergences : sequence of Divergence
        Their channels are drawn, at most six; without any, the position and the commanded force.

    Returns
    -------
    Figure
        Of the whole run, or of the part in which the traces differ where that is short.
    """
    require(golden, Trace, "ebac.plot.plot_overlay", "a golden Trace")
    from ebac.testing.compare import Divergence

    require_each(divergences, Divergence, "ebac.plot.plot_overlay", "divergences, as of compare")
    shown = list(divergences)[:MOST_CHANNELS]
    channels = [d.channel for d in shown] or [c for c in ("x", "f_cmd") if c in found][:2]
    series = {name: (info.unit, values) for name, info, values in found.flat()}
    wanted = {name: values for name, _, values in golden.flat()}
    channels = [c for c in channels if c in series] or [f"{c}_0" for c in channels]
    figure = new_figure(11, 1 + 2.9 * len(channels))
    grid = figure.subplots(2 * len(channels), 1, sharex=True, squeeze=False,
                           height_ratios=[2, 1] * len(channels))[:, 0]  # fmt: skip
    for i, channel in enumerate(channels):
        unit, values = series[channel]
        factor, unit, _ = formatting.SHOWN.get(unit, (1, unit, 0))
        values, expected = factor * values.astype(float), factor * wanted[channel].astype(float)
        upper, lower = grid[2 * i], grid[2 * i + 1]
        _both(upper, found, golden, channel, unit, values, expected)
        _error(lower, golden, unit, values, expected)
        for ax in (upper, lower) if i < len(shown) else ():
            ax.axvline(shown[i].t, color="#d55e00", lw=1, ls=":")
    if (window := _window(found, golden, series, wanted, channels)) is not None:
        grid[0].set_xlim(window)
    legend(grid[0])
    grid[-1].set_xlabel("time [s]")
    figure.align_ylabels()
    figure.suptitle(_title(found, divergences), fontsize="medium")
    return figure


def _window(
    found: Trace, golden: Trace, series: dict[str, Any], wanted: dict[str, Any], channels: list[str]
) -> tuple[float, float] | None:
    """Return from when to when [s] channels differ by a hundredth of their largest difference or more, with a margin.

    None where they do so over most of the run, or nowhere.
    """
    if len(found) != len(golden):
        return None
    differs = np.zeros(len(golden), bool)
    for channel in channels:
        error = np.abs(series[channel][1].astype(float) - wanted[channel].astype(float))
        differs |= (error > 0.01 * np.nanmax(error, initial=0.0)) & (error > 0)
    if not differs.any():
        return None
    t = golden["t"]
    first, last = t[differs][[0, -1]]
    margin = max(0.25 * (last - first), MARGIN)
    whole = float(t[-1] - t[0])
    return (first - margin, last + margin) if last - first + 2 * margin < 0.5 * whole else None


def _title(found: Trace, divergences: Sequence[Divergence]) -> str:
    who = found.law or "a run"
    if not divergences:
        return f"{who} beside its golden trace"
    first, more = divergences[0], len(divergences) - MOST_CHANNELS
    rest = f"; {more} more channels differ" if more > 0 else ""
    return f"{who} beside its golden trace: differs from t = {first.t:.6g} s on, first in {first.channel}{rest}"


def _both(
    ax: Axes, found: Trace, golden: Trace, channel: str, unit: str, values: NDArray[np.float64],
    wanted: NDArray[np.float64],
) -> None:  # fmt: skip
    line(ax, golden["t"], wanted, color="0.65", lw=3, label="golden")
    own = colour(found.law)
    line(ax, found["t"], values, color=own, lw=1.1, label="now")
    dress(ax, f"{channel} [{unit}]" if unit != "1" else channel)


def _error(
    ax: Axes, golden: Trace, unit: str, values: NDArray[np.float64], wanted: NDArray[np.float64]
) -> None:  # fmt: skip
    if len(values) == len(wanted):
        error = values - wanted
        line(ax, golden["t"], error, color="#d55e00", lw=0.9)
    ax.axhline(0, color="0.35", lw=0.8)
    dress(ax, f"now - golden\n[{unit}]" if unit != "1" else "now - golden")
