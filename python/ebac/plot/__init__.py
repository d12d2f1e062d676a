"""Figures of traces and studies; they use no global state of pyplot, so any thread may draw."""

from ebac._util.figure_formats import FORMATS
from ebac.plot.ablation import plot_ablation
from ebac.plot.columns import plot_columns
from ebac.plot.engines import plot_engines
from ebac.plot.faults import plot_fault
from ebac.plot.gastroscope import plot_gastroscopy, plot_gastroscopy_study
from ebac.plot.jitter import plot_jitter
from ebac.plot.maps import plot_map
from ebac.plot.overlay import plot_overlay
from ebac.plot.random_worlds import plot_random_worlds
from ebac.plot.run import plot_trace
from ebac.plot.save import WIDTHS, save
from ebac.plot.shapes import plot_shapes
from ebac.plot.stiffest import plot_stiffest
from ebac.plot.study import plot_study
from ebac.plot.style import (
    COLOURS,
    DPI,
    Picture,
    colour,
    dress,
    figure_legend,
    legend,
    line,
    new_figure,
)
from ebac.plot.sweep import plot_sweep
from ebac.plot.teleop import plot_teleop
from ebac.plot.teleop_runs import plot_teleop_runs
from ebac.plot.tissue import plot_tissue
from ebac.plot.tracking import plot_budget, plot_tracking
from ebac.plot.walls import plot_walls
from ebac.plot.workspace import plot_workspace
from ebac.plot.world import plot_world
from ebac.plot.worst import plot_worst
from ebac.plot.zwidth import plot_zwidth

__all__ = [
    "COLOURS",
    "DPI",
    "FORMATS",
    "WIDTHS",
    "Picture",
    "colour",
    "dress",
    "figure_legend",
    "legend",
    "line",
    "new_figure",
    "plot_ablation",
    "plot_budget",
    "plot_columns",
    "plot_engines",
    "plot_fault",
    "plot_gastroscopy",
    "plot_gastroscopy_study",
    "plot_jitter",
    "plot_map",
    "plot_overlay",
    "plot_random_worlds",
    "plot_shapes",
    "plot_stiffest",
    "plot_study",
    "plot_sweep",
    "plot_teleop",
    "plot_teleop_runs",
    "plot_tissue",
    "plot_trace",
    "plot_tracking",
    "plot_walls",
    "plot_workspace",
    "plot_world",
    "plot_worst",
    "plot_zwidth",
    "save",
]


def __dir__() -> list[str]:
    return __all__
