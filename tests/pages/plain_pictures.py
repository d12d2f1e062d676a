"""Draws the PNG of a command without laying it out, two thirds of its time, where a test is not about pictures.

Of those whose axes have the same labels a process draws the first, and of all pages that a process follows the first
one does; ticks and their texts are most of what is left.
`test_figures.py` and `test_plot.py` lay out every kind of figure, the building of the site those of its pages.
"""

from importlib import import_module
from pathlib import Path
from typing import Any, BinaryIO

from matplotlib.figure import Figure

#: The module; the package has a function of the same name.
SAVE: Any = import_module("ebac.plot.save")
write_png = SAVE.write_png
#: Enough to be a picture.
DPI = 40.0
#: Labels of the axes of what was drawn and written.
drawn: set[str] = set()


def draw_plain(figure: Figure, file: Path | BinaryIO, _dpi: float) -> None:
    """Stand in for `ebac.plot.save.write_png`."""
    kind = repr([(axes.get_xlabel(), axes.get_ylabel()) for axes in figure.axes])
    if kind in drawn:
        write_png(Figure(), file, DPI)
        return
    layout = figure.get_layout_engine()
    figure.set_layout_engine("none")
    try:
        write_png(figure, file, DPI)
    finally:
        figure.set_layout_engine(layout)
    drawn.add(kind)
