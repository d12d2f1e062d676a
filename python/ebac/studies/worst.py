"""`worst`: the hand that takes most energy out of a law's port, searched over families of hands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import RunLimits
from ebac.laws import AnyLaw, design, law_name
from ebac.scenario import Scenario
from ebac.simulation import LoopFault, simulate
from ebac.studies.changes import truth
from ebac.studies.conditions import Condition, conditions
from ebac.studies.families import Family, families, find_family
from ebac.sweeps.job import Progress
from ebac.sweeps.measure import Columns, Watch, cores, measure
from ebac.trace import Trace

#: Largest pull of a hand [N] for a law that declares none.
PULL = 20.0
#: Shares of the runs: at random, and bred from the best; the rest is for NLopt.
AT_RANDOM, BRED = 0.25, 0.6
#: Hands of a generation, the parents that are kept, and the first and least spread of a parameter's change.
CHILDREN, PARENTS, SPREAD, LEAST_SPREAD = 40, 10, 0.15, 0.01
#: Weight of the energy drawn in any window beside that below zero: it guides where nothing is below zero.
GUIDE = 1e-3
#: Runs measured at once.
BATCH = 256


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
        Energy it drew: minus the least port energy of `Contact`, at least 0.
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
    most_drawn_J: float
    most_pull_N: float
    unseen_J: float
    runs: int


@dataclass(frozen=True, kw_only=True, eq=False)
class Worst:
    """What a search found: the worst hand of every family, the worst first.

    Attributes
    ----------
    law : str
        Its name.
    made : law
        As it was designed for the condition.
    condition : Condition
        What was changed for every hand.
    pull : float
        Largest pull the hands were allowed [N].
    declared : float or None
        Largest pull the law counts with [N], None for a law that declares none.
    reserve : float or None
        Energy the law lends at the start, e(0) of eq. (3) [J]; None for a law that lends none.
    hands : tuple of WorstHand
        One per family.
    """

    law: str
    made: Any
    condition: Condition
    pull: float
    declared: float | None
    reserve: float | None
    hands: tuple[WorstHand, ...]

    def within(self, hand: WorstHand) -> bool | None:
        """Return whether a hand stays within what the law counts with; None for a law that declares nothing."""
        return None if self.declared is None else hand.most_pull_N <= self.declared

    def rows(self) -> list[dict[str, Any]]:
        """Return the documented rows of `ebac worst --json`."""
        return [
            {
                "law": self.law,
                "condition": self.condition.name,
                "family": hand.family.name,
                "energy_drawn_J": hand.energy_J,
                "reserve_J": self.reserve,
                "most_drawn_J": hand.most_drawn_J,
                "most_pull_N": hand.most_pull_N,
                "within_declared_pull": self.within(hand),
                "unseen_J": hand.unseen_J,
                "runs": hand.runs,
                "parameters": [
                    {"name": p.name, "value": hand.values[p.name], "unit": p.unit, "low": p.low, "high": p.high}
                    for p in hand.family.parameters
                ],
            }
            for hand in self.hands
        ]  # fmt: skip

    def trace(self, hand: WorstHand | None = None) -> Trace:
        """Simulate a hand again, by default the worst, with every row."""
        return _rows((hand or self.hands[0]).scenario, self.made)


def worst(
    law: AnyLaw = "ebac",
    condition: str | Condition = "d1K10",
    *,
    family: Sequence[str] | None = None,
    evaluations: int = 2000,
    seed: int = 1,
    pull: float | None = None,
    base: Scenario | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Worst:
    """Search the hand that draws most energy out of a law's port. The same seed finds the same hand.

    A quarter of the runs goes to random hands; then generations are bred from the best, each measured together; NLopt's
    subplex method (SBPLX) ends. The ground is rough: another seed may find a worse one.

    Parameters
    ----------
    law : str, law class, Variant, law or PythonLaw
        As `simulate` takes it.
    condition : str or Condition
        One that changes device, timing or wall; the hand is what is searched.
    family : sequence of str, optional
        Names of `families`; default: all.
    evaluations : int
        Runs per family, at least 40.
    seed : int
        Of the search, [0, 2^31).
    pull : float, optional
        Largest pull of a hand [N], (0, 1000]; default: what the law declares, else 20 N.
    base : Scenario, optional
        What the condition changes; default: the reference scenario.
    threads : int, optional
        Threads for the random part; default: one per core. The result does not depend on it.
    progress : callable, optional
        Called with (runs done, runs in all).

    Returns
    -------
    Worst

    Raises
    ------
    ValueError
        For a number out of range, a family or condition that does not exist, or a condition that changes the hand.
    """
    where = _condition(condition, base or Scenario())
    scenario = where.change(base or Scenario())
    made = design(law, *where.believed(scenario))
    declared, reserve = (getattr(made, name, None) for name in ("pull", "reserve"))
    most = pull if pull is not None else declared or PULL
    _check(evaluations=(evaluations, 40, 10**7), seed=(seed, 0, 2**31 - 1), pull=(most, 1e-3, 1e3))
    wanted = [find_family(n, most) for n in dict.fromkeys(family or families(most))]
    total = evaluations * len(wanted)
    tell = progress or (lambda done, total: None)
    found = []
    for i, one in enumerate(wanted):
        count = partial(_tell, tell, i * evaluations, total)
        search = _Search(one, scenario, made, most, threads or cores(), count)
        found.append(search.run(evaluations, seed))
    found.sort(key=lambda hand: (-hand.energy_J, -hand.most_drawn_J))
    return Worst(
        law=law_name(law), made=made, condition=where, pull=most, declared=declared,
        reserve=reserve, hands=tuple(found),
    )  # fmt: skip


def _tell(progress: Progress, before: int, total: int, runs: int) -> None:
    progress(before + runs, total)


def replays(condition: Condition, scenario: Scenario) -> bool:
    """Whether a law designed for the scenario is the one that was searched: the condition tells it no lie."""
    return condition.believed(scenario) == truth(scenario)


class _Search:
    """One family: hands are points of the unit cube, and the best so far is kept here, not by the optimiser."""

    def __init__(
        self,
        family: Family,
        base: Scenario,
        law: Any,
        pull: float,
        threads: int,
        tell: Callable[[int], None],
    ) -> None:
        self.family, self.base, self.law, self.pull = family, base, law, pull
        self.threads, self.tell = threads, tell
        self.runs = 0
        self.value = -np.inf
        self.best: tuple[NDArray[np.float64], Columns] | None = None

    def run(self, evaluations: int, seed: int) -> WorstHand:
        n = len(self.family.parameters)
        random = np.random.Generator(np.random.PCG64([seed, n]))
        at_random = max(1, int(AT_RANDOM * evaluations))
        # A Latin hypercube: every parameter is spread over its whole range.
        order = np.stack([random.permutation(at_random) for _ in range(n)], axis=1)
        points = (order + random.random((at_random, n))) / at_random
        parts = [points[start : start + BATCH] for start in range(0, at_random, BATCH)]
        values = np.concatenate([self.measure(part) for part in parts])
        self._breed(points, values, int((AT_RANDOM + BRED) * evaluations), random)
        self._polish(evaluations - self.runs)
        return self._found()

    def _breed(
        self,
        points: NDArray[np.float64],
        values: NDArray[np.float64],
        until: int,
        random: np.random.Generator,
    ) -> None:
        """Breed from the best: a child has some parameters of a parent changed, or a step between two others added."""
        spread = SPREAD
        n = points.shape[1]
        while self.runs < until:
            best = np.argsort(-values, kind="stable")[:PARENTS]
            points, values = points[best], values[best]
            k = min(CHILDREN, until - self.runs)
            parents, one, other = (points[random.integers(0, len(points), k)] for _ in range(3))
            changes = spread * random.normal(size=(k, n)) * (random.random((k, n)) < 0.5)
            steps = 0.5 * (one - other) * (random.random((k, 1)) < 0.5)
            children = np.clip(parents + changes + steps, 0, 1)
            points = np.vstack([points, children])
            values = np.concatenate([values, self.measure(children)])
            spread = max(LEAST_SPREAD, 0.96 * spread)

    def measure(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what is maximised for points of the cube, shape (runs, parameters)."""
        scenarios = [self.family.make(self.base, self.family.values(p)) for p in points]
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
        self.tell(self.runs)
        return values

    def _polish(self, runs: int) -> None:
        import nlopt

        if runs <= 0 or self.best is None:
            return
        n = len(self.family.parameters)
        optimiser = nlopt.opt(nlopt.LN_SBPLX, n)
        optimiser.set_exceptions_enabled(False)
        optimiser.set_lower_bounds(np.zeros(n))
        optimiser.set_upper_bounds(np.ones(n))
        raised: list[BaseException] = []

        def objective(point: NDArray[np.float64], _: object) -> float:
            try:
                return float(self.measure(np.clip(point, 0, 1)[None])[0])
            except BaseException as error:  # would be lost inside of NLopt
                raised.append(error)
                optimiser.force_stop()
                return 0.0

        optimiser.set_max_objective(objective)
        optimiser.set_initial_step(0.02)
        end = self.runs + runs
        while self.runs < end:  # one that converged begins again from the best
            before = self.runs
            optimiser.set_maxeval(end - self.runs)
            optimiser.optimize(np.clip(self.best[0], 0, 1))
            if raised:
                raise raised[0]
            if self.runs == before:
                break

    def _found(self) -> WorstHand:
        if self.best is None:  # not even one number came of the first batch
            raise ValueError(f"family {self.family.name}: no run gave a number")
        point, columns = self.best
        values = self.family.values(point)
        scenario = self.family.make(self.base, values)
        turned = np.abs(np.diff(_rows(scenario, self.law)["f_applied"], axis=0)).sum()
        return WorstHand(
            family=self.family,
            values=values,
            scenario=scenario,
            energy_J=max(0.0, -float(columns["least_energy_J"][0])),
            most_drawn_J=float(columns["most_drawn_J"][0]),
            most_pull_N=float(columns["most_pull_N"][0]),
            unseen_J=scenario.device.count * float(turned),
            runs=self.runs,
        )


def _rows(scenario: Scenario, law: Any) -> Trace:
    try:
        return simulate(scenario, law)
    except LoopFault as fault:
        return fault.trace


def _condition(given: str | Condition, base: Scenario) -> Condition:
    chosen = conditions([given])
    if len(chosen) != 1:
        names = ", ".join(one.name for one in chosen)
        raise ValueError(f"condition {given}: stands for {names}; give one")
    [one] = chosen
    if one.drives or one.change(base).hand != base.hand:
        raise ValueError(
            f"condition {one.name}: changes the hand ({one.summary}), which is what is searched; "
            "give one that changes device, timing or wall"
        )
    return one


def _check(**numbers: tuple[float, float, float]) -> None:
    for name, (value, low, high) in numbers.items():
        if not low <= value <= high:
            unit = " N" if name == "pull" else ""
            raise ValueError(
                f"worst: {name} = {value:g}{unit}: must lie in [{low:g}, {high:g}]{unit}"
            )
