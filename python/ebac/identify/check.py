"""Is the method honest? Random arms on random devices, simulated and identified; how often the truth lies inside.

Everything here is a simulation: encoder counts, noise of the force sensor, a wall and a law in the loop, friction the
fit
knows nothing of.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from ebac._core import Device, ForceSensor, Free, Hand, Mechanics, Recorded, Step, Tapping, Wall
from ebac.identify.arm import fit_arm
from ebac.identify.recording import Recording
from ebac.identify.target import Target
from ebac.scenario import Scenario

#: What the hand does, and its share of the arms: `free` never meets a wall and tells nothing of the arm.
TASKS = {"tapping": 0.4, "tracking": 0.3, "press": 0.2, "free": 0.1}
LAWS = ("ebac", "eba", "tca-damped")
HAND = ("M0", "B0", "K0")


@dataclass(frozen=True, kw_only=True)
class Case:
    """One arm on one device under one law."""

    number: int
    task: str
    law: str
    scenario: Scenario

    def truth(self) -> dict[str, float]:
        """Return the true values by the names of a fit."""
        hand = self.scenario.hand
        out = {"M0": hand.mass, "B0": hand.damping, "K0": hand.stiffness}
        path = hand.path[0]
        if isinstance(path, Tapping):
            out |= {"X0/1": path.target, "X0/2": path.rest}
        elif isinstance(path, Step):
            out["X0"] = path.target
        return out


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

    @property
    def covered(self) -> bool:
        """Whether the interval holds the truth."""
        return self.low <= self.truth <= self.high

    @property
    def error(self) -> float:
        """Relative error of the estimate."""
        return (self.value - self.truth) / abs(self.truth)


def draw(number: int, seed: int, seconds: float = 10.0) -> Case:
    """Draw case `number`; the same numbers give the same case."""
    random = np.random.Generator(np.random.PCG64([seed, number]))

    def between(low: float, high: float) -> float:  # log-uniform
        return float(low * (high / low) ** random.random())

    task = str(random.choice(list(TASKS), p=list(TASKS.values())))
    reach = float(random.uniform(0.01, 0.04))
    stiffness = between(80, min(1000, 30 / reach))
    makers: dict[str, Callable[[], Step | Tapping | Recorded]] = {
        "tapping": lambda: Tapping(
            target=reach, rest=-float(random.uniform(0.005, 0.02)), frequency=between(0.5, 2)
        ),
        "tracking": lambda: _wandering(random, reach, seconds),
        "press": lambda: Step(target=reach),
        "free": lambda: Step(target=reach),
    }
    path = makers[task]()
    hand = Hand(mass=between(0.05, 1.2), damping=between(2, 20), stiffness=stiffness, path=path)
    device = Device(
        mechanics=Mechanics(
            handle_mass=between(0.05, 0.5), damping=between(1, 5), coulomb=between(0.005, 0.1)
        ),
        sensor=ForceSensor(noise=between(0.01, 0.1), quantum=0.01),
    )
    wall = Wall(stiffness=between(1e3, 10e3))
    scenario = Scenario(
        hand=hand,
        device=device,
        environment=Free() if task == "free" else wall,
        seconds=seconds,
        seed=int(random.integers(1, 2**31)),
    )
    return Case(number=number, task=task, law=str(random.choice(LAWS)), scenario=scenario)


def _wandering(random: np.random.Generator, reach: float, seconds: float) -> Recorded:
    """Return a path on a screen: five slow sines around the wall."""
    t = np.arange(0, seconds + 0.01, 0.005)
    waves = sum(
        np.sin(2 * np.pi * (f * t + random.random())) for f in random.uniform(0.2, 3.0, size=5)
    )
    return Recorded(t=t.tolist(), x=(0.4 * reach * waves).tolist())


def run_case(case: Case) -> list[Outcome]:
    """Simulate and identify one case."""
    from ebac.simulation import simulate

    trace = simulate(case.scenario, case.law)
    recording = Recording.from_trace(trace, name=f"case {case.number}")
    result = fit_arm(recording, Target.of(case.scenario.hand, recording.t))
    truth = case.truth()
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
            seconds=result.seconds,
        )
        for name, e in result.estimates.items()
        if not e.fixed
    ]


def _run(job: tuple[int, int, float]) -> list[Outcome]:
    return run_case(draw(*job))


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
        """Count what became of the cases that tell nothing of the arm, and of the others."""
        by_case: dict[int, list[Outcome]] = {}
        for o in self.outcomes:
            by_case.setdefault(o.case, []).append(o)

        def called(outcomes: list[Outcome]) -> bool:
            return any(not o.determined for o in outcomes if o.parameter in HAND)

        free = [c for c in by_case.values() if c[0].task == "free"]
        rest = [c for c in by_case.values() if c[0].task != "free"]
        wrong = [
            o for o in self.outcomes if o.parameter in HAND and o.determined and abs(o.error) > 0.5
        ]
        return {
            "free_cases": len(free),
            "free_called": sum(map(called, free)),
            "other_cases": len(rest),
            "other_called": sum(map(called, rest)),
            "determined_and_wrong_by_half": len(wrong),
        }

    def median_seconds(self) -> float:
        """Median time of a fit [s]."""
        return float(np.median([o.seconds for o in self.outcomes]))


def check(
    arms: int = 200,
    *,
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
    seed : int
        Of arms, devices, tasks, laws and noise.
    seconds : float
        Length of each log [s], [1, 1000].
    workers : int, optional
        Processes; default: one for each core.
    progress : callable, optional
        Told how many are done.

    Raises
    ------
    ValueError
        For a number out of range.
    """
    if arms < 1:
        raise ValueError(f"arms = {arms}: must be at least 1")
    if not 1 <= seconds <= 1000:
        raise ValueError(f"seconds = {seconds} s: must lie in [1, 1000] s")
    if workers is not None and workers < 1:
        raise ValueError(f"workers = {workers}: must be at least 1")
    jobs = [(i, seed, seconds) for i in range(arms)]
    outcomes: list[Outcome] = []
    with ProcessPoolExecutor(workers) as pool:
        for done, found in enumerate(pool.map(_run, jobs), 1):
            outcomes += found
            if progress is not None:
                progress(done)
    return Check(outcomes=tuple(outcomes))
