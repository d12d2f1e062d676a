"""`tune`: a law's parameters searched on training hands, judged on others."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import unknown_name
from ebac._util.nlopt_callbacks import Carried
from ebac.laws import LAWS, AnyLaw, Variant, shown_value
from ebac.operators import Operators
from ebac.scenario import Scenario
from ebac.studies.conditions import Condition
from ebac.studies.conditions import conditions as find
from ebac.studies.result import Study
from ebac.studies.study import study
from ebac.studies.sweeps.job import Progress
from ebac.studies.sweeps.result import SweepResult
from ebac.studies.sweeps.run import seed_of, sweep

Range: TypeAlias = tuple[float, float]
Values: TypeAlias = NDArray[np.float64]

#: What is searched of each law, in SI units; (0, 1) for a switch. Facts about the device are left alone.
RANGES: dict[str, dict[str, Range]] = {
    "tca": {"kp": (0, 2), "kd": (0, 0.005)},
    "tca-damped": {"virtual_damping": (5, 200), "kp": (0, 1)},
    "lag-compensator": {
        "stiffness": (500, 2e4), "virtual_damping": (5, 200), "recovery_time": (0.01, 1)
    },
    "passivity-control": {"cap": (0.1, 60), "reference": (0, 1), "per_contact": (0, 1)},
    "iss": {"gain": (1e-7, 1e-2), "most_damping": (1, 200)},
    "virtual-coupling": {"coupling_stiffness": (500, 2e5), "coupling_damping": (0.01, 200)},
    "sfa": {"stiffness": (200, 1e4), "gain": (0.005, 1), "transient": (0, 1)},
    "eba": {"share": (0.1, 1)},
    "eba-account": {"share": (0.1, 1)},
}  # fmt: skip
#: Conditions of a search: delay 0, 1, 2 at 10 and 20 kN/m.
TUNING_CONDITIONS = ("d0K10", "d0K20", "d1K10", "d1K20", "d2K10", "d2K20")
#: Training hands: so many random ones, of this seed; the test hands are the grid of 60.
HANDS, HANDS_SEED = 24, 14
#: Share of the runs that look over the whole range (DIRECT-L); the others refine the best point (Subplex).
LOOKS = 0.6

# The cost of a run: at most 0.3 for one that is good, at least 1 for another.
_WEIGHT = 0.1  # of settling, of energy and of ripple
_HALF_SETTLING = 0.5  # s, at which half of the weight is charged
_HALF_ENERGY = 10e-3  # J
_HALF_RIPPLE = 1.0  # N
_FAR = 1e-3  # m, error and swing of a run that is not good


@dataclass(frozen=True, kw_only=True)
class TunedRow:
    """A law under one condition, over the test hands; None where there is none.

    Attributes
    ----------
    condition : str
        Its name.
    hands, good : int
        Hands, and the good ones, see `StudyRow`.
    median_settled_s : float or None
        Median settling time of those that settled [s].
    least_energy_J, most_drawn_J : float or None
        Least energy of the port, and most drawn in any window of any run [J].
    ripple_N : float or None
        Largest force swing at rest of a good hand [N].
    """

    condition: str
    hands: int
    good: int
    median_settled_s: float | None
    least_energy_J: float | None
    most_drawn_J: float | None
    ripple_N: float | None


@dataclass(frozen=True, kw_only=True)
class Tuned:
    """A law tuned for one delay.

    Attributes
    ----------
    law : str
        Its name.
    delay : int
        Transport delay [samples] of the conditions.
    changes : dict
        The parameters found, in SI units; none where the design is best.
    tried : int
        Points that were tried, the default among them.
    cost, default_cost : float
        Of the training hands, see `cost_of`.
    test, default : tuple of TunedRow
        One per condition, of the test hands: with these parameters, and with those of the design.
    """

    law: str
    delay: int
    changes: dict[str, float | bool]
    tried: int
    cost: float
    default_cost: float
    test: tuple[TunedRow, ...]
    default: tuple[TunedRow, ...]

    @property
    def variant(self) -> Variant:
        """The law with these parameters, to be used wherever a law can be."""
        return Variant(self.law, self.changes)

    def row(self) -> dict[str, Any]:
        """Return the documented row of `ebac tune --json`."""
        return asdict(self)

    def __repr__(self) -> str:
        """Return the parameters and how many test hands are good."""
        found = ", ".join(f"{n} = {shown_value(v)}" for n, v in self.changes.items())
        good = ", ".join(
            f"{t.condition} {t.good} of {t.hands} (before: {d.good})"
            for t, d in zip(self.test, self.default, strict=True)
        )
        return f"<{self.law}, delay {self.delay}: {found}; good, simulated: {good}>"


class TuningInterrupted(KeyboardInterrupt):
    """A search was interrupted from the keyboard; `result` holds the best so far."""

    def __init__(self, result: list[Tuned]) -> None:
        self.result = result
        super().__init__("the best so far is kept" if result else "nothing was tried yet")


def cost_of(result: SweepResult) -> float:
    """Return the mean cost of some runs [1]; less is better.

    A good run costs 0.1 s/(s + 0.5 s) for settling at s; any other 1 + e/(2 (e + 1 mm)) for an error and a swing of e
    together. To both comes 0.1 E/(E + 10 mJ), E the most energy drawn in any window, and 0.1 R/(R + 1 N), R the force
    swing at rest. A good hand more outweighs what two others can gain.
    """
    bad = 1 + 0.5 * _share(np.abs(result.deviation_m) + result["swing_m"], _FAR)
    settling = _WEIGHT * _share(result["settled_s"], _HALF_SETTLING)
    energy = _WEIGHT * _share(result["most_drawn_J"], _HALF_ENERGY)
    ripple = _WEIGHT * _share(result["force_swing_N"], _HALF_RIPPLE)
    return float(np.mean(np.where(result.good, settling, bad) + energy + ripple))


def _share(values: Values, half: float) -> Values:
    """Return x/(x + half); 1 where there is no number."""
    return np.asarray(1 - half / (np.nan_to_num(values, nan=np.inf, posinf=np.inf) + half))


def tune(
    law: str,
    conditions: Sequence[str | Condition] = TUNING_CONDITIONS,
    *,
    training: Operators | None = None,
    test: Operators | None = None,
    ranges: Mapping[str, Range] | None = None,
    base: Scenario | None = None,
    evaluations: int = 120,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress | None = None,
) -> list[Tuned]:
    """Search a law's parameters on training hands; judge the best on test hands.

    Conditions of one delay are tuned together and each delay for itself: a law is designed for its timing, and knows
    nothing of the wall.

    Parameters
    ----------
    law : str
        A name of `RANGES`, or any law with `ranges`.
    conditions : sequence of str or Condition
        As `study` takes them.
    training, test : Operators, optional
        Hands of the search, default 24 random ones; and those of the result, default the grid of 60.
    ranges : mapping of str to (low, high), optional
        Parameters to search, in SI units, within what the law allows; (0, 1) for a switch.
    base : Scenario, optional
        What conditions change; default: the reference scenario.
    evaluations : int
        Points to try for each delay, at least 2; each runs every training hand under every condition of the delay.
    seed : int
        Gives each hand its noise and jitter.
    threads : int, optional
        Default: one per core.
    progress : callable, optional
        Called with (points done, points in all).

    Returns
    -------
    list of Tuned
        One for each delay, in the order of the conditions.

    Raises
    ------
    TuningInterrupted
        On a keyboard interrupt; carries the best so far, judged on the test hands.
    ValueError
        For a law without ranges, a parameter it does not have, or a number out of range.
    """
    if law not in LAWS:
        raise unknown_name("law", law, LAWS)
    if evaluations < 2:
        raise ValueError(f"evaluations = {evaluations}: must be at least 2")
    searched = dict(RANGES.get(law, {}) if ranges is None else ranges)
    _check(law, searched)
    hands = Operators.sample(HANDS, HANDS_SEED) if training is None else training
    others = Operators.grid() if test is None else test
    start = base or Scenario()
    groups: dict[int, list[Condition]] = {}
    for one in find(conditions):
        delay = one.believed(one.scenarios(hands[:1], start)[0])[1].delay
        groups.setdefault(delay, []).append(one)
    done: list[Tuned] = []
    total = len(groups) * evaluations
    for i, (delay, chosen) in enumerate(groups.items()):
        search = _Search(law, searched, chosen, hands, start, seed, threads)
        search.report = lambda n, i=i: progress and progress(min(i * evaluations + n, total), total)
        stopped = False
        try:
            search.run(evaluations)
        except KeyboardInterrupt:
            stopped = True
        if search.tried:
            done.append(_judged(search, delay, others, start, seed, threads))
        if stopped:
            raise TuningInterrupted(done)
    return done


def _check(law: str, ranges: Mapping[str, Range]) -> None:
    if not ranges:
        names = ", ".join(RANGES)
        raise ValueError(f"law {law!r}: nothing to tune; give ranges, or one of {names}")
    fields = {f.name: f for f in LAWS[law].fields()}
    for name, (low, high) in ranges.items():
        if name not in fields:
            raise unknown_name(f"parameter of {law}", name, fields)
        field = fields[name]
        if not field.low <= low < high <= field.high:
            raise ValueError(
                f"{name} from {low:g} to {high:g} {field.unit}: must lie in [{field.low:g}, {field.high:g}]"
            )


def _judged(
    search: _Search, delay: int, hands: Operators, base: Scenario, seed: int, threads: int | None
) -> Tuned:
    changes, cost = min(search.tried, key=lambda tried: tried[1])
    laws: dict[str, AnyLaw] = {"default": search.law, "tuned": Variant(search.law, changes)}
    found = study(hands, laws, search.conditions, base=base, seed=seed, threads=threads)
    return Tuned(
        law=search.law,
        delay=delay,
        changes=changes,
        tried=len(search.tried),
        cost=cost,
        default_cost=search.tried[0][1],
        test=_rows(found, "tuned"),
        default=_rows(found, "default"),
    )


def _rows(found: Study, law: str) -> tuple[TunedRow, ...]:
    rows = []
    for row in (row for row in found.rows if row.law == law):
        runs = found.runs(law, row.condition)
        swings = found.columns["force_swing_N"][runs][found.columns["good"][runs]]
        rows.append(
            TunedRow(
                condition=row.condition,
                hands=row.hands,
                good=row.good or 0,
                median_settled_s=row.median_settled_s,
                least_energy_J=row.least_energy_J,
                most_drawn_J=row.most_drawn_J,
                ripple_N=float(swings.max()) if len(swings) else None,
            )
        )
    return tuple(rows)


class _Search:
    """One law under conditions of one delay; keeps every point that was tried, the default first."""

    def __init__(
        self,
        law: str,
        ranges: Mapping[str, Range],
        conditions: Sequence[Condition],
        hands: Operators,
        base: Scenario,
        seed: int,
        threads: int | None,
    ) -> None:
        self.law, self.ranges, self.conditions, self.threads = law, ranges, conditions, threads
        self.switches = {f.name for f in LAWS[law].fields() if f.kind == "bool"}
        parts = [(c, c.scenarios(hands, base)) for c in conditions]
        self.scenarios = [
            s.replace(seed=seed_of(seed, i)) for _, p in parts for i, s in enumerate(p)
        ]
        self.known = [c.believed(s) for c, part in parts for s in part]
        self.tried: list[tuple[dict[str, float | bool], float]] = []
        self.report: Any = None

    def run(self, evaluations: int) -> None:
        """Try the default, look over the whole range, then refine the best."""
        import nlopt

        self.measure({})
        looks = max(1, round(LOOKS * (evaluations - 1)))
        middle = np.full(len(self.ranges), 0.5)
        self._search(nlopt.GN_DIRECT_L, looks, middle)
        left = evaluations - len(self.tried)
        if left > 0:
            best = min(self.tried[1:], key=lambda tried: tried[1])[0]
            self._search(nlopt.LN_SBPLX, left, self._place(best))

    def measure(self, changes: dict[str, float | bool]) -> float:
        """Simulate the training hands with some parameters changed; keep the point."""
        law = Variant(self.law, changes)
        runs = sweep(self.scenarios, law, designed_for=self.known, threads=self.threads)
        cost = cost_of(runs)
        self.tried.append((changes, cost))
        self.report(len(self.tried))
        return cost

    def _search(self, algorithm: int, evaluations: int, start: Values) -> None:
        import nlopt

        optimiser = nlopt.opt(algorithm, len(self.ranges))
        carried = Carried(optimiser)
        most = len(self.tried) + evaluations  # NLopt's own limit is not sharp

        def cost(point: Values) -> float:
            if len(self.tried) >= most:
                optimiser.force_stop()
                return math.inf
            return self.measure(self._changes(point))

        optimiser.set_min_objective(carried(cost, instead=math.inf))
        optimiser.set_lower_bounds(np.zeros(len(self.ranges)))
        optimiser.set_upper_bounds(np.ones(len(self.ranges)))
        optimiser.set_maxeval(evaluations)
        optimiser.set_xtol_abs(2e-3)
        if algorithm == nlopt.LN_SBPLX:
            optimiser.set_initial_step(0.1)
        optimiser.optimize(start)
        carried.settle()

    def _changes(self, point: Values) -> dict[str, float | bool]:
        """Return the parameters at a point of the unit cube; a wide range that begins above 0 is logarithmic."""
        found: dict[str, float | bool] = {}
        for share, (name, (low, high)) in zip(point.tolist(), self.ranges.items(), strict=True):
            if name in self.switches:
                found[name] = share > 0.5
            else:
                value = (
                    low * (high / low) ** share if _wide(low, high) else low + (high - low) * share
                )
                found[name] = float(f"{value:.4g}")
        return found

    def _place(self, changes: Mapping[str, float | bool]) -> Values:
        shares = []
        for name, (low, high) in self.ranges.items():
            value = float(changes[name])
            if name in self.switches:
                shares.append(0.25 + 0.5 * value)
            elif _wide(low, high):
                shares.append(math.log(value / low) / math.log(high / low))
            else:
                shares.append((value - low) / (high - low))
        return np.asarray(np.clip(np.array(shares), 0, 1))


def _wide(low: float, high: float) -> bool:
    return low > 0 and high >= 10 * low
