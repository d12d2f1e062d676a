"""The search for gains: looks over the whole range, then NLopt's COBYLA from several starts; every pair is kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Device, Timing
from ebac._util.arguments import unknown
from ebac._util.arrays import Values
from ebac._util.nlopt_callbacks import Carried
from ebac.identify.gains.press_trials import Presses, noise_gain
from ebac.identify.gains.trial import Candidate, Limits, Trial, spare
from ebac.identify.loop import LoopModel
from ebac.laws import LAWS, design
from ebac.scenario import Scenario

#: Largest gains that are tried: K_p [1], K_d [s]; a law may allow less.
LARGEST = {"kp": 2.0, "kd": 0.01}
#: First looks, as shares of the largest gains; squared, since small gains matter most.
LOOKS = (0.0, 0.25, 0.5, 0.75, 0.95)
#: Where the default gains break a constraint, shares of them down to the first that keeps all.
SHARES = (0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1)
#: Most evaluations of COBYLA that can be asked for.
MOST_EVALUATIONS = 10**7
#: How finely COBYLA searches, as a share of the root of the largest gains.
RESOLVED = 5e-3
#: COBYLA starts from the default gains or what is left of them, and from this many of the best looks.
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
        threads: int | None,
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
        self.report = progress or (lambda done, of: None)
        self.most = len(LOOKS) ** 2 + evaluations + len(RULES) + len(SHARES) + 1  # at most

    def judge(self, name: str, kp: float, kd: float) -> Candidate:
        """Measure one pair, and keep it."""
        found = self.trial.judge(name, kp, kd, self.base)
        self.tried.append(found)
        self.report(len(self.tried), self.most)
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
            names = [name.replace(" ", "_") for name in best.broken]
            given = ", ".join(f"{name}=..." for name in names if hasattr(self.limits, name))
            loosen = f"loosen them by limits=Limits({given}), or " * bool(given)
            raise ValueError(
                "no pair of gains keeps the constraints: broken are "
                f"{', '.join(best.broken)} even at kp = {best.kp:.3g}, kd = {best.kd:.3g} s; {loosen}choose another "
                "law"
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
        optimiser.set_xtol_abs(RESOLVED)
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


#: The rules by name.
RULES = ("step-response",)


@dataclass(frozen=True, kw_only=True)
class StepResponse:
    """The reading of the force sensor after a step of the command, the handle held: dead time, rise, gain."""

    dead_time: float  # s
    rise_time: float  # s
    gain: float  # 1


def blocked_step(device: Device, timing: Timing) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return times [s] and the reading [1] after a unit step of the command at t = 0, the handle held in place.

    Transport delay, then the current loop's lag and the sensor's; a command counts from the tick it is computed in.
    """
    dead = timing.delay * timing.dt
    first, second = device.drive.current_lag, device.sensor.lag
    span = dead + 12 * (first + second) + 10 * timing.dt
    t = np.linspace(0, span, 4001)
    s = np.maximum(t - dead, 0)
    if first == second:
        second *= 1.001
    if first == 0 and second == 0:
        return t, (t >= dead).astype(float)

    def rest(lag: float) -> NDArray[np.float64]:
        return lag * np.exp(-s / lag) if lag > 0 else np.zeros_like(s)

    return t, 1 - (rest(first) - rest(second)) / (first - second)


def by_tangent(t: NDArray[np.float64], y: NDArray[np.float64]) -> StepResponse:
    """Read dead time and rise time off a step response, by the tangent at its steepest point (Ziegler, Nichols 1942).

    Raises
    ------
    ValueError
        When the response does not rise.
    """
    slope = np.gradient(y, t)
    steepest = int(np.argmax(slope))
    final = float(y[-1] - y[0])
    if not (final > 0 and slope[steepest] > 0):
        raise ValueError("the step response does not rise: turn its sign, or record a step upwards")
    crossing = float(t[steepest] - (y[steepest] - y[0]) / slope[steepest])
    return StepResponse(
        dead_time=max(crossing, 0.0), rise_time=final / float(slope[steepest]), gain=final
    )


def by_rule(name: str, device: Device, timing: Timing) -> tuple[float, float]:
    """Return K_p [1] and K_d [s] by a named rule.

    `step-response`: the paper takes its "quasi-optimal" set from the step response by its reference [12], whose formula
    it does not print. Taken here: Chien, Hrones and Reswick (1952), no overshoot after a step of the command, for the
    reaction curve of the force with the handle held. K_p = 0.3 T/(k L) as for a proportional controller, since the
    feed-forward of eq. (2) stands in for the integral; the derivative acts over half the dead time, K_d = K_p L/2.

    Raises
    ------
    ValueError
        For a rule that does not exist.
    """
    if name not in RULES:
        raise ValueError(unknown(f"rule {name!r}", name, RULES))
    read = by_tangent(*blocked_step(device, timing))
    dead = max(read.dead_time, 0.5 * timing.dt)  # a sampled loop is never quicker
    kp = 0.3 * read.rise_time / (read.gain * dead)
    return kp, 0.5 * dead * kp
