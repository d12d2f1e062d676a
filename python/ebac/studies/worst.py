"""`worst`: the hand that takes most energy out of a law's port, searched over families of hands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from ebac._util import formatting
from ebac._util.arguments import nearest_float, number, require, whole
from ebac._util.cores import thread_count
from ebac._util.progress import Progress
from ebac._util.sequences import several
from ebac._util.wrong_calls import plain_function
from ebac.laws import AnyLaw, design, law_name
from ebac.laws.making import reserve_of
from ebac.laws.tuned_laws import on_its_observer
from ebac.scenario import Scenario
from ebac.studies.condition import Condition, known_under
from ebac.studies.conditions import conditions
from ebac.studies.families import PULL, families, find_family
from ebac.studies.hand_search import HandSearch, WorstHand, every_row
from ebac.studies.scenario_changes import truth
from ebac.studies.slower_hands import no_quicker
from ebac.trace import Trace

#: Numbers that are whole.
WHOLE = ("evaluations", "seed")
#: Runs per family, unless others are asked for; fewer find less.
EVALUATIONS = 2000


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Worst:
    """What a search found: the worst hand of every family, the worst first.

    Attributes
    ----------
    law : str
        Its name.
    made : law
        As it was designed for the condition.
    condition : Condition
        What was changed for every hand.
    pull : float
        Largest pull the hands were allowed [N].
    pull_rate : float or None
        How quickly their own force may change [N/s]; None: at once.
    declared : float or None
        Largest pull the law counts with [N], None for a law that declares none.
    reserve : float or None
        Reserve of the law, e(0) of eq. (3) [J]; None for a law without a reserve.
    hands : tuple of WorstHand
        One per family.
    """

    law: str
    made: Any
    condition: Condition
    pull: float
    pull_rate: float | None
    declared: float | None
    reserve: float | None
    hands: tuple[WorstHand, ...]

    def within(self, hand: WorstHand) -> bool | None:
        """Return whether a hand stays within what the law counts with; None for a law that declares nothing."""
        return None if self.declared is None else hand.most_pull_N <= self.declared

    def rows(self) -> list[dict[str, Any]]:
        """Return the documented rows of `ebac worst --json`."""
        return [
            {
                "law": self.law,
                "condition": self.condition.name,
                "family": hand.family.name,
                "energy_drawn_J": hand.energy_J,
                "energy_drawn_300_s_J": hand.long_energy_J,
                "reserve_J": self.reserve,
                "most_drawn_J": hand.most_drawn_J,
                "most_pull_N": hand.most_pull_N,
                "within_declared_pull": self.within(hand),
                "unseen_J": hand.unseen_J,
                "runs": hand.runs,
                "parameters": [
                    {"name": p.name, "value": hand.values[p.name], "unit": p.unit, "low": p.low, "high": p.high}
                    for p in hand.family.parameters
                ],
            }
            for hand in self.hands
        ]  # fmt: skip

    def __repr__(self) -> str:
        """Return a row per family, the worst hand first."""
        from ebac._util.report import report

        shown = ("family", "energy_drawn_J", "energy_drawn_300_s_J", "most_drawn_J", "most_pull_N")
        rows = [{key: row[key] for key in shown} for row in self.rows()]
        reserve = (
            "" if self.reserve is None else f", reserve {formatting.quantity(self.reserve, 'J')}"
        )
        return report(f"Worst hands of {self.law}, {self.condition.name}, simulated{reserve}", rows)

    def _repr_html_(self) -> str:
        """Return the worst hand's figure and a row per family, for a notebook."""
        from ebac._util import notebook
        from ebac.plot import plot_worst

        rows = [{k: v for k, v in row.items() if k != "parameters"} for row in self.rows()]
        return notebook.result("Worst hands, simulated", rows, lambda: plot_worst(self))

    def trace(self, hand: WorstHand | None = None) -> Trace:
        """Simulate a hand again, by default the worst, with every row."""
        chosen = self.hands[0] if hand is None else hand
        require(chosen, WorstHand, "Worst.trace", "one of its hands")
        return every_row(chosen.scenario, self.made)


@plain_function
def worst(
    law: AnyLaw = "ebac",
    condition: str | Condition = "d1K10",
    *,
    family: str | Sequence[str] | None = None,
    evaluations: int = EVALUATIONS,
    seed: int = 1,
    seconds: float | None = None,
    pull: float | None = None,
    pull_rate: float | None = None,
    base: Scenario | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Worst:
    """Search the hand that draws most energy out of a law's port. The same seed finds the same hand.

    A quarter of the runs goes to random hands; then generations are bred from the best, each measured together; NLopt's
    subplex method (SBPLX) ends. The ground is rough: another seed may find a worse one.

    Parameters
    ----------
    law : str, law class, Variant, law or PythonLaw
        As `simulate` takes it.
    condition : str or Condition
        One that changes device, timing or wall; the hand is what is searched.
    family : str or sequence of str, optional
        Names of `families`; default: all.
    evaluations : int
        Runs per family, at least 40; a search of fewer than the default misses worse hands.
    seed : int
        Of the search, [0, 2^31).
    seconds : float, optional
        Length of each run [s], [0.1, 3600]; default: 2 to 8 s, by family. What was found is also run for 300 s, since a
        slow leak needs minutes to show; a search of such runs finds more.
    pull : float, optional
        Largest pull of a hand [N], (0, 1000]; default: 20 N, or what the law declares where that is more.
    pull_rate : float, optional
        How quickly the own force K0 X0 of a hand, eq. (4), may change [N/s], [1, 1e9]; default: at once, as no person
        can. A law's parameter `pull_rate` is how quickly it expects a pull to grow.
    base : Scenario, optional
        What the condition changes; default: the reference scenario.
    threads : int, optional
        Threads for the random part; default: one per usable core. The result does not depend on it.
    progress : callable, optional
        Called with (runs done, runs in all).

    Returns
    -------
    Worst

    Raises
    ------
    TypeError
        For several conditions.
    ValueError
        For a number out of range, a family or condition that does not exist, or a condition that changes the hand.
    """
    base = Scenario() if base is None else base
    require(base, Scenario, "ebac.worst", "a Scenario as its base")
    where = _condition(condition, base)
    scenario = on_its_observer(where.made(where.change(base)), law)
    made = design(law, *known_under(where, scenario))
    declared = getattr(made, "pull", None)
    most = pull if pull is not None else max(PULL, declared or 0.0)
    _check(evaluations=(evaluations, 40, 10**7), seed=(seed, 0, 2**31 - 1), pull=(most, 1e-3, 1e3))
    asked = list(families(most)) if family is None else family
    names = [asked] if isinstance(asked, str) else several("worst: family", asked)
    wanted = [find_family(n, most) for n in dict.fromkeys(names)]
    if seconds is not None:
        _check(seconds=(seconds, 0.1, 3600))
    if pull_rate is not None:
        _check(pull_rate=(pull_rate, 1, 1e9))
        wanted = [no_quicker(one, pull_rate) for one in wanted]
    total = evaluations * len(wanted)
    report = progress or (lambda done, total: None)
    found = []
    for i, one in enumerate(wanted):
        count = partial(_report, report, i * evaluations, total)
        search = HandSearch(one, scenario, made, most, thread_count(threads), count, seconds)
        found.append(search.run(evaluations, seed))
    found.sort(key=lambda hand: (-hand.energy_J, -hand.most_drawn_J))
    return Worst(
        law=law_name(law), made=made, condition=where, pull=most, pull_rate=pull_rate,
        declared=declared, reserve=reserve_of(made, scenario), hands=tuple(found),
    )  # fmt: skip


def _report(progress: Progress, before: int, total: int, runs: int) -> None:
    progress(before + runs, total)


def replays(condition: Condition, scenario: Scenario) -> bool:
    """Whether a law designed for the scenario is the one that was searched: the condition changes none of its facts."""
    return condition.believed(scenario) == truth(scenario)


def _condition(given: str | Condition, base: Scenario) -> Condition:
    require(given, (str, Condition), "worst: condition", "one condition, such as 'd1K10'")
    chosen = conditions([given])
    if len(chosen) != 1:
        names = ", ".join(one.name for one in chosen)
        raise ValueError(f"condition {given}: stands for {names}; give one")
    [one] = chosen
    if one.drives or one.change(base).hand != base.hand:
        raise ValueError(
            f"condition {one.name}: changes the hand ({one.summary}), which is what is searched; "
            "give one that changes device, timing or wall"
        )
    return one


def _check(**numbers: tuple[float, float, float]) -> None:
    for name, (value, low, high) in numbers.items():
        named = f"worst: {name}"
        if not low <= (whole if name in WHOLE else number)(named, value) <= high:
            unit = {"pull": " N", "pull_rate": " N/s", "seconds": " s"}.get(name, "")
            raise ValueError(
                f"{named} = {nearest_float(value):g}{unit}: must lie in [{low:g}, {high:g}]{unit}"
            )
