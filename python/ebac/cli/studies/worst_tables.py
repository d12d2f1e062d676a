"""What `ebac worst` prints: the worst hand of each family of one law, or the worst hand of each of several laws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.studies import Worst, WorstHand

#: What two headings of the tables mean.
_MEANING = (
    "Drawn: minus the least energy of the port in the run that was searched, then in 5 min of the same hand. "
    "In any window: the most that the port gives out between two instants, whatever went in before."
)


def show_one(found: Worst, evaluations: int) -> None:
    """Print a row per family, and the worst hand with its numbers."""
    from ebac._util import formatting

    headings = [
        "family",
        "drawn",
        "in 5 min",
        "in any window",
        "hardest pull",
        "runs",
    ]
    if found.declared is not None:
        headings.append(f"within the law's {found.declared:g} N")
    grid = output.table(headings, numbers=(1, 2, 3, 4, 5))
    for hand in found.hands:
        within = {None: [], True: ["yes"], False: ["[red]no[/]"]}[found.within(hand)]
        grid.add_row(
            hand.family.name,
            *(_drawn(found, energy) for energy in (hand.energy_J, hand.long_energy_J)),
            formatting.quantity(hand.most_drawn_J, "J"),
            formatting.quantity(hand.most_pull_N, "N"),
            str(hand.runs),
            *within,
        )  # fmt: skip
    output.show(grid)
    output.say(_MEANING)
    top = found.hands[0]
    output.say(f"The worst: {top.family.name}, {top.family.summary}", style="bold")
    for p in top.family.parameters:
        span = f"[{formatting.quantity(p.low, p.unit)}, {formatting.quantity(p.high, p.unit)}]"
        output.say(f"  {p.name} = {formatting.quantity(top.values[p.name], p.unit)} of {span}")
    if found.pull_rate is not None:
        quickest = formatting.quantity(found.pull_rate, "N/s")
        output.say(f"The own force of each hand changes by {quickest} at most.")
    output.say(_verdict(found, top))
    _ending(evaluations)


def _drawn(found: Worst, energy: float) -> str:
    text = _joules(energy)
    return f"[red]{text}[/]" if found.reserve is not None and energy > found.reserve else text


def _joules(energy: float) -> str:
    """Return an energy that was drawn; a run ends where it has drawn as much as is counted."""
    from ebac._core import RunLimits
    from ebac._util import formatting

    most = RunLimits().energy
    return (
        f"> {formatting.quantity(most, 'J')}"
        if energy >= most
        else formatting.quantity(energy, "J")
    )


def _verdict(found: Worst, top: WorstHand) -> str:
    from ebac._util import formatting

    drawn, longer = map(_joules, (top.energy_J, top.long_energy_J))
    drawn = f"It draws {drawn} in {top.scenario.seconds:g} s and {longer} in 5 min"
    if found.reserve is None:
        return f"{drawn}; {found.law} has no reserve."
    unseen = formatting.quantity(top.unseen_J, "J")
    reserve = f"the reserve is {formatting.quantity(found.reserve, 'J')}"
    if max(top.energy_J, top.long_energy_J) <= found.reserve:
        return f"{drawn}; {reserve}: within it."
    if top.energy_J <= found.reserve:
        return f"{drawn}; {reserve}: within it at first, beyond it in the end."
    drawn = f"{drawn}; {reserve}: beyond it."
    return f"{drawn} An account of encoder counts may miss {unseen}: one count times all changes of the force."


def show_several(found: Sequence[Worst], evaluations: int) -> None:
    """Print the worst hand of each law, the law of which least is drawn first."""
    from ebac._util import formatting

    headings = ["law", "drawn", "in 5 min", "in any window", "reserve", "family", "hardest pull"]
    grid = output.table(headings, numbers=(1, 2, 3, 4, 6))
    for one in sorted(found, key=lambda each: each.hands[0].energy_J):
        top = one.hands[0]
        grid.add_row(
            one.law,
            *(_drawn(one, energy) for energy in (top.energy_J, top.long_energy_J)),
            formatting.quantity(top.most_drawn_J, "J"),
            "none" if one.reserve is None else formatting.quantity(one.reserve, "J"),
            top.family.name,
            formatting.quantity(top.most_pull_N, "N"),
        )  # fmt: skip
    output.say(f"The worst hand of each law, {found[0].condition.name}", style="bold")
    output.show(grid)
    output.say(_MEANING)
    _ending(evaluations)


def _ending(evaluations: int) -> None:
    from ebac.studies.worst import EVALUATIONS

    if evaluations < EVALUATIONS:
        output.say(
            f"A short search, {evaluations} runs per family: it proves less, since more runs find worse hands. "
            f"The default is --evaluations {EVALUATIONS}."
        )
    output.say(
        "Simulated, not measured; a search shows what exists, never that nothing worse does.",
        style="bold",
    )
