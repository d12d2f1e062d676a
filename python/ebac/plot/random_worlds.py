"""Random hands in random worlds: how many hands draw more than an energy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ebac.plot.style import Numbers, Picture, colour, dress, figure_legend, new_figure
from ebac.studies.world_kinds import KINDS

if TYPE_CHECKING:
    from ebac.studies.random_worlds import RandomWorlds

#: Ends of the axis of energy [mJ], the upper one at least.
LEAST, TOP = 1e-3, 10.0


def plot_random_worlds(found: RandomWorlds) -> Picture:
    """Draw a panel for each kind of world, a line for each law: the share of hands that draw more than an energy.

    Parameters
    ----------
    found : RandomWorlds
        What `ebac.studies.random_worlds` returned.

    Returns
    -------
    Figure
        Hands with all devices, stiffnesses and delays together; the reserve of a law as a vertical line.
    """
    kinds = list(dict.fromkeys(row.kind for row in found.rows))
    figure = new_figure(1.0 + 2.2 * len(kinds), 3.0)
    panels = figure.subplots(1, len(kinds), squeeze=False, sharey=True)[0]
    top = max(TOP, 2e3 * max(row.most_drawn_J for row in found.rows))
    for ax, kind in zip(panels, kinds, strict=True):
        for law in found.laws:
            energies = _energies(found, kind, law)
            shown = energies[energies > LEAST]
            more = np.arange(len(shown), -1, -1) / len(energies)
            x, y = np.concatenate([[LEAST], shown, [top]]), 100 * np.append(more, 0.0)
            ax.step(x, y, where="post", color=colour(law), label=law)
        for reserve in {row.reserve_J for row in found.rows if row.reserve_J}:
            ax.axvline(1e3 * reserve, color="0.35", lw=1, ls="--", label="reserve")
        dress(ax, "")
        ax.set_xscale("log")
        ax.set_xlim(LEAST, top)
        ax.set_title(KINDS[kind].summary, fontsize="medium")
        ax.set_xlabel("energy [mJ]")
    panels[0].set_ylim(-2, 102)
    panels[0].set_ylabel("hands that draw more [%]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure_legend(figure, handles, labels)
    bodies = "moving" if found.moving else "still"
    figure.suptitle(
        f"Random hands in random worlds of {bodies} bodies, simulated", fontsize="medium"
    )
    return figure


def _energies(found: RandomWorlds, kind: str, law: str) -> Numbers:
    """Return what each hand drew [mJ], sorted."""
    of_rows = zip(found.rows, found.drawn_J, strict=True)
    return 1e3 * np.sort(np.concatenate([e for r, e in of_rows if (r.kind, r.law) == (kind, law)]))
