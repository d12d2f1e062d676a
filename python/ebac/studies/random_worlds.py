"""Laws under random hands in random worlds of several bodies: held back by the guard, energy drawn, faults."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from ebac._util.arguments import named, require, whole
from ebac._util.cores import thread_count
from ebac._util.progress import Progress
from ebac._util.sequences import several
from ebac._util.wrong_calls import plain_function
from ebac.laws import AnyLaw, CoreLaw, PythonLaw, design
from ebac.laws.making import reserve_of
from ebac.laws.protocols import is_core_law
from ebac.laws.tuned_laws import on_its_observer
from ebac.metrics.energy_drawn import drawn
from ebac.scenario import Scenario
from ebac.studies.hand_search import every_row
from ebac.studies.random_scenario import DEVICES, LAG, random_scenario
from ebac.studies.random_worlds_result import HELD_BACK, HandRun, RandomWorldRow, RandomWorlds
from ebac.studies.sweeps.run import Laws, name_laws
from ebac.studies.world_kinds import KINDS
from ebac.trace import Trace

#: Stiffnesses of the surfaces [N/m] and delays [samples] unless others are given.
STIFFNESSES, DELAYS = (10e3,), (1,)
#: Most hands of a row.
MOST_HANDS = 100_000


@plain_function
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
    lag: float = LAG,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress | None = None,
) -> RandomWorlds:
    """Simulate each law with random hands, each in a random world of several bodies of its own, for 4 s.

    Hand and world come from seed, kind, device and the index of the hand alone: all laws, stiffnesses and delays meet
    the same, and more hands begin with those of fewer. Each number is drawn evenly from its range, mass and stiffness
    of a hand evenly in their logarithm:

    * a hand: 0.02 to 1 kg, 2 to 20 N s/m, 100 to 1000 N/m; each axis of its target swings by 1 to 15 mm at 0.3 to 3 Hz
      about -10 to 20 mm;
    * a plane, of the kinds `planes`, `ball-and-plane` and `three-planes`: its surface 2 to 8 mm from where the handle
      begins; the first two directions, of planes or balls, 5 to 175 degrees apart;
    * a ball: of the kind `balls` two of one radius, 5 to 30 mm, their surfaces 2 to 6 mm away; of `ball-and-plane`
      one of 3 to 20 mm, 2 to 8 mm away;
    * a `cavity` of 8 to 20 mm about the handle, in it a cylinder of 2 to 6 mm radius, its axis at 0.4 to 0.8 times the
      radius of the cavity, its surface at least 1 mm away;
    * friction: 0.4 in one world of three, else 0;
    * with `moving`: each body swings by up to 4 mm at 0.5 to 3 Hz.

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
        Whether each body swings in a direction of its own.
    hands : int
        For each row, [1, 100000].
    noise : float
        Of the force sensor, standard deviation [N], [0, 10].
    lag : float
        Time constant of its filter [s], [0, 0.1].
    seed : int
        Of all hands, [0, 2^31).
    threads : int, optional
        Threads, [1, 1024]; default: one per usable core. The result does not depend on it. Laws in Python have one.
    progress : callable, optional
        Called with runs done and all.

    Returns
    -------
    RandomWorlds

    Raises
    ------
    ValueError
        For a number out of its range, or nothing to simulate.
    TypeError
        For a number that is not whole where it must be, or a `moving` that is neither True nor False.
    KeyError
        For an unknown law, kind or device.
    LoopFault
        When a law in Python raised an error, which is its cause.
    """
    require(moving, bool, "ebac.random_worlds", "moving=True or False")
    kinds, devices, stiffnesses, delays = (
        list(dict.fromkeys(several(name, values)))  # each once
        for name, values in (
            ("kinds", kinds),
            ("devices", devices),
            ("stiffnesses", stiffnesses),
            ("delays", delays),
        )
    )
    for kind in kinds:
        named("kind of world", kind, KINDS)
    for device in devices:
        named("device for random worlds", device, DEVICES)
    _check_whole(hands=(hands, 1, MOST_HANDS), seed=(seed, 0, 2**31 - 1))
    workers = thread_count(threads)
    chosen = name_laws(laws)
    cells = list(product(kinds, devices, stiffnesses, delays))
    makers = [_maker(cell, moving=moving, noise=noise, lag=lag, seed=seed) for cell in cells]
    firsts = [make(0) for make in makers]  # refuse what cannot be, before any work
    made = [
        {name: design(law, first.device, first.known_timing) for name, law in chosen.items()}
        for first in firsts
    ]
    rows: list[RandomWorldRow] = []
    hand_by_hand: list[list[HandRun]] = []
    total = len(cells) * len(chosen) * hands
    with _threads(workers) as executor:
        for cell, make, first, ready in zip(cells, makers, firsts, made, strict=True):
            for name, law in ready.items():
                measured = partial(_measured, make, law, chosen[name])
                spread = executor.map if is_core_law(law) else map
                runs: list[HandRun] = []
                for run in spread(measured, range(hands)):
                    runs.append(run)
                    if progress is not None:
                        progress(len(rows) * hands + len(runs), total)
                rows.append(_row(cell, name, reserve_of(law, first), runs))
                hand_by_hand.append(runs)
    return RandomWorlds(
        rows=tuple(rows),
        moving=moving,
        noise_N=noise,
        lag_s=lag,
        seed=seed,
        laws=chosen,
        drawn_J=tuple(np.array([run.drawn_J for run in runs]) for runs in hand_by_hand),
        held_back_s=tuple(
            np.array([run.held_back_s for run in runs], float) for runs in hand_by_hand
        ),
    )


_Cell = tuple[str, str, float, int]


def _maker(cell: _Cell, **how: Any) -> Callable[[int], Scenario]:
    """Return what makes the scenario of a hand from its index."""
    kind, device, stiffness, delay = cell
    return partial(_indexed, kind, device, how | {"stiffness": stiffness, "delay": delay})


def _indexed(kind: str, device: str, how: dict[str, Any], index: int) -> Scenario:
    return random_scenario(kind, device, index, **how)


def _measured(
    make: Callable[[int], Scenario], law: CoreLaw | PythonLaw, given: AnyLaw, index: int
) -> HandRun:
    trace = every_row(on_its_observer(make(index), given), law)
    held = float(trace["law.starved"].max()) if _guarded(law, trace) else None
    touched = bool(trace["f_env"].any())
    return HandRun(held, drawn(trace), bool(trace["fault"].any()), touched)


def _guarded(law: CoreLaw | PythonLaw, trace: Trace) -> bool:
    return bool(getattr(law, "guard", False)) and "law.starved" in trace


def _row(cell: _Cell, name: str, reserve: float | None, runs: list[HandRun]) -> RandomWorldRow:
    kind, device, stiffness, delay = cell
    held = [run.held_back_s for run in runs if run.held_back_s is not None]
    return RandomWorldRow(
        kind=kind,
        device=device,
        stiffness_N_per_m=stiffness,
        delay_samples=delay,
        law=name,
        hands=len(runs),
        touched=sum(run.touched for run in runs),
        held_back=sum(time > HELD_BACK for time in held) if held else None,
        longest_held_back_s=max(held, default=None),
        drawn_J=max(run.drawn_J for run in runs),
        reserve_J=reserve,
        beyond_reserve=None if reserve is None else sum(run.drawn_J > reserve for run in runs),
        faults=sum(run.fault for run in runs),
        worst_hand=max(range(len(runs)), key=lambda i: runs[i].rank),
    )


@contextmanager
def _threads(count: int) -> Iterator[ThreadPoolExecutor]:
    """Give threads that drop what waits when the work is stopped."""
    executor = ThreadPoolExecutor(count, thread_name_prefix="ebac random worlds")
    try:
        yield executor
    finally:
        executor.shutdown(cancel_futures=True)


def _check_whole(**numbers: tuple[Any, int, int]) -> None:
    for name, (value, low, high) in numbers.items():
        if not low <= whole(name, value) <= high:
            raise ValueError(f"{name} = {value}: must lie in [{low}, {high}]")
