"""K_p and K_d of eq. (2), chosen on the loop of a log."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.identify.loop import LoopModel
from ebac.identify.presses import Presses, arms_around, force_loop_laws, noise_gain, run_presses
from ebac.identify.rules import RULES, by_rule
from ebac.laws import LAWS, Variant, design
from ebac.scenario import Scenario

Values = NDArray[np.float64]

#: Largest gains that are tried: K_p [1], K_d [s]; a law may allow less.
LARGEST = {"kp": 2.0, "kd": 0.01}
#: First looks, as shares of the largest gains; squared, since small gains matter most.
LOOKS = (0.0, 0.15, 0.4, 0.8)
#: How much deeper than the default gains others may go, where no limit is given.
SLACK = 1.25
#: A broken constraint costs so much more than the worst of what keeps them.
PENALTY = 10.0


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
class GainsResult:
    """Gains chosen on a loop; `result.law` runs in any `Scenario`."""

    loop: LoopModel
    name: str
    limits: Limits
    chosen: Candidate
    default: Candidate
    rules: tuple[Candidate, ...]
    tried: tuple[Candidate, ...]

    @property
    def kp(self) -> float:
        """K_p of eq. (2) [1]."""
        return self.chosen.kp

    @property
    def kd(self) -> float:
        """K_d of eq. (2) [s]."""
        return self.chosen.kd

    @property
    def law(self) -> Variant:
        """The law with these gains, designed for the device it runs on."""
        return Variant(self.name, {"kp": self.kp, "kd": self.kd})

    @property
    def scenario(self) -> Scenario:
        """The loop they were chosen on."""
        return self.loop.scenario

    def rows(self) -> list[dict[str, Any]]:
        """Return default, rules and choice, one row each."""
        return [c.row() for c in (self.default, *self.rules, self.chosen)]

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers in SI units, for JSON."""
        return {
            "rows": self.rows(),
            "law": self.name,
            "kp": self.kp,
            "kd_s": self.kd,
            "limits": vars(self.limits),
            "hands": len(self.chosen.presses.goals),
            "tried": [
                {"kp": c.kp, "kd_s": c.kd, "cost": c.cost, "broken": list(c.broken)}
                for c in self.tried
            ],
            "remarks": list(self.loop.remarks),
        }

    def _repr_html_(self) -> str:
        """Return the figure and default, rules and choice, for a notebook."""
        from ebac import notebook
        from ebac.identify.gains_figures import plot_gains

        return notebook.result(repr(self), self.rows(), lambda: plot_gains(self))

    def __repr__(self) -> str:
        """Return the choice and what it comes to."""
        n = self.chosen.presses.numbers()
        return (
            f"<Gains of {self.name}: kp = {self.kp:.3g}, kd = {1e3 * self.kd:.3g} ms; settles in "
            f"{n['settled_median_s']:.3g} s, swings {1e3 * n['swing_worst_m']:.3g} mm at most, cost "
            f"{self.chosen.cost:.3g} of the default's 1>"
        )


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


def fit_gains(
    loop: LoopModel,
    law: str = "ebac",
    *,
    limits: Limits | None = None,
    vary: float = 0.3,
    evaluations: int = 60,
    threads: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> GainsResult:
    """Choose K_p and K_d of eq. (2) for the loop of a log.

    Every pair is simulated on a press of the identified hand, of the ends of its interval, and of hands `vary` away
    from it. The cost is the mean over them of time-weighted error, swing and noise, each over what the default gains
    give; the constraints hold for the worst. First a few looks over the whole range, then NLopt's COBYLA from the best
    of them; the best point seen that keeps all constraints is the answer.

    Parameters
    ----------
    loop : LoopModel
        From `fit_loop`.
    law : str
        A law with the force loop of eq. (2): `tca`, `tca-damped`, `ebac`.
    limits : Limits, optional
        What must be kept.
    vary : float
        How far hands are tried beyond the interval, as a share, [0, 3].
    evaluations : int
        Pairs that COBYLA may try, at least 1.
    threads : int
        Threads of the simulation; 0 for one per core.
    progress : callable, optional
        Told how many pairs are done, and of how many at most.

    Returns
    -------
    GainsResult

    Raises
    ------
    ValueError
        When the log does not determine the hand, the law has no force loop, a number is out of range, or no pair keeps
        the constraints; the message says which.
    """
    known = force_loop_laws()
    if law not in known:
        raise ValueError(
            f"law {law!r}: has no force loop of eq. (2); must be one of {', '.join(known)}"
        )
    if not 0 <= vary <= 3:
        raise ValueError(f"vary = {vary:g}: must lie in [0, 3]")
    if evaluations < 1:
        raise ValueError(f"evaluations = {evaluations}: must be at least 1")
    hands = arms_around(loop.arm, vary)
    scenarios = tuple(loop.pressing(hand, seed=i + 1) for i, hand in enumerate(hands))
    search = _Search(law, scenarios, loop, limits or Limits(), threads, progress, evaluations)
    return search.run()


class _Search:
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
        self.largest = np.array([min(LARGEST[n], ranges[n]) for n in ("kp", "kd")])
        first = Trial(law=law, scenarios=scenarios, limits=limits, threads=threads)
        base = first.measure(self.kp, self.kd)
        self.limits = _complete(limits, loop, base)
        self.trial = Trial(law=law, scenarios=scenarios, limits=self.limits, threads=threads)
        self.base = base
        self.tried: list[Candidate] = []
        self.tell = progress or (lambda done, of: None)
        self.most = len(LOOKS) ** 2 + evaluations + len(RULES) + 1

    def judge(self, name: str, kp: float, kd: float) -> Candidate:
        found = self.trial.judge(name, kp, kd, self.base)
        self.tried.append(found)
        self.tell(len(self.tried), self.most)
        return found

    def run(self) -> GainsResult:
        default = self.judge("default", self.kp, self.kd)
        device, timing = self.loop.device, self.loop.timing
        rules = []
        for name in RULES:
            wanted = np.minimum(by_rule(name, device, timing), self.largest)
            rules.append(self.judge(name, *wanted.tolist()))
        for a in LOOKS:
            for b in LOOKS:
                kp, kd = (np.array([a, b]) ** 2 * self.largest).tolist()
                self.judge("look", kp, kd)
        self._descend()
        best = min(self.tried, key=lambda c: (bool(c.broken), c.cost))
        if best.broken:
            raise ValueError(
                "no pair of gains keeps the constraints: broken are "
                f"{', '.join(best.broken)} even at kp = {best.kp:.3g}, kd = {best.kd:.3g} s; loosen them, or choose "
                "another law"
            )
        chosen = Candidate(**{**vars(best), "name": "chosen"})
        return GainsResult(
            loop=self.loop,
            name=self.law,
            limits=self.limits,
            chosen=chosen,
            default=default,
            rules=tuple(rules),
            tried=tuple(self.tried),
        )

    def _descend(self) -> None:
        import nlopt

        seen: dict[tuple[float, float], Candidate] = {}
        raised: list[BaseException] = []
        optimiser = nlopt.opt(nlopt.LN_COBYLA, 2)
        optimiser.set_exceptions_enabled(False)

        def at(point: Values) -> Candidate:
            kp, kd = (np.clip(point, 0, 1) ** 2 * self.largest).tolist()
            if (kp, kd) not in seen:
                seen[kp, kd] = self.judge("search", kp, kd)
            return seen[kp, kd]

        def objective(point: Values, _: Any) -> float:
            try:
                return min(at(point).cost, PENALTY)
            except BaseException as error:  # would be lost inside of NLopt
                raised.append(error)
                optimiser.force_stop()
                return PENALTY

        def constraint(point: Values, _: Any) -> float:
            if raised:
                return 0.0
            try:
                c = at(point)
                return max(excess(c.presses, c.noise_gain, self.limits).values())
            except BaseException as error:
                raised.append(error)
                optimiser.force_stop()
                return 0.0

        best = min(self.tried, key=lambda c: (bool(c.broken), c.cost))
        optimiser.set_min_objective(objective)
        optimiser.add_inequality_constraint(constraint, 1e-9)
        optimiser.set_lower_bounds(np.zeros(2))
        optimiser.set_upper_bounds(np.ones(2))
        optimiser.set_initial_step(0.15)
        optimiser.set_xtol_abs(5e-3)
        optimiser.set_maxeval(self.evaluations)
        optimiser.optimize(np.clip(np.sqrt(np.array([best.kp, best.kd]) / self.largest), 0, 1))
        if raised:
            raise raised[0]


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
