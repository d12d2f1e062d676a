"""Stability maps: what each run came to, its swing, the energy it took and where it rests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm
from matplotlib.figure import Figure

from ebac._util import descriptions, formatting
from ebac._util.arrays import Values
from ebac.metrics import STILL_SWING
from ebac.plot.marks import for_law
from ebac.plot.style import Picture, new_figure, plain_decades
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies.maps import MapAxis, StabilityMap

#: Colours of the verdicts, best first; without an ideal rest none is "still, not exact".
VERDICT_COLOURS = ("#0072b2", "#56b4e9", "#c9dff0", "#f0c05a", "#8c2d04")
UNJUDGED_COLOURS = VERDICT_COLOURS[:2] + VERDICT_COLOURS[3:]
#: A logarithmic axis to less than so many times its start has labels within its decades.
SHORT = 25
LINE: dict[str, Any] = {"colors": "black", "linewidths": 1.2, "linestyles": "solid"}


@takes_its_class("ebac.studies.maps")
def plot_map(found: StabilityMap) -> Picture:
    """Draw a map: verdict, swing, energy drawn and, where there is an ideal rest, deviation, one panel each.

    Parameters
    ----------
    found : StabilityMap
        What `ebac.studies.maps.stability_map` returned.

    Returns
    -------
    Figure
        Contours, of the median over a twentieth of each axis: 0.25 mm of swing, 1 mJ, two encoder
        counts and what friction holds.
    """
    figure = new_figure(12, 9)
    grid = figure.subplots(2, 2, sharex=True, sharey=True)
    _verdicts(figure, grid[0, 0], found)
    swing, energy = 1e3 * found["swing_m"], -1e3 * found["least_energy_J"]
    _panel(
        figure, grid[0, 1], found, swing, 1e3 * STILL_SWING, (1e-2, 1e2), "swing, peak to peak [mm]"
    )
    _panel(figure, grid[1, 0], found, energy, 1.0, (1e-2, 1e5), "energy drawn from the port [mJ]")
    along, up = found.axes
    lowest = grid[-1]
    if found.unjudged:
        grid[1, 1].remove()
        lowest = [grid[1, 0], grid[0, 1]]
    else:
        _deviation(figure, grid[1, 1], found)
    for ax in lowest:
        _axis(ax, along, "x", found.xs)
        ax.tick_params(which="both", labelbottom=True)
    for ax in grid[:, 0]:
        _axis(ax, up, "y", found.ys)
    figure.suptitle(_title(found), fontsize="medium")
    return figure


def _title(found: StabilityMap) -> str:
    shares = found.scores()
    parts = for_law(descriptions.describe(found.base), found.law).split("; ")
    quiet, energy, exact = (
        formatting.quantity(shares[f"{name}_share"], "share")
        for name in ("quiet", "energy", "exact")
    )
    judged = f", exact and quiet on {exact}"
    if found.unjudged:
        judged = f"; not judged exact, there is no ideal rest: {found.unjudged}"
    return (
        f"law {found.law}, simulated: {parts[0]}; {parts[1]}; {parts[3]}; the quantities of the axes vary\n"
        f"Quiet on {quiet} of the area, at most 1 mJ drawn from the port on {energy}{judged}"
    )


def _verdicts(figure: Figure, ax: Axes, found: StabilityMap) -> None:
    names = found.verdicts
    colours = ListedColormap(UNJUDGED_COLOURS if found.unjudged else VERDICT_COLOURS)
    norm = BoundaryNorm(np.arange(len(names) + 1) - 0.5, colours.N)
    image = ax.pcolormesh(*_edges(found), found.verdict, cmap=colours, norm=norm, rasterized=True)
    bar = figure.colorbar(image, ax=ax, ticks=range(len(names)), pad=0.02)
    bar.ax.set_yticklabels(names)
    bar.ax.tick_params(length=0)
    ax.set_title("verdict", fontsize="medium")


def _deviation(figure: Figure, ax: Axes, found: StabilityMap) -> None:
    allowed = 1e3 * found["allowed_m"]  # it depends on wall and hand
    deviation = 1e3 * np.abs(found["rest_m"] - found["ideal_m"])
    _panel(figure, ax, found, deviation, allowed, (1e-3, 1e1), "rest, away from the ideal [mm]")


def _panel(
    figure: Figure, ax: Axes, found: StabilityMap, values: Values, limit: float | Values,
    shown: tuple[float, float], title: str,
) -> None:  # fmt: skip
    """Draw values, and a line where they are at their limit, which may be another in each cell."""
    known = np.where(np.isfinite(values), values, shown[1])
    inside = np.clip(known, *shown)
    image = ax.pcolormesh(
        *_edges(found), inside, cmap="viridis_r", norm=LogNorm(*shown), rasterized=True
    )
    bar = figure.colorbar(image, ax=ax, pad=0.02, extend="both")
    low, high = float(np.min(limit)), float(np.max(limit))
    one = f"{low:.2g}" == f"{high:.2g}"
    xs, ys, smooth = _surface(found, np.log(inside) - np.log(limit))
    line = ""
    if smooth.min() < 0 < smooth.max():
        ax.contour(xs, ys, smooth, [0.0], **LINE)
        if one:
            bar.ax.axhline(low, color="black", lw=1.4)
        line = " (line)"
    text = f"{low:.3g}" if one else f"{low:.2g} to {high:.2g}"
    ax.set_title(f"{title}; limit{line}: {text}", fontsize="medium")


def _surface(found: StabilityMap, values: Values) -> tuple[Values, Values, Values]:
    """Return what a contour runs over: borders, not single runs; over whole numbers, steps."""
    sizes = [
        1 if axis.whole else _window(n) for axis, n in zip(found.axes, values.T.shape, strict=True)
    ]
    smooth = _median(values, sizes[1], sizes[0])
    places = [found.xs, found.ys]
    for i, axis in enumerate(found.axes):
        if axis.whole:
            places[i] = np.column_stack((places[i] - 0.499, places[i] + 0.499)).ravel()
            smooth = smooth.repeat(2, axis=1 - i)
    return places[0], places[1], smooth


def _window(count: int) -> int:
    return max(1, count // 20) // 2 * 2 + 1


def _median(values: Values, rows: int, columns: int) -> Values:
    padded = np.pad(values, ((rows // 2,) * 2, (columns // 2,) * 2), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (rows, columns))
    return np.asarray(np.median(windows, axis=(2, 3)))


def _edges(found: StabilityMap) -> tuple[Values, Values]:
    along, up = found.axes
    return _cells(found.xs, along.logarithmic), _cells(found.ys, up.logarithmic)


def _cells(centres: Values, logarithmic: bool) -> Values:
    """Return the edges of cells around their centres."""
    place = np.log(centres) if logarithmic else centres
    middle = 0.5 * (place[1:] + place[:-1])
    edges = np.concatenate(([2 * place[0] - middle[0]], middle, [2 * place[-1] - middle[-1]]))
    return np.exp(edges) if logarithmic else edges


def _axis(ax: Axes, quantity: MapAxis, which: str, values: Values) -> None:
    kilo = quantity.unit == "N/m" and quantity.low >= 1e3  # a wall, not a hand
    unit = f"[{'k' * kilo}{quantity.unit}]"
    getattr(ax, f"set_{which}label")(quantity.label.replace(f"[{quantity.unit}]", unit))
    if quantity.logarithmic:
        getattr(ax, f"set_{which}scale")("log")
        steps = (1, 3) if values[-1] < SHORT * values[0] else (1,)
        plain_decades(getattr(ax, f"{which}axis"), 1000.0**kilo, steps)
