"""Criteria for a pair of gains: limits that apply to every hand, and a cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ebac._util.arguments import number
from ebac._util.wrong_calls import plain_constructor
from ebac.identify.gains.press_trials import Presses, noise_gain, run_presses
from ebac.laws import design
from ebac.scenario import Scenario

#: What overshoot and energy must stay below their limits, as a share of them.
SPARE = 0.1
#: Swing and noise that differ by less than this share are called equal.
ALIKE = 0.01
#: The cost where a press ends in a fault, or flies away.
RUINED = 1e3


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits that gains must keep for every hand with which they are simulated.

    Parameters
    ----------
    overshoot : float, optional
        Largest depth beyond the ideal rest [m]; default: 1.25 times that of the default gains.
    force : float, optional
        Largest applied force [N]; default: the motor's peak.
    current : float, optional
        Largest commanded current [A]; default: the drive's peak.
    noise_gain : float
        Noise of the command per noise of the force reading [1], > 0.
    energy : float
        Largest energy that the port may have given out at any time [J], >= 0.

    Raises
    ------
    ValueError
        For a number out of range.
    """

    overshoot: float | None = None
    force: float | None = None
    current: float | None = None
    noise_gain: float = 0.5
    energy: float = 0.010

    def __post_init__(self) -> None:
        """Check the ranges."""
        units = {"overshoot": "m", "force": "N", "current": "A", "noise_gain": "", "energy": "J"}
        for name, unit in units.items():
            value = getattr(self, name)
            if value is None:
                continue
            number(f"Limits.{name}", value)
            if not (value > 0 or (name == "energy" and value == 0)):
                must = "at least 0" if name == "energy" else "positive"
                raise ValueError(f"Limits.{name} = {value:g} {unit}".rstrip() + f": must be {must}")


@dataclass(frozen=True, kw_only=True, eq=False)
class Candidate:
    """One pair of gains and its results.

    `ratios`: settling, swing and noise over the default's, geometric mean over the presses. `close`: overshoot or
    energy come so near their limit that another hand might break it.
    """

    name: str
    kp: float
    kd: float
    cost: float
    noise_gain: float
    broken: tuple[str, ...]
    close: bool
    ratios: dict[str, float]
    presses: Presses

    def row(self) -> dict[str, Any]:
        """Return its numbers in SI units."""
        return {
            "gains": self.name,
            "kp": self.kp,
            "kd_s": self.kd,
            "cost": self.cost,
            "noise_gain": self.noise_gain,
            "broken": list(self.broken),
            **{f"{name}_ratio": value for name, value in self.ratios.items()},
            **self.presses.numbers(),
        }

    def __repr__(self) -> str:
        """Return one line: gains, cost, broken constraints."""
        return (
            f"<Candidate {self.name}: kp = {self.kp:.4g}, kd = {1e3 * self.kd:.4g} ms, cost {self.cost:.4g}; "
            f"breaks {', '.join(self.broken) or 'nothing'}>"
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Trial:
    """Judges gains on one set of presses, against what the default gains come to there."""

    law: str
    scenarios: tuple[Scenario, ...]
    limits: Limits
    threads: int | None

    def measure(self, kp: float, kd: float) -> Presses:
        """Run all presses."""
        return run_presses(list(self.scenarios), self.law, {"kp": kp, "kd": kd}, self.threads)

    def judge(self, name: str, kp: float, kd: float, base: Presses | None = None) -> Candidate:
        """Measure gains; `base` is what the default comes to, itself when missing."""
        presses = self.measure(kp, kd)
        first, base = self.scenarios[0], base or presses
        made: Any = design(self.law, first.device, first.timing)
        gain = noise_gain(kp, kd, made.filter, first.timing.dt)
        over = ratios(presses, base, first)
        return Candidate(
            name=name,
            kp=kp,
            kd=kd,
            cost=cost(over, allowances(base, first)) if presses.whole.all() else RUINED,
            noise_gain=gain,
            broken=broken(presses, gain, self.limits),
            close=max(spare(presses, gain, self.limits).values()) > 1e-9,
            ratios=over,
            presses=presses,
        )


def ratios(presses: Presses, base: Presses, scenario: Scenario) -> dict[str, float]:
    """Return settling, swing, noise over those of `base`: the geometric mean of all presses.

    A press that never settles counts with the length of its run; swing counts beyond one encoder count, and noise
    beyond a thousandth of the force, or two numbers next to nothing would decide.
    """
    c, b = presses.columns, base.columns
    count, quiet = scenario.device.count, max(1e-6, 1e-3 * float(np.mean(b["most_force"])))
    settled, before = (np.minimum(p.settled, scenario.seconds) for p in (presses, base))
    tick = scenario.timing.dt
    over = {
        "settling": (settled + tick) / (before + tick),
        "swing": (c["swing"] + count) / (b["swing"] + count),
        "noise": (c["noise"] + quiet) / (b["noise"] + quiet),
    }
    return {name: float(np.exp(np.mean(np.log(values)))) for name, values in over.items()}


def allowances(base: Presses, scenario: Scenario) -> dict[str, float]:
    """Return by what share each number may be longer or larger and still be called equal.

    Half a tick, since a settling time is a whole number of them; of swing and noise one percent.
    """
    tick = scenario.timing.dt
    settled = np.minimum(base.settled, scenario.seconds) + tick
    half = 0.5 * tick / float(np.exp(np.mean(np.log(settled))))
    return {"settling": half, "swing": ALIKE, "noise": ALIKE}


def cost(over: dict[str, float], alike: dict[str, float]) -> float:
    """Return what gains cost, 1 for the default: less where they win, and never by giving back what the default has.

    What they win of settling, swing and noise is multiplied (Nash 1950): no gain in one pays for a loss in another.
    Where something is given back, that alone counts.
    """
    won = np.array([(1 + a - over[name]) / (1 + a) for name, a in alike.items()])
    start = np.prod([a / (1 + a) for a in alike.values()]) ** (1 / 3)
    if not np.isfinite(won).all():
        return RUINED
    if (won > 0).all():
        return float((1 - np.prod(won) ** (1 / 3)) / (1 - start))
    return float(1 / (1 - start) + np.maximum(-won, 0).sum())


def excess(presses: Presses, gain: float, limits: Limits) -> dict[str, float]:
    """Return by how much each constraint is broken, as a share of its limit; negative where it is kept."""
    n = presses.numbers()
    energy = max(limits.energy, 1e-6)
    out = {
        "noise gain": gain / limits.noise_gain - 1,
        "energy": (-n["least_energy_J"] - limits.energy) / energy,
    }
    for name, value, limit in (
        ("overshoot", n["overshoot_worst_m"], limits.overshoot),
        ("force", n["force_worst_N"], limits.force),
        ("current", n["current_worst_A"], limits.current),
    ):
        if limit is not None:
            out[name] = value / limit - 1
    if not presses.whole.all():
        out["stability"] = 1.0
    return {k: v if np.isfinite(v) else 1.0 for k, v in out.items()}


def spare(presses: Presses, gain: float, limits: Limits) -> dict[str, float]:
    """Return the same with something to spare, since held-out hands are others: a tenth of overshoot and energy."""
    out = excess(presses, gain, limits)
    for name, limit in (("overshoot", limits.overshoot), ("energy", limits.energy)):
        if limit:
            out[name] += SPARE
    return out


def broken(presses: Presses, gain: float, limits: Limits) -> tuple[str, ...]:
    """Return the names of the constraints that are broken."""
    return tuple(name for name, by in excess(presses, gain, limits).items() if by > 1e-9)
