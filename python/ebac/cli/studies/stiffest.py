"""`ebac stiffest`: the stiffest wall up to which each law holds for all hands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac._util.doubts.wall import MOST
from ebac.cli import (
    by_name,
    changed_laws,
    doubtful,
    from_options,
    interrupts,
    options,
    output,
)
from ebac.cli.files import ResultOptions
from ebac.cli.studies import study_results

if TYPE_CHECKING:
    from ebac.scenario import Scenario
    from ebac.studies import Stiffest, StiffestRow


@dataclass(frozen=True, kw_only=True)
class _Run(options.RunOptions):
    wall_damping: Annotated[
        float | None,
        options.option(text="Damping B of the wall [N s/m]", default="0", panel=options.WALL),
    ] = None
    delay: options.Delay = None


def stiffest(
    to: ResultOptions,
    device: options.DeviceOptions,
    run: _Run,
    hands: options.PopulationOptions,
    law: Annotated[list[str] | None, options.laws("all")] = None,
    change: changed_laws.Change = None,
    wall_stiffness: Annotated[
        list[float] | None,
        typer.Option(
            help="Stiffnesses of the walls to try [N/m]; several separated by commas.",
            show_default="13, 1000 to 100000",
            rich_help_panel=options.WALL,
        ),
    ] = None,
    share: Annotated[
        float,
        typer.Option(
            help="Share of the hands for which a wall must hold, above 0 and at most 1.",
            rich_help_panel=options.POPULATION,
        ),
    ] = 1.0,
    threads: options.Threads = None,
    resume: Annotated[bool, options.resume("search")] = False,
    as_json: output.AsJson = False,
) -> None:
    """Find the stiffest wall up to which each law holds for all hands.

    A simulation of walls from soft to stiff, all else as in the scenario. Criteria, as in `ebac study`: *exact, still*
    judges the position; *good*, the force is quiet, too; *good, in time*, and settled soon. A law's stiffest wall is
    the last one before the first that fails: it may lose a soft wall and hold a stiffer one, which is then named below
    the table. Beside it stands the most energy that any hand draws there, and the stiffness on impact: a wall may be
    exact at rest and give way when the hand arrives. The law that is good up to the stiffest wall is first.

    **Examples**

    * `ebac stiffest`: all laws on the reference device, 60 hands

    * `ebac stiffest --law ebac --wall-stiffness 5000,10000,20000`: three walls, in seconds

    * `ebac stiffest --law tca-damped --change kp=0 --delay 2 --wall-stiffness 5000,10000`: a damper alone beside it

    * `ebac stiffest --law all --no-device-sensor --share 0.95`: no force sensor, and 3 of the 60 hands may be lost
    """
    from ebac.studies.stiffest import LADDER

    with output.refusing():
        laws = changed_laws.beside(by_name.laws(law or ["all"], many=True), change or [])
        _check(share, wall_stiffness or ())
        base = from_options.scenario(device, run)
        _check_wall(base, run.scenario)
        given: dict[str, Any] = {
            "population": hands.operators(),
            "base": base,
            "share": share,
            "seed": hands.seed,
            "threads": threads,
            **({"stiffnesses": wall_stiffness} if wall_stiffness else {}),
        }
        doubtful.note_weak_motor_at(wall_stiffness or LADDER, given["population"], base)
        doubtful.note_short(given["base"])
    folder = to.folder("stiffest", as_json=as_json, resume=study_results.BUNDLES * resume)
    found = _run(laws, given, folder, resume, quiet=as_json)
    to.report(
        folder, "stiffest", found.to_json(), as_json=as_json,
        fill=lambda draft: _fill(draft, found, to), show=lambda: _show(found),
    )  # fmt: skip


def _check_wall(base: Scenario, file: Path | None) -> None:
    """Refuse a world whose stiffness the search cannot set."""
    from ebac._core import Wall

    if not isinstance(base.environment, Wall):
        raise ValueError(
            f"--scenario {file}: its environment is a {type(base.environment).__name__}, and this search sets the "
            'stiffness of a Wall; give [environment] the type = "Wall", or leave [environment] out; `ebac study '
            "--approach 0` and `ebac random-worlds` take bodies"
        )


def _check(share: float, stiffnesses: Sequence[float]) -> None:
    """Refuse numbers by the names of their options."""
    from ebac.studies.stiffest import require_share

    require_share("--share", share)
    for stiffness in stiffnesses:
        if not 0 < stiffness <= MOST:
            raise ValueError(f"--wall-stiffness = {stiffness:g} N/m: must lie in (0, {MOST:g}] N/m")
        doubtful.note_stiffness(stiffness)


def _run(
    laws: Any, given: dict[str, Any], folder: Path | None, resume: bool, *, quiet: bool
) -> Stiffest:
    from ebac.studies import stiffest as search

    with (
        interrupts.resumable(folder),
        output.refusing(folder),
        output.counting("simulating", quiet=quiet) as progress,
    ):
        bundles = None if folder is None else folder / study_results.BUNDLES
        return search(laws, out=bundles, resume=resume, progress=progress, **given)


def _fill(draft: Path, found: Stiffest, to: ResultOptions) -> None:
    to.save(found.plot(), draft, "stiffest")
    found.save(draft / "stiffest.csv")
    output.csv_table(draft / "walls.csv", found.walls())
    study_results.write_failures(draft / "failures.csv", found.study)
    found.study.operators.to_csv(draft / "population.csv")
    found.study.result().to_csv(draft / "runs.csv")
    found.base.save(draft / "scenario.toml")


def _show(found: Stiffest) -> None:
    from ebac._util import descriptions, formatting

    output.say(
        f"Stiffest wall [kN/m] up to which {found.needed} of {found.hands} hands are exact and still, good, good in "
        "time; beside it what is drawn there, how soon it settles, and its stiffness on impact.",
        style="bold",
    )
    headings = [
        "law",
        "exact, still",
        "good",
        "drawn",
        "settled",
        "on impact",
        "good, in time",
        "drawn",
        "on impact",
    ]
    grid = output.table(headings, numbers=range(1, len(headings)))
    for row in found.rows:
        grid.add_row(
            row.law,
            _kilo(found, row, "exact_and_still"),
            _kilo(found, row, "good"),
            formatting.quantity(row.good_drawn_J, "J"),
            formatting.quantity(row.good_settled_s, "s"),
            formatting.quantity(row.good_impact_share, "share"),
            _kilo(found, row, "good_in_time"),
            formatting.quantity(row.good_in_time_drawn_J, "J"),
            formatting.quantity(row.good_in_time_impact_share, "share"),
        )
    output.show(grid)
    _show_hands(found)
    _show_again(found)
    _show_exact_only(found)
    _show_next_step(found)
    output.say(
        f"{_up_to_which(found)} Drawn: most energy that any hand draws in any window at that wall. Settled: median of "
        "the hands that settle there. On impact: the force where a hand goes deepest, over that of the wall there, in "
        "the median; below 50 % a wall is soft on impact, however stiff it is at rest."
    )
    if "good_in_time" not in found.counts:
        output.say(
            "In time is not judged: the time at an ideal wall is known on straight axes only."
        )
    output.say("Simulated, not measured. Stiffness and hand vary; everything else:", style="bold")
    device, _, *others = descriptions.describe(found.base).split("; ")
    output.indented("\n".join([device, *others[-2:]]))


def _show_hands(found: Stiffest) -> None:
    """Print how many hands are not good, and how many of the good ones are late, at each wall under each law."""
    timed = found.late is not None
    output.say(
        f"Of {found.hands} hands at each wall [kN/m]: how many are not good{', + good but late' if timed else ''}.",
        style="bold",
    )
    headings = [f"{1e-3 * stiffness:g}" for stiffness in found.stiffnesses]
    grid = output.table(["law", *headings], numbers=range(1, 1 + len(headings)))
    laws = list(found.study.laws)
    for row in found.rows:
        i = laws.index(row.law)
        late = [f" + {n}" if n else "" for n in found.late[i]] if found.late is not None else []
        cells = [f"{n}{more}" for n, more in zip_longest(found.not_good[i], late, fillvalue="")]
        grid.add_row(row.law, *cells)
    output.show(grid)


def _up_to_which(found: Stiffest) -> str:
    """Return what a wall in the table and "none" mean."""
    softest, walls = f"{1e-3 * found.stiffnesses[0]:g} kN/m", len(found.stiffnesses)
    if walls == 1:
        return f"The one wall tried, {softest}, holds where it is named; none (N): it fails, by N hands."
    return (
        f"Up to which: all softer ones of the {walls} walls tried hold, too; none (N): the softest, {softest}, fails, "
        "by N hands."
    )


def _show_again(found: Stiffest) -> None:
    """Name the stiffer walls at which a law is good though it fails at a softer one."""
    for law, walls in found.again("good").items():
        if walls:
            named = ", ".join(f"{1e-3 * wall:g}" for wall in walls)
            output.say(f"{law}: good at {named} kN/m, too, beyond a softer wall that fails.")


def _show_exact_only(found: Stiffest) -> None:
    """Say what the stiffest exact wall is like under laws that are good at none."""
    from ebac._util import formatting

    for row in found.rows:
        if row.good_N_per_m is None and row.exact_and_still_N_per_m is not None:
            output.say(
                f"{row.law}: at {1e-3 * row.exact_and_still_N_per_m:g} kN/m, exact and still, not quiet in force, "
                f"{formatting.quantity(row.exact_and_still_drawn_J, 'J')} are drawn, and it settles in "
                f"{formatting.quantity(row.exact_and_still_settled_s, 's')}, "
                f"{formatting.quantity(row.exact_and_still_impact_share, 'share')} on impact."
            )


def _show_next_step(found: Stiffest) -> None:
    """Say what to try where no law is good at any wall for as many hands as were asked for."""
    if any(row.good_N_per_m is not None for row in found.rows):
        return
    tries = []
    if found.share > 0.95:
        tries.append("--share 0.95, which leaves out 5 % of the hands")
    if not found.base.device.sensor.fitted:
        tries.append("a force sensor")
    if found.base.device.mechanics.coulomb == 0:
        tries.append("friction, if the device has some: [device.mechanics] coulomb")
    if tries:
        output.say(f"No law is good here. What may change that: {'; '.join(tries)}.")


def _kilo(found: Stiffest, row: StiffestRow, criterion: str) -> str:
    """Return the stiffest wall of a law [kN/m], or how many hands fail already at the softest."""
    stiffness = getattr(row, f"{criterion}_N_per_m")
    if stiffness is not None:
        return f"{1e-3 * stiffness:g}{' or more' if stiffness == found.stiffnesses[-1] else ''}"
    if criterion not in found.counts:
        return "none"
    return (
        f"none ({found.hands - found.counts[criterion][list(found.study.laws).index(row.law), 0]})"
    )
