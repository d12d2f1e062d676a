"""`sweep`: many scenarios under several laws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from types import NoneType
from typing import Any, TypeAlias

import numpy as np

from ebac._core import Device, DeviceFacts, RunLimits, Timing
from ebac._util.arguments import require, require_path, whole
from ebac._util.progress import Progress
from ebac._util.wrong_calls import plain_function
from ebac.laws import AnyLaw, design, law_name
from ebac.laws.tuned_laws import on_its_observer
from ebac.scenario import Scenario
from ebac.studies.sweeps.job import Job
from ebac.studies.sweeps.measure import Columns, Run
from ebac.studies.sweeps.parameters import swept
from ebac.studies.sweeps.result import SweepResult
from ebac.studies.sweeps.store import Store, fingerprint

Laws: TypeAlias = AnyLaw | Sequence[AnyLaw] | Mapping[str, AnyLaw]
Known: TypeAlias = tuple[Device | DeviceFacts, Timing]

#: Runs of a bundle: what is lost when a sweep is killed, and what travels to an executor at once.
BUNDLE = 500


class SweepInterrupted(KeyboardInterrupt):
    """A sweep was interrupted from the keyboard; `result` holds what was done, see its column `done`."""

    def __init__(self, result: SweepResult) -> None:
        self.result = result
        super().__init__(f"interrupted after {int(result['done'].sum())} of {len(result)} runs")

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what a copy is made from: the result, not the text."""
        return type(self), (self.result,)


@plain_function
def sweep(
    scenarios: Sequence[Scenario],
    laws: Laws,
    *,
    seed: int | None = None,
    designed_for: Sequence[Known] | None = None,
    limits: RunLimits | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    bundle: int | None = None,
    out: str | Path | None = None,
    resume: bool = True,
    progress: Progress | None = None,
) -> SweepResult:
    """Run every scenario under every law and measure each run. The result does not depend on how it is computed.

    Parameters
    ----------
    scenarios : sequence of Scenario
        What to run, n of them.
    laws : law, sequence of laws, or mapping of names to laws
        As `simulate` takes them; a name or class is designed anew for each scenario's device, timing and jitter.
    seed : int, optional
        Gives scenario i a seed of its own, derived from (seed, i), the same under every law. None keeps the
        scenarios' seeds.
    designed_for : sequence of (Device or DeviceFacts, Timing), optional
        What laws are designed for where that is not what is simulated: one for each scenario.
    limits : RunLimits, optional
        A run beyond these ends early and is called `diverged`. (Those of a device are `limits` of `simulate`.)
    threads : int, optional
        Threads of this process, or of each worker of `executor`; default: one per usable core, or 1 under an executor.
    executor : concurrent.futures.Executor, optional
        Runs bundles elsewhere: threads, processes, or a cluster (Dask: `Client(...).get_executor()`).
    bundle : int, optional
        Runs that are written or sent at once; default 500, fewer under an executor when there are few.
    out : path, optional
        Folder to which each bundle is written as soon as it is done. A sweep that was killed and is called again
        continues there and gives the same bits. One with another law is refused, also where only the code of a law
        in Python has changed (what it uses of other modules is not looked at).
    resume : bool
        False starts anew in a folder that holds a sweep.
    progress : callable, optional
        Called with (runs done, runs in all) in the calling thread, some times a second.

    Returns
    -------
    SweepResult
        len(laws) x n rows.

    Raises
    ------
    SweepInterrupted
        On a keyboard interrupt, within 0.2 s for laws of the core; carries what is done.
    ValueError
        For no scenarios or laws, two laws of one name, or a folder that holds another sweep.
    """
    require(scenarios, Sequence, "ebac.sweep", "a list of scenarios")
    wanted = "limits=RunLimits(...), beyond which a run ends early (a device's own: ebac.simulate)"
    require(limits, (RunLimits, NoneType), "ebac.sweep", wanted)
    require(executor, (Executor, NoneType), "ebac.sweep", "an executor of concurrent.futures")
    if out is not None:
        require_path(out, "ebac.sweep", "the path of a folder as out")
    require(
        designed_for,
        (Sequence, NoneType),
        "designed_for",
        "pairs of Device or DeviceFacts, and Timing",
    )
    _check(scenarios, seed=seed, threads=threads, bundle=bundle, designed_for=designed_for)
    named = name_laws(laws)
    if progress is not None:
        progress(0, len(named) * len(scenarios))  # before the designs, which take seconds of many
    if seed is not None:
        scenarios = [s.replace(seed=seed_of(seed, i)) for i, s in enumerate(scenarios)]
    known = designed_for or [(s.device, s.known_timing) for s in scenarios]
    places, distinct = _distinct(known)
    runs: list[Run] = []
    for law in named.values():
        made = [design(law, device, timing) for device, timing in distinct]
        runs += [
            (on_its_observer(one, law), made[place])
            for one, place in zip(scenarios, places, strict=True)
        ]
    job = Job(runs, limits or RunLimits(), threads, progress or (lambda done, total: None))
    size = bundle or _bundle(len(runs), shared=executor is not None, stored=out is not None)
    store: AbstractContextManager[Store | None] = nullcontext()
    if out is not None:
        about = {
            "runs": len(runs),
            "bundle": size,
            "laws": list(named),
            "fingerprint": fingerprint(runs, job.limits),
        }
        store = Store(out, about, resume=resume)
    n = len(scenarios)
    head: Columns = {
        "law": np.repeat(np.array(list(named)), n),
        "scenario": np.tile(np.arange(n), len(named)),
        "seed": np.tile(np.array([s.seed for s in scenarios]), len(named)),
    }
    head |= {name: np.tile(values, len(named)) for name, values in swept(scenarios).items()}
    try:
        with store as folder:
            for part, columns in job.work(size, folder, executor):
                job.keep(part, columns)
    except KeyboardInterrupt:
        raise SweepInterrupted(SweepResult(head | job.columns)) from None
    return SweepResult(head | job.columns)


def seed_of(seed: int, index: int) -> int:
    """Return the seed of task `index` of a sweep: 63 bits that depend on both numbers."""
    bits = np.random.SeedSequence((seed, index)).generate_state(1, np.uint64)[0]
    return int(bits) >> 1


def name_laws(laws: Laws, what: str = "a sweep") -> dict[str, AnyLaw]:
    """Return the laws of a sweep by name; `what` needs them, for messages.

    Raises
    ------
    ValueError
        When there is none, or two go by one name.
    """
    if isinstance(laws, Mapping):
        named = {str(name): law for name, law in laws.items()}
    else:
        given: Sequence[Any] = laws if isinstance(laws, (list, tuple)) else [laws]
        names = [law_name(law) for law in given]
        named = dict(zip(names, given, strict=True))
        if len(named) < len(given):
            twice = next(name for name in names if names.count(name) > 1)
            raise ValueError(f"two laws are called {twice!r}: give a mapping of names to laws")
    if not named:
        raise ValueError(f"no law given: {what} needs at least one")
    return named


def _distinct(known: Sequence[Known]) -> tuple[list[int], list[Known]]:
    """Return, for each scenario, the place of its facts and timing among the distinct ones, and those."""
    found: dict[tuple[DeviceFacts, Timing], int] = {}
    places: list[int] = []
    distinct: list[Known] = []
    for pair in known:
        require(pair, (tuple, list), "designed_for", "pairs of Device or DeviceFacts, and Timing")
        device, timing = pair
        facts = device.facts if isinstance(device, Device) else device
        place = found.setdefault((facts, timing), len(found))
        if place == len(distinct):
            distinct.append((device, timing))
        places.append(place)
    return places, distinct


def _bundle(runs: int, *, shared: bool, stored: bool) -> int:
    if shared:
        return min(BUNDLE, max(1, runs // 32))
    return BUNDLE if stored else runs


def _check(scenarios: Sequence[Scenario], **numbers: Any) -> None:
    if not scenarios:
        raise ValueError("no scenario given: a sweep needs at least one")
    for one in scenarios:
        require(one, Scenario, "ebac.sweep", "a list of scenarios, each a Scenario")
    designed_for = numbers.pop("designed_for")
    if designed_for is not None and len(designed_for) != len(scenarios):
        raise ValueError(
            f"designed_for has {len(designed_for)} entries for {len(scenarios)} scenarios: give one for each"
        )
    for name, value in numbers.items():
        least = 0 if name == "seed" else 1
        if value is not None and whole(f"sweep: {name}", value) < least:
            raise ValueError(f"sweep: {name} = {value}: must be at least {least}")
