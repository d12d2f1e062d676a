"""One run over time: position, force, beta and energy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.gridspec import GridSpec

from ebac._util.arguments import require
from ebac._util.arrays import Values
from ebac._util.plural import plural
from ebac.plot.columns import plot_columns
from ebac.plot.decades import StiffnessScale
from ebac.plot.marks import mark_changes, mark_end, no_beta, title, used_axes
from ebac.plot.style import (
    QUANTITIES,
    Picture,
    colour,
    dress,
    landmarks,
    legend,
    line,
    new_figure,
)
from ebac.trace import Trace

if TYPE_CHECKING:
    from ebac.logs import Event

#: Columns that every loop of ebac has.
LOOP = ("x", "f_env", "f_meas", "f_cmd", "f_applied", "work", "damped")
#: The first contact is enlarged: from so long before to so long after it begins [s], in a run that is longer by LONG.
AROUND, LONG = (0.02, 0.23), 4.0
#: Width of its panels, over that of the others.
CONTACT_SHARE = 0.6
#: Width of the panels of one axis [in], by how many stand side by side: a figure that is too wide is read too small.
WIDTHS = {1: 8.0, 2: 6.2, 3: 5.0}
#: A beta that changes by less is constant [N/m]: its panel begins with 1 kN/m, and rounding alone changes it.
LEAST_CHANGE = 1.0
#: Label and style of each energy, by the column that it is of.
ENERGIES: dict[str, tuple[str, dict[str, Any]]] = {
    "work": ("work + damped energy", {"color": "0.75", "lw": 3}),
    "law.energy": ("account of the law", {"color": "black"}),
    "law.account": ("account of the law", {"color": "black"}),
    "true.energy": ("port energy", {}),
}
#: Label of each bound on beta: both follow from the largest force that the energy allows, to either side.
BOUNDS = {
    "law.beta_max": "highest that the energy bound allows",
    "law.beta_min": "lowest",
}
#: Draws a part of a run on one axis of the device, on the scales of the whole run.
Panel = Callable[[Axes, Trace, int, Trace], None]


def plot_trace(trace: Trace, *, events: Sequence[Event] = (), scale: str | None = None) -> Picture:
    """Draw a run: position, force, beta and energy over time, one column of panels per axis in use.

    A log that lacks columns of a loop, such as one of another program, is drawn with all of its columns that change.

    Parameters
    ----------
    trace : Trace
        At least two rows.
    events : sequence of Event
        Those of its log: what was changed while it ran is marked, each change by a line and a number.
    scale : "linear", "log" or None
        Of beta; default: "log", as its bounds run over decades.

    Returns
    -------
    Figure
        Save it with `savefig`, or with `ebac.plot.save` for a journal.

    Raises
    ------
    ValueError
        When the trace is too short.
    """
    require(trace, Trace, "ebac.plot.plot_trace", "a Trace")
    if len(trace) < 2:
        raise ValueError(f"the trace has {plural(len(trace), 'row')}: a figure needs at least 2")
    if not all(name in trace for name in LOOP):
        others = [name for name in trace if name not in ("t", "tick")]
        moving = [name for name in others if (trace[name] != trace[name][:1]).any()]
        return plot_columns(trace, moving or others, scale=scale)
    used = used_axes(trace)
    with_beta = [axis for axis in used if _has_beta(trace, axis)]
    constant = [axis for axis in with_beta if len(used) > 1 and _beta_is_constant(trace, axis)]
    with_beta = [axis for axis in with_beta if axis not in constant]
    panels: list[Panel] = [_position, _force, _energy]
    beta: Panel = partial(_beta, scale=scale or "log")
    if with_beta:  # last where an axis lacks it, so that all else stands side by side
        panels.insert(2 if with_beta == used else len(panels), beta)
    contact = _first_contact(trace, used[0]) if len(used) == 1 else None
    figure = new_figure(1.5 + WIDTHS[min(len(used), 3)] * len(used), 1.0 + 2.4 * len(panels))
    shares = [1.0] * len(used) if contact is None else [1.0, CONTACT_SHARE]
    grid = figure.add_gridspec(len(panels), len(shares), width_ratios=shares)
    for column, axis in enumerate(used):
        above: Axes | None = None
        drawn = [draw for draw in panels if draw is not beta or axis in with_beta]
        for row, draw in enumerate(drawn):
            above = figure.add_subplot(grid[row, column], sharex=above)
            draw(above, trace, axis, trace)
            if trace.axes > 1 and row == 0:
                legend(above, columns=6, title=f"axis {axis}")
            _time_below(above, last=row == len(drawn) - 1)
    if contact is not None:
        _enlarge(figure.axes, grid, panels, contact, used[0], trace)
    figure.align_ylabels()
    changes = [event for event in events if event.kind == "parameter"]
    mark_changes(figure.axes, changes)
    idle = [str(axis) for axis in range(trace.axes) if axis not in used]
    note = f"\naxis {', '.join(idle)} not in use, not shown" if idle else ""
    if constant:
        several = "axes" if len(constant) > 1 else "axis"
        note += f"\nbeta is constant on {several} {', '.join(map(str, constant))}, not shown"
    elif "law.beta" in trace and beta not in panels:
        note += f"\nbeta is not shown: {no_beta(trace)}"
    for number, change in enumerate(changes, start=1):
        note += f"\n{number}, at {change.t:.4g} s: {change.message}"
    figure.suptitle(title(trace) + note, fontsize="medium")
    return figure


def _first_contact(trace: Trace, axis: int) -> Trace | None:
    """Return the rows around the first contact; None without one, or where they are much of the run."""
    t = trace["t"]
    asked = trace.axis("f_env", axis)
    met = np.flatnonzero(np.isfinite(asked) & (asked != 0))
    if not met.size or t[-1] - t[0] < LONG * sum(AROUND):
        return None
    before, after = AROUND
    part = trace.between(t[met[0]] - before, t[met[0]] + after)
    return part if len(part) > 1 else None


def _enlarge(
    beside: list[Axes], grid: GridSpec, panels: list[Panel], part: Trace, axis: int, whole: Trace
) -> None:
    """Draw a part of a run beside its panels, on their scales."""
    above: Axes | None = None
    for row, (draw, left) in enumerate(zip(panels, beside, strict=True)):
        above = left.figure.add_subplot(grid[row, -1], sharex=above, sharey=left)
        draw(above, part, axis, whole)
        above.set_ylabel("")
        above.tick_params(labelleft=False)
        if explained := above.get_legend():
            explained.remove()
        if row == 0:
            above.set_title("first contact", fontsize="medium")
        _time_below(above, last=row == len(panels) - 1)


def _time_below(ax: Axes, *, last: bool) -> None:
    ax.tick_params(labelbottom=last)
    if last:
        ax.set_xlabel("time [s]")


def _has_beta(trace: Trace, axis: int) -> bool:
    return "law.beta" in trace and bool(np.isfinite(trace.axis("law.beta", axis)).any())


def _beta_is_constant(trace: Trace, axis: int) -> bool:
    beta = trace.axis("law.beta", axis)
    return bool(np.ptp(beta[np.isfinite(beta)]) < LEAST_CHANGE)


def _position(ax: Axes, trace: Trace, axis: int, whole: Trace) -> None:
    t, scenario = trace["t"], trace.scenario
    if "true.x" in trace:
        line(ax, t, 1e3 * trace.axis("x", axis), color=QUANTITIES["x"], lw=2.2, label="x, encoder")
        line(ax, t, 1e3 * trace.axis("true.x", axis), color=colour(trace.law), label="x, true")
    else:
        line(ax, t, 1e3 * trace.axis("x", axis), color=colour(trace.law), label="x, encoder")
    if scenario and axis == 0:
        landmarks(ax, trace)
    mark_end(ax, trace)
    dress(ax, "position [mm]")
    legend(ax, columns=6)


def _force(ax: Axes, trace: Trace, axis: int, whole: Trace) -> None:
    t = trace["t"]
    asked = trace.axis("f_env", axis)
    if trace.scenario is None or trace.scenario.device.sensor.fitted:
        style: dict[str, Any] = {"color": QUANTITIES["f_meas"], "lw": 1.4}
        line(ax, t, trace.axis("f_meas", axis), label="measured, $F_M$", **style)
    line(
        ax,
        t,
        trace.axis("f_cmd", axis),
        color=QUANTITIES["f_cmd"],
        lw=2.2,
        label="commanded, $F_c$",
    )
    line(ax, t, trace.axis("f_applied", axis), color=colour(trace.law), lw=1.0, label="applied")
    if "log.f_cmd" in trace:
        line(
            ax, t, trace.axis("log.f_cmd", axis), color="black", ls=":", label="commanded, recorded"
        )
    limited = np.concatenate([whole.axis(n, axis) for n in ("f_meas", "f_cmd", "f_applied")])
    low, high = _span(limited)
    room = 0.15 * max(high - low, 1.0)
    ax.set_ylim(low - room, high + room)  # what is asked may go far beyond
    least, most = _span(whole.axis("f_env", axis))
    beyond = max(most - high, low - least) > room
    far = f", beyond the panel to {max(least, most, key=abs):.3g} N" if beyond else ""
    line(ax, t, asked, color="black", lw=0.6, zorder=1.9, label=f"environment, $F_e${far}")
    mark_end(ax, trace, label=False)
    dress(ax, "force [N]")
    legend(ax, columns=5)


def _span(values: Values) -> tuple[float, float]:
    """Return the least and the most of what is finite; zeros where nothing is."""
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)


def _beta(ax: Axes, trace: Trace, axis: int, whole: Trace, scale: str) -> None:
    t, beta = trace["t"], trace.axis("law.beta", axis) / 1e3
    range_ = StiffnessScale.of([whole.axis("law.beta", axis) / 1e3], scale)
    for name, label in BOUNDS.items():
        if name in trace:
            bound = trace.axis(name, axis) / 1e3
            ax.plot(
                t,
                range_.cut(bound),
                ".",
                ms=2.5,
                color=QUANTITIES[name],
                label=range_.named(label, whole.axis(name, axis) / 1e3),
            )
    ax.plot(t, range_.cut(beta), ".", ms=3.5, color=colour(trace.law), label=r"$\beta$ taken")
    if (shown := stiffness_in_motion(whole, axis)) is not None:
        ax.axhline(
            shown / 1e3, color="0.35", lw=1, zorder=1.9, label=f"$c_h$, {shown / 1e3:.3g} kN/m"
        )
    if "law.clamped" in trace:
        _ticks(ax, t[trace.axis("law.clamped", axis) != 0])
    range_.set(ax)
    mark_end(ax, trace, label=False)
    dress(ax, r"$\beta$ [kN/m]")
    legend(ax)


def stiffness_in_motion(trace: Trace, axis: int = 0) -> float | None:
    """Return the stiffness c_h [N/m] that `ebac` shows a handle in motion, if the trace contains it.

    Its bound |F_d(t)| <= |F_d(t-1) + c_h dx| limits beta to c_h on one side: from above while the handle moves in, from
    below while it comes out. The other limit turns the force round, and is mostly far away.
    """
    if not trace.law_repr.startswith("EBAC("):
        return None
    low, high = trace.axis("law.beta_min", axis), trace.axis("law.beta_max", axis)
    known = np.isfinite(low) & np.isfinite(high)
    if not known.any():
        return None
    shown = float(np.median(np.where(low > 0, low, high)[known]))
    one_side = np.isclose(low, shown) | np.isclose(high, shown)
    return shown if one_side[known].all() else None


def _ticks(ax: Axes, t: Values) -> None:
    """Mark instants along the lower edge."""
    ax.plot(
        t,
        np.full(len(t), 0.03),
        "|",
        ms=5,
        mew=0.5,
        color="0.3",
        transform=ax.get_xaxis_transform(),
        label="force limited",
    )


def _energies(trace: Trace, axis: int) -> dict[str, Values]:
    """Return work with what was damped, and the accounts that a trace has [J]."""
    work = trace.axis("work", axis) + trace.axis("damped", axis)
    return {"work": work} | {n: trace.axis(n, axis) for n in ENERGIES if n != "work" and n in trace}


def _energy(ax: Axes, trace: Trace, axis: int, whole: Trace) -> None:
    every = np.concatenate([*_energies(whole, axis).values()])
    factor, unit = (1e3, "mJ") if max(map(abs, _span(every))) < 1 else (1.0, "J")
    for name, values in _energies(trace, axis).items():
        label, style = ENERGIES[name]
        line(ax, trace["t"], factor * values, label=label, **{"color": colour(trace.law), **style})
    ax.axhline(0, color="0.35", lw=1)
    mark_end(ax, trace, label=False)
    dress(ax, f"energy [{unit}]")
    legend(ax)
