"""`ebac worst`: the hand that takes most energy out of a law's port."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac._util.file_names import file_name
from ebac.cli import by_name, changed_laws, from_options, interrupts, options, output
from ebac.cli.files import ResultOptions
from ebac.cli.studies import replaced, worst_tables

if TYPE_CHECKING:
    from ebac._util.progress import Progress
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
    law: Annotated[list[str] | None, options.laws("ebac", panel=_WHAT)] = None,
    change: Annotated[
        list[str] | None,
        typer.Option(
            help="Parameters to change of the one law that is searched: NAME=VALUE in SI units, on or off, separated "
            "by commas.",
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
    random hands, generations bred from the best, then NLopt. A hand that pulls harder than allowed does not count. Of
    one law each family's worst hand is shown, and whether its pull is within the largest one that the law is made for,
    its parameter `pull`; of several laws the worst hand of each.

    **Examples**

    * `ebac worst --evaluations 200`: EBAC at the paper's wall, a short search

    * `ebac worst --condition d2K10 --family swinging`: one family, at two samples of delay

    * `ebac worst --law tca-damped,eba,ebac --family swinging --evaluations 100`: each law against its own worst hand

    * `ebac worst --change guard=off --family impact`: the same without the guard

    * `ebac worst --pull-rate 1000 --family tapping --evaluations 200`: hands that need a millisecond for each newton
    """
    from ebac.studies.worst import worst as search

    with output.refusing():
        laws = by_name.laws(law or ["ebac"], many=True)
        chosen = changed_laws.instead(laws, change or [])
        base = from_options.scenario(device, length)
        wanted = by_name.one_condition(condition or options.usual_condition(length))
        replaced.note(base, [wanted])
        families = output.words(family)
        folder = to.folder("worst", as_json=as_json)
        interrupts.keeping(
            "nothing was written; the same command starts from the beginning, and fewer --family or --evaluations "
            "take less time"
        )
        with output.counting("searching", quiet=as_json) as progress:
            found = [
                search(
                    one, wanted, family=families or None, evaluations=evaluations, seed=seed, seconds=length.seconds,
                    pull=pull, pull_rate=pull_rate, base=base, threads=threads,
                    progress=_from(i, len(chosen), progress),
                )
                for i, one in enumerate(chosen)
            ]  # fmt: skip

    def show() -> None:
        if len(found) > 1:
            worst_tables.show_several(found, evaluations)
        else:
            worst_tables.show_one(found[0], evaluations)
        if folder is not None:
            _show_replay(found, folder, by_name.own_words(law or []), changed=bool(change))

    to.report(
        folder, "worst", _document(found, evaluations, seed, length.seconds), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=show,
    )  # fmt: skip


def _from(before: int, laws: int, progress: Progress) -> Progress:
    """Return the progress of one law, of which `before` were searched."""
    return lambda done, total: progress(before * total + done, laws * total)


def _document(found: Sequence[Worst], evaluations: int, seed: int, seconds: float | None) -> str:
    declared = [one.declared for one in found if one.declared is not None]
    return output.document(
        "worst", [row for one in found for row in one.rows()],
        allowed_pull_N=max(one.pull for one in found), allowed_pull_rate_N_per_s=found[0].pull_rate,
        declared_pull_N=max(declared, default=None), evaluations=evaluations, seed=seed, seconds_s=seconds,
    )  # fmt: skip


def _fill(draft: Path, found: Sequence[Worst], to: ResultOptions) -> None:
    """Write every hand of one law, or the worst hand of each of several."""
    from ebac.plot import plot_worst

    for one in found:
        for hand in one.hands if len(found) == 1 else one.hands[:1]:
            name = _file(one, hand, found)
            hand.scenario.save(draft / f"{name}.toml")
            to.save(plot_worst(one, hand), draft, name)
    rows = [
        {
            **row,
            "parameters": " ".join(f"{p['name']}={p['value']!r}" for p in row["parameters"]),
        }
        for one in found
        for row in one.rows()
    ]
    output.csv_table(draft / "worst.csv", rows)


def _file(one: Worst, hand: WorstHand, found: Sequence[Worst]) -> str:
    return f"worst-{hand.family.name if len(found) == 1 else file_name(one.law)}"


def _show_replay(
    found: Sequence[Worst], folder: Path, own: Mapping[str, str], *, changed: bool
) -> None:
    from ebac.studies.worst import replays

    for one in found:
        top = one.hands[0]
        if not changed and replays(one.condition, top.scenario):
            file = folder / f"{_file(one, top, found)}.toml"
            law = own.get(one.law, one.law)
            _replay_line(f"ebac wall --law {law} --scenario {file}", first=one is found[0])
        else:
            output.say(
                "\nReplay from Python, `ebac.worst(...).trace()`: this law is not the one designed for the scenario."
            )
            return


def _replay_line(command: str, *, first: bool) -> None:
    if first:
        output.say("\nReplay:", style="bold")
    output.path(command)
