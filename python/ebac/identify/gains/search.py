"""The search for gains: looks over the whole range, then NLopt's COBYLA from several starts; every pair is kept."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.carried import Carried
from ebac.identify.gains_trial import Candidate, Limits, Trial, spare
from ebac.identify.loop import LoopModel
from ebac.identify.presses import Presses, noise_gain
from ebac.identify.rules import RULES, by_rule
from ebac.laws import LAWS, design
from ebac.scenario import Scenario

Values = NDArray[np.float64]

#: Largest gains that are tried: K_p [1], K_d [s]; a law may allow less.
LARGEST = {"kp": 2.0, "kd": 0.01}
#: First looks, as shares of the largest gains; squared, since small gains matter most.
LOOKS = (0.0, 0.25, 0.5, 0.75, 0.95)
#: Where the default gains break a constraint, shares of them down to the first that keeps all.
SHARES = (0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1)
#: COBYLA starts from the default gains or what is left of them, and from so many of the best looks.
STARTS = 2
#: How much deeper than the default gains others may go, where no limit is given.
SLACK = 1.25
#: A broken constraint costs so much more than the worst of what keeps them.
PENALTY = 10.0


class GainsSearch:
    """Looks, then COBYLA; keeps every candidate."""

    def __init__(
        self,
        law: str,
        scenarios: tuple[Scenario, ...],
        loop: LoopModel,
        limits: Limits,
        threads: int,
        progress: Callable[[int, int], None] | None,
        evaluations: int,
    ) -> None:
        made: Any = design(law, loop.device, loop.timing)
        self.loop, self.law, self.evaluations = loop, law, evaluations
        self.kp, self.kd = float(made.kp), float(made.kd)
        ranges = {f.name: f.high for f in LAWS[law].fields() if f.name in LARGEST}
        self.filter = float(made.filter)
        each = {  # more of one alone would break the noise gain
            "kp": limits.noise_gain,
            "kd": limits.noise_gain / noise_gain(0, 1, self.filter, loop.timing.dt),
        }
        self.largest = np.array([min(LARGEST[n], ranges[n], each[n]) for n in ("kp", "kd")])
        first = Trial(law=law, scenarios=scenarios, limits=limits, threads=threads)
        base = first.measure(self.kp, self.kd)
        self.limits = _complete(limits, loop, base)
        self.trial = Trial(law=law, scenarios=scenarios, limits=self.limits, threads=threads)
        self.base = base
        self.tried: list[Candidate] = []
        self.tell = progress or (lambda done, of: None)
        self.most = len(LOOKS) ** 2 + evaluations + len(RULES) + len(SHARES) + 1  # at most

    def judge(self, name: str, kp: float, kd: float) -> Candidate:
        """Measure one pair, and keep it."""
        found = self.trial.judge(name, kp, kd, self.base)
        self.tried.append(found)
        self.tell(len(self.tried), self.most)
        return found

    def run(self) -> tuple[Candidate, Candidate | None, tuple[Candidate, ...], Candidate]:
        """Return default, what is left of it where it breaks a constraint, rules and choice.

        Raises
        ------
        ValueError
            When no pair keeps the constraints.
        """
        default = self.judge("default", self.kp, self.kd)
        turned = self._turned_down(default)
        device, timing = self.loop.device, self.loop.timing
        rules = []
        for name in RULES:
            wanted = np.minimum(by_rule(name, device, timing), self.largest)
            rules.append(self.judge(name, *wanted.tolist()))
        for a in LOOKS:
            for b in LOOKS:
                kp, kd = (np.array([a, b]) ** 2 * self.largest).tolist()
                if noise_gain(kp, kd, self.filter, timing.dt) <= self.limits.noise_gain:
                    self.judge("look", kp, kd)
        for start in (turned or default, *sorted(self.tried, key=_merit)[:STARTS]):
            self._descend(start)
        best = min(self.tried, key=_merit)
        if best.broken:
            raise ValueError(
                "no pair of gains keeps the constraints: broken are "
                f"{', '.join(best.broken)} even at kp = {best.kp:.3g}, kd = {best.kd:.3g} s; loosen them, or choose "
                "another law"
            )
        chosen = Candidate(**{**vars(best), "name": "chosen"})
        return default, turned, tuple(rules), chosen

    def _turned_down(self, default: Candidate) -> Candidate | None:
        """Return the largest share of the default that keeps all constraints; None where all of it or none does."""
        if not (default.broken or default.close):
            return None
        for share in SHARES:
            found = self.judge("turned down", share * self.kp, share * self.kd)
            if not (found.broken or found.close):
                return found
        return None

    def _descend(self, start: Candidate) -> None:
        import nlopt

        seen: dict[tuple[float, float], Candidate] = {}
        optimiser = nlopt.opt(nlopt.LN_COBYLA, 2)
        carried = Carried(optimiser)

        def at(point: Values) -> Candidate:
            kp, kd = (np.clip(point, 0, 1) ** 2 * self.largest).tolist()
            if (kp, kd) not in seen:
                seen[kp, kd] = self.judge("search", kp, kd)
            return seen[kp, kd]

        def cost(point: Values) -> float:
            return min(at(point).cost, PENALTY)

        def too_much(point: Values) -> float:
            c = at(point)
            return max(spare(c.presses, c.noise_gain, self.limits).values())

        optimiser.set_min_objective(carried(cost, instead=PENALTY))
        optimiser.add_inequality_constraint(carried(too_much, instead=0.0), 1e-9)
        optimiser.set_lower_bounds(np.zeros(2))
        optimiser.set_upper_bounds(np.ones(2))
        optimiser.set_initial_step(0.15)
        optimiser.set_xtol_abs(5e-3)
        optimiser.set_maxeval(max(1, self.evaluations // (STARTS + 1)))
        optimiser.optimize(np.clip(np.sqrt(np.array([start.kp, start.kd]) / self.largest), 0, 1))
        carried.settle()


def _merit(candidate: Candidate) -> tuple[bool, bool, float]:
    """Return what candidates are sorted by, the best first."""
    return bool(candidate.broken), candidate.close, candidate.cost


def _complete(limits: Limits, loop: LoopModel, base: Presses) -> Limits:
    """Fill in what was left to the device and to the default gains."""
    device = loop.device
    peak = device.peak_force * (1 + 1e-9)
    overshoot = limits.overshoot
    if overshoot is None:
        overshoot = SLACK * max(float(np.nanmax(base.overshoot)), 0.0) + device.count
    return Limits(
        overshoot=overshoot,
        force=limits.force if limits.force is not None else peak,
        current=limits.current if limits.current is not None else peak / device.force(1.0),
        noise_gain=limits.noise_gain,
        energy=limits.energy,
    )
