"""Many simulated physicians, with and without force feedback: what feedback changes, with its uncertainty."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from statistics import NormalDist
from types import NoneType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._core import Device, Hand, Linear, Master
from ebac._util.arguments import number, require, whole
from ebac._util.background import cancellable
from ebac._util.cores import thread_count
from ebac._util.sequences import each_once, several
from ebac.gastroscope.procedure import Procedure, core_law
from ebac.laws import AnyLaw
from ebac.laws.tuned_laws import on_its_observer

#: Difference of forces for which the power is stated [N].
MATTERS = 1.0
RESAMPLES = 4000
#: The joystick's masses and damping on three straight axes.
STRAIGHT = Device(kinematics=Linear(axes=3))


@dataclass(frozen=True, kw_only=True)
class StudyRow:
    """A law at a delay, with or without feedback, over all physicians: medians unless it says otherwise."""

    law: str
    delay_s: float
    feedback: bool
    physicians: int
    reached_share: float
    touched_mean: float
    seconds_s: float
    path_m: float
    most_force_N: float
    most_force_90_N: float
    impulse_N_s: float
    over_limit_share: float
    perforated_share: float
    least_energy_J: float
    hand_work_J: float


@dataclass(frozen=True, kw_only=True)
class Effect:
    """Largest tissue force with feedback less that without, the same physician in pairs.

    Attributes
    ----------
    law : str
    delay_s : float
    difference_N : float
        Mean over the pairs; negative: less force with feedback.
    low_N, high_N : float
        95 % confidence interval by bootstrap over physicians.
    power : float
        Probability to find a difference of 1 N at the 5 % level with this many pairs of this scatter.
    detectable_N : float
        Difference that would be found with 80 % probability.
    """

    law: str
    delay_s: float
    difference_N: float
    low_N: float
    high_N: float
    power: float
    detectable_N: float


@dataclass(frozen=True, kw_only=True)
class GastroscopyStudy:
    """What `gastroscopy_study` found.

    Attributes
    ----------
    rows : tuple of StudyRow
        Each law at each delay without and with feedback.
    effects : tuple of Effect
        Of feedback on the largest tissue force.
    runs : dict
        Findings of each run, arrays of shape (physicians,), by (law, delay, feedback) and name.
    force_limit_N : float
        Force on the tissue that no physician should exceed [N].
    """

    rows: tuple[StudyRow, ...]
    effects: tuple[Effect, ...]
    runs: dict[tuple[str, float, bool], dict[str, NDArray[np.float64]]]
    force_limit_N: float

    def table(self) -> list[dict[str, Any]]:
        """Return the rows as dictionaries, units in the keys."""
        return [asdict(row) for row in self.rows]

    def effect_table(self) -> list[dict[str, Any]]:
        """Return the effects as dictionaries, units in the keys."""
        return [asdict(row) for row in self.effects]


def physicians(count: int, seed: int, base: Procedure) -> list[Procedure]:
    """Return procedures that differ in physician and hand: log-normal about those of `base`, assumed.

    Reaction, speeds and the hand's impedance scatter by 25 %, the noise of bearings by 40 %.
    """
    random = np.random.default_rng(seed)

    def scattered(value: float, share: float, low: float, high: float) -> float:
        return float(np.clip(value * np.exp(share * random.standard_normal()), low, high))

    made = []
    for _ in range(count):
        p, h = base.physician, base.hand
        physician = p.replace(
            reaction=scattered(p.reaction, 0.25, 0.05, 1.0),
            crossover=scattered(p.crossover, 0.2, 0.05, 0.6),
            noise=scattered(p.noise, 0.4, 0.0, 0.3),
            advance=scattered(p.advance, 0.25, 5e-3, 0.1),
            approach=scattered(p.approach, 0.25, 2e-3, 0.05),
        )
        hand: Hand = h.replace(
            stiffness=scattered(h.stiffness, 0.25, 50, 2000),
            damping=scattered(h.damping, 0.25, 1, 50),
            mass=scattered(h.mass, 0.25, 0.02, 2),
        )
        made.append(replace(base, physician=physician, hand=hand, seed=int(random.integers(2**31))))
    return made


def gastroscopy_study(
    laws: Sequence[AnyLaw] | Mapping[str, AnyLaw] = ("direct", "ebac"),
    *,
    delays: Sequence[float] = (0.0, 0.05, 0.1),
    count: int = 100,
    seed: int = 1,
    procedure: Procedure | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> GastroscopyStudy:
    """Compare gastroscopies with and without force feedback over simulated physicians.

    Parameters
    ----------
    laws : sequence of laws, or mapping of names to laws
        Of the joystick; two of one kind by names of their own.
    delays : sequence of float
        Of the line each way [s], [0, 2], each once.
    count : int
        Physicians, [2, 10000].
    seed : int
        Of the population.
    procedure : Procedure, optional
        What they have in common; default: `Procedure()` with a joystick of three straight axes, which is simulated
        many times as fast as the gimbal.
    threads : int, optional
        Threads, [1, 1024]; default: one per usable core.
    progress : callable, optional
        Called with runs done and all.

    Raises
    ------
    ValueError
        For a number out of its range, nothing to compare, two laws of one name, a delay that stands there twice.
    TypeError
        For what is no sequence or no number.
    """
    from ebac.studies.sweeps.run import name_laws

    named = name_laws(laws if isinstance(laws, Mapping) else several("laws", laws), what="a study")
    delays = each_once("delays", [number("delays", one) for one in several("delays", delays)], "s")
    if not 2 <= whole("count", count) <= 10000:
        raise ValueError(f"count = {count}: must lie in [2, 10000] physicians")
    if whole("seed", seed) < 0:
        raise ValueError(f"seed = {seed}: must be at least 0")
    wanted = (Procedure, NoneType)
    require(procedure, wanted, "ebac.gastroscope.gastroscopy_study", "a Procedure")
    cores = thread_count(threads)
    base = Procedure(device=STRAIGHT) if procedure is None else procedure
    cells = [
        (name, law, delay, feedback)
        for name, law in named.items()
        for delay in delays
        for feedback in (False, True)
    ]
    people = physicians(count, seed, base)
    gain = base.master.feedback if base.master.feedback > 0 else 1.0
    todo: list[tuple[_core._Procedure, _core.Setup, Any]] = []
    for _, law, delay, feedback in cells:
        master: Master = base.master.replace(delay=delay, feedback=gain if feedback else 0.0)
        for person in people:
            own = replace(person, master=master)
            scenario = on_its_observer(own.scenario(), law)
            todo.append((own.core(), scenario.setup(), core_law(law, scenario)))
    columns = _run(todo, cores, progress)
    runs = {
        (name, delay, feedback): {
            key: values[i * count : (i + 1) * count] for key, values in columns.items()
        }
        for i, (name, _, delay, feedback) in enumerate(cells)
    }
    limit = base.lumen.patient.force_limit
    effects = [
        _effect(name, delay, runs[name, delay, False], runs[name, delay, True], seed)
        for name in named
        for delay in delays
    ]
    rows = [_row(key, found, limit) for key, found in runs.items()]
    return GastroscopyStudy(
        rows=tuple(rows), effects=tuple(effects), runs=runs, force_limit_N=limit
    )


def _run(
    todo: list[tuple[Any, Any, Any]],
    threads: int,
    progress: Callable[[int, int], None] | None,
) -> dict[str, NDArray[np.float64]]:
    procedures, setups, laws = zip(*todo, strict=True)
    columns = cancellable(
        lambda state: _core._run_procedures(procedures, setups, laws, threads, state),
        None if progress is None else lambda done: progress(done, len(todo)),
    )
    return {str(name): np.asarray(values) for name, values in columns.items()}


def _row(
    key: tuple[str, float, bool], found: dict[str, NDArray[np.float64]], limit: float
) -> StudyRow:
    force = found["most_section"]
    return StudyRow(
        law=key[0],
        delay_s=key[1],
        feedback=key[2],
        physicians=len(force),
        reached_share=float(found["reached"].mean()),
        touched_mean=float(found["touched"].mean()),
        seconds_s=float(np.median(found["seconds"])),
        path_m=float(np.median(found["path"])),
        most_force_N=float(np.median(force)),
        most_force_90_N=float(np.quantile(force, 0.9)),
        impulse_N_s=float(np.median(found["impulse"])),
        over_limit_share=float((force > limit).mean()),
        perforated_share=float((found["perforations"] > 0).mean()),
        least_energy_J=float(found["least_energy"].min()),
        hand_work_J=float(np.median(found["hand_work"])),
    )


def _effect(
    law: str,
    delay: float,
    without: dict[str, NDArray[np.float64]],
    with_: dict[str, NDArray[np.float64]],
    seed: int,
) -> Effect:
    difference = with_["most_section"] - without["most_section"]
    n = len(difference)
    random = np.random.default_rng(seed)
    means = difference[random.integers(n, size=(RESAMPLES, n))].mean(axis=1)
    low, high = np.quantile(means, [0.025, 0.975])
    error = float(difference.std(ddof=1)) / np.sqrt(n)
    normal = NormalDist()
    power = normal.cdf(MATTERS / error - normal.inv_cdf(0.975)) if error > 0 else 1.0
    return Effect(
        law=law,
        delay_s=delay,
        difference_N=float(difference.mean()),
        low_N=float(low),
        high_N=float(high),
        power=float(power),
        detectable_N=float(error * (normal.inv_cdf(0.975) + normal.inv_cdf(0.8))),
    )
