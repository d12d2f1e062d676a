"""Runs of teleoperation over time: positions, forces and energies of both ports."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, MaxNLocator

from ebac._util.arrays import Values
from ebac._util.sequences import several
from ebac.plot.marks import mark_cut
from ebac.plot.style import Picture, dress, figure_legend, line, new_figure

if TYPE_CHECKING:
    from ebac.teleop.run import Run

#: One colour per thing, of Okabe and Ito.
MASTER, SLAVE, MASTER_PORT, BOTH_PORTS = "#0072b2", "#d55e00", "#cc79a7", "#009e73"
#: Each row of panels: label of the axis, factor from SI units, column, label and colour of each line.
ROWS = (
    ("position [mm]", 1e3, (("true_x", "master", MASTER), ("slave_x", "slave", SLAVE))),
    ("force at both ends [N]", 1.0, (("force", "master", MASTER), ("met", "slave", SLAVE))),
    (
        "energy taken in [mJ],\nlog beyond \u00b110 mJ",
        1e3,
        (
            ("energy", "energy of the master's port", MASTER_PORT),
            ("network", "energy of both ports together", BOTH_PORTS),
        ),
    ),
)
#: Up to here the scale of energies is linear [mJ].
LINEAR = 10.0
#: What does not swing by more decides on the scale [m]; others are shown as far as so many times its range.
CALM, BEYOND = 5e-3, 2.0


def plot_teleop_runs(runs: Sequence[Run]) -> Picture:
    """Draw a column for each run: positions, forces and energies of both ports over time.

    Runs that shake do not decide on the scale of positions and forces: what lies beyond it is named in the panel.

    Parameters
    ----------
    runs : sequence of Run
        What `ebac.teleop.simulate` returned; at least one.
    """
    from ebac.teleop.run_text import conditions

    several("plot_teleop_runs: runs", runs)
    figure = new_figure(max(6.0, 1.4 + 2.4 * len(runs)), 7.0)
    grid = figure.subplots(3, len(runs), squeeze=False, sharex=True, sharey="row")
    for axes, (label, factor, lines) in zip(grid, ROWS, strict=True):
        values = [[factor * run[name] for name, _, _ in lines] for run in runs]
        for ax, run, drawn in zip(axes, runs, values, strict=True):
            for one, (_, text, colour) in zip(drawn, lines, strict=True):
                line(ax, run["t"], one, color=colour, lw=1.2, label=text)
            dress(ax, "")
        axes[0].set_ylabel(label)
        if "energy" in label:
            axes[0].set_yscale("symlog", linthresh=LINEAR)
            axes[0].yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        else:
            _limit(axes, runs, values, label.partition("[")[2].rstrip("]"))
    shared, own = _split([conditions(run) for run in runs])
    for ax, run, differing in zip(grid[0], runs, own, strict=True):
        ax.set_title("\n".join([run.scheme.name, *differing]), fontsize="medium")
    for ax in grid[-1]:
        ax.set_xlabel("time [s]")
        ax.xaxis.set_major_locator(MaxNLocator(3, steps=[1, 2, 5, 10]))
    marks = {
        text: mark
        for ax in grid[:, 0]
        for mark, text in zip(*ax.get_legend_handles_labels(), strict=True)
    }
    figure_legend(figure, list(marks.values()), list(marks))
    figure.suptitle("\n".join(["Teleoperation, simulated", *shared]), fontsize="medium")
    return figure


def _split(conditions: list[tuple[str, ...]]) -> tuple[list[str], list[list[str]]]:
    """Return what all runs share, in one line, and what each has of its own."""
    same = [len(set(one)) == 1 for one in zip(*conditions, strict=True)]
    shared = [text for text, every in zip(conditions[0], same, strict=True) if every]
    own = [[text for text, every in zip(one, same, strict=True) if not every] for one in conditions]
    return (["; ".join(shared)] if shared else []), own


def _limit(
    axes: Sequence[Axes], runs: Sequence[Run], values: list[list[Values]], unit: str
) -> None:
    """Give a row of panels the scale of the calm runs, and name in each what lies beyond it."""
    spans = [(min(one.min() for one in mine), max(one.max() for one in mine)) for mine in values]
    calm = [span for run, span in zip(runs, spans, strict=True) if run.swing_m < CALM] or spans
    low, high = min(one[0] for one in calm), max(one[1] for one in calm)
    more = 0.5 * (BEYOND - 1) * max(high - low, 1.0)
    low = max(low - more, min(one[0] for one in spans))
    high = min(high + more, max(one[1] for one in spans))
    room = 0.05 * max(high - low, 1.0)
    axes[0].set_ylim(low - room, high + room)
    for ax, (least, most) in zip(axes, spans, strict=True):
        mark_cut(ax, least, most, unit)
