"""Is the method honest? Random arms on random devices, simulated and identified; how often the truth lies inside.

Everything here is a simulation: encoder counts, noise of the force sensor, a wall and a law in the loop, friction
that the fit knows nothing of.
"""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import active_children
from time import perf_counter
from typing import Any

import numpy as np

from ebac._util.cores import MOST_THREADS
from ebac.identify.arm import fit_arm
from ebac.identify.cases import Case, draw, draw_device, draw_sway
from ebac.identify.device import fit_device
from ebac.identify.estimate import Estimate
from ebac.identify.fit import spread_at
from ebac.identify.force_scale import DAMPING, MASS, force_scale
from ebac.identify.parameters import HAND, lay_out
from ebac.identify.problem import Problem
from ebac.identify.recording import Recording
from ebac.identify.result import ArmResult
from ebac.identify.target import Target
from ebac.identify.validation import TooFewReadings


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Estimate, interval and truth of one parameter of one case."""

    case: int
    task: str
    law: str
    parameter: str
    truth: float
    value: float
    low: float
    high: float
    determined: bool
    seconds: float
    informative: bool = True  # whether the log determines it, at the true values; only of the arm

    @property
    def covered(self) -> bool:
        """Whether the interval holds the truth."""
        return self.low <= self.truth <= self.high

    @property
    def error(self) -> float:
        """Relative error of the estimate."""
        return (self.value - self.truth) / abs(self.truth)


def run_case(case: Case) -> list[Outcome]:
    """Simulate and identify one case; a log that is refused determines no parameter."""
    from ebac.simulation import simulate

    trace = simulate(case.scenario, case.law)
    recording = Recording.from_trace(trace, name=f"case {case.number}")
    target = Target.of(case.scenario.hand, recording.t)
    truth = case.truth()
    try:
        result = fit_arm(recording, target)
    except TooFewReadings:
        result = _not_fitted(recording, target)
        free, seconds = _nothing(result.parameters.names[i] for i in result.parameters.free), 0.0
    else:
        free = {name: e for name, e in result.estimates.items() if not e.fixed}
        seconds = result.seconds
    known = determined_by(result, truth)
    found = _outcomes(case, free, truth, seconds)
    return [replace(o, informative=o.parameter in known) for o in found]


def determined_by(result: ArmResult, truth: Mapping[str, float]) -> set[str]:
    """Return the parameters a log determines, judged at the true values; only a simulation knows them."""
    p = result.parameters
    values = np.array([truth.get(n, v) for n, v in zip(p.names, result.values, strict=True)])
    known = replace(result, values=values, covariance=spread_at(result.problem, values))
    return set(p.names) - set(known.undetermined)


def _not_fitted(recording: Recording, target: Target) -> ArmResult:
    """Return the problem of a refused log, with no estimates: what it determines can be judged at the true values."""
    parameters = lay_out([target.levels], fixed={}, bounds={}, free=(), own=())
    problem = Problem(recordings=(recording,), targets=(target,), parameters=parameters)
    values = np.where(np.isnan(parameters.fixed), 0.0, parameters.fixed)
    return ArmResult(
        problem=problem,
        values=values,
        optimum=values,
        force_noise=problem.shown,
        errors=np.zeros(len(recording.t)),
        covariance=np.diag(np.full(len(parameters.free), np.inf)),
        robust=None,
        converged=False,
        evaluations=0,
        seconds=0.0,
    )


def _nothing(names: Iterable[str]) -> dict[str, Estimate]:
    """Return estimates of a log that is refused: none of the parameters is determined."""
    return {
        n: Estimate(
            name=n, value=0.0, unit="", low=-np.inf, high=np.inf, fixed=False, determined=False
        )
        for n in names
    }


def run_device_case(case: Case) -> list[Outcome]:
    """Simulate one case and identify its device; a log that is refused has no outcome but that."""
    from ebac.simulation import simulate

    trace = simulate(case.scenario, case.law)
    truth = case.device_truth()
    try:
        result = fit_device(Recording.from_trace(trace, name=f"case {case.number}"))
    except ValueError:
        return _outcomes(case, _nothing(truth), truth, 0.0)
    return _outcomes(case, result.estimates, truth, result.seconds)


def run_scale_case(case: Case) -> list[Outcome]:
    """Simulate one case and compare its sensor with its motor, mass and damping as wrong as they may be."""
    from ebac.simulation import simulate

    began = perf_counter()
    sensor, device = case.scenario.device.sensor, case.scenario.device
    off = np.random.Generator(np.random.PCG64([case.scenario.seed, 3])).choice([-1, 1], size=2)
    truth = {"scale": sensor.scale}
    recording = Recording.from_trace(simulate(case.scenario, case.law), name=f"case {case.number}")
    try:
        found = force_scale(
            recording,
            mass=float(device.mass * (1 + MASS * off[0])),
            damping=float(device.mechanics.damping * (1 + DAMPING * off[1])),
        )
    except ValueError:
        return _outcomes(case, _nothing(truth), truth, 0.0)
    estimate = Estimate(
        name="scale",
        value=found.scale,
        unit="N/N",
        low=found.low,
        high=found.high,
        fixed=False,
        determined=found.determined,
    )
    return _outcomes(case, {"scale": estimate}, truth, perf_counter() - began)


def _outcomes(
    case: Case, estimates: Mapping[str, Estimate], truth: Mapping[str, float], seconds: float
) -> list[Outcome]:
    return [
        Outcome(
            case=case.number,
            task=case.task,
            law=case.law,
            parameter=name,
            truth=truth.get(name, 0.0),
            value=e.value,
            low=e.low,
            high=e.high,
            determined=e.determined,
            seconds=seconds,
        )
        for name, e in estimates.items()
    ]


def _without_handlers() -> None:
    """Leave Ctrl-C to the process that started this one, and end at once when it says so."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _run(job: tuple[str, int, int, float]) -> list[Outcome]:
    what, number, seed, seconds = job
    if what == "device":
        return run_device_case(draw_device(number, seed, seconds))
    if what == "scale":
        return run_scale_case(draw_sway(number, seed, seconds))
    return run_case(draw(number, seed, seconds))


@dataclass(frozen=True, kw_only=True)
class Check:
    """The outcomes of many cases."""

    outcomes: tuple[Outcome, ...]

    def rows(self) -> list[dict[str, Any]]:
        """Return coverage and bias of each parameter, over the cases that determine it."""
        names = dict.fromkeys(o.parameter for o in self.outcomes)
        return [self._row(name) for name in names]

    def _row(self, name: str) -> dict[str, Any]:
        every = [o for o in self.outcomes if o.parameter == name]
        known = [o for o in every if o.determined]
        errors = np.array([o.error if o.truth else np.nan for o in known])
        has_truth = bool(np.isfinite(errors).any())
        return {
            "parameter": name,
            "cases": len(every),
            "determined": len(known),
            "covered_share": float(np.mean([o.covered for o in known])) if known else None,
            "covered_share_all": float(np.mean([o.covered for o in every])),
            "median_bias": float(np.nanmedian(errors)) if has_truth else None,
            "median_error": float(np.nanmedian(np.abs(errors))) if has_truth else None,
        }

    def unidentifiable(self) -> dict[str, int]:
        """Count the logs that determine the arm and those that do not, with the verdict on each."""
        by_case: dict[int, list[Outcome]] = {}
        for o in self.outcomes:
            if o.parameter in HAND:
                by_case.setdefault(o.case, []).append(o)
        called = {n: any(not o.determined for o in case) for n, case in by_case.items()}
        silent = {n for n, case in by_case.items() if any(not o.informative for o in case)}
        wrong = [
            o for o in self.outcomes if o.parameter in HAND and o.determined and abs(o.error) > 0.5
        ]
        return {
            "silent_cases": len(silent),
            "silent_called": sum(called[n] for n in silent),
            "telling_cases": len(by_case) - len(silent),
            "telling_called": sum(called[n] for n in by_case if n not in silent),
            "determined_and_wrong_by_half": len(wrong),
        }

    def median_seconds(self) -> float:
        """Median time of a fit [s]."""
        return float(np.median([o.seconds for o in self.outcomes]))


def check(
    arms: int = 200,
    *,
    what: str = "arm",
    seed: int = 1,
    seconds: float = 10.0,
    workers: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> Check:
    """Simulate and identify `arms` random arms, in parallel.

    Parameters
    ----------
    arms : int
        How many, at least 1.
    what : str
        What is identified: `arm`, `device`, or `scale` of the force sensor.
    seed : int
        Of arms, devices, tasks, laws and noise.
    seconds : float
        Length of each log [s], [1, 1000].
    workers : int, optional
        Processes; default: one for each core.
    progress : callable, optional
        Called with how many are done.

    Raises
    ------
    ValueError
        For a number out of range.
    """
    if what not in ("arm", "device", "scale"):
        raise ValueError(f"what = {what!r}: must be arm, device or scale")
    if arms < 1:
        raise ValueError(f"arms = {arms}: must be at least 1")
    if not 1 <= seconds <= 1000:
        raise ValueError(f"seconds = {seconds} s: must lie in [1, 1000] s")
    if workers is not None and not 1 <= workers <= MOST_THREADS:
        raise ValueError(f"workers = {workers}: must lie in [1, {MOST_THREADS}]")
    jobs = [(what, i, seed, seconds) for i in range(arms)]
    outcomes: list[Outcome] = []
    # Ctrl-C in a terminal goes to all processes: this one alone takes it, and ends the workers.
    others = set(active_children())
    pool = ProcessPoolExecutor(workers, initializer=_without_handlers)
    try:
        for done, job in enumerate([pool.submit(_run, job) for job in jobs], 1):
            outcomes += job.result()
            if progress is not None:
                progress(done)
    except BaseException:
        for worker in set(active_children()) - others:
            worker.terminate()
        # Nothing is cancelled, as by pool.map: the pool gives each job the error of its workers, which a cancelled one
        # refuses with a traceback.
        pool.shutdown(wait=False)
        raise
    pool.shutdown()
    return Check(outcomes=tuple(outcomes))
