"""Rows of a population: every combination of some numbers, or random ones."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from ebac._util.arguments import number, whole
from ebac._util.arrays import Values
from ebac._util.sequences import several_numbers
from ebac.operators.columns import OPERATOR_COLUMNS, check

#: Least and most of mass [kg], damping [N s/m], stiffness [N/m] and target [m] of a random hand.
LEAST, MOST = (0.03, 1, 50, 0.010), (1.5, 25, 1200, 0.060)


def combinations(
    mass: Sequence[float],
    damping: Sequence[float],
    stiffness: Sequence[float],
    target: Sequence[float],
    most_pull: float,
) -> Values:
    """Return every combination that pulls with at most `most_pull` [N], shape (n, 4); errors as `Operators.grid`."""
    number("Operators.grid: most_pull", most_pull)
    given = (("mass", mass), ("damping", damping), ("stiffness", stiffness), ("target", target))
    axes = [several_numbers(f"Operators.grid: {name}", values) for name, values in given]
    for column, values in zip(OPERATOR_COLUMNS.values(), axes, strict=False):
        check(column, np.array(values))
    rows = [row for row in itertools.product(*axes) if row[2] * row[3] <= most_pull]
    if not rows:
        raise ValueError(f"no combination pulls with at most most_pull = {most_pull:g} N")
    return np.array(rows)


def random_rows(n: int, seed: int, most_pull: float) -> Values:
    """Return random hands that pull with at most `most_pull` [N], shape (n, 4); errors as `Operators.sample`."""
    n, seed = whole("Operators.sample: n", n), whole("Operators.sample: seed", seed)
    most_pull = number("Operators.sample: most_pull", most_pull)
    for name, value, least in (("n", n, 1), ("seed", seed, 0), ("most_pull", most_pull, 0.5)):
        if not value >= least:
            raise ValueError(f"Operators.sample: {name} = {value}: must be at least {least}")
    draw = np.random.Generator(np.random.PCG64(seed))
    low, high = np.array([LEAST, MOST])
    rows = np.empty((0, 4))
    while len(rows) < n:
        share = draw.random((n, 4))
        drawn = low * (high / low) ** share
        drawn[:, 3] = low[3] + (high[3] - low[3]) * share[:, 3]
        rows = np.vstack([rows, drawn[drawn[:, 2] * drawn[:, 3] <= most_pull]])
    return rows[:n]
