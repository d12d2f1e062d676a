"""The page of an exploration, made with Bokeh: panels, linked axes, and the script that thins."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from importlib.resources import files
from itertools import cycle
from typing import Any

import numpy as np
from bokeh.document import Document
from bokeh.embed import file_html
from bokeh.events import DocumentReady
from bokeh.layouts import gridplot
from bokeh.models import (
    ColumnDataSource,
    CrosshairTool,
    CustomJS,
    CustomJSTicker,
    CustomJSTickFormatter,
    Div,
    HoverTool,
    Label,
    Range1d,
    Span,
)
from bokeh.plotting import figure
from bokeh.resources import INLINE

from ebac._util.gaps import alone
from ebac.explore.exploration import PANEL
from ebac.explore.pack import even, packed
from ebac.explore.panels import Panel, without_numbers
from ebac.explore.thin import bands
from ebac.plot.marks import title
from ebac.plot.style import QUANTITIES, colour
from ebac.trace import Trace

#: For columns without a colour of their own: Okabe and Ito's palette.
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e6ab02")
#: Columns that have the law's colour, as in every figure.
LAWS_OWN = ("true.x", "f_applied", "law.beta", "true.energy")
#: Furthest out and closest in, in spans of the trace and in rows.
FARTHEST, CLOSEST = 1.05, 10


def page(trace: Trace, panels: Sequence[Panel]) -> str:
    """Return the whole page as HTML, its scripts inside."""
    t = np.asarray(trace["t"], dtype=float)
    span = t[-1] - t[0]
    room = 0.5 * (FARTHEST - 1) * span
    window = Range1d(
        float(t[0]),
        float(t[-1]),
        bounds=(float(t[0] - room), float(t[-1] + room)),
        min_interval=CLOSEST * span / (len(t) - 1),
    )
    cursor = CrosshairTool(
        dimensions="height", overlay=Span(dimension="height", line_color="#999999")
    )
    plots, sources, decades = [], [], []
    for panel in panels:
        plot, shown = _draw(panel, trace.law, t, window)
        if reason := without_numbers(trace, panel):
            _write(plot, reason)
        plot.add_tools(cursor)
        plots.append(plot)
        sources += shown
        decades += [panel.decades] * len(shown)
    plots[-1].xaxis.visible = True
    plots[-1].xaxis.axis_label = "time [s]"
    plots[-1].height += 45
    thin = CustomJS(
        args={
            "packed_times": b"" if even(t) else packed(t),
            "packed_columns": [packed(values) for panel in panels for values in panel.values],
            "rows": len(t),
            "first": float(t[0]),
            "last": float(t[-1]),
            "sources": sources,
            "decades": decades,
            "window_": window,
            "plots": plots,
        },
        code=_script("thin.js"),
    )
    window.js_on_change("start", thin)
    window.js_on_change("end", thin)
    column = gridplot(
        [[plot] for plot in plots],
        sizing_mode="stretch_width",
        merge_tools=True,
        toolbar_options={"logo": None},
    )
    document = Document()
    document.add_root(Div(text=f"<b>{escape(title(trace))}</b>".replace("\n", "<br>")))
    document.add_root(column)
    document.js_on_event(DocumentReady, thin)
    return str(file_html(document, INLINE, title=repr(trace)))


def _script(name: str) -> str:
    return files("ebac.explore").joinpath(name).read_text(encoding="utf-8")


def _write(plot: figure, text: str) -> None:
    """Write into a panel without a number why it has none; Bokeh would not even draw its axes."""
    plot.y_range = Range1d(0.0, 1.0)
    plot.yaxis.visible = False
    at: dict[str, Any] = {"x": 12, "y": 60, "x_units": "screen", "y_units": "screen"}
    plot.add_layout(Label(text=text, text_font_size="10pt", text_color="#444444", **at))


def _draw(
    panel: Panel, law: str, t: np.ndarray[tuple[int], np.dtype[np.float64]], window: Range1d
) -> tuple[figure, list[ColumnDataSource]]:
    """Return the plot of a panel and what it draws, one source for each series."""
    plot = figure(
        height=PANEL,
        x_range=window,
        y_axis_label=panel.label,
        tools="xpan,xwheel_zoom,box_zoom,reset,save",
        active_scroll="xwheel_zoom",
        active_drag="xpan",
        output_backend="canvas",
        lod_threshold=None,  # what is drawn is thinned already; Bokeh would leave nine of ten places out
        min_border_left=75,
    )
    sources = []
    for name, values, shade in zip(panel.names, panel.values, colours(panel, law), strict=True):
        thin = bands(values, t)
        scale = np.arcsinh if panel.decades else np.asarray
        low, high = scale(thin.least), scale(thin.most)
        source = ColumnDataSource({**vars(thin), "low": low, "high": high, "alone": alone(high)})
        shown = {"source": source, "legend_label": name}
        # Strokes, not an area: that closes over gaps, and over rows without a least it fills to a chord.
        plot.segment("t", "low", "t", "high", line_color=shade, line_width=2, **shown)
        plot.scatter("t", "alone", size=3, color=shade, **shown)
        plot.line("t", "low", line_color=shade, line_join="bevel", **shown)
        line = plot.line("t", "high", name=name, line_color=shade, line_join="bevel", **shown)
        unit = "" if panel.unit == "1" else f" {panel.unit}"
        plot.add_tools(
            HoverTool(
                renderers=[line],
                tooltips=f"{name} = @most{{0.000000}}{unit} at @t{{0.000000}} s",
                visible=False,
            )
        )
        sources.append(source)
    _dress(plot, panel)
    return plot, sources


def colours(panel: Panel, law: str) -> list[str]:
    """Return the colours of a panel's columns: the law's own, that of the quantity, or one of the palette."""
    others = cycle(PALETTE)
    known = {**QUANTITIES, **dict.fromkeys(LAWS_OWN, colour(law))}
    if "true.x" not in panel.names:
        known["x"] = colour(law)
    return [known.get(name) or next(others) for name in panel.names]


def _dress(plot: figure, panel: Panel) -> None:
    plot.xaxis.visible = False
    plot.grid.grid_line_color = "#e5e5e5"
    plot.outline_line_color = None
    plot.y_range.only_visible = True
    legend = plot.legend[0]
    legend.click_policy = "hide"
    legend.orientation = "horizontal"
    legend.background_fill_alpha = 0.0
    legend.border_line_color = None
    legend.padding, legend.spacing, legend.margin = 0, 12, 2
    legend.label_text_font_size = "8.5pt"
    plot.add_layout(legend, "above")
    if panel.decades:
        plot.yaxis.ticker = CustomJSTicker(major_code=_script("decades.js"))
        plot.yaxis.formatter = CustomJSTickFormatter(
            code="return Number(Math.sinh(tick).toPrecision(6)).toString()"
        )
