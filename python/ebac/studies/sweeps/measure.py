"""One bundle of runs, measured: by the threads of the core, laws and hands in Python one after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import nan
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ebac._core import Fault, RunLimits, SweepProgress
from ebac._util.foreign_worlds import foreign
from ebac.hands import is_own
from ebac.laws import CoreLaw, PythonLaw
from ebac.metrics import FEWEST_ROWS, allowed_deviation, contact, ideal_rest
from ebac.metrics.wall_contact import COLUMNS, FLAGS
from ebac.scenario import Scenario
from ebac.simulation import LoopFault, simulate
from ebac.trace import Trace

Columns: TypeAlias = dict[str, NDArray[Any]]
Run: TypeAlias = tuple[Scenario, CoreLaw | PythonLaw]

#: Columns beside the numbers of a contact, and what they hold of a run that was not done.
STATUS: dict[str, tuple[str, Any]] = {
    **dict.fromkeys(FLAGS, ("?", False)),
    "ticks": ("i8", 0),
    "fault": ("u4", 0),
    "diverged": ("?", False),
    "done": ("?", False),
}


@dataclass
class Watch:
    """How far a bundle has come, and the way to stop it, for another thread."""

    core: SweepProgress = field(default_factory=SweepProgress)
    others: int = 0  # runs under laws in Python

    @property
    def done(self) -> int:
        """Runs done."""
        return self.core.done + self.others


def empty(n: int) -> Columns:
    """Return the columns of `n` runs of which nothing is known yet."""
    columns: Columns = {
        name: np.full(n, nan) for name in ("ideal_m", "count_m", "allowed_m", *COLUMNS)
    }
    return columns | {name: np.full(n, value, kind) for name, (kind, value) in STATUS.items()}


def measure(runs: Sequence[Run], *, threads: int, limits: RunLimits, watch: Watch) -> Columns:
    """Run every scenario under its law and return one row of numbers each, in order.

    Parameters
    ----------
    runs : sequence of (Scenario, law)
        Laws are finished, not names.
    threads : int
        Threads of the core.
    limits : RunLimits
        What is beyond has diverged.
    watch : Watch
        Counts the runs done; its `core.cancel()` ends the work.
    """
    columns = empty(len(runs))
    for i, (scenario, _) in enumerate(runs):
        ideal = ideal_rest(scenario)
        columns["ideal_m"][i] = nan if ideal is None else ideal
        columns["count_m"][i] = scenario.device.count
        columns["allowed_m"][i] = allowed_deviation(scenario)
    kinds: dict[tuple[Any, bool], list[int]] = {}
    for i, (scenario, law) in enumerate(runs):
        fast = hasattr(law, "_sweep") and not is_own(scenario.hand.model)
        fast = fast and foreign(scenario.environment) is None
        kinds.setdefault((type(law), fast), []).append(i)
    for (kind, fast), places in kinds.items():
        if fast:
            setups = [runs[i][0].setup() for i in places]
            laws = [runs[i][1] for i in places]
            found = kind._sweep(setups, laws, threads, limits, watch.core)
            for name, core_name in (COLUMNS | {name: name for name in STATUS}).items():
                columns[name][places] = found[core_name]
        else:
            _measure_python(columns, runs, places, limits, watch)
    return columns


def _measure_python(
    columns: Columns, runs: Sequence[Run], places: list[int], limits: RunLimits, watch: Watch
) -> None:
    for i in places:
        if watch.core.cancelled:
            return
        scenario, law = runs[i]
        try:
            trace = simulate(scenario, law)
        except LoopFault as stopped:
            if stopped.__cause__ is not None:  # an error in Python code of a user's own
                raise
            trace = stopped.trace
        for name, value in _row(trace, limits).items():
            columns[name][i] = value
        watch.others += 1


def _row(trace: Trace, limits: RunLimits) -> dict[str, Any]:
    """Return the numbers the core would give for this run."""
    rows = len(trace)
    far = np.abs(trace["true.x"].reshape(rows, -1)).max(axis=1) > limits.position
    energy = trace["true.energy"].reshape(rows, -1).sum(axis=1)
    faults = trace["fault"]
    ended = np.flatnonzero(far | (energy < -limits.energy) | (faults != 0))
    last = int(ended[0]) if len(ended) else rows - 1
    row: dict[str, Any] = {
        "ticks": last + 1,
        "fault": int(faults[last]),
        "diverged": bool(far[last] or energy[last] < -limits.energy),
        "done": True,
    }
    kept = trace[: float(trace["t"][last + 1])] if last + 1 < rows else trace
    if len(kept) >= FEWEST_ROWS:
        numbers = contact(kept)
        row |= {name: getattr(numbers, name) for name in (*COLUMNS, *FLAGS)}
    if last + 1 < rows or Fault(row["fault"]) is not Fault.NONE:
        row |= {"settled_s": None, "force_settled_s": None, **dict.fromkeys(FLAGS, False)}
    return {name: nan if value is None else value for name, value in row.items()}
