"""Laws under random hands in random worlds of several bodies: held back by the guard, energy drawn, faults."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import require, whole
from ebac._util.cores import usable_cores
from ebac.laws import AnyLaw, CoreLaw, PythonLaw, design
from ebac.scenario import Scenario
from ebac.metrics.energy_drawn import drawn
from ebac.studies.hand_search import every_row
from ebac.studies.random_scenario import DEVICES, find_device, random_scenario
from ebac.studies.sweeps.job import Progress
from ebac.studies.sweeps.run import Laws, name_laws
from ebac.studies.world_kinds import KINDS, find_kind
from ebac.trace import Trace

#: Stiffnesses of the surfaces [N/m] and delays [samples] unless others are given.
STIFFNESSES, DELAYS = (10e3,), (1,)
#: A hand that the guard holds back for longer than this is counted [s].
HELD_BACK = 0.1
#: Most hands of a row.
MOST_HANDS = 100_000


@dataclass(frozen=True, kw_only=True)
class RandomWorldRow:
    """The hands of one law in worlds of one kind, with one device, stiffness and delay.

    Attributes
    ----------
    kind, device, law : str
        Names.
    stiffness_N_per_m : float
        Of every surface.
    delay_samples : int
        Until a command acts.
    hands : int
        How many ran.
    held_back : int or None
        Hands for which the guard let less than half of the command through for longer than 0.1 s; None for a law
        without a guard.
    longest_held_back_s : float or None
        The longest such time of all hands.
    most_drawn_J : float
        Most energy that a hand drew out of the port beyond all that it had put in and what moving surfaces did:
        `drawn`.
    reserve_J : float or None
        What the law lends at the start of a run; None for a law that lends nothing.
    beyond_reserve : int or None
        Hands that drew more than that; None for a law that lends nothing.
    faults : int
        Hands whose run ended by a fault.
    worst_hand : int
        Index of a hand to look at: one with a fault, else the one that was held back longest if that is longer than
        0.1 s, else the one that drew most.
    """

    kind: str
    device: str
    stiffness_N_per_m: float
    delay_samples: int
    law: str
    hands: int
    held_back: int | None
    longest_held_back_s: float | None
    most_drawn_J: float
    reserve_J: float | None
    beyond_reserve: int | None
    faults: int
    worst_hand: int


@dataclass(frozen=True, kw_only=True, repr=False)
class RandomWorlds:
    """What `random_worlds` found.

    Attributes
    ----------
    rows : tuple of RandomWorldRow
        For each kind, device, stiffness and delay: each law.
    moving : bool
        Whether each body swung in a direction of its own.
    noise_N : float
        Noise of the force sensor, standard deviation.
    seed : int
        Of all hands.
    laws : dict of str to law
        By the names in the rows.
    drawn_J, held_back_s : tuple of array, each of shape (hands,)
        Energy that each hand of a row drew, and the longest time for which it was held back, in the order of `rows`;
        the time is NaN for a law without a guard.
    """

    rows: tuple[RandomWorldRow, ...]
    moving: bool
    noise_N: float
    seed: int
    laws: dict[str, AnyLaw]
    drawn_J: tuple[NDArray[np.float64], ...] = field(compare=False)
    held_back_s: tuple[NDArray[np.float64], ...] = field(compare=False)

    def table(self) -> list[dict[str, Any]]:
        """Return the rows as dictionaries, units in the keys."""
        return [asdict(row) for row in self.rows]

    def totals(self) -> list[RandomWorldRow]:
        """Return all rows of a law as one, for each law; kind, device, stiffness and delay are those of its worst.

        A hand counts once for each stiffness and delay that it met.
        """
        return [
            _together([row for row in self.rows if row.law == law])
            for law in dict.fromkeys(row.law for row in self.rows)
        ]

    def worst(self) -> list[RandomWorldRow]:
        """Return the row with the worst hand, for each law and kind."""
        groups: dict[tuple[str, str], list[RandomWorldRow]] = {}
        for row in self.rows:
            groups.setdefault((row.law, row.kind), []).append(row)
        return [max(rows, key=_rank) for rows in groups.values()]

    def scenario(self, row: RandomWorldRow, hand: int | None = None) -> Scenario:
        """Return the scenario of a hand.

        Parameters
        ----------
        row : RandomWorldRow
            One of `rows`.
        hand : int, optional
            Its index, at least 0; default: the worst of the row.
        """
        return random_scenario(
            row.kind,
            row.device,
            row.worst_hand if hand is None else hand,
            stiffness=row.stiffness_N_per_m,
            delay=row.delay_samples,
            moving=self.moving,
            noise=self.noise_N,
            seed=self.seed,
        )

    def trace(self, row: RandomWorldRow, hand: int | None = None) -> Trace:
        """Simulate a hand of a row again, by default its worst, with every row up to a fault."""
        scenario = self.scenario(row, hand)
        return every_row(
            scenario, design(self.laws[row.law], scenario.device, scenario.known_timing)
        )

    def __repr__(self) -> str:
        """Return the rows with their units."""
        from ebac._util.report import plural, report

        shown = (
            "kind", "device", "stiffness_N_per_m", "delay_samples", "law", "held_back",
            "longest_held_back_s", "most_drawn_J",
        )  # fmt: skip
        bodies = "moving" if self.moving else "still"
        return report(
            f"{plural(self.rows[0].hands, 'random hand')} a row in worlds of {bodies} bodies, simulated",
            [{key: row[key] for key in shown} for row in self.table()],
        )


def random_worlds(
    laws: Laws = ("ebac",),
    *,
    kinds: Sequence[str] = tuple(KINDS),
    devices: Sequence[str] = tuple(DEVICES),
    stiffnesses: Sequence[float] = STIFFNESSES,
    delays: Sequence[int] = DELAYS,
    moving: bool = False,
    hands: int = 200,
    noise: float = 0.03,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress | None = None,
) -> RandomWorlds:
    """Simulate each law with random hands, each in a random world of several bodies of its own, for 4 s.

    Hand and world come from seed, kind, device and the index of the hand alone: all laws, stiffnesses and delays meet
    the same, and more hands begin with those of fewer. `random_scenario` has their ranges.

    Parameters
    ----------
    laws : law, sequence of laws, or mapping of names to laws
        As `sweep` takes them.
    kinds : sequence of str
        Of worlds: planes, balls, ball-and-plane, three-planes, cavity.
    devices : sequence of str
        The reference device with 2-axes or 3-axes, or on a gimbal.
    stiffnesses : sequence of float
        Of every surface [N/m], [0, 1e7].
    delays : sequence of int
        Until a command acts [samples], [0, 8].
    moving : bool
        Whether each body swings, by up to 4 mm at 0.5 to 3 Hz in a direction of its own.
    hands : int
        For each row, [1, 100000].
    noise : float
        Of the force sensor, standard deviation [N], [0, 100].
    seed : int
        Of all hands, [0, 2^31).
    threads : int, optional
        Threads, [1, 1024]; default: one per core. The result does not depend on it. Laws in Python have one.
    progress : callable, optional
        Called with runs done and all.

    Returns
    -------
    RandomWorlds

    Raises
    ------
    ValueError
        For an unknown kind or device, a number out of its range, or nothing to simulate.
    TypeError
        For a number that is not whole where it must be, or a `moving` that is neither True nor False.
    KeyError
        For an unknown law.
    """
    require(moving, bool, "ebac.random_worlds", "moving=True or False")
    _check(kinds=kinds, devices=devices, stiffnesses=stiffnesses, delays=delays)
    _check_whole(hands=(hands, 1, MOST_HANDS), seed=(seed, 0, 2**31 - 1))
    workers = usable_cores() if threads is None else threads
    _check_whole(threads=(workers, 1, 1024))
    named = name_laws(laws)
    cells = list(product(kinds, devices, stiffnesses, delays))
    makers = [_maker(cell, moving=moving, noise=noise, seed=seed) for cell in cells]
    firsts = [make(0) for make in makers]  # refuse what cannot be, before any work
    made = [
        {name: design(law, first.device, first.known_timing) for name, law in named.items()}
        for first in firsts
    ]
    rows: list[RandomWorldRow] = []
    hand_by_hand: list[list[_Run]] = []
    total = len(cells) * len(named) * hands
    with _threads(workers) as executor:
        for cell, make, ready in zip(cells, makers, made, strict=True):
            for name, law in ready.items():
                measured = partial(_measured, make, law)
                spread = executor.map if isinstance(law, CoreLaw) else map
                runs: list[_Run] = []
                for run in spread(measured, range(hands)):
                    runs.append(run)
                    if progress is not None:
                        progress(len(rows) * hands + len(runs), total)
                rows.append(_row(cell, name, law, runs))
                hand_by_hand.append(runs)
    return RandomWorlds(
        rows=tuple(rows),
        moving=moving,
        noise_N=noise,
        seed=seed,
        laws=named,
        drawn_J=tuple(np.array([run.drawn_J for run in runs]) for runs in hand_by_hand),
        held_back_s=tuple(
            np.array([run.held_back_s for run in runs], float) for runs in hand_by_hand
        ),
    )


class _Run(NamedTuple):
    """What came of one hand."""

    held_back_s: float | None
    drawn_J: float
    fault: bool

    @property
    def rank(self) -> tuple[bool, float, float]:
        """Larger for a hand that is more worth to look at."""
        held = self.held_back_s or 0.0
        return self.fault, held if held > HELD_BACK else 0.0, self.drawn_J


_Cell = tuple[str, str, float, int]


def _maker(cell: _Cell, **how: Any) -> Callable[[int], Scenario]:
    """Return what makes the scenario of a hand from its index."""
    kind, device, stiffness, delay = cell
    return partial(_indexed, kind, device, how | {"stiffness": stiffness, "delay": delay})


def _indexed(kind: str, device: str, how: dict[str, Any], index: int) -> Scenario:
    return random_scenario(kind, device, index, **how)


def _measured(make: Callable[[int], Scenario], law: CoreLaw | PythonLaw, index: int) -> _Run:
    trace = every_row(make(index), law)
    held = float(trace["law.starved"].max()) if "law.starved" in trace else None
    return _Run(held, drawn(trace), bool(trace["fault"].any()))


def _row(cell: _Cell, name: str, law: CoreLaw | PythonLaw, runs: list[_Run]) -> RandomWorldRow:
    kind, device, stiffness, delay = cell
    held = [run.held_back_s for run in runs if run.held_back_s is not None]
    reserve = getattr(law, "observed_reserve", None)
    return RandomWorldRow(
        kind=kind,
        device=device,
        stiffness_N_per_m=stiffness,
        delay_samples=delay,
        law=name,
        hands=len(runs),
        held_back=sum(time > HELD_BACK for time in held) if held else None,
        longest_held_back_s=max(held, default=None),
        most_drawn_J=max(run.drawn_J for run in runs),
        reserve_J=reserve,
        beyond_reserve=None if reserve is None else sum(run.drawn_J > reserve for run in runs),
        faults=sum(run.fault for run in runs),
        worst_hand=max(range(len(runs)), key=lambda i: runs[i].rank),
    )


def _together(rows: list[RandomWorldRow]) -> RandomWorldRow:
    """Return the rows of a law as one, named after its worst."""
    worst = max(rows, key=_rank)
    guarded, lends = worst.held_back is not None, worst.beyond_reserve is not None
    return replace(
        worst,
        hands=sum(row.hands for row in rows),
        held_back=sum(row.held_back or 0 for row in rows) if guarded else None,
        longest_held_back_s=max(row.longest_held_back_s or 0.0 for row in rows) if guarded else None,
        most_drawn_J=max(row.most_drawn_J for row in rows),
        beyond_reserve=sum(row.beyond_reserve or 0 for row in rows) if lends else None,
        faults=sum(row.faults for row in rows),
    )  # fmt: skip


def _rank(row: RandomWorldRow) -> tuple[bool, float, float]:
    return _Run(row.longest_held_back_s, row.most_drawn_J, row.faults > 0).rank


@contextmanager
def _threads(count: int) -> Iterator[ThreadPoolExecutor]:
    """Give threads that drop what waits when the work is stopped."""
    executor = ThreadPoolExecutor(count, thread_name_prefix="ebac random worlds")
    try:
        yield executor
    finally:
        executor.shutdown(cancel_futures=True)


def _check(**given: Sequence[Any]) -> None:
    for name, values in given.items():
        if isinstance(values, str) or not len(values):
            raise ValueError(f"{name} = {values!r}: must be a sequence of one at least")
    for kind in given["kinds"]:
        find_kind(kind)
    for device in given["devices"]:
        find_device(device)


def _check_whole(**numbers: tuple[Any, int, int]) -> None:
    for name, (value, low, high) in numbers.items():
        if not low <= whole(name, value) <= high:
            raise ValueError(f"{name} = {value}: must lie in [{low}, {high}]")
