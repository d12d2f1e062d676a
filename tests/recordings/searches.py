"""Searches compared on one objective a log: `python tests/recordings/searches.py [logs]`, with one thread of BLAS.

The objective is that of the first round of a fit, from its first guess: exact errors and Jacobian, bounds.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Any, TypeAlias

import nlopt
import numpy as np
from numpy.typing import NDArray
from recorded_arm import LEVELS, TASKS, recorded
from scipy.optimize import least_squares as scipy_least_squares

from ebac import identify
from ebac.identify.arm import _without_pauses
from ebac.identify.level_forces import LevelForces
from ebac.identify.parameters import lay_out
from ebac.identify.search import least_squares
from ebac.identify.start import better_guess

Values: TypeAlias = NDArray[np.float64]
Model: TypeAlias = Callable[[Values], tuple[Values, Values]]
Search: TypeAlias = Callable[[Model, Values, Values, Values], Values]


def case(number: int, level: str, folder: Path) -> tuple[Model, Values, Values, Values]:
    """Return objective, start and bounds of one log."""
    log = recorded(number, level=level, task=TASKS[number % len(TASKS)])
    columns = {"t": log.t, "x": log.x, "force": log.force}
    np.savez(
        folder / "log.npz", **(columns if log.path is None else columns | {"target": log.path})
    )
    recording = identify.load(folder / "log.npz")
    if recording.target is None:
        target = identify.Target(switches=log.switches, segments=log.segments)
    else:
        target = identify.Target.following(recording.target)
    layout = lay_out([target.levels], fixed={}, bounds={}, free=(), own=())
    problem = _without_pauses([recording], [target], layout)
    guess, pull = better_guess(problem), LevelForces.of(problem)
    gains, (low, high) = problem.gains(guess, problem.shown), pull.bounds
    start = np.clip(pull.moved(guess), low, high)
    return (lambda part: pull.linearised(pull.full(part, guess), gains)), start, low, high


def by_ebac(model: Model, start: Values, low: Values, high: Values) -> Values:
    """Search as `fit_arm` does."""
    return least_squares(model, start, low, high).values


def by_scipy(method: str) -> Search:
    """Search by SciPy, errors and Jacobian in one call."""

    def search(model: Model, start: Values, low: Values, high: Values) -> Values:
        last: dict[str, Any] = {}

        def errors(x: Values) -> Values:
            last["x"], (e, last["J"]) = x.copy(), model(x)
            return e

        def jacobian(x: Values) -> Values:
            return last["J"].T if (x == last["x"]).all() else model(x)[1].T

        bounds = {} if method == "lm" else {"bounds": (low, high)}
        found = scipy_least_squares(
            errors, start, jac=jacobian, method=method, x_scale="jac", max_nfev=100, **bounds
        )
        if not ((found.x >= low) & (found.x <= high)).all():
            raise ValueError("ended beyond a bound")
        return np.asarray(found.x)

    return search


def by_nlopt(algorithm: int) -> Search:
    """Search by NLopt, each coordinate scaled by the Jacobian at the start."""

    def search(model: Model, start: Values, low: Values, high: Values) -> Values:
        scale = 1 / np.maximum(np.sqrt((model(start)[1] ** 2).sum(axis=1)), 1e-300)
        optimiser = nlopt.opt(algorithm, len(start))

        def half_cost(x: Values, gradient: Values) -> float:
            e, J = model(x * scale)
            if gradient.size:
                gradient[:] = np.einsum("ik,k->i", J, e) * scale
            return 0.5 * float(np.einsum("i,i->", e, e))

        optimiser.set_min_objective(half_cost)
        optimiser.set_lower_bounds(low / scale)
        optimiser.set_upper_bounds(high / scale)
        optimiser.set_ftol_abs(1e-4)
        optimiser.set_maxeval(300)
        return np.clip(optimiser.optimize(start / scale) * scale, low, high)

    return search


SEARCHES: dict[str, Search] = {
    "ebac: NLopt SLSQP in rounds": by_ebac,
    "SciPy trf": by_scipy("trf"),
    "SciPy dogbox": by_scipy("dogbox"),
    "SciPy lm, no bounds": by_scipy("lm"),
    "NLopt SLSQP": by_nlopt(nlopt.LD_SLSQP),
    "NLopt LBFGS": by_nlopt(nlopt.LD_LBFGS),
    "NLopt VAR2": by_nlopt(nlopt.LD_VAR2),
    "NLopt TNEWTON": by_nlopt(nlopt.LD_TNEWTON_PRECOND_RESTART),
    "NLopt MMA": by_nlopt(nlopt.LD_MMA),
    "NLopt CCSAQ": by_nlopt(nlopt.LD_CCSAQ),
}


def main(logs: int) -> None:
    """Print a row of a table for each search."""
    cost = np.full((len(SEARCHES), logs), np.inf)
    seconds = np.zeros(cost.shape)
    with tempfile.TemporaryDirectory() as folder:
        for number in range(logs):
            model, start, low, high = case(number, LEVELS[number % len(LEVELS)], Path(folder))
            for row, search in enumerate(SEARCHES.values()):
                began = process_time()
                try:
                    e, _ = model(search(model, start.copy(), low, high))
                    cost[row, number] = float(np.einsum("i,i->", e, e))
                except (ValueError, nlopt.runtime_error, nlopt.RoundoffLimited):
                    pass
                seconds[row, number] = process_time() - began
    above = cost / cost.min(axis=0) - 1
    print("| search | best optimum | worst above it | failures | CPU time, median, mean [ms] |")
    print("|---|---|---|---|---|")
    for row, name in enumerate(SEARCHES):
        ended = np.isfinite(cost[row])
        print(
            f"| {name} | {np.sum(above[row] <= 1e-6)} of {logs} | {above[row][ended].max():.1g} | {np.sum(~ended)} "
            f"| {1e3 * np.median(seconds[row]):.0f}, {1e3 * seconds[row].mean():.0f} |"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
