"""What a pair of gains is judged by: limits that hold for every hand, and a cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ebac.identify.presses import Presses, noise_gain, run_presses
from ebac.laws import design
from ebac.scenario import Scenario


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What gains must keep for every hand they are tried on.

    Parameters
    ----------
    overshoot : float, optional
        How much deeper than an ideal wall rests [m]; default: a quarter more than the default gains show.
    force : float, optional
        Largest applied force [N]; default: the motor's peak.
    current : float, optional
        Largest current asked [A]; default: the drive's peak.
    noise_gain : float
        Noise of the command per noise of the force reading [1], > 0.
    energy : float
        Most energy the port may have given away at any time [J], >= 0.

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
            if value is not None and not (value > 0 or (name == "energy" and value == 0)):
                raise ValueError(
                    f"Limits.{name} = {value:g} {unit}".rstrip() + ": must be positive"
                )


@dataclass(frozen=True, kw_only=True, eq=False)
class Candidate:
    """One pair of gains and what it came to."""

    name: str
    kp: float
    kd: float
    cost: float
    noise_gain: float
    broken: tuple[str, ...]
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
            **self.presses.numbers(),
        }


@dataclass(frozen=True, kw_only=True, eq=False)
class Trial:
    """Judges gains on one set of presses, against what the default gains come to there."""

    law: str
    scenarios: tuple[Scenario, ...]
    limits: Limits
    threads: int

    def measure(self, kp: float, kd: float) -> Presses:
        """Run all presses."""
        return run_presses(list(self.scenarios), self.law, {"kp": kp, "kd": kd}, self.threads)

    def judge(self, name: str, kp: float, kd: float, base: Presses | None = None) -> Candidate:
        """Measure gains; `base` is what the default comes to, itself when missing."""
        presses = self.measure(kp, kd)
        first = self.scenarios[0]
        made: Any = design(self.law, first.device, first.timing)
        gain = noise_gain(kp, kd, made.filter, first.timing.dt)
        return Candidate(
            name=name,
            kp=kp,
            kd=kd,
            cost=cost(presses, base or presses, first.device.count),
            noise_gain=gain,
            broken=broken(presses, gain, self.limits),
            presses=presses,
        )


def cost(presses: Presses, base: Presses, count: float) -> float:
    """Return what gains cost, 1 for the default: time-weighted error, swing, noise, each over the default's.

    Time-weighted, since a settling time jumps where the error touches its band.
    """
    c, b = presses.columns, base.columns
    late = np.mean(c["lateness"] / np.maximum(b["lateness"], 1e-12))
    swing = np.mean((c["swing"] + count) / (b["swing"] + count))
    quiet = max(1e-6, 1e-3 * float(np.mean(b["most_force"])))
    noise = np.mean((c["noise"] + quiet) / (b["noise"] + quiet))
    total = float((late + swing + noise) / 3)
    return total if np.isfinite(total) and presses.whole.all() else 1e3


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


def broken(presses: Presses, gain: float, limits: Limits) -> tuple[str, ...]:
    """Return the names of the constraints that are broken."""
    return tuple(name for name, by in excess(presses, gain, limits).items() if by > 1e-9)
