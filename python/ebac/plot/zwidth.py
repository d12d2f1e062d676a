"""Z-width: the border of every law over the wall's damping, and the area under it."""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from ebac._util import formatting
from ebac._util.arrays import Values
from ebac.plot.shared_lines import draw_shared
from ebac.plot.style import Picture, colours, dress, figure_legend, new_figure

if TYPE_CHECKING:
    from ebac.studies.zwidth import ZWidth

#: Width of a border [points].
WIDTH = 2.0
#: The criteria drawn, a row of panels each.
ROWS = {"still": "still", "quiet": "quiet", "energy": "at most {} mJ", "usable": "usable"}
#: The ceilings: how each is drawn, in the row of panels of its criterion.
CEILINGS: dict[str, dict[str, dict[str, Any]]] = {
    "still": {
        "linear loop, no law": {"color": "black", "ls": (0, (5, 3)), "lw": 1.4},
        "linear loop by formula (Gil et al. 2009), hand on": {
            "color": "black",
            "ls": (0, (1, 2)),
            "lw": 1.4,
        },
    },
    "energy": {"passive without a law": {"color": "0.45", "ls": (0, (6, 2, 1, 2)), "lw": 1.4}},
}


def plot_zwidth(found: ZWidth) -> Picture:
    """Draw a Z-width: borders by criterion and delay, with the ceilings, and the areas below.

    Parameters
    ----------
    found : ZWidth
        What `ebac.studies.zwidth.zwidth` returned.

    Returns
    -------
    Figure
        One column of panels per delay. A law that holds no wall, however soft, is named above the panel, and "none"
        stands in the legend behind one that holds none in any of them; one with "none" at its bar is never quiet. Where
        borders coincide, their dashes take turns.
    """
    columns = len(found.delays)
    bars = 0.9 + 0.26 * len(found.laws)
    figure = new_figure(2.6 + 3.6 * columns, 1.2 + 2.6 * len(ROWS) + bars)
    grid = figure.subplots(
        len(ROWS) + 1, columns, squeeze=False, sharey="row", height_ratios=[2.6] * len(ROWS) + [bars]
    )  # fmt: skip
    for d, delay in enumerate(found.delays):
        for ax, criterion in zip(grid[:, d], ROWS, strict=False):
            _borders(ax, found, criterion, d)
        _areas(grid[-1, d], found, delay)
    absent = [ax.get_title(loc="left") for ax in grid[0]]
    above = "\n" * max(name.count("\n") + 1 if name else 0 for name in absent)
    for ax, delay in zip(grid[0], found.delays, strict=True):
        samples = "1 sample" if delay == 1 else f"{delay} samples"
        ax.set_title(f"delay {samples}{above}", fontsize="medium", fontweight="bold")
    for row, text in enumerate(ROWS.values()):
        words = text.format(f"{1e3 * found.epsilon:g}")
        dress(grid[row, 0], f"{words}\nup to K [kN/m]")
    for ax in grid[len(ROWS) - 1]:
        ax.set_xlabel("wall damping B [N s/m]")
    grid[-1, 0].set_yticks(range(len(found.laws)), found.laws)
    grid[-1, 0].invert_yaxis()
    entries = dict(
        entry
        for ax in grid[: len(ROWS), 0]
        for entry in zip(*reversed(ax.get_legend_handles_labels()), strict=True)
    )
    figure_legend(figure, list(entries.values()), list(entries), columns=5)
    parts = formatting.describe(found.base).split("; ")
    others = f" ({found.random_hands} included)" if found.hands else ""
    figure.suptitle(
        f"Z-width, simulated: {parts[0]}; {parts[1]}; {1e-3 / found.base.timing.dt:g} kHz\n"
        "Hardest wall K that each law renders, by wall damping B: still, still and with a quiet force (quiet), with at "
        f"most {1e3 * found.epsilon:g} mJ drawn from the port{others},\n"
        "and quiet with that energy and at least half of K shown (usable); bars: mean over B",
        fontsize="medium",
    )
    return figure


def _borders(ax: Axes, found: ZWidth, criterion: str, d: int) -> None:
    shades = colours(found.laws)
    for i, (law, shade) in enumerate(shades.items()):
        none = not any(found.limits[name][i].any() for name in ROWS)
        ax.plot([], [], color=shade, lw=WIDTH, label=f"{law} (none)" if none else law)
    drawn = [_kilo(found.limits[criterion][i, d]) for i in range(len(shades))]
    draw_shared(ax, found.dampings, drawn, list(shades.values()), WIDTH)
    ax.axhline(
        1e-3 * found.most_stiffness,
        color="0.6",
        lw=0.8,
        zorder=0,
        label=f"end of the search, {1e-3 * found.most_stiffness:g} kN/m",
    )
    if absent := [law for law, limit in zip(shades, drawn, strict=True) if np.isnan(limit).all()]:
        text = "\n".join(wrap(f"no wall: {', '.join(absent)}", 44))
        ax.set_title(text, fontsize="x-small", color="0.35", loc="left", pad=3)
    for (name, style), (dampings, ceiling) in zip(
        CEILINGS.get(criterion, {}).items(), _ceilings(found, criterion, d), strict=True
    ):
        ax.plot(dampings, _kilo(ceiling), **style, label=name)
    ax.set_ylim(1e-3 * found.least_stiffness, 1.3e-3 * found.most_stiffness)
    ax.set_yscale("log")  # after the limits: it finds none where all lines lie at the top
    ax.yaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_major_locator(MaxNLocator(5))
    ax.xaxis.set_major_formatter("{x:g}")
    dress(ax, "")
    ax.margins(x=0.03)


def _ceilings(found: ZWidth, criterion: str, d: int) -> list[tuple[Values, Values]]:
    """Return damping and stiffness of each ceiling of a criterion, in the order of `CEILINGS`."""
    from ebac.studies.zwidth import delay_ceiling, passive_ceiling

    device, hand = found.base.device, found.base.hand
    timing = found.base.timing.replace(delay=found.delays[d])
    dampings = np.linspace(found.dampings[0], found.dampings[-1], 400)
    values = dampings.tolist()
    if criterion == "still":
        formula = np.array([delay_ceiling(device, timing, b, hand) for b in values])
        return [(found.dampings, found.spectral[d]), (dampings, formula)]
    if criterion == "energy":
        return [(dampings, np.array([passive_ceiling(device, timing, b) for b in values]))]
    return []


def _kilo(newton_per_metre: Values) -> Values:
    return np.where(newton_per_metre > 0, 1e-3 * newton_per_metre, np.nan)


def _areas(ax: Axes, found: ZWidth, delay: int) -> None:
    places = np.arange(len(found.laws))
    shades = list(colours(found.laws).values())
    # Mean stiffness over the damping: the area over its width, a number in kN/m.
    width = 1e3 * float(found.dampings[-1] - found.dampings[0])
    for criterion, thick, alpha in (("quiet", 0.75, 0.3), ("usable", 0.45, 1.0)):
        areas = [found.area(criterion, law, delay) / width for law in found.laws]
        ax.barh(places, areas, thick, color=shades, alpha=alpha, label=criterion)
        for place, area in zip(places, areas, strict=True):
            if criterion == "quiet" and area == 0:
                ax.annotate("none", (0, place), (4, 0), textcoords="offset points", va="center")
    ax.set_xlim(0, 1.02e-3 * found.most_stiffness)
    ax.set_xlabel("mean K [kN/m]; pale: quiet, full: usable")
    dress(ax, "")
