"""A study: how far from the ideal and how restless every hand ends, law by law."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from ebac._util import descriptions
from ebac._util.plural import plural
from ebac.metrics import STILL_SWING
from ebac.plot.study_overview import LONG, overview, wrapped
from ebac.plot.style import Picture, colours, figure_legend, new_figure
from ebac.plot.takes import takes_its_class

if TYPE_CHECKING:
    from ebac.studies import Study

#: Conditions on one page of scatters, laws abreast where there is one condition, failures named in one panel.
PAGE, ABREAST, NAMED = 5, 5, 4
#: What is shown of swing and deviation [mm]; beyond lies on the edge.
LEAST_SWING, MOST = 1e-4, 100.0
#: Where a hand is exact and still; the mark of a good one, of one whose force is not quiet, which shows on top of good
#: ones, and of any other.
EXACT = "0.88"
GOOD: dict[str, Any] = {"marker": "o", "ms": 4, "mew": 0, "alpha": 0.6}
RING: dict[str, Any] = {"marker": "o", "ms": 4, "mew": 0.9, "mfc": "white"}
CROSS: dict[str, Any] = {"marker": "x", "ms": 5, "mew": 1.1}


@takes_its_class("ebac.studies")
def plot_study(study: Study) -> Iterator[tuple[str, Picture]]:
    """Draw a study: an overview, then scatters of deviation against swing, some conditions a page.

    Parameters
    ----------
    study : Study
        What `ebac.study` returned.

    Yields
    ------
    (str, Figure)
        A name for the file, without its suffix, and the figure.
    """
    yield "overview", overview(study, narrow=False)
    resting = [c.name for c in study.conditions if _rests(study, c.name)]
    pages = [resting[i : i + PAGE] for i in range(0, len(resting), PAGE)]
    for number, names in enumerate(pages, 1):
        yield f"hands-{number}" if len(pages) > 1 else "hands", _scatter(study, names, narrow=False)


def _rests(study: Study, condition: str) -> bool:
    return any(row.good is not None for row in study.rows if row.condition == condition)


def _scatter(study: Study, conditions: list[str], *, narrow: bool) -> Picture:
    panels = [(law, condition) for condition in conditions for law in study.laws]
    columns = len(study.laws)
    named = narrow or len(conditions) == 1  # every panel names its law
    if narrow:
        columns = min(2, columns)
    elif named:  # as many below each other as abreast, or nearly
        columns = -(-columns // -(-columns // ABREAST))
    rows = -(-len(panels) // columns)
    figure = (
        new_figure(5, 1.6 + 2.1 * rows)
        if narrow
        else new_figure(1.4 + 3.3 * columns, 1.3 + 2.7 * rows)
    )
    figure.narrow = partial(_scatter, study, conditions, narrow=True)
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    shades = colours(study.laws)
    for (row, column), ax in np.ndenumerate(grid):
        place = row * columns + column
        if place >= len(panels):
            ax.remove()
            continue
        law, condition = panels[place]
        _panel(ax, study, law, condition, shades[law])
        if row == 0 or named:
            name = f"{law}, {condition}" if narrow and len(conditions) > 1 else law
            ax.annotate(
                wrapped(name, LONG), (0.5, 1), (0, 22), "axes fraction", textcoords="offset points",
                ha="center", fontweight="bold", color=shades[law],
            )  # fmt: skip
        if column == 0:
            ax.set_ylabel("deviation [mm]" if narrow else f"{condition}\ndeviation [mm]")
        if place + columns >= len(panels):
            ax.set_xlabel("swing, peak to peak [mm]")
            ax.tick_params(labelbottom=True)
    comes = "comes" if len(study.operators) == 1 else "come"
    figure.suptitle(
        f"How {plural(len(study.operators), 'hand')} {comes} to rest, simulated: {_setting(study, conditions)}",
        fontsize="medium",
    )
    _explain(figure, _summaries(study, conditions))
    return figure


def _explain(figure: Picture, conditions: list[str]) -> None:
    """Explain area, marks and conditions below the panels."""
    marks = [Line2D([], [], ls="", color="0.3", **style) for style in (GOOD, RING, CROSS)]
    figure_legend(
        figure,
        [Patch(color=EXACT), *marks, *(Line2D([], [], ls="") for _ in conditions)],
        [
            "exact and still: a rest within 2 encoder counts of the ideal,\n"
            "or as far as friction holds it, and a swing below 0.25 mm",
            "good: exact, still and quiet in force",
            "exact and still, force not quiet",
            "not exact and still; #5: row 5 of the population",
            *conditions,
        ],
    )


def _setting(study: Study, conditions: list[str]) -> str:
    """Return what the conditions share of device, virtual world and timing."""
    law = next(iter(study.laws))
    runs = np.concatenate([study.runs(law, name) for name in conditions]) % len(study.scenarios)
    device, world, timing = zip(
        *((parts[0], "; ".join(parts[2:-2]), parts[-2])
          for parts in (descriptions.describe(study.scenarios[run]).split("; ") for run in runs)),
        strict=True,
    )  # fmt: skip
    changed = "" if len(set(device)) == 1 else ", changed as each condition says"
    same = [device[0] + changed, *({*world} if len({*world}) == 1 else ())]
    first, *others = (one.split(", ") for one in timing)
    same.append(", ".join(word for word in first if all(word in other for other in others)))
    return "; ".join(filter(None, same))


def _summaries(study: Study, conditions: list[str]) -> list[str]:
    """Return what each of several conditions is, in a line."""
    summaries = {c.name: c.summary for c in study.conditions}
    return [f"{name}: {summaries[name]}" for name in conditions if len(conditions) > 1]


def _panel(ax: Axes, study: Study, law: str, condition: str, shade: str) -> None:
    runs = study.runs(law, condition)
    part = {name: values[runs] for name, values in study.columns.items()}
    swing = np.clip(1e3 * part["swing_m"], LEAST_SWING, MOST)
    deviation = np.clip(1e3 * (part["rest_m"] - part["ideal_m"]), -MOST, MOST)
    band = 1e3 * float(np.median(part["allowed_m"]))
    ax.fill_between([LEAST_SWING, 1e3 * STILL_SWING], -band, band, color=EXACT, lw=0)
    good, there = part["good"], part["exact_and_still"]
    marks: tuple[tuple[NDArray[np.bool_], dict[str, Any]], ...] = (
        (good, GOOD),
        (there & ~good, RING),
        (~there, CROSS),
    )
    for which, style in marks:
        ax.plot(swing[which], deviation[which], ls="", color=shade, **style)
    ax.set_xscale("log")
    ax.set_yscale("symlog", linthresh=0.1)
    ax.set_xlim(LEAST_SWING / 2, 2 * MOST)
    ax.set_xticks([LEAST_SWING, 1e-2, 1, MOST])
    ax.set_ylim(-2 * MOST, 2 * MOST)
    ax.set_yticks([-100, -1, -0.1, 0, 0.1, 1, 100])
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: _at_edge(value)))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: _at_edge(value)))
    ax.grid(color="0.93", lw=0.8)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    _name_worst(ax, swing, deviation, part, band)
    ax.set_title(f"{int(good.sum())} of {len(runs)} good", fontsize="small", loc="left")


def _at_edge(value: float) -> str:
    """Return the label of a tick; on an edge lies what is beyond it as well."""
    if value == LEAST_SWING:
        return "none"
    sign = {MOST: "≥ ", -MOST: "≤ "}.get(value, "")
    return f"{sign}{value:g}"


def _name_worst(
    ax: Axes,
    swing: NDArray[np.float64],
    deviation: NDArray[np.float64],
    part: dict[str, NDArray[Any]],
    band: float,
) -> None:
    """Write the population's row beside the worst failures, those that lie apart."""
    badness = np.maximum(np.abs(deviation) / band, swing / (1e3 * STILL_SWING))
    badness[part["exact_and_still"] | ~np.isfinite(badness)] = 0
    shown: list[tuple[float, float]] = []
    for i in np.argsort(-badness, kind="stable"):
        if badness[i] == 0 or len(shown) == NAMED:
            break
        place = (float(np.log10(swing[i])), float(np.arcsinh(deviation[i] / 0.1)))
        if all(abs(place[0] - x) > 1.4 or abs(place[1] - y) > 1.6 for x, y in shown):
            shown.append(place)
            ax.annotate(
                f"#{part['operator'][i]}", (swing[i], deviation[i]), (4, 3),
                textcoords="offset points", fontsize="x-small",
                path_effects=[withStroke(linewidth=2, foreground="white")],
            )  # fmt: skip
