"""Teleoperation over networks: shaking, energy and transparency over the delay."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import unknown_name
from ebac.plot.style import Picture, dress, figure_legend, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.teleop.study import Study, StudyRow

#: Okabe and Ito's colours; a marker of its own for each scheme as well.
LOOKS = {
    "position-force": ("#999999", "o"),
    "master-passivity": ("#cc79a7", "v"),
    "two-port-passivity": ("#e69f00", "s"),
    "waves": ("#0072b2", "D"),
    "ebac": ("#009e73", "^"),
    "two-port-ebac": ("#d55e00", "P"),
}
#: From the marks of one scheme to those of the next [ms].
ASIDE = 2.5
#: Delays, at most, of which each is named.
TICKS = 6
#: Below, a swing is drawn as this [mm].
LEAST = 0.005


@takes_its_class("ebac.teleop.study")
def plot_teleop(found: Study, network: str = "rough") -> Picture:
    """Draw a column for each contact: shaking, energy of both ports and transparency over the delay.

    Parameters
    ----------
    found : Study
        What `ebac.teleop.study` returned.
    network : str
        Which of its networks.

    Raises
    ------
    KeyError
        For a network that the study does not have.
    """
    networks = list(dict.fromkeys(row.network for row in found.rows))
    if network not in networks:
        raise unknown_name("network", network, networks)
    rows = [row for row in found.rows if row.network == network]
    contacts = list(dict.fromkeys(row.contact for row in rows))
    figure = new_figure(1.2 + 3.0 * len(contacts), 8.0)
    grid = figure.subplots(3, len(contacts), squeeze=False, sharex=True, sharey="row")
    for column, contact in enumerate(contacts):
        for number, one in enumerate(found.schemes):
            mine = [row for row in rows if row.contact == contact and row.scheme == one.name]
            colour, marker = LOOKS.get(one.name, (f"C{number}", "x"))
            look = {"color": colour, "marker": marker, "label": one.name, "ms": 4, "lw": 1.2}
            # A little aside, so that equal ones do not cover each other.
            aside = ASIDE * (number - 0.5 * (len(found.schemes) - 1))
            delay = [1e3 * row.delay_s + aside for row in mine]
            for ax, values in zip(grid[:, column], _values(mine), strict=True):
                ax.plot(delay, values, **look)
        stiffness = next(row.stiffness_N_per_m for row in rows if row.contact == contact)
        met = f"{contact}, {stiffness:,.0f} N/m" if stiffness else contact
        grid[0, column].set_title(met, fontsize="medium")
        grid[0, column].axhline(0.25, color="0.6", lw=0.8, ls="--")
        grid[2, column].axhline(1, color="0.6", lw=0.8, ls="--")
    for ax in grid.flat:
        dress(ax, "")
    for ax in grid[0]:
        ax.set_yscale("log")
    for ax in grid[1]:
        ax.set_yscale("symlog", linthresh=1)
        ax.set_ylim(4e3 * min(0.0, *(row.least_network_J for row in rows)) - 0.2, 1)
    for ax, text in zip(
        grid[:, 0],
        (
            "shaking of the stick [mm]\ndashed: still below",
            "least energy of\nboth ports [mJ],\nlog beyond -1 mJ",
            "transparency",
        ),
        strict=True,
    ):
        ax.set_ylabel(text)
    delays = sorted({1e3 * row.delay_s for row in rows})
    if len(delays) <= TICKS:
        grid[0, 0].set_xticks(delays)
    for column in grid.T:
        _bottom(column)
    named = [ax for ax in grid[2] if ax.lines]
    if named:  # free motion, which stands first, has none
        grid[2, 0].set_ylabel("")
        named[0].set_ylabel("transparency")
        named[0].tick_params(labelleft=True)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure_legend(figure, handles, labels, columns=3)
    figure.suptitle(
        f"Teleoperation over a {network} network, simulated; worst of the hands, transparency their median\n"
        "The marks of the schemes stand side by side at each delay",
        fontsize="medium",
    )
    return figure


def _bottom(column: NDArray[Any]) -> None:
    """Name the horizontal axis below a column, which ends with the energy where there is no transparency."""
    last = column[2]
    if not any(np.isfinite(one.get_ydata()).any() for one in last.lines[:-1]):
        last.spines[:].set_visible(False)
        last.grid(visible=False)
        last.tick_params(length=0, which="both", labelbottom=False, labelleft=False)
        for one in list(last.lines):
            one.remove()
        text = "no transparency:\nno contact, or no rest"
        last.text(0.5, 0.8, text, ha="center", va="center", transform=last.transAxes, color="0.4")
        column[1].tick_params(labelbottom=True)
        last = column[1]
    last.set_xlabel("delay each way [ms]")


def _values(rows: list[StudyRow]) -> tuple[list[float], list[float], list[float]]:
    shaking = [1e3 * row.shaking_m if np.isfinite(row.shaking_m) else np.nan for row in rows]
    return (
        [float(np.maximum(LEAST, one)) for one in shaking],  # NaN, a gap, where the run did not end
        [1e3 * row.least_network_J for row in rows],
        [row.transparency for row in rows],
    )
