"""Z-width: the border of every law over the wall's damping, and the area under it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, MaxNLocator
from numpy.typing import NDArray

from ebac._util import descriptions
from ebac._util.arrays import Values
from ebac.plot.shared_lines import side_by_side
from ebac.plot.style import Picture, colours, dress, figure_legend, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies.zwidth import ZWidth

#: Width of a border and size of its marks [points]; the height of a panel [inch], and in one column.
WIDTH, MARK = 1.4, 4.0
HEIGHT, NARROW_HEIGHT = 2.8, 1.9
#: Letters of a line of the names above a panel, and in one column; room for such a line [points].
LETTERS, NARROW_LETTERS, LINE = 44, 26, 9
#: One mark per law, in their order.
MARKS = "osD^v<>PXhp*d"
#: The mark of a damping at which a law holds no wall.
OPEN: dict[str, Any] = {"ls": "", "ms": MARK, "mfc": "white", "mew": 0.9, "zorder": 3}
#: The criteria that can be drawn: the label of a panel.
LABELS = {"usable": "usable", "energy": "at most {} mJ", "quiet": "quiet", "still": "still"}
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


@takes_its_class("ebac.studies.zwidth")
def plot_zwidth(found: ZWidth, criteria: Sequence[str] = ("usable", "energy")) -> Picture:
    """Draw a Z-width: borders by criterion and delay, with the ceilings, and the areas below.

    Parameters
    ----------
    found : ZWidth
        What `ebac.studies.zwidth.zwidth` returned.
    criteria : sequence of {"usable", "energy", "quiet", "still"}
        A row of panels each.

    Returns
    -------
    Figure
        One column of panels per delay, with a mark at every wall damping that was searched; it is open and lies on the
        lower edge where a law holds no wall, however soft. A law that holds none at any damping is named above the
        panel, and "none" stands in the legend behind one that holds none in any of them; one with "none" at its bar is
        never quiet. Borders that coincide are drawn side by side, the true one on top.

    Raises
    ------
    ValueError
        When there is no criterion, or one is unknown.
    """
    if not criteria or not set(criteria) <= set(LABELS):
        raise ValueError(f"criteria = {criteria!r}: must be some of {', '.join(LABELS)}")
    return _draw(found, list(criteria), narrow=False)


def _draw(found: ZWidth, criteria: list[str], *, narrow: bool) -> Picture:
    delays = len(found.delays)
    bars = 0.7 + (0.17 if narrow else 0.26) * len(found.laws)
    panel = NARROW_HEIGHT if narrow else HEIGHT
    down, abreast = (delays, len(criteria)) if narrow else (len(criteria), delays)
    figure = new_figure(5 if narrow else 2.6 + 3.6 * delays, 1.4 + panel * down + bars)
    figure.narrow = partial(_draw, found, criteria, narrow=True)
    ratios = [panel] * down + [bars]
    grid = figure.add_gridspec(len(ratios), abreast * delays, height_ratios=ratios)
    first: Axes | None = None
    headings: dict[Axes, str] = {}
    for row, column in np.ndindex(down, abreast):
        c, d = (column, row) if narrow else (row, column)
        place = grid[row, delays * column : delays * (column + 1)]
        ax = figure.add_subplot(place, sharex=first, sharey=first)
        first = first or ax
        _borders(ax, found, criteria[c], d, panel)
        _name_absent(ax, found, criteria[c], d, NARROW_LETTERS if narrow else LETTERS)
        words = LABELS[criteria[c]].format(f"{1e3 * found.epsilon:g}")
        samples = "1 sample" if found.delays[d] == 1 else f"{found.delays[d]} samples"
        across, beside = (words, f"delay {samples}") if narrow else (f"delay {samples}", words)
        if row == 0:
            headings[ax] = across
        if column == 0:
            ax.set_ylabel(f"{beside}\nup to K [kN/m]")
        if row == down - 1:
            ax.set_xlabel("wall damping B [N s/m]")
        ax.tick_params(labelleft=column == 0, labelbottom=row == down - 1)
    _head(headings)
    below: Axes | None = None
    for d, delay in enumerate(found.delays):
        ax = figure.add_subplot(grid[-1, abreast * d : abreast * (d + 1)], sharey=below)
        _areas(ax, found, delay)
        ax.tick_params(labelleft=below is None)
        if below is None:
            below = ax
            ax.set_yticks(range(len(found.laws)), found.laws)
            ax.invert_yaxis()
        if narrow and delays > 1:
            ax.set_xlabel(f"delay {delay}\nmean K [kN/m]" if d != delays // 2 else
                          f"delay {delay}\nmean K [kN/m]\npale: quiet, full: usable")  # fmt: skip
    entries = dict(
        entry
        for ax in figure.axes[:-delays]
        for entry in zip(*reversed(ax.get_legend_handles_labels()), strict=True)
    )
    figure_legend(figure, list(entries.values()), list(entries), columns=5)
    figure.suptitle(_title(found, criteria), fontsize="medium")
    return figure


def _title(found: ZWidth, criteria: list[str]) -> str:
    parts = descriptions.describe(found.base).split("; ")
    energy = f"{1e3 * found.epsilon:g} mJ drawn"
    if found.hands:
        energy += f" ({found.random_hands} included)"
    means = {
        "usable": f"usable: quiet, at most {energy}, and at rest at least half of K is rendered",
        "energy": "" if "usable" in criteria else f"at most {energy}",
        "quiet": "quiet: still, with a quiet force",
        "still": "still: no limit cycle",
    }
    lines = [
        f"Z-width, simulated: {parts[0]}; {parts[1]}; {1e-3 / found.base.timing.dt:g} kHz",
        "; ".join(
            [
                "hardest wall K by wall damping B",
                *filter(None, (means[c] for c in criteria)),
                "borders that coincide are drawn below each other, the top one is true",
            ]
        ),
    ]
    return "\n".join(lines)


def _head(headings: dict[Axes, str]) -> None:
    """Write a heading above each panel, all at one height, just above the names of laws that stand there."""
    lines = max(len(ax.get_title(loc="left").splitlines()) for ax in headings)
    for ax, words in headings.items():
        ax.annotate(
            words, (0.5, 1), (0, 5 + LINE * lines), "axes fraction", textcoords="offset points",
            ha="center", fontweight="bold",
        )  # fmt: skip


def _name_absent(ax: Axes, found: ZWidth, criterion: str, d: int, letters: int) -> None:
    """Name the laws that hold no wall in a panel."""
    limits = found.limits[criterion][:, d]
    if absent := [law for law, limit in zip(found.laws, limits, strict=True) if not limit.any()]:
        text = "\n".join(wrap(f"no wall: {', '.join(absent)}", letters, break_on_hyphens=False))
        ax.set_title(text, fontsize="x-small", color="0.35", loc="left", pad=3)


def _borders(ax: Axes, found: ZWidth, criterion: str, d: int, height: float) -> None:
    ax.set_ylim(1e-3 * found.least_stiffness, 1.3e-3 * found.most_stiffness)
    ax.set_yscale("log")  # after the limits: it finds none where all lines lie at the top
    low, high = np.log(ax.get_ylim())
    step = float(np.exp(-(high - low) * 1.3 * WIDTH / (72 * 0.8 * height)))  # labels take a fifth
    drawn = _kilo(found.limits[criterion][:, d])
    shades = colours(found.laws)
    for i, (law, border) in enumerate(zip(shades, side_by_side(drawn, step), strict=True)):
        none = not any(found.limits[name][i].any() for name in LABELS)
        ax.plot(
            found.dampings, border, color=shades[law], lw=WIDTH, marker=MARKS[i % len(MARKS)], ms=MARK, mew=0,
            label=f"{law} (none)" if none else law,
        )  # fmt: skip
    ax.axhline(
        1e-3 * found.most_stiffness,
        color="0.6",
        lw=0.8,
        zorder=0,
        label=f"end of the search, {1e-3 * found.most_stiffness:g} kN/m",
    )
    _failures(ax, found, np.isnan(drawn), np.exp((high - low) * 1.2 * MARK / (72 * 0.8 * height)))
    for (name, style), (dampings, ceiling) in zip(
        CEILINGS.get(criterion, {}).items(), _ceilings(found, criterion, d), strict=True
    ):
        ax.plot(dampings, _kilo(ceiling), **style, label=name)
    ax.yaxis.set_major_locator(LogLocator(numticks=10))  # every decade
    ax.yaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_major_locator(MaxNLocator(5))
    ax.xaxis.set_major_formatter("{x:g}")
    dress(ax, "")
    ax.margins(x=0.03)


def _failures(ax: Axes, found: ZWidth, failed: NDArray[np.bool_], step: float) -> None:
    """Mark where laws that hold some walls hold none at a damping: on the lower edge, one above the other."""
    failed = failed & ~failed.all(axis=1, keepdims=True)
    places = side_by_side(np.where(failed, 1e-3 * found.least_stiffness, np.nan), step)
    for i, (shade, place) in enumerate(zip(colours(found.laws).values(), places, strict=True)):
        ax.plot(
            found.dampings, place, color=shade, marker=MARKS[i % len(MARKS)], **OPEN, clip_on=False
        )  # fmt: skip
    if failed.any():
        ax.plot([], [], color="0.3", marker="o", **OPEN, label="no wall at this damping")


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
