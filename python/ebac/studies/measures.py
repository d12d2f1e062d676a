"""What an ablation looks at: numbers over a population, each with its unit and what makes a difference in it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ebac._util import formatting
from ebac._util.wrong_calls import plain_constructor

if TYPE_CHECKING:
    from ebac.studies.result import Study
    from ebac.trace import Trace

#: Energy that a passive port may have given out for errors of the measurement, as in `ebac zwidth` [J].
SPARE = 1e-3

Columns: TypeAlias = dict[str, NDArray[Any]]


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Measure:
    """One number of a law over a population.

    Attributes
    ----------
    key : str
        Its key in `ebac ablation --json`, unit included.
    heading, unit : str
        What tables call it, and its SI unit; "hands" for a count.
    conditions : tuple of str
        Where it is taken; all runs together.
    of : callable
        The columns of these runs in, the number out; NaN where there is none.
    traced : callable, optional
        A number that needs every row of a run: a Trace in, the number out. Each run is then simulated again and
        `of` finds the numbers under `traced`.
    more : bool
        Whether more of it is better.
    matters : float
        A smaller difference is none: in its unit, for `relative` as a share of the larger number, for counts as a
        share of the runs.
    relative : bool
        How `matters` is meant.
    """

    key: str
    heading: str
    unit: str
    conditions: tuple[str, ...]
    of: Callable[[Columns], float]
    traced: Callable[[Trace], float] | None = None
    more: bool = False
    matters: float
    relative: bool = False

    def value(self, study: Study, law: str) -> float | None:
        """Return the number for a law; None where there is none."""
        runs = np.concatenate([study.runs(law, name) for name in self.conditions])
        columns = {name: values[runs] for name, values in study.columns.items()}
        if self.traced is not None:
            columns["traced"] = np.array([self.traced(study.trace(run)) for run in runs.tolist()])
        value = self.of(columns)
        if not np.isfinite(value):
            return None
        return int(value) if self.unit == "hands" else value

    def gain(self, value: float | None, other: float | None, hands: int) -> int:
        """Return 1 where `value` is better than `other`, -1 where worse, 0 where they differ by nothing that matters.

        A number that does not exist is worse than any. Numbers that read the same are the same.
        """
        if value is None or other is None:
            return (value is not None) - (other is not None)
        if formatting.cell(value, self.unit) == formatting.cell(other, self.unit):
            return 0
        size = max(abs(value), abs(other)) if self.relative else 1.0
        least = max(1.0, self.matters * hands) if self.unit == "hands" else self.matters * size
        if abs(value - other) < least or value == other:
            return 0
        return 1 if (value > other) == self.more else -1


def _count(column: str) -> Callable[[Columns], float]:
    return lambda runs: float(runs[column].sum())


def _median(column: str, where: str | None = None) -> Callable[[Columns], float]:
    def of(runs: Columns) -> float:
        values = runs[column][runs[where]] if where else runs[column]
        there = values[np.isfinite(values)]
        return float(np.median(there)) if len(there) else float("nan")

    return of


def _largest(column: str, where: str | None = None) -> Callable[[Columns], float]:
    def of(runs: Columns) -> float:
        values = runs[column][runs[where]] if where else runs[column]
        there = values[np.isfinite(values)]
        return float(there.max()) if len(there) else float("nan")

    return of


def _least(runs: Columns) -> float:
    return float(np.nanmin(runs["least_energy_J"]))


def _step_inside(trace: Trace) -> float:
    """Return the largest step of the command between two ticks in which the world asks for a force."""
    rows = len(trace)
    inside = (trace["f_env"].reshape(rows, -1) != 0).any(axis=1)
    steps = np.abs(np.diff(trace["f_cmd"].reshape(rows, -1), axis=0)).max(axis=1)
    return float(np.max(steps, where=inside[1:] & inside[:-1], initial=0.0))


def _away(runs: Columns) -> float:
    return _median("away")({"away": np.abs(runs["rest_m"] - runs["ideal_m"])[runs["still"]]})


def _good(key: str, heading: str, condition: str) -> Measure:
    return Measure(
        key=key, heading=heading, unit="hands", conditions=(condition,), of=_count("good"), more=True, matters=0.02
    )  # fmt: skip


def _energy(key: str, heading: str, *conditions: str) -> Measure:
    return Measure(
        key=key, heading=heading, unit="J", conditions=conditions, of=_least, more=True, matters=5e-4
    )  # fmt: skip


#: Every measure of an ablation, in the order of its columns.
MEASURES = (
    _good("good", "good", "d1K10"),
    Measure(key="exact_and_still", heading="exact, still", unit="hands", conditions=("d1K10",),
            of=_count("exact_and_still"), more=True, matters=0.02),
    Measure(key="settled_in_time", heading="in time", unit="hands", conditions=("d1K10",),
            of=_count("settled_in_time"), more=True, matters=0.02),
    Measure(key="median_settled_s", heading="settled", unit="s", conditions=("d1K10",),
            of=_median("settled_s", "exact_and_still"), matters=0.1, relative=True),
    _good("good_K20", "good, 20 kN/m", "d1K20"),
    _good("good_d2_K20", "good, 20 kN/m, delay 2", "d2K20"),
    _good("good_slow_press_d2_K20", "good, slow press, 20 kN/m, delay 2", "slow-press-d2K20"),
    _good("good_tremor", "good, tremor 9 Hz", "tremor-9Hz"),
    _energy("least_energy_impact_J", "least energy, impact", "d1K10", "d1K20", "d2K20"),
    _energy("least_energy_let_go_J", "least energy, let go", "slow-let-go", "slow-let-go-d2", "slow-let-go-K20"),
    _energy("least_energy_pumping_J", "least energy, pumping", "pumping"),
    Measure(key="force_swing_N", heading="force swing", unit="N", conditions=("d1K10",),
            of=_largest("force_swing_N", "exact_and_still"), matters=0.1, relative=True),
    Measure(key="force_swing_noise_N", heading="force swing, sensor noise 0.2 N", unit="N", conditions=("force-noise",),
            of=_largest("force_swing_N", "exact_and_still"), matters=0.1, relative=True),
    Measure(key="force_step_N", heading="largest force step inside", unit="N", conditions=("d1K10",),
            of=_largest("traced"), traced=_step_inside, matters=0.1, relative=True),
    Measure(key="friction_m", heading="off the ideal, friction 1 N", unit="m", conditions=("friction-1",),
            of=_away, matters=0.05, relative=True),
)  # fmt: skip


def conditions_of(measures: Iterable[Measure]) -> list[str]:
    """Return the conditions under which all of these measures are taken, each once."""
    return list(dict.fromkeys(one for measure in measures for one in measure.conditions))
