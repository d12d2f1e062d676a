"""`ebac study`: laws over whole populations of hands under named conditions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import by_name, changed_laws, doubtful, from_options, interrupts, options, output
from ebac.cli.files import PANEL, ResultOptions
from ebac.cli.studies import replaced, study_results

if TYPE_CHECKING:
    from ebac.laws import AnyLaw
    from ebac.operators import Operators
    from ebac.studies import Study

_WHAT = "Laws and conditions"


def study(
    to: ResultOptions,
    device: options.DeviceOptions,
    length: options.RunOptions,
    hands: options.PopulationOptions,
    approach: Annotated[
        float | None,
        typer.Option(
            help="Distance every hand moves through free air before the wall [m].",
            show_default="0.01, or as in the file",
            rich_help_panel=options.POPULATION,
        ),
    ] = None,
    law: Annotated[
        list[str] | None, options.laws("direct, tca, tca-damped, eba, ebac", panel=_WHAT)
    ] = None,
    change: changed_laws.Change = None,
    condition: Annotated[
        list[str] | None,
        options.conditions(
            "A condition or a group of them, see `ebac conditions`, or one written out, such as d2K15, or K15 to "
            "change the stiffness of the wall only; several separated by commas.",
            panel=_WHAT,
            default=options.USUAL_CONDITION,
        ),
    ] = None,
    threads: options.Threads = None,
    resume: Annotated[bool, options.resume("study")] = False,
    traces: Annotated[
        int | None,
        typer.Option(
            help="Largest number of failures whose traces are kept.",
            show_default="one of each law and condition, 20 at most",
            min=0,
            max=10_000,
            rich_help_panel=PANEL,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Simulate laws with many different hands and conditions.

    A simulation. A hand is good when it rests within two encoder counts of the ideal (with friction f_c, within
    f_c/(K0 + K) more), swings by less than 0.25 mm, and its force settles and vibrates by less than three detection
    thresholds (quiet force). "Exact, still" does not judge the force. Such a hand is in time when it settles within
    1.5 times the time that it needs at an ideal wall, plus 0.2 s.

    **Examples**

    * `ebac study`: 60 hands against the paper's wall

    * `ebac study --condition five --law ebac --population random --hands 500`

    * `ebac demo hands`, then `ebac study --population hands.csv --json`: your own hands

    * `ebac study --law tca-damped --change kp=0 --change kp=0,virtual_damping=60`: a law with other parameters

    * `ebac study --law ebac --out big`, and after Ctrl-C the same with `--resume`
    """
    from ebac.studies.study import LAWS

    with output.refusing():
        laws = changed_laws.beside(by_name.laws(law or LAWS, many=True), change or [])
        people = hands.operators(approach)
        given: dict[str, Any] = {
            "base": from_options.scenario(device, length),
            "conditions": by_name.condition_names(condition or [options.usual_condition(length)]),
            "seed": hands.seed,
            "threads": threads,
        }
        replaced.note(given["base"], given["conditions"])
        doubtful.note_weak_motor(people, given["base"])
        doubtful.note_short(given["base"])
    folder = to.folder("study", as_json=as_json, resume=study_results.BUNDLES * resume)
    found = _run(people, laws, given, folder, resume, quiet=as_json)
    to.report(
        folder, "study", found.to_json(), as_json=as_json,
        fill=lambda draft: study_results.fill(draft, found, traces, to, quiet=as_json),
        show=lambda: study_results.show(found, files=folder is not None),
    )  # fmt: skip


def _run(
    people: Operators,
    laws: Mapping[str, AnyLaw],
    given: dict[str, Any],
    folder: Path | None,
    resume: bool,
    *,
    quiet: bool,
) -> Study:
    from ebac.studies import study as run_study

    with (
        interrupts.resumable(folder),
        output.refusing(folder),
        output.counting("simulating", quiet=quiet) as progress,
    ):
        bundles = None if folder is None else folder / study_results.BUNDLES
        return run_study(people, laws, out=bundles, resume=resume, progress=progress, **given)
