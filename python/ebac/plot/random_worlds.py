"""Random hands in random worlds: how many draw more than an energy, and are held back for longer than a time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ebac._util.arrays import Values
from ebac.plot.style import Picture, colours, dress, figure_legend, new_figure
from ebac.plot.takes import takes_its_class
from ebac.studies.random_worlds_result import HELD_BACK
from ebac.studies.world_kinds import KINDS

if TYPE_CHECKING:
    from ebac.studies.random_worlds_result import RandomWorlds

#: Ends of the axis of energy [mJ], the upper one at least; of that of time [s], in which a run lasts 4 s.
LEAST, TOP = 1e-3, 10.0
SHORTEST, LONGEST = 1e-3, 4.0


@takes_its_class("ebac.studies.random_worlds_result")
def plot_random_worlds(found: RandomWorlds) -> Picture:
    """Draw a column for each kind of world, a line for each law: shares of hands, all devices and delays together.

    Parameters
    ----------
    found : RandomWorlds
        What `ebac.studies.random_worlds` returned.

    Returns
    -------
    Figure
        Above, the share of hands that draw more than an energy, with the reserve of a law as a vertical line. Below,
        where a law has a guard, the share that it holds back for longer than a time, with the time that is counted.
    """
    kinds = list(dict.fromkeys(row.kind for row in found.rows))
    guarded = any(row.held_back is not None for row in found.rows)
    figure = new_figure(1.0 + 2.2 * len(kinds), 5.2 if guarded else 3.0)
    panels = figure.subplots(1 + guarded, len(kinds), squeeze=False, sharey="row")
    energies = tuple(1e3 * drawn for drawn in found.drawn_J)
    top = max(TOP, 2 * max(drawn.max() for drawn in energies))
    for ax, kind in zip(panels[0], kinds, strict=True):
        _exceed(ax, found, kind, energies, (LEAST, top))
        for reserve in {row.reserve_J for row in found.rows if row.reserve_J}:
            ax.axvline(1e3 * reserve, color="0.35", lw=1, ls="--", label="reserve")
        ax.set_title(KINDS[kind].summary, fontsize="medium")
        ax.set_xlabel("energy [mJ]")
    panels[0, 0].set_ylim(-2, 102)
    panels[0, 0].set_ylabel("hands that draw more [%]")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    if guarded:
        for ax, kind in zip(panels[1], kinds, strict=True):
            _exceed(ax, found, kind, found.held_back_s, (SHORTEST, LONGEST))
            ax.axvline(HELD_BACK, color="0.35", lw=1, ls=":", label="counted from here")
            ax.set_xlabel("time [s]")
        shares = [np.max(line.get_ydata()) for ax in panels[1] for line in ax.lines[:-1]]
        panels[1, 0].set_ylim(-0.1, max(5.0, 1.05 * max(shares)))
        panels[1, 0].set_ylabel("held back for longer [%]")
        lines, names = panels[1, 0].get_legend_handles_labels()
        handles, labels = [*handles, lines[-1]], [*labels, names[-1]]
    figure_legend(figure, handles, labels)
    bodies = "moving" if found.moving else "still"
    figure.suptitle(
        f"Random hands in random worlds of {bodies} bodies, simulated", fontsize="medium"
    )
    return figure


def _exceed(
    ax: Any,
    found: RandomWorlds,
    kind: str,
    of_rows: tuple[Values, ...],
    ends: tuple[float, float],
) -> None:
    """Draw for each law the share of hands with a larger value than the axis says; none for a law without one."""
    for law, shade in colours(found.laws).items():
        of_law = [
            v
            for row, v in zip(found.rows, of_rows, strict=True)
            if (row.kind, row.law) == (kind, law)
        ]
        values = np.sort(np.concatenate(of_law))
        if np.isnan(values).any():
            continue
        shown = values[values > ends[0]]
        more = np.arange(len(shown), -1, -1) / len(values)
        x, y = np.concatenate([[ends[0]], shown, [ends[1]]]), 100 * np.append(more, 0.0)
        ax.step(x, y, where="post", color=shade, label=law)
    dress(ax, "")
    ax.set_xscale("log")
    ax.set_xlim(*ends)
