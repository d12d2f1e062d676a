"""Figures of traces and studies; they use no global state of pyplot, so any thread may draw."""

from ebac.plot.ablation import plot_ablation
from ebac.plot.columns import plot_columns
from ebac.plot.faults import plot_fault
from ebac.plot.jitter import plot_jitter
from ebac.plot.maps import plot_map
from ebac.plot.run import plot_trace
from ebac.plot.study import plot_study
from ebac.plot.style import COLOURS, DPI, Picture, colour, dress, legend, line, new_figure
from ebac.plot.walls import plot_walls
from ebac.plot.worst import plot_worst
from ebac.plot.zwidth import plot_zwidth

__all__ = [
    "COLOURS",
    "DPI",
    "Picture",
    "colour",
    "dress",
    "legend",
    "line",
    "new_figure",
    "plot_ablation",
    "plot_columns",
    "plot_fault",
    "plot_jitter",
    "plot_map",
    "plot_study",
    "plot_trace",
    "plot_walls",
    "plot_worst",
    "plot_zwidth",
]
