"""What stands in one panel of `plot_walls`: a law's position, force or beta, and its end at the scale of counts."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes

from ebac._util.arrays import Values
from ebac.metrics import EXACT_COUNTS, TAIL_SHARE, allowed_deviation
from ebac.plot.marks import fault_name, mark_end
from ebac.plot.style import IDEAL, dress, legend, line
from ebac.trace import Trace

#: The rows of panels: key, label of the axis.
ROWS = {"x": "position [mm]", "f": "applied force [N]", "beta": r"$\beta$ [kN/m]"}


class Run(NamedTuple):
    """A trace, what it is called, and its colour."""

    name: str
    shade: str
    trace: Trace

    @property
    def label(self) -> str:
        """Its name, and the fault that ended it."""
        fault = fault_name(self.trace)
        return f"{self.name}, ended by {fault}" if fault else self.name


class Direction(NamedTuple):
    """The axis of the device that is drawn, and its letter; none where there is but one."""

    axis: int
    letter: str

    def label(self, quantity: str) -> str:
        """Return a label that says which axis it shows."""
        return quantity.replace(" [", f" {self.letter} [") if self.letter else quantity


def positions(trace: Trace, axis: int = 0) -> Values:
    """Return the true positions of the handle [m] where they are known, or its readings."""
    return trace.axis("true.x" if "true.x" in trace else "x", axis)


def has_beta(trace: Trace) -> bool:
    """Return whether the law limits a stiffness that it renders."""
    return "law.beta" in trace and bool(np.isfinite(trace.axis("law.beta")).any())


def first_contact(traces: Sequence[Trace]) -> float:
    """Return when the first law touches anything [s]; the start of the runs when none ever does."""
    touched = [t[0] for trace in traces if len(t := trace["t"][trace.axis("f_env") != 0])]
    return float(min(touched, default=traces[0]["t"][0]))


def begin_and_end(trace: Trace, contact: float) -> tuple[Trace, Trace]:
    """Return a quarter of the run from the first contact on, and its last twentieth."""
    t = trace["t"]
    length = float(t[-1] - t[0])
    begin = max(float(t[0]), min(contact - 0.01 * length, float(t[-1]) - 0.1 * length))
    return trace[begin : contact + 0.25 * length], trace[float(t[-1]) - 0.05 * length :]


def draw_row(ax: Axes, row: str, part: Trace, shade: str, label: str) -> None:
    """Draw one of `ROWS` of a part of a run; of the force also the peak of the motor, where it is reached."""
    style: dict[str, Any] = {"color": shade, "label": label}
    if row == "x":
        line(ax, part["t"], 1e3 * positions(part), lw=1.3, **style)
    elif row == "f":
        force = part.axis("f_applied")
        line(ax, part["t"], force, lw=1.3, **style)
        peak = part.scenario.device.peak_force if part.scenario else np.inf
        for edge in (peak, -peak):
            if np.any(np.sign(edge) * force > 0.999 * peak):
                text = f"peak force of the motor, {peak:.3g} N"
                ax.axhline(edge, color="0.35", lw=1, ls=":", zorder=1.9, label=text)
    elif has_beta(part):
        ax.plot(part["t"], 1e-3 * part.axis("law.beta"), ".", ms=2.5, **style)
    mark_end(ax, part, label=False)


def _band(trace: Trace) -> float:
    """Return what an exact law may be off [mm]."""
    return 1e3 * (allowed_deviation(trace.scenario) if trace.scenario else 0.0)


def beyond_rest(trace: Trace, ideal: float) -> tuple[Values, Values] | None:
    """Return times [s] and places beyond the ideal rest [mm] of the last 30 %; None where they are off the scale."""
    t, band = trace["t"], _band(trace)
    part = trace[float(t[-1] - TAIL_SHARE * (t[-1] - t[0])) :]
    offset = 1e3 * (positions(part) - ideal)
    near = np.ptp(offset) < 10 * band and abs(offset.mean()) < 5 * band
    return (part["t"], offset) if near else None


def draw_near(ax: Axes, runs: Sequence[Run], ideal: float, way: Direction, *, named: bool) -> None:
    """Draw the last 30 % around the ideal point, at the scale of encoder counts; its legend may name the laws."""
    first = runs[0].trace
    scenario, band = first.scenario, _band(first)
    friction = scenario is not None and band > 1.001e3 * EXACT_COUNTS * scenario.device.count
    more = " and friction" if friction else ""
    ax.axhspan(-band, band, color="0.92", label=f"within {EXACT_COUNTS} encoder counts{more}")
    ax.axhline(0, **IDEAL)
    ax.set_ylim(-5 * band, 5 * band)
    away = []
    for run in runs:
        offset = beyond_rest(run.trace, ideal)
        if offset is None:
            away.append(run.name)
        else:
            line(ax, *offset, color=run.shade, lw=1.2, label=run.name if named else "_")
    dress(ax, way.label("beyond the\nideal rest [mm]"))
    ax.set_xlabel("time [s]")
    if away:
        names = fill(f"off this scale: {', '.join(away)}", 60)
        ax.text(0.01, 0.03, names, fontsize="small", transform=ax.transAxes)
    legend(ax)
