"""`study`: laws over a population of hands under named conditions."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from concurrent.futures import Executor
from pathlib import Path
from types import NoneType

import numpy as np
from numpy.typing import NDArray

from ebac._core import Wall
from ebac._util import remarks
from ebac._util.arguments import require, whole
from ebac._util.doubts.study import doubts
from ebac._util.progress import Progress
from ebac._util.wrong_calls import plain_function
from ebac.operators import Operators
from ebac.scenario import Scenario
from ebac.simulation import warn_of
from ebac.studies.condition import Condition, known_under
from ebac.studies.conditions import conditions as find
from ebac.studies.ideal import ideal_contacts, settled_in_time
from ebac.studies.result import Study
from ebac.studies.sweeps.run import Laws, name_laws, seed_of, sweep

#: Laws that are compared unless others are given.
LAWS = ("direct", "tca", "tca-damped", "eba", "ebac")


@plain_function
def study(
    population: Operators,
    laws: Laws = LAWS,
    conditions: Sequence[str | Condition] | None = None,
    *,
    base: Scenario | None = None,
    seed: int | None = None,
    threads: int | None = None,
    executor: Executor | None = None,
    out: str | Path | None = None,
    resume: bool = True,
    progress: Progress | None = None,
) -> Study:
    """Run every law with every hand of a population under every condition.

    Parameters
    ----------
    population : Operators
        The hands.
    laws : law, sequence of laws, or mapping of names to laws
        As `sweep` takes them; default: `direct`, `tca`, `tca-damped`, `eba`, `ebac`.
    conditions : sequence of str or Condition
        Names of `CONDITIONS` or `GROUPS`, or conditions of your own; default: "d1K10", and "as-given" with a `base`.
    base : Scenario, optional
        What conditions change; default: the reference scenario.
    seed : int
        Gives each hand its noise and jitter, the same under every law; default: that of `base`.
    threads, executor, out, resume, progress
        As in `sweep`.

    Returns
    -------
    Study

    Warns
    -----
    UserWarning
        When hands come to rest before the surface, and when the hand of `base` has a model, which no hand of a
        population has.
    DoubtWarning
        For what is doubtful of the device and the length of `base`, and where its motor is too weak for hands.
    """
    require(population, Operators, "ebac.study", "a population, an Operators")
    require(base, (Scenario, NoneType), "ebac.study", "a Scenario as its base")
    if seed is not None and whole("study: seed", seed) < 0:
        raise ValueError(f"study: seed = {seed}: must be at least 0")
    if conditions is None:
        conditions = ["d1K10" if base is None else "as-given"]
    chosen = tuple(find(conditions))
    if not chosen:
        raise ValueError("no condition given: a study needs at least one")
    named = name_laws(laws)
    if base is not None and base.hand.model is not None:
        warnings.warn(
            f"the hand of base, {type(base.hand.model).__name__}, gives way to those of the population; a Condition "
            "whose change sets it has it under every law",
            stacklevel=3,
        )
    if base is not None and remarks.wanted():
        warn_of(doubts(population, base))
    if progress is not None:
        hands = sum(len(c.drives) or len(population) for c in chosen)
        progress(0, hands * len(named))  # the scenarios of many take seconds
    parts = [condition.scenarios(population, base or Scenario()) for condition in chosen]
    rows = [
        np.zeros(len(p), int) if c.drives else np.arange(1, len(p) + 1)
        for c, p in zip(chosen, parts, strict=True)
    ]
    # A hand has one seed under all conditions.
    first = seed if seed is not None else (base or Scenario()).seed
    scenarios = [s.replace(seed=seed_of(first, i)) for part in parts for i, s in enumerate(part)]
    lengths = [len(part) for part in parts]
    under = [(c, s) for c, part in zip(chosen, parts, strict=True) for s in part]
    result = sweep(
        scenarios, named, designed_for=[known_under(c, s) for c, s in under], threads=threads, executor=executor,
        out=out, resume=resume, progress=progress,
    )  # fmt: skip
    ideal = ideal_contacts(scenarios, threads)
    n = len(named)
    columns = dict(result.columns)
    columns["condition"] = np.tile(np.repeat([c.name for c in chosen], lengths), n)
    columns["operator"] = np.tile(np.concatenate(rows), n)
    _warn_of_free_air(chosen, lengths, scenarios, result["ideal_m"])
    columns["ideal_settled_s"] = np.tile(ideal["settled_s"], n)
    columns["ideal_good"] = (
        np.abs(np.tile(ideal["rest_m"], n) - columns["ideal_m"]) <= columns["allowed_m"]
    ) & np.tile(ideal["quiet"], n)
    columns["exact_and_still"] = result.exact_and_still
    columns["good"] = result.good
    columns["settled_in_time"] = settled_in_time(result, columns["ideal_settled_s"])
    return Study(
        operators=population, conditions=chosen, scenarios=scenarios,
        designed_for=[c.believed(s) for c, s in under], laws=named, columns=columns,
    )  # fmt: skip


def _warn_of_free_air(
    chosen: Sequence[Condition],
    lengths: Sequence[int],
    scenarios: Sequence[Scenario],
    ideal_m: NDArray[np.float64],
) -> None:
    """Warn of hands that come to rest before the surface, of which no law has anything to show."""
    walls = [s.environment for s in scenarios]
    surface = np.array([w.position if isinstance(w, Wall) else -np.inf for w in walls])
    before = np.split(ideal_m[: len(scenarios)] <= surface, np.cumsum(lengths)[:-1])
    free = {c.name: part for c, part in zip(chosen, before, strict=True) if part.any()}
    if free:
        each = ", ".join(f"{part.sum()} of {len(part)} under {name}" for name, part in free.items())
        warnings.warn(
            f"hands that rest before the wall, {each}: every law is good for them; give targets beyond the surface",
            stacklevel=4,
        )
