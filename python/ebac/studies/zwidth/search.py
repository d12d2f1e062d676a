"""The border of stability of a law, searched in the simulation: a ladder of stiffness, then bisection."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import LinearLoop, Recorded, Timing, Wall
from ebac._util.arguments import number, require, whole
from ebac._util.arrays import Values
from ebac._util.sequences import several, several_numbers
from ebac._util.wrong_calls import plain_function
from ebac.laws import LAWS, AnyLaw
from ebac.metrics import EXACT_COUNTS, ideal_rest
from ebac.metrics.unjudged import no_ideal_rest
from ebac.scenario import Scenario
from ebac.studies.families import PULL, families
from ebac.studies.sweeps import SweepResult, sweep
from ebac.studies.sweeps.run import Laws, name_laws
from ebac.studies.zwidth.linear import stiffness_limit
from ebac.studies.zwidth.result import CRITERIA, SEEDS, STIFFNESSES, ZWidth

#: Wall dampings [N s/m]: up to ten times the reference device's own.
DAMPINGS = (0.0, 2.5, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0)
#: Way through free air [m] of the two contacts that must hold: a press from the surface, and a tap.
APPROACHES = (0.0, 0.02)
#: Bisections after the ladder; each halves the interval of log K.
ROUNDS = 4
#: At least this share of the stiffness asked for must be there at rest.
SHOWN_SHARE = 0.5
#: Most random hands of a family.
MOST_HANDS = 1000
#: Most walls of a ladder.
MOST_RUNGS = 10_000

Flags = NDArray[np.bool_]
Point = tuple[Timing, float]


@plain_function
def zwidth(
    laws: Laws | None = None,
    *,
    base: Scenario | None = None,
    delays: Sequence[int] = (0, 1, 2),
    dampings: Sequence[float] | Values = DAMPINGS,
    least_stiffness: float = 100.0,
    most_stiffness: float = 1e5,
    rungs: int = 31,
    epsilon: float = 1e-3,
    hands: int = 0,
    threads: int | None = None,
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> ZWidth:
    """Search for every law, delay and wall damping the largest stiffness up to which a criterion holds.

    A law must pass with a hand that presses from the surface and with one that taps through 20 mm of free air, at every
    rung of a ladder of stiffness, even in log K, from `least_stiffness` up; between the last rung that passes and the
    first that fails, bisection.

    Parameters
    ----------
    laws : law, sequence of laws, or mapping of names to laws
        As `sweep` takes them; default: every law of `LAWS`.
    base : Scenario, optional
        Device, hand and the rest; the position of its wall is the surface. Default: the reference scenario, 3 s.
    delays : sequence of int
        Samples of delay, [0, 8].
    dampings : array-like
        Wall damping B, rising [N s/m].
    least_stiffness, most_stiffness : float
        Ends of the ladder [N/m], up to 1e7.
    rungs : int
        Of the ladder, at least 2.
    epsilon : float
        Energy [J] that a hand may draw.
    hands : int
        Random hands of each family of `ebac worst`, [0, 1000], that may not draw more either: they tap, swing,
        shake, push at random, press and let go. The same seven times `hands` on every wall; one that pulls harder than
        20 N in its run is not counted, as are most position drives on a stiff wall; a run that a fault ends always is.
    threads, executor, progress
        As in `sweep`.

    Returns
    -------
    ZWidth

    Raises
    ------
    ValueError
        For a scenario without a wall straight across the first axis, or numbers out of range.
    """
    scenario = Scenario(seconds=3.0) if base is None else base
    require(scenario, Scenario, "ebac.zwidth", "a Scenario as its base")
    _check(scenario, dampings, least_stiffness, most_stiffness, rungs, epsilon, hands)
    search = _Search(scenario, epsilon, hands, {"threads": threads, "executor": executor})
    named = name_laws(list(LAWS.values()) if laws is None else laws)
    samples = several("zwidth: delays", delays)
    timings = [scenario.timing.replace(delay=delay) for delay in samples]
    points = [(timing, float(damping)) for timing in timings for damping in dampings]
    ladder = np.geomspace(least_stiffness, most_stiffness, rungs)
    shown = len(timings) * len(STIFFNESSES) * SEEDS * len(APPROACHES)
    total = len(named) * (len(points) * (rungs + ROUNDS * len(CRITERIA)) * search.runs + shown)
    search.report = _counter(progress, total)
    shape = (len(named), len(timings), len(dampings))
    borders = [search.border(law, points, ladder) for law in named.values()]
    return ZWidth(
        base=scenario, laws=tuple(named), delays=tuple(samples), dampings=np.asarray(dampings, float),
        least_stiffness=least_stiffness, most_stiffness=most_stiffness, epsilon=epsilon, hands=hands,
        limits={name: np.array([b[i] for b in borders]).reshape(shape) for i, name in enumerate(CRITERIA)},
        spectral=np.array([_spectral(scenario, *point) for point in points]).reshape(shape[1:]),
        vibration=np.array([search.vibration(law, timings) for law in named.values()]),
    )  # fmt: skip


def _further(path: Any, way: float) -> Any:
    """Return a target that comes to rest `way` further [m]."""
    if isinstance(path, Recorded):
        return path.replace(x=np.asarray(path.x) + way)
    return path.replace(target=path.target + way)


class _Search:
    def __init__(self, base: Scenario, epsilon: float, hands: int, how: dict[str, Any]) -> None:
        self.base = base
        self.epsilon = epsilon
        self.how = how
        self.explorers = [
            (family, family.values(point))
            for i, family in enumerate(families(PULL).values())
            for point in family.at_random(hands, np.random.default_rng([base.seed, i]))
        ]
        self.runs = len(APPROACHES) + len(self.explorers)  # for each wall
        first, *others = base.hand.path
        self.hands = {
            way: base.hand.replace(path=[_further(first, way), *others]) for way in APPROACHES
        }
        self.report: Callable[[int], None] = lambda runs: None

    def border(self, law: AnyLaw, points: list[Point], ladder: Values) -> Values:
        """Return the largest stiffness by criterion and point."""
        n, rungs = len(points), len(ladder)
        passed = self.passes(law, [(p, k) for p in points for k in ladder]).reshape(-1, n, rungs)
        first = np.where(passed.all(axis=2), rungs, (~passed).argmax(axis=2))
        low = np.log(ladder[np.maximum(first - 1, 0)])
        high = np.log(ladder[np.minimum(first, rungs - 1)])
        own = np.arange(len(CRITERIA))
        for _ in range(ROUNDS):
            middle = 0.5 * (low + high)
            tasks = [(p, k) for row in np.exp(middle) for p, k in zip(points, row, strict=True)]
            holds = self.passes(law, tasks).reshape(len(CRITERIA), len(CRITERIA), n)[own, own]
            low, high = np.where(holds, middle, low), np.where(holds, high, middle)
        inside = np.where(first == rungs, ladder[-1], np.exp(low))
        return np.where(first == 0, 0.0, inside)

    def passes(self, law: AnyLaw, tasks: list[tuple[Point, float]]) -> Flags:
        """Return whether each criterion holds for each wall, with every approach and every random hand."""
        runs = [self._scenario(p, k, way) for p, k in tasks for way in APPROACHES]
        result = sweep(runs, law, **self.how)
        self.report(len(runs))
        stiffness = np.repeat([k for _, k in tasks], len(APPROACHES))
        flags = _judge(result, self.base, self.epsilon, stiffness)
        shape = (len(CRITERIA), len(tasks), len(APPROACHES))
        held: Flags = np.asarray(flags.reshape(shape).all(axis=2))
        energy, usable = (list(CRITERIA).index(name) for name in ("energy", "usable"))
        held[[energy, usable]] &= self.drawn(law, tasks, held[energy]) <= self.epsilon
        return held

    def vibration(self, law: AnyLaw, timings: list[Timing]) -> Values:
        """Return the vibration by timing, stiffness and seed, the larger of both approaches [thresholds]."""
        wall = self.base.environment
        damping = wall.damping if isinstance(wall, Wall) else 0.0
        runs = [
            self._scenario((timing, damping), stiffness, way).replace(seed=self.base.seed + more)
            for timing in timings
            for stiffness in STIFFNESSES
            for more in range(SEEDS)
            for way in APPROACHES
        ]
        result = sweep(runs, law, **self.how)
        self.report(len(runs))
        vibrates = np.where(_whole(result), result["perceived"], np.nan)
        shape = (len(timings), len(STIFFNESSES), SEEDS, len(APPROACHES))
        return np.asarray(vibrates.reshape(shape).max(axis=3))

    def drawn(self, law: AnyLaw, tasks: list[tuple[Point, float]], asked: Flags) -> Values:
        """Return the most energy that a random hand draws, for each wall that is asked for; else 0 [J]."""
        walls = [self._scenario(p, k, 0.0) for (p, k), ask in zip(tasks, asked, strict=True) if ask]
        runs = [family.make(wall, values) for wall in walls for family, values in self.explorers]
        most = np.zeros(len(tasks))
        if runs:
            result = sweep(runs, law, **self.how)
            taken = np.maximum(-result["least_energy_J"], 0.0)
            taken[result["most_pull_N"] > PULL] = 0.0  # as a stiff position drive may: not counted
            taken[~_whole(result)] = np.inf
            most[asked] = taken.reshape(len(walls), -1).max(axis=1)
        self.report(len(tasks) * len(self.explorers))
        return most

    def _scenario(self, point: Point, stiffness: float, way: float) -> Scenario:
        timing, damping = point
        wall = Wall(stiffness=stiffness, damping=damping, position=_surface(self.base) + way)
        return self.base.replace(timing=timing, environment=wall, hand=self.hands[way])


def _judge(result: SweepResult, base: Scenario, epsilon: float, stiffness: Values) -> Flags:
    still, quiet = result["still"], result["quiet"]
    energy = _whole(result) & (result["least_energy_J"] >= -epsilon)
    surface = _surface(base) + np.resize(APPROACHES, len(result))
    depth, ideal = result["rest_m"] - surface, result["ideal_m"] - surface
    held = ideal * (base.hand.stiffness + stiffness) - base.hand.stiffness * depth  # N, at rest
    slack = EXACT_COUNTS * result["count_m"]
    shown = held >= SHOWN_SHARE * stiffness * (depth - slack)
    return np.array([still, quiet, energy, quiet & energy & shown])


def _whole(result: SweepResult) -> Flags:
    return np.asarray(result["done"] & ~result["diverged"] & (result["fault"] == 0))


def _surface(base: Scenario) -> float:
    return base.environment.position if isinstance(base.environment, Wall) else 0.0


def _spectral(base: Scenario, timing: Timing, damping: float) -> float:
    if not LinearLoop.covers(base.device):
        return float("nan")  # null in JSON: the criterion does not exist for this device
    return stiffness_limit(base.replace(timing=timing), damping)


def _counter(progress: Callable[[int, int], None] | None, total: int) -> Callable[[int], None]:
    done = 0

    def count(runs: int) -> None:
        nonlocal done
        done += runs
        if progress is not None:
            progress(done, total)

    return count


def _check(
    base: Scenario,
    dampings: Any,
    least: float,
    most: float,
    rungs: int,
    epsilon: float,
    hands: int,
) -> None:
    if not isinstance(base.environment, Wall) or ideal_rest(base) is None:
        raise ValueError(
            f"zwidth: needs a scenario with an ideal rest; here {no_ideal_rest(base) or 'there is no wall'}: give a "
            "wall straight across the first axis, and a hand with a target that does not let go"
        )
    rising = several_numbers("zwidth: dampings", dampings)
    if len(rising) < 2 or rising[0] < 0 or not (np.diff(rising) > 0).all():
        raise ValueError(
            f"zwidth: dampings = {dampings} N s/m: must be at least two, rising, from 0 up"
        )
    if not 0 < least < most <= 1e7:
        raise ValueError(
            f"zwidth: least_stiffness = {least} N/m, most_stiffness = {most} N/m: must be "
            "0 < least_stiffness < most_stiffness <= 1e7 N/m"
        )
    if not 2 <= whole("zwidth: rungs", rungs) <= MOST_RUNGS:
        raise ValueError(f"zwidth: rungs = {rungs}: must lie in [2, {MOST_RUNGS}]")
    if not number("zwidth: epsilon", epsilon) >= 0:
        raise ValueError(f"zwidth: epsilon = {epsilon} J: must be at least 0")
    if not 0 <= whole("zwidth: hands", hands) <= MOST_HANDS:
        raise ValueError(f"zwidth: hands = {hands}: must lie in [0, {MOST_HANDS}]")
