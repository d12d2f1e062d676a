"""One look for every figure: a colour per law, units on axes, legends that cover nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from io import BytesIO
from itertools import cycle
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from numpy.typing import NDArray

from ebac._core import Wall
from ebac._util.arguments import require
from ebac._util.arrays import Values
from ebac._util.atomic_file import draft
from ebac._util.law_colours import COLOURS
from ebac.metrics import ideal_rest
from ebac.plot.legends import figure_legend, legend
from ebac.trace import Trace

#: Colours of laws that have none of their own: a user's, or one with other parameters.
OTHER_LAWS = ("#5f44f8", "#ba0103", "#8d5078")
#: Shares of white, or of black below zero, in the colours of the forms of one design in a picture.
FORMS = (0.0, 0.4, -0.5)
#: One colour per quantity that is not the law's own, in figures and on pages alike.
QUANTITIES = {
    "x": "#a6a6a6",
    "f_env": "#000000",
    "f_meas": "#999999",
    "f_cmd": "#56b4e9",
    "law.beta_max": "#56b4e9",
    "law.beta_min": "#b3a7d6",
    "law.energy": "#000000",
    "law.account": "#000000",
}
#: Better, worse and no difference: blue and orange, which every eye distinguishes.
BETTER, WORSE, SAME = "#92c5de", "#f4a582", "#f2f2f2"
IDEAL: dict[str, Any] = {"color": "black", "ls": (0, (5, 3)), "lw": 1.2}
#: Dots per inch on the screen.
DPI = 150
#: More points than this on one line are thinned to their extremes.
MOST_POINTS = 20_000


__all__ = [
    "BETTER",
    "COLOURS",
    "DPI",
    "IDEAL",
    "MOST_POINTS",
    "OTHER_LAWS",
    "QUANTITIES",
    "SAME",
    "WORSE",
    "Picture",
    "colour",
    "colours",
    "dress",
    "figure_legend",
    "landmarks",
    "legend",
    "line",
    "new_figure",
]  # fmt: skip


class Picture(Figure):
    """A matplotlib figure that notebooks show by themselves and that breaks long titles and legends.

    Attributes
    ----------
    narrow : callable or None
        Draws the same with its panels below one another, for one column of a journal; None where it fits as it is.
    """

    narrow: Callable[[], Picture] | None = None

    def savefig(self, fname: Any, **kwargs: Any) -> None:
        """Save as matplotlib does, with legends and titles broken into lines that fit; a file appears when it is whole.

        Raises
        ------
        OSError
            When the file cannot be written; one of that name stays as it is.
        """
        from ebac.plot.save import fitted

        with fitted(self), ExitStack() as stack:
            ending = Path(fname).suffix if isinstance(fname, (str, PathLike)) else ""
            if ending:  # matplotlib gives one to a name without
                kwargs = {"format": ending[1:], **kwargs}
                fname = stack.enter_context(draft(fname))
            super().savefig(fname, **kwargs)

    def align_ylabels(self, axs: Any = None) -> None:
        """Align labels as matplotlib does, only where there is one: each costs the layout a look at all others."""
        super().align_ylabels([ax for ax in axs or self.axes if ax.get_ylabel()])

    def _repr_png_(self) -> bytes:
        from ebac.plot.save import fitted, write_png

        file = BytesIO()
        with fitted(self):
            write_png(self, file, DPI)
        return file.getvalue()


def new_figure(width: float, height: float) -> Picture:
    """Return an empty figure, size in inches, that lays itself out.

    Parameters
    ----------
    width, height : float
        Size [in].
    """
    return Picture(figsize=(width, height), layout="constrained", dpi=DPI)


def _own_colour(law: str) -> str | None:
    return COLOURS.get(law.partition("-tuned")[0])


def colour(law: str) -> str:
    """Return the colour of a law; a tuned one has that of its design.

    Parameters
    ----------
    law : str
        Its name.

    Returns
    -------
    str
        As matplotlib takes it.
    """
    require(law, str, "ebac.plot.colour", "the name of a law")
    return _own_colour(law) or OTHER_LAWS[0]


def colours(laws: Iterable[str]) -> dict[str, str]:
    """Return the colours of all laws of a picture; those that have none of their own get different ones.

    Of several forms of one design, as `tca` and `tca-tuned`, the first has its colour, the next a lighter one and the
    third a darker one.
    """
    others = cycle(OTHER_LAWS)
    forms: dict[str, Iterator[float]] = {}
    found: dict[str, str] = {}
    for law in dict.fromkeys(laws):
        own = _own_colour(law)
        if own is None:
            found[law] = next(others)
        else:
            found[law] = _mixed(own, next(forms.setdefault(own, cycle(FORMS))))
    return found


def _mixed(shade: str, white: float) -> str:
    """Return a colour with a share of white, or of black where it is below zero."""
    other = 1.0 if white > 0 else 0.0
    red, green, blue = (c + abs(white) * (other - c) for c in to_rgb(shade))
    return to_hex((red, green, blue))


def dress(ax: Axes, ylabel: str) -> None:
    """Give an axes its label, grid and light frame.

    Parameters
    ----------
    ax : Axes
        Which.
    ylabel : str
        What its vertical axis shows, with the unit.
    """
    ax.set_ylabel(ylabel)
    ax.grid(color="0.9", lw=0.8)
    ax.set_axisbelow(True)
    ax.margins(x=0.01)
    ax.spines[["top", "right"]].set_visible(False)


def plain_decades(axis: Axis, unit: float = 1.0, steps: tuple[int, ...] = (1, 2, 5)) -> None:
    """Label a logarithmic axis at 1, 2 and 5 of each decade, or at other steps, in plain numbers of a unit."""
    axis.set_major_locator(LogLocator(subs=steps))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / unit:g}"))
    axis.set_minor_formatter(NullFormatter())


def line(ax: Axes, t: Values, y: Values, **style: Any) -> None:
    """Draw a line, thinned to its extremes where it has very many points.

    Parameters
    ----------
    ax : Axes
        Which.
    t, y : array, shape (n,)
        Points of the line.
    **style
        As `Axes.plot` takes it.
    """
    keep = _extremes(y)
    ax.plot(t[keep], y[keep], **style)


def _extremes(y: Values) -> NDArray[np.intp] | slice:
    if len(y) <= MOST_POINTS or not np.isfinite(y).all():
        return slice(None)
    size = 2 * len(y) // MOST_POINTS + 1
    bins = y[: len(y) // size * size].reshape(-1, size)
    start = np.arange(len(bins)) * size
    rest = np.arange(len(bins) * size, len(y))  # rows of no bin: less than one
    chosen = np.concatenate((start + bins.argmin(1), start + bins.argmax(1), rest, [len(y) - 1]))
    return np.unique(chosen)


def landmarks(ax: Axes, trace: Trace) -> None:
    """Mark the wall's surface and where an ideal wall would rest."""
    scenario = trace.scenario
    if scenario is None:
        return
    ideal = (
        ideal_rest(scenario) if "true.x" in trace and not trace.changed else None
    )  # a real hand is not that of a scenario
    if isinstance(scenario.environment, Wall) and scenario.environment.angle == 0:
        surface = 1e3 * scenario.environment.position
        at_first = " at the start" if trace.changed else ""
        style: dict[str, Any] = {"color": "0.35", "lw": 1, "label": f"wall surface{at_first}"}
        if swing := 1e3 * scenario.environment.motion_amplitude:
            t = trace["t"][(trace["t"] >= ax.dataLim.x0) & (trace["t"] <= ax.dataLim.x1)]
            turns = scenario.environment.motion_frequency * t
            ax.plot(t, surface + swing * np.sin(2 * np.pi * turns), **style)
        else:
            ax.axhline(surface, **style)
    if ideal is not None:
        ax.axhline(1e3 * ideal, **IDEAL, label=f"ideal rest, {1e3 * ideal:.3f} mm")
