"""Legends above the axes or below the figure, where they cover nothing, in as many columns as fit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.legend import Legend

#: Size of a legend's letters [pt].
LETTERS = 8.33
_ABOVE_AXES: dict[str, Any] = {
    "loc": "lower left",
    "bbox_to_anchor": (0, 1),
    "borderaxespad": 0.1,
    "columnspacing": 1.4,
}
#: The attribute of a legend that keeps how it was made, to make it again in fewer columns.
_OPTIONS = "ebac_options"


def legend(ax: Axes, columns: int = 4, title: str = "") -> None:
    """Put the legend above the axes, and above it a title; nothing where nothing has a label.

    Parameters
    ----------
    ax : Axes
        Which.
    columns : int
        Of the legend.
    title : str
        Printed in bold; it moves up where the legend has more lines.
    """
    if ax.get_legend_handles_labels()[0]:
        options: dict[str, Any] = {"ncols": columns, "frameon": False, "fontsize": LETTERS}
        if title:
            bold = {"weight": "bold", "size": "large"}
            options |= {"title": title, "title_fontproperties": bold, "alignment": "left"}
        _make(ax, {**_ABOVE_AXES, **options})


def figure_legend(
    figure: Figure, handles: Sequence[Artist], labels: Sequence[str], columns: int | None = None
) -> None:
    """Put one legend for all panels below the figure, whose title stands above.

    Parameters
    ----------
    figure : Figure
        Which.
    handles : sequence of Artist
        What is explained.
    labels : sequence of str
        In the same order.
    columns : int, optional
        Default: as many as labels.
    """
    options = {"handles": list(handles), "labels": list(labels), "loc": "outside lower center"}
    _make(
        figure, {**options, "ncols": columns or len(labels), "frameon": False, "fontsize": LETTERS}
    )


def fit_legends(
    figure: Figure,
    renderer: RendererBase,
    letters: float | None,
    undo: list[Callable[[], Any]],
) -> None:
    """Make each legend again, in as many columns as fit above its axes or its figure."""
    for old in [*figure.legends, *(ax.get_legend() for ax in figure.axes)]:
        options = getattr(old, _OPTIONS, None)
        if old is None or options is None:
            continue
        owner: Any = figure if old in figure.legends else old.axes
        size = letters or options["fontsize"]
        room = _room(figure, owner, renderer)
        if letters is None and old.get_window_extent(renderer).width <= room:
            continue
        _drop(figure, old)
        for columns in range(options["ncols"], 0, -1):
            new = _make(owner, {**options, "ncols": columns, "fontsize": size})
            if columns == 1 or new.get_window_extent(renderer).width <= room:
                break
            _drop(figure, new)
        _break_lines(new, room, renderer)
        # last of all, when the lines it copies are as they were
        undo.insert(0, partial(_again, figure, new, owner, options))


def _room(figure: Figure, owner: Axes | Figure, renderer: RendererBase) -> float:
    """Return how wide a legend may be [pixels]."""
    from ebac.plot.save import column_share

    if isinstance(owner, Figure):
        return 0.97 * figure.bbox.width
    labels = owner.yaxis.get_tightbbox(renderer)
    beside = labels.width if labels is not None else 0.0
    return 0.95 * column_share(owner) * figure.bbox.width - beside


def _break_lines(one: Legend, room: float, renderer: RendererBase) -> None:
    """Break the entries of a legend of one column that is too wide into lines that fit."""
    from ebac.plot.save import balanced

    words = [text.get_text() for text in one.get_texts()]
    most = max(map(len, words))
    while most > 12 and one.get_window_extent(renderer).width > room:
        most -= 1
        for text, whole in zip(one.get_texts(), words, strict=True):
            text.set_text("\n".join(balanced(part, most) for part in whole.split("\n")))


def _make(owner: Axes | Figure, options: dict[str, Any]) -> Legend:
    made = owner.legend(**options)
    setattr(made, _OPTIONS, options)
    return made


def _drop(figure: Figure, one: Legend) -> None:
    if one in figure.legends:
        figure.legends.remove(one)
    else:
        one.remove()


def _again(figure: Figure, new: Legend, owner: Axes | Figure, options: dict[str, Any]) -> None:
    _drop(figure, new)
    _make(owner, options)
