"""Saving a figure: as PNG, PDF or SVG, at the width of a journal's column."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from textwrap import wrap
from threading import RLock
from typing import Any, BinaryIO

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.spines import Spine
from matplotlib.text import Text

from ebac._util.arguments import nearest_float, require
from ebac._util.atomic_file import draft
from ebac._util.figure_formats import FORMATS
from ebac.plot.legends import LETTERS, fit_legends
from ebac.plot.style import DPI

#: Widths of a journal's columns [mm].
WIDTHS = {"single": 89.0, "double": 183.0}
#: Dots per inch of a PNG for a journal.
PRINT_DPI = 300
#: Smallest and largest letters in print [pt].
SMALLEST, LARGEST = 6.0, 9.0
#: Narrower and wider figures are refused [mm].
NARROWEST, WIDEST = 40.0, 1000.0
#: Height of a journal's page [mm]: no figure is made higher than that when it is made narrower.
TALLEST = 230.0
_MM = 1 / 25.4
#: Panels of a figure narrower than this stand below one another [in].
NARROW = 5.0
#: So do those of one that shrinks further than to this share of its width as drawn.
SHRUNK = 0.4
#: One figure is drawn at a time: matplotlib's parser of formulas is shared by all threads.
_DRAWING = RLock()

Undo = list[Callable[[], Any]]


def save(
    figure: Figure,
    path: str | Path,
    *,
    file_format: str | None = None,
    width: str | float | None = None,
    title: bool = True,
) -> Path:
    """Save a figure.

    Parameters
    ----------
    figure : Figure
        Stays as it is.
    path : str or Path
        Name of the file; its extension decides on the format unless `file_format` is given.
    file_format : {"png", "pdf", "svg"}, optional
        Replaces the extension of such a format; any other name gets it behind.
    width : {"single", "double"} or float, optional
        Width on paper: one column (89 mm), two columns (183 mm), or millimetres. Letters shrink to
        6 pt at most; legends and titles are broken into lines that fit. Default: as drawn.
    title : bool, optional
        Whether the figure's title, which says what was simulated, is saved with it; in a paper the caption says that.
        The titles of panels stay.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ValueError
        For an unknown format or width.
    OSError
        When the file cannot be written; one of that name stays as it is.
    """
    require(figure, Figure, "ebac.plot.save", "a Figure")
    file = Path(path)
    if file_format is not None:
        stem = file.stem if file.suffix[1:] in FORMATS else file.name
        file = file.with_name(f"{stem}.{file_format}")
    if file.suffix[1:] not in FORMATS:
        raise ValueError(
            f"{file}: a figure is saved as {', '.join(FORMATS)}; give it that ending, {file.name}.png"
        )
    inches = None if width is None else _MM * millimetres(width)
    narrow = getattr(figure, "narrow", None)
    least = max(NARROW, SHRUNK * figure.get_figwidth())
    if narrow is not None and inches is not None and inches < least:
        figure = narrow()
    dpi = DPI if inches is None else PRINT_DPI
    with fitted(figure, inches, title=title), draft(file) as name:
        if file.suffix == ".png":
            write_png(figure, name, dpi)
        else:
            Figure.savefig(figure, name, format=file.suffix[1:], dpi=dpi)
    return file


def write_png(figure: Figure, file: Path | BinaryIO, dpi: float) -> None:
    """Write what `Figure.savefig` writes, drawn once; that draws a figure that lays itself out twice."""
    before = figure.dpi
    figure.dpi = dpi
    try:
        FigureCanvasAgg(figure).print_png(file)  # type: ignore[no-untyped-call]
    finally:
        figure.dpi = before


def millimetres(width: str | float) -> float:
    """Return a width in millimetres: "single", "double", or a number of millimetres.

    Raises
    ------
    ValueError
        For another word, or a width outside [40, 1000] mm.
    """
    try:
        given = WIDTHS.get(width, width) if isinstance(width, str) else width
        value = float(given) if isinstance(given, str) else nearest_float(given)
    except ValueError:
        known = ", ".join(f"{name} ({mm:g} mm)" for name, mm in WIDTHS.items())
        raise ValueError(f"width = {width!r}: must be {known} or millimetres") from None
    if not NARROWEST <= value <= WIDEST:
        raise ValueError(f"width = {value:g} mm: must lie in [{NARROWEST:g}, {WIDEST:g}] mm")
    return value


@contextmanager
def fitted(figure: Figure, inches: float | None = None, *, title: bool = True) -> Iterator[None]:
    """Break legends and titles into lines that fit, at another width if one is given; undone at the end."""
    with _DRAWING:
        undo: Undo = []
        try:
            if not title and (heading := getattr(figure, "_suptitle", None)) is not None:
                _change(heading, "visible", False, undo)
                _change(heading, "in_layout", False, undo)
            letters = None if inches is None else _resize(figure, inches, undo)
            renderer = RendererAgg(*figure.bbox.size, figure.dpi)  # type: ignore[no-untyped-call]
            fit_legends(figure, renderer, letters, undo)
            for text, room in _titles(figure):
                _fit_text(text, room * figure.bbox.width, renderer, undo)
            yield
        finally:
            for step in reversed(undo):
                step()


def _resize(figure: Figure, inches: float, undo: Undo) -> float:
    """Set the width and return the size of a legend's letters; the height follows more slowly, down to a page's."""
    wide, high = figure.get_size_inches()
    factor = inches / wide
    undo.append(lambda: figure.set_size_inches(wide, high))
    figure.set_size_inches(inches, min(high * factor**0.6, max(TALLEST / 25.4, high * factor)))
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            _tick_letters(ax, axis.axis_name, factor, undo)
    for text in figure.findobj(Text):
        _change(text, "fontsize", _letters(text.get_fontsize(), factor), undo)
    thinner = min(1.0, max(factor, 0.5))
    for line in figure.findobj(Line2D):
        _change(line, "linewidth", line.get_linewidth() * thinner, undo)
        _change(line, "markersize", line.get_markersize() * thinner, undo)
    for spine in figure.findobj(Spine):
        _change(spine, "linewidth", spine.get_linewidth() * thinner, undo)
    for lines in figure.findobj(LineCollection):
        _change(
            lines, "linewidth", [w * thinner for w in np.atleast_1d(lines.get_linewidth())], undo
        )
    return _letters(LETTERS, factor)


def _letters(size: Any, factor: float) -> float:
    return float(min(max(size * factor, SMALLEST), LARGEST))


def _tick_letters(ax: Axes, name: Any, factor: float, undo: Undo) -> None:
    """Set the size of tick labels, those too that a new layout brings."""
    labels = ax.get_xticklabels() if name == "x" else ax.get_yticklabels()
    if name not in ("x", "y") or not labels:
        return
    before = labels[0].get_fontsize()
    undo.append(lambda: ax.tick_params(axis=name, labelsize=before))
    ax.tick_params(axis=name, labelsize=_letters(before, factor))


def _change(artist: Any, name: str, value: Any, undo: Undo) -> None:
    before = getattr(artist, f"get_{name}")()
    setter = getattr(artist, f"set_{name}")
    undo.append(lambda: setter(before))
    setter(value)


def _titles(figure: Figure) -> Iterator[tuple[Text, float]]:
    """Yield titles and labels, each with the share of the figure's width it may take."""
    heading = getattr(figure, "_suptitle", None)
    if heading is not None and heading.get_visible():
        yield heading, 0.97
    for ax in figure.axes:
        share = 0.92 * column_share(ax)  # beside a colour bar it is off the middle of its column
        for name in ("title", "_left_title", "_right_title"):
            yield getattr(ax, name), share
        yield ax.xaxis.label, share


def column_share(ax: Axes) -> float:
    """Return the share of the figure's width that belongs to an axes."""
    place = ax.get_subplotspec()
    if place is None:
        return 1.0
    ratios: Any = place.get_gridspec().get_width_ratios()
    columns = range(place.colspan.start, place.colspan.stop)
    return float(sum(ratios[i] for i in columns) / sum(ratios))


def _fit_text(text: Text, room: float, renderer: RendererAgg, undo: Undo) -> None:
    words = text.get_text()
    if not words or (width := text.get_window_extent(renderer).width) <= room:
        return
    undo.append(lambda: text.set_text(words))
    longest = max(len(one) for one in words.split("\n"))
    most = max(12, int(longest * room / width) - 1)
    while most >= 12 and text.get_window_extent(renderer).width > room:
        text.set_text("\n".join(balanced(one, most) for one in words.split("\n")))
        most -= 1  # a line of wide letters may need it


def balanced(text: str, most: int) -> str:
    """Return text in as few lines as fit, of about one length; a number keeps its unit beside it."""
    glued = re.sub(r"(?<=\d) (?=[A-Za-zµ%])|(?<=N) (?=s/m|m\b)", "\N{NO-BREAK SPACE}", text)
    lines = wrap(glued, most)
    for narrower in range(most - 1, 0, -1):
        tried = wrap(glued, narrower, break_long_words=False)
        if len(tried) != len(lines) or max(map(len, tried), default=0) > most:
            break
        lines = tried
    return "\n".join(lines)
