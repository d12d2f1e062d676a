"""`tune`: a law's parameters searched on training hands, judged on others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ebac._util.arguments import named, require, whole
from ebac._util.progress import Progress
from ebac._util.wrong_calls import plain_function
from ebac.laws import LAWS, AnyLaw, Variant, changed, law_name
from ebac.laws.making import checked
from ebac.operators import Operators
from ebac.scenario import Scenario
from ebac.studies.condition import Condition
from ebac.studies.conditions import conditions as find
from ebac.studies.study import study
from ebac.studies.tuning.ranges import Range, Ranges, ranges_of
from ebac.studies.tuning.result import Tuned, TuningInterrupted, rows_of
from ebac.studies.tuning.search import Search

#: Conditions of a search: delay 0, 1, 2 at 10 and 20 kN/m.
TUNING_CONDITIONS = ("d0K10", "d0K20", "d1K10", "d1K20", "d2K10", "d2K20")
#: Training hands: this many random ones, of this seed; the test hands are the grid of 60.
HANDS, HANDS_SEED = 24, 14


@plain_function
def tune(
    law: AnyLaw,
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
    law : law
        A name of `RANGES`; a law of your own in Python, an object of a dataclass, whose numeric fields have `low` and
        `high` in their metadata; or any law as `simulate` takes it, with `ranges`.
    conditions : sequence of str or Condition
        As `study` takes them.
    training, test : Operators, optional
        Hands of the search, default 24 random ones; and those of the result, default the grid of 60.
    ranges : mapping of str to (low, high), optional
        Parameters to search, in SI units, within what the law allows; (0, 1) for a switch.
    base : Scenario, optional
        What conditions change; default: the reference scenario. With `observer="every-law"` the law acts on the
        estimate, else on the encoder.
    evaluations : int
        Points to try for each delay, at least 2; each runs every training hand under every condition of the delay.
    seed : int
        Gives each hand its noise and jitter, and the search its points.
    threads : int, optional
        Default: one per usable core.
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
    TypeError
        For what is no law, or a law without parameters to change, as one that is no dataclass.
    ValueError
        For a law, or a field of a law in Python, without a range; a parameter it does not have; or a number out of
        range.
    """
    if isinstance(law, str):
        named("law", law, LAWS)
    if not isinstance(law, (str, type, Variant)):
        checked(law)
    changed(law)  # refuses a law without parameters
    if whole("evaluations", evaluations) < 2:
        raise ValueError(f"evaluations = {evaluations}: must be at least 2")
    if whole("seed", seed) < 0:
        raise ValueError(f"seed = {seed}: must be at least 0")
    searched = Ranges(law, ranges_of(law) if ranges is None else ranges)
    hands = Operators.sample(HANDS, HANDS_SEED) if training is None else training
    others = Operators.grid() if test is None else test
    for population in (hands, others):
        require(population, Operators, "ebac.tune", "populations, each an Operators")
    start = Scenario() if base is None else base
    require(start, Scenario, "ebac.tune", "a Scenario as its base")
    groups: dict[int, list[Condition]] = {}
    for one in find(conditions):
        delay = one.believed(one.scenarios(hands[:1], start)[0])[1].delay
        groups.setdefault(delay, []).append(one)
    if not groups:
        raise ValueError("no condition given: tune needs at least one")
    done: list[Tuned] = []
    total = len(groups) * evaluations
    for i, (delay, chosen) in enumerate(groups.items()):
        stopped = False
        try:
            search = Search(law, searched, chosen, hands, start, seed, threads)
            search.report = lambda n, i=i: (
                progress and progress(min(i * evaluations + n, total), total)
            )
            try:
                search.run(evaluations)
            except KeyboardInterrupt:
                stopped = True
            if search.tried:
                found = _judged(search, delay, others, start, seed, threads)
                parameters = searched.searched(found.changes)
                at_bounds = searched.at_bounds(found.changes)
                done.append(replace(found, parameters=parameters, at_bounds=at_bounds))
        except KeyboardInterrupt:  # before the search, or while its result was judged
            stopped = True
        if stopped:
            raise TuningInterrupted(done)
    return done


def _judged(
    search: Search, delay: int, hands: Operators, base: Scenario, seed: int, threads: int | None
) -> Tuned:
    changes, cost = min(search.tried, key=lambda tried: tried[1])
    observer = base.designed_observer()
    laws: dict[str, AnyLaw] = {"default": search.law, "tuned": changed(search.law, **changes)}
    found = study(hands, laws, search.conditions, base=base, seed=seed, threads=threads)
    return Tuned(
        law=law_name(search.law),
        variant=laws["tuned"],
        delay=delay,
        observer=observer is not None and observer.every_law,
        changes=changes,
        tried=len(search.tried),
        cost=cost,
        default_cost=search.tried[0][1],
        test=rows_of(found, "tuned"),
        default=rows_of(found, "default"),
    )
