"""The coordinates of a search: a level of the target is moved as the force by which it pulls, K0 X0."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._core import ArmGains
from ebac._util.arrays import Values
from ebac.identify.parameters import BEFORE_LEVELS, BOUNDS, kind
from ebac.identify.problem import Problem

#: Least K0 that a force is divided by [N/m].
SOFTEST = 1e-3


@dataclass(frozen=True, kw_only=True, eq=False)
class LevelForces:
    """Which of what is moved are levels, and where the K0 of each stands among all parameters."""

    problem: Problem
    which: NDArray[np.intp]  # of all parameters: what is moved
    levels: tuple[tuple[int, int, int], ...]  # row among the moved: of X0, of its K0; K0 among all

    @classmethod
    def of(cls, problem: Problem) -> LevelForces:
        """Return what is moved; levels that are bounded, or whose K0 is given, stay levels."""
        p, which = problem.parameters, problem.moved
        row = {int(index): i for i, index in enumerate(which)}
        pairs = {
            int(level): int(place[2])
            for place in p.places
            for level in place[BEFORE_LEVELS:]
            if kind(p.names[place[2]]) == "K0"
        }
        levels = tuple(
            (row[x], row[k], k)
            for x, k in pairs.items()
            if x in row and k in row and (p.low[x], p.high[x]) == BOUNDS["X0"]
        )
        return cls(problem=problem, which=which, levels=levels)

    @property
    def bounds(self) -> tuple[Values, Values]:
        """Least and largest of what is moved; a force has none."""
        low, high = (
            self.problem.parameters.low[self.which],
            self.problem.parameters.high[self.which],
        )
        for x, _, _ in self.levels:
            low[x], high[x] = -np.inf, np.inf
        return low, high

    def moved(self, values: Values) -> Values:
        """Return what is moved, of all parameters."""
        out = values[self.which]
        for x, _, k in self.levels:
            out[x] *= max(values[k], SOFTEST)
        return out

    def full(self, part: Values, values: Values) -> Values:
        """Return all parameters: `values` with what is moved put in."""
        out = values.copy()
        out[self.which] = part
        for x, _, k in self.levels:
            out[self.which[x]] = part[x] / max(out[k], SOFTEST)
        return out

    def linearised(
        self, values: Values, gains: list[ArmGains]
    ) -> tuple[Values, NDArray[np.float64]]:
        """Return objective, and d objective / d moved, shape (moved, rows + doubts)."""
        errors, out = self.problem.linearised(values, gains)
        with np.errstate(
            over="ignore", invalid="ignore"
        ):  # a search refuses a model that runs away
            for x, row, k in self.levels:
                by = max(float(values[k]), SOFTEST)
                out[row] -= out[x] * values[self.which[x]] / by
                out[x] /= by
        return errors, out
