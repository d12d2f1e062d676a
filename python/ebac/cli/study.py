"""`ebac study`: laws over whole populations of hands under named conditions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import options, output, setting, study_results

if TYPE_CHECKING:
    from ebac.operators import Operators
    from ebac.studies import Study

DEFAULT_LAWS = ("direct", "tca", "eba", "ebac")
DEFAULT_OUT = Path("ebac-study")
_WHO, _WHAT, _RUN = "Population", "Laws and conditions", "Run"


def study(
    population: Annotated[
        str,
        typer.Option(
            help="grid60, random, or a CSV file with the columns m_kg, b_Ns_per_m, k_N_per_m, target_m and, as wanted, "
            "approach_m, tremor_m, tremor_Hz.",
            rich_help_panel=_WHO,
        ),
    ] = "grid60",
    hands: Annotated[
        int | None,
        typer.Option(
            help="How many random hands.", show_default="500", min=1, rich_help_panel=_WHO
        ),
    ] = None,
    seed: Annotated[
        int, typer.Option(help="Seed of random hands, noise and jitter.", rich_help_panel=_WHO)
    ] = 1,
    approach: Annotated[
        float | None,
        typer.Option(
            help="Way of every hand through free air before the wall [m]; default: 0.01, or as in the file.",
            show_default=False,
            rich_help_panel=_WHO,
        ),
    ] = None,
    law: Annotated[
        list[str] | None,
        typer.Option(
            "--law",
            "-l",
            help="A law by name, see `ebac laws`; repeat it for several, `all` for every law.",
            show_default=", ".join(DEFAULT_LAWS),
            rich_help_panel=_WHAT,
        ),
    ] = None,
    condition: Annotated[
        list[str] | None,
        typer.Option(
            "--condition",
            "-c",
            help="A condition by name or a group: five, cells, robustness, all; repeat it. see `ebac conditions`.",
            show_default="d1K10",
            rich_help_panel=_WHAT,
        ),
    ] = None,
    scenario: options.ScenarioFile = None,
    threads: options.Threads = None,
    out: Annotated[
        Path | None, options.out_folder("tables, figures and traces of failures", DEFAULT_OUT)
    ] = None,
    resume: Annotated[bool, options.resume("study")] = False,
    traces: Annotated[
        int,
        typer.Option(
            help="Most failures whose traces are kept.", min=0, max=10_000, rich_help_panel=_RUN
        ),
    ] = 20,
    as_json: output.AsJson = False,
) -> None:
    """Run laws with whole populations of hands under named conditions. A simulation.

    Good is a hand that rests within two encoder counts of the ideal, or where friction f_c holds it,
    f_c/(K0 + K) farther, and swings by less than 0.25 mm;
    in time, one that has settled within 1.5 times what it needs against an ideal wall, plus 0.2 s.

    **Examples**

    * `ebac study`: 60 hands against the paper's wall.

    * `ebac study --condition five --law ebac --population random --hands 500 --seed 7`

    * `ebac study --population hands.csv --condition slow-press --json`: your own hands.

    * `ebac study --condition all --law all --out big`, and after an interruption the same with `--resume`.
    """
    with output.refusing():
        names = setting.law_names(law or DEFAULT_LAWS)
        people = setting.population(population, hands, seed, approach)
        given: dict[str, Any] = {
            "base": setting.base_scenario(scenario),
            "conditions": condition or ["d1K10"],
            "seed": seed,
            "threads": threads,
        }
    folder = out or (None if as_json else DEFAULT_OUT)
    if resume and folder is None:
        output.fail("--resume continues in a folder: give it with --out")
    found = _run(people, names, given, folder, resume, quiet=as_json)
    files = study_results.write(folder, found, traces, quiet=as_json) if folder else []
    if as_json:
        typer.echo(study_results.document(found))
        return
    study_results.show(found)
    if folder is not None:
        output.list_files(folder, files)


def _run(
    people: Operators,
    names: list[str],
    given: dict[str, Any],
    folder: Path | None,
    resume: bool,
    *,
    quiet: bool,
) -> Study:
    from ebac.studies import study as run_study
    from ebac.sweeps import SweepInterrupted

    try:
        with output.refusing(), output.counting("simulating", quiet=quiet) as progress:
            bundles = None if folder is None else folder / study_results.BUNDLES
            return run_study(people, names, out=bundles, resume=resume, progress=progress, **given)
    except SweepInterrupted as stopped:
        more = f"; continue with --resume --out {folder}" if folder is not None else ""
        output.fail(f"{stopped}{more}", code=output.INTERRUPTED)
