"""Do gains chosen from a log beat the defaults on hands that were not in it? Everything here is a simulation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np

from ebac._core import Hand
from ebac.identify.cases import Case, draw
from ebac.identify.gains import GainsResult, fit_gains
from ebac.identify.gains_trial import broken
from ebac.identify.loop import LoopModel, fit_loop
from ebac.identify.presses import Presses, run_presses
from ebac.identify.recording import Recording
from ebac.identify.target import Target
from ebac.scenario import Scenario

#: Hands of each log that are held out: up to this factor lighter, softer, ... or heavier than the true one.
HELD_OUT, GRIP = 20, 1.3
#: How deep they want to press [m].
DEPTHS = (0.010, 0.030)
LAWS = ("tca", "tca-damped", "ebac")


@dataclass(frozen=True, kw_only=True, eq=False)
class GainsCase:
    """Gains chosen from one log, and what default and choice come to on the hands that were held out."""

    case: int
    law: str
    result: GainsResult
    default: Presses
    chosen: Presses

    def broken(self, presses: Presses) -> tuple[str, ...]:
        """Return which constraints of the choice these presses break."""
        candidate = self.result.chosen if presses is self.chosen else self.result.default
        return broken(presses, candidate.noise_gain, self.result.limits)


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
    progress : callable, optional
        Told how many choices are made.

    Raises
    ------
    ValueError
        For a number out of range.
    """
    from ebac.simulation import simulate

    if logs < 1:
        raise ValueError(f"logs = {logs}: must be at least 1")
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
        if any(n in loop.arm.undetermined for n in ("M0", "B0", "K0")):
            continue
        done += 1
        others = held_out(case, loop, seed)
        for law in laws:
            out.append(_choose(case, law, loop, others))
            if progress is not None:
                progress(len(out))
    return out


def _choose(case: Case, law: str, loop: LoopModel, others: list[Scenario]) -> GainsCase | Refused:
    try:
        result = fit_gains(loop, law)
    except ValueError as error:
        return Refused(case=case.number, law=law, why=str(error))
    presses = [
        run_presses(others, law, {"kp": c.kp, "kd": c.kd}) for c in (result.default, result.chosen)
    ]
    return GainsCase(
        case=case.number, law=law, result=result, default=presses[0], chosen=presses[1]
    )


def gains_rows(cases: Sequence[GainsCase | Refused]) -> list[dict[str, Any]]:
    """Return a row for each law and kind of gains, over all presses that were held out.

    A law of which every log was refused has no row.
    """
    rows = []
    for law in dict.fromkeys(c.law for c in cases):
        mine = [c for c in cases if isinstance(c, GainsCase) and c.law == law]
        refused = sum(isinstance(c, Refused) and c.law == law for c in cases)
        for kind in ("default", "chosen") if mine else ():
            presses: list[Presses] = [getattr(c, kind) for c in mine]
            row = _row(mine, presses)
            rows.append({"law": law, "gains": kind, **row, "logs_refused": refused})
    return rows


def _row(cases: list[GainsCase], presses: list[Presses]) -> dict[str, Any]:
    settled = np.concatenate([p.settled for p in presses])

    def column(name: str) -> Any:
        return np.concatenate([p.columns[name] for p in presses])

    pairs = list(zip(cases, presses, strict=True))
    kinds = [c.result.chosen if p is c.chosen else c.result.default for c, p in pairs]
    return {
        "kp_median": float(np.median([k.kp for k in kinds])),
        "kd_median_s": float(np.median([k.kd for k in kinds])),
        "presses": len(settled),
        "settled": int(np.isfinite(settled).sum()),
        "settled_median_s": float(np.median(settled)),
        "swing_median_m": float(np.median(column("swing"))),
        "swing_worst_m": float(np.max(column("swing"))),
        "noise_median_N": float(np.median(column("noise"))),
        "least_energy_J": float(np.min(column("least_energy"))),
        "logs": len(cases),
        "logs_with_broken_constraint": sum(
            bool(c.broken(p)) for c, p in zip(cases, presses, strict=True)
        ),
        "broken": sorted({b for c, p in zip(cases, presses, strict=True) for b in c.broken(p)}),
    }
