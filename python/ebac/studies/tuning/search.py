"""The search for a law's parameters: at random, bred from the best, polished by NLopt."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ebac._util.arrays import Values
from ebac._util.nlopt_callbacks import Carried
from ebac.laws import AnyLaw, changed
from ebac.operators import Operators
from ebac.scenario import Scenario
from ebac.studies.breeding import AT_RANDOM, BRED, breed
from ebac.studies.condition import Condition, known_under
from ebac.studies.ideal import ideal_contacts, settled_in_time
from ebac.studies.sweeps.result import SweepResult
from ebac.studies.sweeps.run import seed_of, sweep
from ebac.studies.tuning.cost import cost_of
from ebac.studies.tuning.ranges import Ranges

#: Points of a generation, the best that are kept for it, and how the spread narrows.
CHILDREN, PARENTS, NARROWS = 16, 6, 0.9


class Search:
    """One law under conditions of one delay; keeps every point that was tried, the default first."""

    def __init__(
        self,
        law: AnyLaw,
        ranges: Ranges,
        conditions: Sequence[Condition],
        hands: Operators,
        base: Scenario,
        seed: int,
        threads: int | None,
    ) -> None:
        self.law, self.ranges, self.conditions, self.threads = law, ranges, conditions, threads
        parts = [(c, c.scenarios(hands, base)) for c in conditions]
        self.scenarios = [
            s.replace(seed=seed_of(seed, i)) for _, p in parts for i, s in enumerate(p)
        ]
        self.known = [known_under(c, s) for c, part in parts for s in part]
        self.ideal_settled_s = ideal_contacts(self.scenarios, threads)["settled_s"]
        self.seed = seed
        self.tried: list[tuple[dict[str, float | bool], float]] = []
        self.report: Any = None

    def run(self, evaluations: int) -> None:
        """Try the default, points at random, those bred from the best, and those around the best."""
        random = np.random.Generator(np.random.PCG64([self.seed, len(self.ranges)]))
        self.measure({})
        points = random.random((max(1, int(AT_RANDOM * evaluations)), len(self.ranges)))
        values = self._gains(points[: evaluations - 1])
        until = int((AT_RANDOM + BRED) * evaluations)
        breed(
            points, values, self._gains, until - len(self.tried), random,
            children=CHILDREN, parents=PARENTS, narrows=NARROWS,
        )  # fmt: skip
        self._polish(evaluations - len(self.tried))

    def _gains(self, points: Values) -> Values:
        """Return minus the costs of points of the unit cube, shape (m, parameters)."""
        return np.array([-self.measure(self.ranges.at(point)) for point in points])

    def measure(self, changes: dict[str, float | bool]) -> float:
        """Simulate the training hands with some parameters changed; keep the point."""
        law = changed(self.law, **changes)
        runs = sweep(self.scenarios, law, designed_for=self.known, threads=self.threads)
        in_time = settled_in_time(runs, self.ideal_settled_s)
        cost = cost_of(SweepResult({**runs.columns, "settled_in_time": in_time}))
        self.tried.append((changes, cost))
        self.report(len(self.tried))
        return cost

    def _polish(self, runs: int) -> None:
        import nlopt

        if runs <= 0:
            return
        optimiser = nlopt.opt(nlopt.LN_SBPLX, len(self.ranges))
        carried = Carried(optimiser)
        most = len(self.tried) + runs  # NLopt's own limit is not sharp

        def cost(point: Values) -> float:
            if len(self.tried) >= most:
                optimiser.force_stop()
                return math.inf
            return self.measure(self.ranges.at(point))

        optimiser.set_min_objective(carried(cost, instead=math.inf))
        optimiser.set_lower_bounds(np.zeros(len(self.ranges)))
        optimiser.set_upper_bounds(np.ones(len(self.ranges)))
        optimiser.set_maxeval(runs)
        optimiser.set_xtol_abs(2e-3)
        optimiser.set_initial_step(0.1)
        best = min(self.tried[1:], key=lambda tried: tried[1])[0]
        optimiser.optimize(self.ranges.place_of(best))
        carried.settle()
