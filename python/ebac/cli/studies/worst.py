"""`ebac worst`: the hand that takes most energy out of a law's port."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import by_name, from_options, interrupts, options, output, setting
from ebac.cli.files import ResultOptions
from ebac.cli.studies import replaced

if TYPE_CHECKING:
    from ebac.studies import Worst, WorstHand

_WHAT, _SEARCH = "Law and condition", "Search"


@dataclass(frozen=True, kw_only=True)
class Runs(options.RunOptions):
    """The runs of a search."""

    seconds: Annotated[
        float | None,
        options.option(
            text="Length of each run [s]; a slow leak needs minutes to show",
            default="2 to 8, by family",
            panel=options.RUN,
        ),
    ] = None


def worst(
    to: ResultOptions,
    device: options.DeviceOptions,
    length: Runs,
    law: Annotated[str, options.one_law(panel=_WHAT)] = "ebac",
    change: Annotated[
        list[str] | None,
        typer.Option(
            help="Parameters of the law to change: NAME=VALUE in SI units, on or off, separated by commas.",
            show_default=False,
            rich_help_panel=_WHAT,
        ),
    ] = None,
    condition: Annotated[
        str | None,
        options.conditions(
            "A condition of device, timing or wall, see `ebac conditions`, or one written out, as d2K15, or K15 to "
            "change the stiffness of the wall only.",
            panel=_WHAT,
            default=options.USUAL_CONDITION,
        ),
    ] = None,
    family: Annotated[
        list[str] | None,
        typer.Option(
            help="A family of hands: impact, press-and-go, tapping, swinging, drive, noise, periodic; "
            "several separated by commas.",
            show_default="all",
            rich_help_panel=_SEARCH,
        ),
    ] = None,
    evaluations: Annotated[
        int,
        typer.Option(help="Runs per family.", min=40, max=10_000_000, rich_help_panel=_SEARCH),
    ] = 2000,
    seed: Annotated[int, typer.Option(help="Seed of the search.", rich_help_panel=_SEARCH)] = 1,
    pull: Annotated[
        float | None,
        typer.Option(
            help="Largest pull of a hand [N].",
            show_default="20, or what the law declares if more",
            rich_help_panel=_SEARCH,
        ),
    ] = None,
    pull_rate: Annotated[
        float | None,
        typer.Option(
            help="How quickly the own force of a hand may change [N/s]; the law expects its parameter pull_rate.",
            show_default="at once",
            rich_help_panel=_SEARCH,
        ),
    ] = None,
    threads: options.Threads = None,
    as_json: output.AsJson = False,
) -> None:
    """Find the hand that draws the most energy from a controller.

    A simulation. The energy drawn is minus the least energy of the port. Seven families of hands are searched:
    random hands, generations bred from the best, then NLopt. A hand that pulls harder than allowed does not count. The
    last column says whether its pull is within the largest one that the law is made for, its parameter `pull`.

    **Examples**

    * `ebac worst --evaluations 200`: EBAC at the paper's wall

    * `ebac worst --condition d2K10 --family swinging --evaluations 1000`

    * `ebac worst --change guard=off --family impact`: the same without the guard

    * `ebac worst --pull-rate 1000`: hands that need a millisecond for each newton
    """
    from ebac.laws import Variant
    from ebac.studies.worst import worst as search

    with output.refusing():
        name = by_name.one_law(law)
        chosen = Variant(name, setting.parse_change(_one(change))) if change else name
        base = from_options.scenario(device, length)
        wanted = by_name.one_condition(condition or options.usual_condition(length))
        replaced.tell(base, [wanted])
        families = output.words(family)
        folder = to.folder("worst", as_json=as_json)
        interrupts.keeping(
            "nothing was written; the same command starts from the beginning, and fewer --family or --evaluations "
            "take less time"
        )
        with output.counting("searching", quiet=as_json) as progress:
            found = search(
                chosen, wanted, family=families or None, evaluations=evaluations, seed=seed,
                seconds=length.seconds, pull=pull, pull_rate=pull_rate, base=base, threads=threads, progress=progress,
            )  # fmt: skip

    def show() -> None:
        _show(found, evaluations)
        if folder is not None:
            _tell_replay(found, folder, name, changed=bool(change))

    to.report(
        folder, "worst", _document(found, evaluations, seed, length.seconds), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=show,
    )  # fmt: skip


def _one(changes: list[str]) -> str:
    """Return the changes of the law, where the option is given once."""
    if len(changes) > 1:
        raise ValueError(
            f"--change {changes[1]}: one law is searched, and --change {changes[0]} was given already; "
            f"separate the changes by commas: --change {','.join(changes)}"
        )
    return changes[0]


def _document(found: Worst, evaluations: int, seed: int, seconds: float | None) -> str:
    return output.document(
        "worst", found.rows(), allowed_pull_N=found.pull,
        allowed_pull_rate_N_per_s=found.pull_rate, declared_pull_N=found.declared,
        evaluations=evaluations, seed=seed, seconds_s=seconds,
    )  # fmt: skip


def _fill(draft: Path, found: Worst, to: ResultOptions) -> None:
    from ebac.plot import plot_worst

    for hand in found.hands:
        hand.scenario.save(draft / f"{_file(hand)}.toml")
        to.save(plot_worst(found, hand), draft, _file(hand))
    rows = [
        {
            **row,
            "parameters": " ".join(f"{p['name']}={p['value']!r}" for p in row["parameters"]),
        }
        for row in found.rows()
    ]
    output.csv_table(draft / "worst.csv", rows)


def _file(hand: WorstHand) -> str:
    return f"worst-{hand.family.name}"


def _show(found: Worst, evaluations: int) -> None:
    from ebac._util import formatting
    from ebac.studies.worst import EVALUATIONS

    headings = [
        "family",
        "drawn",
        "in 5 min",
        "drawn in any window",
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
    top = found.hands[0]
    output.say(f"The worst: {top.family.name}, {top.family.summary}", style="bold")
    for p in top.family.parameters:
        span = f"[{formatting.quantity(p.low, p.unit)}, {formatting.quantity(p.high, p.unit)}]"
        output.say(f"  {p.name} = {formatting.quantity(top.values[p.name], p.unit)} of {span}")
    if found.pull_rate is not None:
        quickest = formatting.quantity(found.pull_rate, "N/s")
        output.say(f"The own force of each hand changes by {quickest} at most.")
    output.say(_verdict(found, top))
    if evaluations < EVALUATIONS:
        output.say(
            f"A short search, {evaluations} runs per family: it proves less, since more runs find worse hands. "
            f"The default is --evaluations {EVALUATIONS}."
        )
    output.say(
        "Simulated, not measured; a search shows what exists, never that nothing worse does.",
        style="bold",
    )


def _drawn(found: Worst, energy: float) -> str:
    from ebac._util import formatting

    text = formatting.quantity(energy, "J")
    return f"[red]{text}[/]" if found.reserve is not None and energy > found.reserve else text


def _verdict(found: Worst, top: WorstHand) -> str:
    from ebac._util import formatting

    drawn, longer = (formatting.quantity(e, "J") for e in (top.energy_J, top.long_energy_J))
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


def _tell_replay(found: Worst, folder: Path, law: str, *, changed: bool) -> None:
    from ebac.studies.worst import replays

    top = found.hands[0]
    if not changed and replays(found.condition, top.scenario):
        output.say("\nReplay:", style="bold")
        output.path(f"ebac wall --law {law} --scenario {folder / _file(top)}.toml")
    else:
        output.say(
            "\nReplay from Python, `ebac.worst(...).trace()`: this law is not the one designed for the scenario."
        )
