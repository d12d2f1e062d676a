"""The result of a study: a row per law and condition, and every run that failed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._util import row_files, verdicts
from ebac._util.arguments import require_path, whole
from ebac.laws import design
from ebac.laws.tuned_laws import on_its_observer
from ebac.operators import Operators
from ebac.scenario import Scenario
from ebac.simulation import LoopFault, simulate
from ebac.studies.condition import Condition
from ebac.studies.sweeps.measure import Columns
from ebac.studies.sweeps.result import SweepResult
from ebac.trace import Trace

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True)
class StudyRow:
    """One law under one condition, over all hands; None where a thing does not exist.

    Attributes
    ----------
    law, condition : str
        Names.
    hands : int
        Runs.
    good : int or None
        Hands that rest within two counts and what friction holds of the ideal (`allowed_deviation`) and are quiet, in
        position and force; None where the condition has no point of rest.
    exact_and_still : int or None
        The same by position alone: hands that would be good whatever their force does.
    settled_in_time : int or None
        Of those, hands whose position settles within 1.5 times what the same hand needs against an ideal wall, plus
        0.2 s.
    least_energy_J : float or None
        Lowest physical port energy of all runs.
    most_drawn_J : float or None
        Most energy drawn in any window of any run, see `Contact`.
    median_settled_s : float or None
        Median over the runs that settled.
    ideal_good : int or None
        Hands for which an ideal, continuous wall is good by the same measure: what no law can be blamed for. None where
        it has no closed form.
    least_rest_power_W : float or None
        Lowest mean rate of the port energy over the last 30 % of a run, dW/dt at rest; a port that is held for long
        gives out energy without end where it is below zero. Of the runs that are at rest from 20 s before that on, see
        `Contact`; None where there is none, as after 6 s.
    force_quiet : int or None
        Hands for which the force is quiet, see `Contact`; None where the condition has no point of rest.
    median_impact_share : float or None
        Median share of the wall's stiffness that a hand meets at its deepest position, `Contact.impact_share`.
    ended_early : int
        Runs that a fault ended, or that diverged: the other numbers are of the time until then.
    """

    law: str
    condition: str
    hands: int
    good: int | None
    exact_and_still: int | None
    settled_in_time: int | None
    least_energy_J: float | None
    most_drawn_J: float | None
    median_settled_s: float | None
    ideal_good: int | None = None
    least_rest_power_W: float | None = None
    force_quiet: int | None = None
    median_impact_share: float | None = None
    ended_early: int = 0

    def row(self) -> dict[str, Any]:
        """Return the documented row of `ebac study --json`."""
        return asdict(self)


@dataclass(frozen=True, kw_only=True)
class Failure:
    """A run that was not good: its place in the columns, and why.

    `operator` is the row of its hand, from 1, and 0 for a drive; `drive` which of its condition it is, from 1, and 0
    for a hand.
    """

    run: int
    law: str
    condition: str
    operator: int
    drive: int
    name: str
    why: str


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Study:
    """Laws x conditions x hands.

    Attributes
    ----------
    operators : Operators
        The population.
    conditions : tuple of Condition
        In the order of the rows.
    scenarios : list of Scenario
        What was simulated: all hands of the first condition, then of the second, and so on.
    columns : dict of str to array, shape (runs,)
        Those of `SweepResult`, and `condition`, `operator` (row from 1, 0 for a drive), `ideal_settled_s` (inf where
        even an ideal wall does not settle, NaN where that is not known), `ideal_good`, `exact_and_still`, `good`,
        `settled_in_time`.
    """

    operators: Operators
    conditions: tuple[Condition, ...]
    scenarios: list[Scenario]
    designed_for: list[tuple[_core.DeviceFacts, _core.Timing]]
    laws: dict[str, Any]
    columns: Columns

    def runs(self, law: str, condition: str) -> NDArray[np.intp]:
        """Return the places of the runs of a law under a condition."""
        both = (self.columns["law"] == law) & (self.columns["condition"] == condition)
        return np.flatnonzero(both)

    @cached_property
    def rows(self) -> list[StudyRow]:
        """One row per law and condition, the laws of a condition together."""
        return [self._row(law, c.name) for c in self.conditions for law in self.laws]

    def _row(self, law: str, condition: str) -> StudyRow:
        runs = self.runs(law, condition)
        part = {name: values[runs] for name, values in self.columns.items()}
        rests = bool(np.isfinite(part["ideal_m"]).all())
        timed = rests and not bool(np.isnan(part["ideal_settled_s"]).any())
        return StudyRow(
            law=law,
            condition=condition,
            hands=len(runs),
            good=int(part["good"].sum()) if rests else None,
            exact_and_still=int(part["exact_and_still"].sum()) if rests else None,
            settled_in_time=int(part["settled_in_time"].sum()) if timed else None,
            least_energy_J=_of(np.min, part["least_energy_J"]),
            most_drawn_J=_of(np.max, part["most_drawn_J"]),
            median_settled_s=_of(np.median, part["settled_s"]),
            ideal_good=int(part["ideal_good"].sum()) if timed else None,
            least_rest_power_W=_of(np.min, part["rest_power_W"]),
            force_quiet=int(part["force_quiet"].sum()) if rests else None,
            median_impact_share=_of(np.median, part["impact_share"]),
            ended_early=int(_ended_early(part).sum()),
        )

    @cached_property
    def unjudged(self) -> dict[str, str]:
        """Conditions under which no hand is judged good or exact, and why: some hand has no ideal rest."""
        from ebac.metrics.unjudged import no_ideal_rest

        unknown = np.flatnonzero(~np.isfinite(self.columns["ideal_m"][: len(self.scenarios)]))
        names = self.columns["condition"]
        first = {str(names[i]): self.scenarios[i] for i in unknown[::-1].tolist()}
        return {c.name: no_ideal_rest(first[c.name]) for c in self.conditions if c.name in first}

    @cached_property
    def failures(self) -> list[Failure]:
        """Every run that was not good where there is a point of rest, or that diverged or stopped on a fault."""
        return list(self._failures())

    def _failures(self) -> Iterator[Failure]:
        c = self.columns
        for i in np.flatnonzero(
            (np.isfinite(c["ideal_m"]) & ~c["good"]) | _ended_early(c)
        ).tolist():
            operator = int(c["operator"][i])
            law, condition = str(c["law"][i]), str(c["condition"][i])
            drive = 0 if operator else 1 + i - int(self.runs(law, condition)[0])
            yield Failure(
                run=i,
                law=law,
                condition=condition,
                operator=operator,
                drive=drive,
                name=self.operators.name(operator - 1) if operator else f"drive {drive}",
                why=_why({name: values[i] for name, values in c.items()}),
            )

    def trace(self, run: int) -> Trace:
        """Simulate one run again, with every row; a run that stopped on a fault gives its rows too.

        Parameters
        ----------
        run : int
            Its place in the columns, from 0, as `Failure.run`.
        """
        last = len(self.columns["law"]) - 1
        if not 0 <= whole("run", run) <= last:
            raise ValueError(f"run = {run}: must lie in [0, {last}], as `run` of a failure")
        place = run % len(self.scenarios)
        law = self.laws[str(self.columns["law"][run])]
        scenario = on_its_observer(self.scenarios[place], law)
        try:
            return simulate(scenario, design(law, *self.designed_for[place]))
        except LoopFault as fault:
            return fault.trace

    def __repr__(self) -> str:
        """Return a row per law and condition."""
        from ebac._util.plural import plural
        from ebac._util.report import report

        counts = (
            plural(len(self.operators), "hand"),
            plural(len(self.conditions), "condition"),
            plural(len(self.laws), "law"),
            plural(len(self.columns["law"]), "run"),
        )
        title = f"Study, simulated: {', '.join(counts)}, {len(self.failures)} not good"
        return report(title, self._table(), more='in .rows and .save("study.csv")')

    def _repr_html_(self) -> str:
        """Return the first figure and the rows, for a notebook."""
        from ebac._util import notebook
        from ebac._util.plural import plural

        title = f"{plural(len(self.operators), 'hand')}, simulated"
        return notebook.result(title, self._table(), self.plot)

    def _table(self) -> list[dict[str, Any]]:
        return [row.row() for row in self.rows]

    def result(self) -> SweepResult:
        """Return every run as a table, to write it as CSV or Parquet."""
        return SweepResult(self.columns)

    def plot(self) -> Figure:
        """Draw the overview: good hands and energy drawn by law and condition. `ebac.plot.plot_study` draws all."""
        from ebac.plot import plot_study

        return next(plot_study(self))[1]

    def to_json(self) -> str:
        """Return the JSON document of `ebac study --json`: a row per law and condition, SI units."""
        return row_files.document("study", self._table())

    def save(self, path: str | Path) -> None:
        """Write a row per law and condition, the format by the extension: .json as `to_json`, or .csv.

        `result()` has every run, to write as CSV or Parquet. A file of that name is replaced.

        Raises
        ------
        ValueError
            For another extension.
        """
        require_path(path, "Study.save")
        row_files.save(path, self.to_json(), self._table())


def _ended_early(columns: Columns) -> NDArray[np.bool_]:
    early: NDArray[np.bool_] = columns["diverged"] | (columns["fault"] != 0)
    return early


def _of(measure: Any, values: NDArray[np.float64]) -> float | None:
    """Return a measure over the numbers there are."""
    there = values[np.isfinite(values)]
    return float(measure(there)) if len(there) else None


def _why(run: dict[str, Any]) -> str:
    if run["fault"] != 0:
        return f"stopped on fault {_core.Fault(int(run['fault'])).name.lower()}"
    if run["diverged"]:
        return f"diverged after {run['ticks']} ticks"
    if not run["still"]:
        return f"swings by {verdicts.in_mm(run['swing_m'])}"
    reasons = []
    if not run["quiet"]:
        numbers = (run[name] for name in ("force_quiet", "force_settled_s", "jumps", "perceived"))
        reasons.append(f"force {verdicts.force_verdict(*numbers)}")
    if not (run["exact_and_still"] and reasons):
        away = run["rest_m"] - run["ideal_m"]
        deep = "too deep" if away > 0 else "not deep enough"
        reasons.append(f"rests {verdicts.in_mm(abs(away))} {deep}")
    return "; ".join(reasons)
