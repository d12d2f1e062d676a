"""Do gains chosen from a log beat the defaults on hands that were not in it? Everything here is a simulation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import count

import numpy as np

from ebac._core import Hand
from ebac._util.arrays import Values
from ebac.identify.cases import Case, draw
from ebac.identify.gains.gains import GainsResult, fit_gains
from ebac.identify.gains.press_trials import Presses, run_presses
from ebac.identify.gains.search import MOST_EVALUATIONS
from ebac.identify.gains.trial import Candidate, broken
from ebac.identify.loop import LoopModel, fit_loop
from ebac.identify.parameters import HAND
from ebac.identify.recording import Recording
from ebac.identify.target import Target
from ebac.scenario import Scenario

#: Hands of each log that are held out: up to this factor lighter, softer, ... or heavier than the true one.
HELD_OUT, GRIP = 20, 1.3
#: How deep they want to press [m].
DEPTHS = (0.010, 0.030)
LAWS = ("tca", "tca-damped", "ebac")
#: How often each press is done to see what noise alone changes, and how far apart its seeds lie.
REPEATS, SEEDS_APART = 5, 10_000
#: What is compared.
MEASURES = ("settled", "swing", "noise")


@dataclass(frozen=True, kw_only=True, eq=False)
class GainsCase:
    """Gains chosen from one log, and what default and choice come to on the hands that were held out.

    `scatter`: by how much another seed of the noise alone changes each number of each press, under the default gains.
    """

    case: int
    law: str
    result: GainsResult
    default: Presses
    chosen: Presses
    turned_down: Presses | None
    scatter: dict[str, Values]

    def broken(self, kind: str) -> tuple[str, ...]:
        """Return which constraints of the choice are broken by its presses, the default's, or what is left of that."""
        return broken(
            getattr(self, kind), getattr(self.result, kind).noise_gain, self.result.limits
        )


@dataclass(frozen=True, kw_only=True)
class Refused:
    """A log for which no pair of gains keeps the constraints, and why."""

    case: int
    law: str
    why: str


def held_out(case: Case, loop: LoopModel, seed: int) -> list[Scenario]:
    """Return presses on the true device and wall, by hands near the true one, to other depths and with other noise."""
    random = np.random.Generator(np.random.PCG64([seed, case.number, 2]))
    true = case.scenario.hand

    def near(value: float) -> float:
        return float(value * GRIP ** random.uniform(-1, 1))

    scenarios = []
    for i in range(HELD_OUT):
        hand = Hand(
            mass=near(true.mass), damping=near(true.damping), stiffness=near(true.stiffness)
        )
        press = loop.pressing(hand, depth=float(random.uniform(*DEPTHS)), seed=1000 + i)
        wall = press.environment
        scenarios.append(
            press.replace(
                device=case.scenario.device,
                environment=wall.replace(stiffness=case.scenario.environment.stiffness),  # type: ignore[union-attr]
            )
        )
    return scenarios


def check_gains(
    logs: int = 10,
    *,
    seed: int = 1,
    laws: Sequence[str] = LAWS,
    evaluations: int = 75,
    progress: Callable[[int], None] | None = None,
) -> list[GainsCase | Refused]:
    """Identify `logs` random logs of a hand that taps or tracks, choose gains for each law, press with other hands.

    Parameters
    ----------
    logs : int
        How many, at least 1.
    seed : int
        Of all that is drawn.
    laws : sequence of str
        Laws with the force loop of eq. (2).
    evaluations : int
        As for `fit_gains`.
    progress : callable, optional
        Called with how many choices are made.

    Raises
    ------
    ValueError
        For a number out of range.
    """
    from ebac.simulation import simulate

    if logs < 1:
        raise ValueError(f"logs = {logs}: must be at least 1")
    if not 1 <= evaluations <= MOST_EVALUATIONS:
        raise ValueError(f"evaluations = {evaluations}: must lie in [1, {MOST_EVALUATIONS}]")
    out: list[GainsCase | Refused] = []
    done = 0
    for number in count():
        if done == logs:
            break
        case = draw(number, seed)
        if case.task not in ("tapping", "tracking"):
            continue
        recording = Recording.from_trace(
            simulate(case.scenario, case.law), name=f"case {case.number}"
        )
        loop = fit_loop(recording, Target.of(case.scenario.hand, recording.t))
        if any(n in loop.arm.undetermined for n in HAND):
            continue
        done += 1
        others = held_out(case, loop, seed)
        for law in laws:
            out.append(_choose(case, law, loop, others, evaluations))
            if progress is not None:
                progress(len(out))
    return out


def _choose(
    case: Case, law: str, loop: LoopModel, others: list[Scenario], evaluations: int
) -> GainsCase | Refused:
    try:
        result = fit_gains(loop, law, evaluations=evaluations)
    except ValueError as error:
        return Refused(case=case.number, law=law, why=str(error))

    def press(gains: Candidate) -> Presses:
        return run_presses(others, law, {"kp": gains.kp, "kd": gains.kd})

    default, less = press(result.default), result.turned_down
    return GainsCase(
        case=case.number,
        law=law,
        result=result,
        default=default,
        chosen=press(result.chosen),
        turned_down=press(less) if less is not None else None,
        scatter=_scatter(others, law, result, default),
    )


def _scatter(
    others: list[Scenario], law: str, result: GainsResult, first: Presses
) -> dict[str, Values]:
    """Return the deviation of each number of each press over seeds of the noise; NaN where one never settles."""
    gains = {"kp": result.default.kp, "kd": result.default.kd}
    again = [
        run_presses([s.replace(seed=s.seed + SEEDS_APART * i) for s in others], law, gains)
        for i in range(1, REPEATS)
    ]
    runs = {name: np.array([p.columns[name] for p in (first, *again)]) for name in MEASURES}
    return {name: np.asarray(values.std(axis=0, ddof=1)) for name, values in runs.items()}
