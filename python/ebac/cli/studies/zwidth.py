"""`ebac zwidth`: which walls a device can render under each law."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import by_name, changed_laws, from_options, interrupts, options, output, setting
from ebac.cli.files import ResultOptions
from ebac.cli.studies import zwidth_vibration

if TYPE_CHECKING:
    from ebac.studies.zwidth import ZWidth

#: Largest wall damping [N s/m], stiffness [N/m] and energy [J] that can be asked for.
DAMPING, STIFFNESS, ENERGY = 1e4, 1e7, 1e3


@dataclass(frozen=True, kw_only=True)
class _Run(options.RunOptions):
    seconds: Annotated[
        float | None,
        options.option(
            text="Length of a run [s]", default="3, or as in the file", panel=options.RUN
        ),
    ] = None


def zwidth(
    to: ResultOptions,
    hand: options.HandOptions,
    device: options.DeviceOptions,
    length: _Run,
    law: Annotated[list[str] | None, options.laws("all")] = None,
    change: changed_laws.Change = None,
    delay: Annotated[
        list[int] | None,
        typer.Option(
            help="Ticks until a command acts [samples]; several separated by commas.",
            show_default="0, 1, 2",
            rich_help_panel=options.RUN,
        ),
    ] = None,
    most_damping: Annotated[
        float,
        typer.Option(
            help="Largest wall damping; the least is 0 [N s/m].", rich_help_panel=options.WALL
        ),
    ] = 20.0,
    points: Annotated[
        int,
        typer.Option(
            help="Number of wall dampings.", min=2, max=1000, rich_help_panel=options.WALL
        ),
    ] = 9,
    least_stiffness: Annotated[
        float,
        typer.Option(help="Least stiffness of the search [N/m].", rich_help_panel=options.WALL),
    ] = 100.0,
    most_stiffness: Annotated[
        float,
        typer.Option(help="Largest stiffness of the search [N/m].", rich_help_panel=options.WALL),
    ] = 1e5,
    epsilon: Annotated[
        float,
        typer.Option(help="Energy that a hand may draw [J].", rich_help_panel=options.RUN),
    ] = 1e-3,
    hands: Annotated[
        int,
        typer.Option(
            help="Random hands of each family of `ebac worst` that may not take more energy than that either: "
            "they tap, swing, shake, press and let go.",
            min=0,
            max=1000,
            rich_help_panel=options.RUN,
        ),
    ] = 0,
    seed: options.Seed = None,
    threads: options.Threads = None,
    as_json: output.AsJson = False,
) -> None:
    """Find the stiffest wall each law can render (Z-width).

    A simulation, over wall damping and delay, of a press and a tap. Criteria: *still*, no limit cycle; *quiet*, still
    and no vibration of the force above three detection thresholds; *energy*, at most epsilon given out by the port,
    with --hands to random hands as well; *usable*, quiet, energy and at least half of the requested stiffness at rest.
    The score is the area under the border; beside it stands the stiffest usable wall without damping, B = 0.

    **Examples**

    * `ebac zwidth --law ebac --delay 1 --points 3`: one law, in seconds

    * `ebac zwidth`: every law at 0, 1 and 2 samples of delay

    * `ebac zwidth --law direct,ebac --delay 1 --most-damping 50 --points 5`

    * `ebac zwidth --law ebac --delay 1 --points 2 --hands 3 --epsilon 0.002`: 21 random hands explore the wall, too

    * `ebac zwidth --law ebac --delay 2 --points 2 --change observed_reserve=0.005`: with a larger reserve beside it
    """
    import numpy as np

    from ebac.studies.zwidth import zwidth as search

    with output.refusing():
        laws = changed_laws.beside(by_name.laws(law or ["all"], many=True), change or [])
        base = from_options.scenario(hand, device, length, seconds=3.0)
        base = base.replace(**setting.given(seed=seed))
        _check(most_damping, least_stiffness, most_stiffness, epsilon)
        folder = to.folder("zwidth", as_json=as_json)
        interrupts.keeping(
            "nothing was written; the same command starts from the beginning, and fewer --law, --delay or --points "
            "take less time"
        )
        with output.counting("searching", quiet=as_json) as progress:
            found = search(
                laws, base=base, delays=delay or (0, 1, 2), dampings=np.linspace(0, most_damping, points),
                least_stiffness=least_stiffness, most_stiffness=most_stiffness,
                epsilon=epsilon, hands=hands, threads=threads, progress=progress,
            )  # fmt: skip
    to.report(
        folder, "zwidth", _document(found), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=lambda: _show(found),
    )  # fmt: skip


def _check(most_damping: float, least: float, most: float, epsilon: float) -> None:
    """Refuse numbers by the names of their options."""
    if not 0 < most_damping <= DAMPING:
        raise ValueError(
            f"--most-damping = {most_damping:g} N s/m: must lie in (0, {DAMPING:g}] N s/m"
        )
    if not 0 < most <= STIFFNESS:
        raise ValueError(f"--most-stiffness = {most:g} N/m: must lie in (0, {STIFFNESS:g}] N/m")
    if least <= 0:
        raise ValueError(
            f"--least-stiffness = {least:g} N/m: must lie in (0, {most:g}) N/m, below --most-stiffness"
        )
    if not least < most:
        raise ValueError(
            f"--most-stiffness = {most:g} N/m: must lie above --least-stiffness = {least:g} N/m, where the search "
            "begins; give another of the two"
        )
    if not 0 < epsilon <= ENERGY:
        raise ValueError(f"--epsilon = {epsilon:g} J: must lie in (0, {ENERGY:g}] J")


def _document(found: ZWidth) -> str:
    return output.document(
        "zwidth", found.rows(), epsilon_J=found.epsilon, hands=found.hands, most_stiffness_N_per_m=found.most_stiffness,
        scores=found.scores(), vibration=found.vibrations(),
    )  # fmt: skip


def _fill(draft: Path, found: ZWidth, to: ResultOptions) -> None:
    from ebac.plot import plot_zwidth

    to.save(plot_zwidth(found), draft, "zwidth")
    to.save(plot_zwidth(found, ("quiet", "still")), draft, "zwidth-still")
    output.csv_table(draft / "zwidth.csv", found.rows())
    output.csv_table(draft / "scores.csv", found.scores())
    output.csv_table(draft / "vibration.csv", found.vibrations())
    found.base.save(draft / "scenario.toml")


def _show(found: ZWidth) -> None:
    from ebac._util import descriptions
    from ebac.studies.families import PULL
    from ebac.studies.zwidth import CRITERIA

    output.say(
        "Area of the walls that each law renders: stiffness times damping, in kN/m N s/m. Delay in samples.",
        style="bold",
    )
    grid = output.table(
        [
            "delay",
            "law",
            *CRITERIA,
            "share",
            "stiffest",
            "usable walls end by",
        ],
        numbers=range(2, 4 + len(CRITERIA)),
    )
    full, most = found.most_stiffness / 1e3, found.dampings[-1]
    words: set[str] = set()
    for number, delay in enumerate(found.delays):
        if number:
            grid.add_section()
        blank = " " * 8 * ("direct" in found.laws)
        linear = f"{found.area('spectral', '', delay) / 1e3:.0f}{blank}"
        grid.add_row(str(delay), "linear loop, no law", linear)
        for row in found.scores():
            if row["delay_samples"] == delay:
                ends = Counter(found.ended_by(row["law"], delay))
                cells = (_cell(row, name, beside="direct" in found.laws) for name in CRITERIA)
                share = f"{100 * row['usable_share']:.0f} %"
                stiffest = float(found.limits["usable"][found.laws.index(row["law"]), number, 0])
                grid.add_row(
                    str(delay),
                    row["law"],
                    *cells,
                    share,
                    _stiffest(stiffest, found.most_stiffness),
                    _ended(ends),
                )
                words |= set(ends)
    output.show(grid)
    beside = " In brackets, times that of direct." if "direct" in found.laws else ""
    output.say(
        f"Both axes are linear, up to {full:g} kN/m and {most:g} N s/m: {full * most:.0f} kN/m N s/m is all of it. "
        f"Share: the part of it that is usable.{beside} "
        f"Stiffest: the stiffest usable wall with a damping of {found.dampings[0]:g} N s/m. "
        f"What walls end by is counted over {len(found.dampings)} wall dampings{_explained(words, full)}."
    )
    if found.hands:
        output.say(
            f"Energy and usable hold for {found.random_hands} as well; one that pulls harder than {PULL:g} N is not "
            "counted."
        )
    for sentence in _none_because(found):
        output.say(sentence)
    zwidth_vibration.show(found)
    output.say(
        "Simulation. Wall stiffness, wall damping and delay vary as above; everything else:",
        style="bold",
    )
    output.indented(_shared(descriptions.describe(found.base)).replace("; ", "\n"))


def _none_because(found: ZWidth) -> list[str]:
    """Return why a law has no stiffest wall, a sentence for each law and reason: it fails at the softest already."""
    from ebac.studies.zwidth.result import TOO_SOFT, VIBRATION

    why = {
        "limit cycle": "the handle swings on in a limit cycle",
        VIBRATION: "the force is not quiet, 3 detection thresholds or more",
        "energy": f"a hand draws more than {found.epsilon:g} J (--epsilon)",
        TOO_SOFT: "less than half of the stiffness is there at rest",
    }
    softest = f"{found.least_stiffness / 1e3:g} kN/m"
    without: dict[tuple[str, str], list[str]] = {}
    for i, law in enumerate(found.laws):
        for d, delay in enumerate(found.delays):
            if not found.limits["usable"][i, d, 0] > 0:
                end = found.ended_by(law, delay)[0]
                without.setdefault((law, end), []).append(str(delay))
    return [
        f"{law}, delay {', '.join(delays)}: none, since {softest} already fails: {why[end]}. Walls "
        "count up to the first that fails; the table below shows stiffer ones each by itself."
        for (law, end), delays in without.items()
    ]


def _shared(described: str) -> str:
    """Return the description of a scenario without what a search of walls varies."""
    return re.sub(
        r", \d+ samples? of delay", "", re.sub(r"; a wall of [^;]* at ", "; a wall at ", described)
    )


def _stiffest(limit: float, top: float) -> str:
    if limit >= top:
        return f"{top / 1e3:g} kN/m or more"
    return f"{limit / 1e3:.3g} kN/m" if limit > 0 else "none"


def _explained(words: set[str], full: float) -> str:
    """Return what the words for the end of a wall mean, of those that a table has."""
    from ebac.studies.zwidth.result import AT_TOP, TOO_SOFT, VIBRATION

    meanings = {
        VIBRATION: "the force is not quiet, as where the guard holds it back",
        TOO_SOFT: "a stiffer wall shows less than half of its stiffness at rest",
        AT_TOP: f"the search ends at {full:g} kN/m before any wall is lost (--most-stiffness)",
    }
    return "".join(f"; {word}: {meanings[word]}" for word in meanings if word in words)


def _ended(ends: Counter[str]) -> str:
    """Return what borders end by, most often first: "vibration 2, top 1"; one word where it is always the same."""
    if len(ends) == 1:
        return next(iter(ends))
    return ", ".join(f"{word} {n}" for word, n in ends.most_common())


def _cell(row: dict[str, Any], name: str, *, beside: bool) -> str:
    if not beside:
        return f"{row[f'{name}_area'] / 1e3:.0f}"
    times = row[f"{name}_times_direct"]
    behind = "" if times is None else f"({times:.1f})"
    return f"{row[f'{name}_area'] / 1e3:.0f} {behind:>7}"
