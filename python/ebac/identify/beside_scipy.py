"""The search of a fit beside that of SciPy: the same objective from the same first guess, time and result."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter, process_time

import numpy as np

from ebac.identify.arm import fit_arm
from ebac.identify.result import ArmResult
from ebac.identify.start import first_guess


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Times [s] by the clock and of the processor, and the largest difference of an estimate in deviations."""

    ours_s: float
    ours_cpu_s: float
    scipy_s: float
    scipy_cpu_s: float
    apart: float


def compare_with_scipy(result: ArmResult) -> Comparison:
    """Minimise the last objective of a fit by `scipy.optimize.least_squares`, from the same first guess.

    Raises
    ------
    ModuleNotFoundError
        Without SciPy.
    """
    from scipy.optimize import least_squares

    problem, p = result.problem, result.parameters
    gains = problem.gains(result.optimum, result.force_noise)
    start = first_guess(problem)
    moved = problem.moved
    doubt = problem.doubt.deviation
    scale = np.maximum(np.concatenate([result.deviation[p.free], doubt]), 1e-12)

    def errors(part: np.ndarray) -> np.ndarray:
        full = start.copy()
        full[moved] = part
        return problem.objective(full, gains)

    began, busy = perf_counter(), process_time()
    found = least_squares(
        errors,
        start[moved],
        bounds=(p.low[moved], p.high[moved]),
        x_scale=scale,
        xtol=1e-10,
        ftol=1e-12,
    )
    scipy_s, scipy_cpu_s = perf_counter() - began, process_time() - busy
    began, busy = perf_counter(), process_time()
    fit_arm(list(problem.recordings), list(problem.targets), fixed={
        n: float(v) for n, v in zip(p.names, p.fixed, strict=True) if not np.isnan(v)
    }, free=[n for n in ("delay", "onset") if any(p.names[i].startswith(n) for i in p.free)])  # fmt: skip
    ours, ours_cpu = perf_counter() - began, process_time() - busy
    apart = (np.abs(found.x - result.optimum[moved]) / scale)[: len(p.free)]
    return Comparison(
        ours_s=ours,
        ours_cpu_s=ours_cpu,
        scipy_s=scipy_s,
        scipy_cpu_s=scipy_cpu_s,
        apart=float(apart.max()),
    )
