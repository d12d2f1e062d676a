"""The search for the worst hand of one family: at random, bred from the best, polished by NLopt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._core import RunLimits
from ebac._util.nlopt_callbacks import Carried
from ebac.laws import CoreLaw, PythonLaw
from ebac.scenario import Scenario
from ebac.simulation import LoopFault, simulate
from ebac.studies.breeding import AT_RANDOM, BRED, breed
from ebac.studies.families import Family
from ebac.studies.sweeps.measure import Columns, Watch, measure
from ebac.trace import Trace

#: Weight of the energy drawn in any window beside that below zero: it guides where nothing is below zero.
GUIDE = 1e-3
#: Runs measured at once.
BATCH = 256
#: How long the worst hand goes on in a run of its own [s]: what leaks slowly shows there.
LONG = 300.0


@dataclass(frozen=True, kw_only=True)
class WorstHand:
    """The worst hand found in one family.

    Attributes
    ----------
    family : Family
        What was searched.
    values : dict of str to float
        Its parameters, SI units.
    scenario : Scenario
        To simulate it again.
    energy_J : float
        Energy it drew: minus the least energy of `Contact`, at least 0.
    long_energy_J : float
        The same in a run of `LONG` seconds, in which the hand goes on.
    most_drawn_J : float
        The most in any window, see `Contact`.
    most_pull_N : float
        Its hardest pull |K0 (X0 - x)| while the virtual world acts.
    unseen_J : float
        One encoder count times all changes of the applied force: what the energy account of a law may miss.
    runs : int
        Hands tried.
    """

    family: Family
    values: dict[str, float]
    scenario: Scenario
    energy_J: float
    long_energy_J: float
    most_drawn_J: float
    most_pull_N: float
    unseen_J: float
    runs: int


class HandSearch:
    """One family: hands are points of the unit cube, and the best so far is kept here, not by the optimiser."""

    def __init__(
        self,
        family: Family,
        base: Scenario,
        law: CoreLaw | PythonLaw,
        pull: float,
        threads: int,
        report: Callable[[int], None],
        seconds: float | None = None,
    ) -> None:
        self.family, self.base, self.law, self.pull = family, base, law, pull
        self.seconds = seconds
        self.threads, self.report = threads, report
        self.runs = 0
        self.value = -np.inf
        self.best: tuple[NDArray[np.float64], Columns] | None = None

    def run(self, evaluations: int, seed: int) -> WorstHand:
        """Try this many hands; return the worst."""
        n = len(self.family.parameters)
        random = np.random.Generator(np.random.PCG64([seed, n]))
        at_random = max(1, int(AT_RANDOM * evaluations))
        points = self.family.at_random(at_random, random)
        parts = [points[start : start + BATCH] for start in range(0, at_random, BATCH)]
        values = np.concatenate([self.measure(part) for part in parts])
        until = int((AT_RANDOM + BRED) * evaluations)
        breed(points, values, self.measure, until - self.runs, random)
        self._polish(evaluations - self.runs)
        return self._found()

    def measure(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what is maximised for points of the cube, shape (runs, parameters)."""
        scenarios = [self.made(self.family.values(p)) for p in points]
        columns = measure(
            [(s, self.law) for s in scenarios], threads=self.threads, limits=RunLimits(), watch=Watch()
        )  # fmt: skip
        drawn, window = -columns["least_energy_J"], columns["most_drawn_J"]
        values = drawn + GUIDE * window
        over = columns["most_pull_N"] / self.pull - 1
        values = np.where(over > 0, -over, values)  # pulls harder than allowed
        values = np.where(np.isfinite(values), values, -1e9)
        top = int(np.argmax(values))
        if values[top] > self.value:
            self.value = float(values[top])
            self.best = points[top].copy(), {name: c[top : top + 1] for name, c in columns.items()}
        self.runs += len(points)
        self.report(self.runs)
        return values

    def made(self, values: dict[str, float]) -> Scenario:
        """Return the scenario with the hand of some parameters."""
        return self.family.make(self.base, values, self.seconds)

    def _polish(self, runs: int) -> None:
        import nlopt

        if runs <= 0 or self.best is None:
            return
        n = len(self.family.parameters)
        optimiser = nlopt.opt(nlopt.LN_SBPLX, n)
        carried = Carried(optimiser)
        optimiser.set_lower_bounds(np.zeros(n))
        optimiser.set_upper_bounds(np.ones(n))

        def drawn(point: NDArray[np.float64]) -> float:
            return float(self.measure(np.clip(point, 0, 1)[None])[0])

        optimiser.set_max_objective(carried(drawn, instead=0.0))
        optimiser.set_initial_step(0.02)
        end = self.runs + runs
        while self.runs < end:  # one that converged begins again from the best
            before = self.runs
            optimiser.set_maxeval(end - self.runs)
            optimiser.optimize(np.clip(self.best[0], 0, 1))
            carried.settle()
            if self.runs == before:
                break

    def _drawn_for_long(self, values: dict[str, float]) -> float:
        scenario = self.family.make(self.base, values, LONG)
        columns = measure([(scenario, self.law)], threads=1, limits=RunLimits(), watch=Watch())
        return max(0.0, -float(columns["least_energy_J"][0]))

    def _found(self) -> WorstHand:
        if self.best is None:  # not even one number came of the first batch
            raise ValueError(f"family {self.family.name}: no run gave a number")
        point, columns = self.best
        values = self.family.values(point)
        scenario = self.made(values)
        turned = np.abs(np.diff(every_row(scenario, self.law)["f_applied"], axis=0)).sum()
        return WorstHand(
            family=self.family,
            values=values,
            scenario=scenario,
            energy_J=max(0.0, -float(columns["least_energy_J"][0])),
            long_energy_J=self._drawn_for_long(values),
            most_drawn_J=float(columns["most_drawn_J"][0]),
            most_pull_N=float(columns["most_pull_N"][0]),
            unseen_J=scenario.device.count * float(turned),
            runs=self.runs,
        )


def every_row(scenario: Scenario, law: CoreLaw | PythonLaw) -> Trace:
    """Simulate, and keep what there is after a fault; an error of a law in Python is raised."""
    try:
        return simulate(scenario, law)
    except LoopFault as fault:
        if fault.__cause__ is not None:
            raise
        return fault.trace
