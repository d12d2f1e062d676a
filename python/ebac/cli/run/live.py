"""What a run shows while it runs: force, position, load, lateness, faults."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np

from ebac.cli import output

if TYPE_CHECKING:
    from rich.console import RenderableType

    from ebac.hardware import Configuration, Run
    from ebac.trace import Trace

#: Time between two pictures [s], and the time a picture looks back [s].
_PICTURE, _BACK = 0.1, 1.0
#: Time before the end of a run from which on the view asks to release the handle [s].
_SOON = 3.0
_BAR = 16
_TINY = 1e-12


@contextmanager
def view(configuration: Configuration, *, shown: bool) -> Iterator[Callable[[Run], None]]:
    """Give what a run calls while it runs; the view is on stderr and vanishes at the end."""
    if not shown:
        yield lambda run: None
        return
    from rich.live import Live

    rows = max(1, round(_BACK / configuration.timing.dt))
    with Live(console=output.console(stderr=True), transient=True, auto_refresh=False) as live:
        last = 0.0

        def look(run: Run) -> None:
            nonlocal last
            now = time.monotonic()
            if now - last < _PICTURE:
                return
            last = now
            tail = run.tail(rows)
            if len(tail):
                live.update(picture(configuration, run, tail), refresh=True)

        yield look


def picture(configuration: Configuration, run: Run, tail: Trace) -> RenderableType:
    """Return one picture of a run from its last rows."""
    from rich.console import Group

    from ebac.hardware.axis_positions import axis_name

    nodes = [node.id for node in configuration.drives.nodes]
    grid = output.table(["", *(axis_name(axis, node) for axis, node in enumerate(nodes))])
    limits = configuration.limits
    force = configuration.device.force(limits.peak_current)
    for label, column, most, unit, factor in (
        ("position", "x", limits.end, "mm", 1e3),
        ("force asked", "f_env", force, "N", 1.0),
        ("force applied", "f_applied", force, "N", 1.0),
        ("load (i2t)", "limit.heat", 1.0, "%", 100.0),
    ):
        cells = [
            meter(float(tail.axis(column, axis)[-1]), most, unit, factor)
            for axis in range(tail.axes)
        ]
        grid.add_row(label, *cells)
    return Group(grid, *lines(configuration, run, tail))


def meter(value: float, most: float, unit: str, factor: float) -> str:
    """Return a number with a bar from -most to +most around its middle, or from 0 where it has no sign."""
    signed = unit != "%"
    share = min(1.0, abs(value) / max(most, _TINY))
    half = _BAR // 2 if signed else _BAR
    filled = round(half * share)
    colour = "green" if share < 0.6 else "yellow" if share < 0.9 else "red"
    if not signed:
        bar = f"[{colour}]{'━' * filled}[/][dim]{'─' * (half - filled)}[/]"
    elif value < 0:
        bar = f"[dim]{'─' * (half - filled)}[/][{colour}]{'━' * filled}[/]┼[dim]{'─' * half}[/]"
    else:
        bar = f"[dim]{'─' * half}[/]┼[{colour}]{'━' * filled}[/][dim]{'─' * (half - filled)}[/]"
    return f"{bar} {factor * value:8.2f} {unit}"


def lines(configuration: Configuration, run: Run, tail: Trace) -> list[str]:
    """Return state, lateness, bus and log in words."""
    from ebac._core import Fault, LoopState
    from ebac.metrics import observer_use

    late = 1e6 * np.percentile(tail["lateness"], [50, 99.9])
    fault = Fault(int(tail["fault"][-1]))
    state = LoopState(int(tail["state"][-1])).name.lower()
    t = float(tail["t"][-1])
    shown = [
        f"{state}, {t:.1f} s of {configuration.seconds:g} s, law {run.law.name}"
        + (f", [bold red]fault: {fault.name.lower().replace('_', ' ')}[/]" if fault else ""),
        f"lateness p50 {late[0]:.0f} µs, p99.9 {late[1]:.0f} µs, "
        f"{output.plural(int(tail['skipped'].sum()), 'tick')} skipped in the last {_BACK:g} s",
        f"bus: {output.plural(int(tail['bus.missing'].max()), 'answer')} missing, "
        f"{output.plural(int(tail['bus.refused'].max()), 'frame')} refused",
    ]
    if t > configuration.seconds - _SOON or state == "stop":
        shown.insert(0, "[bold yellow]the run ends: release the handle, every force fades[/]")
    used = observer_use(tail)
    if used is not None:
        shown.append(f"observer: {used}")
    if run.recorder is not None:
        lost = run.recorder.lost
        shown.append(
            f"log: {output.plural(run.recorder.written, 'row')}"
            + (f", [bold red]{lost:,} lost[/]" if lost else ", none lost")
        )
    return shown
