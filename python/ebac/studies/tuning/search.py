"""The search for a law's parameters: over the whole range, then around the best."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ebac._util.arrays import Values
from ebac._util.nlopt_callbacks import Carried
from ebac.laws import Variant
from ebac.operators import Operators
from ebac.scenario import Scenario
from ebac.studies.condition import Condition
from ebac.studies.ideal import ideal_contacts, settled_in_time
from ebac.studies.sweeps.result import SweepResult
from ebac.studies.sweeps.run import seed_of, sweep
from ebac.studies.tuning.cost import cost_of
from ebac.studies.tuning.ranges import Ranges

#: Share of the runs that look over the whole range (DIRECT-L); the others refine the best point (Subplex).
LOOKS = 0.6


class Search:
    """One law under conditions of one delay; keeps every point that was tried, the default first."""

    def __init__(
        self,
        law: str,
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
        self.known = [c.believed(s) for c, part in parts for s in part]
        self.ideal_settled_s = ideal_contacts(self.scenarios, threads)["settled_s"]
        self.tried: list[tuple[dict[str, float | bool], float]] = []
        self.report: Any = None

    def run(self, evaluations: int) -> None:
        """Try the default, look over the whole range, then refine the best."""
        import nlopt

        self.measure({})
        looks = max(1, round(LOOKS * (evaluations - 1)))
        middle = np.full(len(self.ranges), 0.5)
        self._search(nlopt.GN_DIRECT_L, looks, middle)
        left = evaluations - len(self.tried)
        if left > 0:
            best = min(self.tried[1:], key=lambda tried: tried[1])[0]
            self._search(nlopt.LN_SBPLX, left, self.ranges.place_of(best))

    def measure(self, changes: dict[str, float | bool]) -> float:
        """Simulate the training hands with some parameters changed; keep the point."""
        law = Variant(self.law, changes)
        runs = sweep(self.scenarios, law, designed_for=self.known, threads=self.threads)
        in_time = settled_in_time(runs, self.ideal_settled_s)
        cost = cost_of(SweepResult({**runs.columns, "settled_in_time": in_time}))
        self.tried.append((changes, cost))
        self.report(len(self.tried))
        return cost

    def _search(self, algorithm: int, evaluations: int, start: Values) -> None:
        import nlopt

        optimiser = nlopt.opt(algorithm, len(self.ranges))
        carried = Carried(optimiser)
        most = len(self.tried) + evaluations  # NLopt's own limit is not sharp

        def cost(point: Values) -> float:
            if len(self.tried) >= most:
                optimiser.force_stop()
                return math.inf
            return self.measure(self.ranges.at(point))

        optimiser.set_min_objective(carried(cost, instead=math.inf))
        optimiser.set_lower_bounds(np.zeros(len(self.ranges)))
        optimiser.set_upper_bounds(np.ones(len(self.ranges)))
        optimiser.set_maxeval(evaluations)
        optimiser.set_xtol_abs(2e-3)
        if algorithm == nlopt.LN_SBPLX:
            optimiser.set_initial_step(0.1)
        optimiser.optimize(start)
        carried.settle()
