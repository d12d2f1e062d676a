"""`ebac wall`: the paper's virtual wall under several laws."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import (
    by_name,
    changed_laws,
    doubtful,
    engine_options,
    from_options,
    options,
    output,
)
from ebac.cli.files import PANEL, ResultOptions
from ebac.cli.wall import results as wall_results

if TYPE_CHECKING:
    from ebac.laws import AnyLaw
    from ebac.scenario import Scenario
    from ebac.trace import Trace

DEFAULT_LAWS = ("tca", "tca-damped", "eba", "ebac")
#: Fewer rows have no tail to measure; more belong into a script, their logs would fill gigabytes.
TICKS = (10, 2_000_000)


def wall(
    setup: options.ScenarioOptions,
    engine: engine_options.EngineOptions,
    to: ResultOptions,
    law: Annotated[list[str] | None, options.laws(", ".join(DEFAULT_LAWS))] = None,
    change: changed_laws.Change = None,
    through: Annotated[
        str | None,
        options.option(
            text="What lies between loop and plant: `can` for a CAN bus with simulated drives, which take torque in "
            "whole thousandths: to the bit the run without a bus with --device-permille, as long as no i2t limit of a "
            "drive acts",
            default="nothing",
            panel=options.RUN,
        ),
    ] = None,
    log: Annotated[
        Path | None,
        typer.Option(
            "--log",
            help="Also write the rows to this file: .mcap (PlotJuggler, Foxglove), .npz, .csv, .parquet, .mat or .h5; "
            "with several laws, run.mcap becomes run-tca.mcap, run-eba.mcap, ...",
            show_default=False,
            rich_help_panel=PANEL,
        ),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Simulate a hand at a virtual wall under several laws.

    The experiment of the paper, Fig. 10 and 11, in simulation. The table shows for each law where the hand comes to
    rest, how far it swings, when it has settled, and the least energy of the port. A good law is *exact and quiet*.

    **Examples**

    * `ebac wall`: the paper's experiment. TCA swings, damped TCA is not quiet in force, EBA rests too deep; EBAC is
      exact and quiet.

    * `ebac wall --law all --wall-stiffness 20000 --delay 2`: every law

    * `ebac wall --law ebac --change guard=off --change fast_stiffness=0`: a law beside itself with other parameters

    * `ebac wall --hand finger --hand-target 0.02 --json`: a finger, as JSON

    * `ebac wall --law ebac --log ebac.mcap`: a log for PlotJuggler or Foxglove

    * `ebac wall --world sphere --engine-rate 60 --engine-jitter 0.01`: a world that is computed 60 times per second

    * `ebac wall --through can`: over a CAN bus, with simulated drives

    * `ebac wall --format pdf --width single --no-title`: a figure for a journal's column

    * `ebac wall --out first`, then `ebac wall --scenario first/scenario.toml --seed 7`: another seed
    """
    with output.refusing():
        laws = changed_laws.beside(by_name.laws(law or DEFAULT_LAWS), change or [])
        logs = wall_results.log_names(log, list(laws), force=to.force)
        chosen = from_options.scenario(setup, engine)
        doubtful.note_start(setup.wall_position, setup.scenario, chosen)
        _check_length(chosen)
        warning = ""
        if through is not None:
            chosen, warning = _on_bus(chosen, through)
    folder = to.folder("wall", as_json=as_json)
    if warning and not as_json:
        output.say(f"Warning: {warning}.", style="yellow")
    _run(chosen, laws, through, folder, logs, to, as_json)


def _on_bus(scenario: Scenario, through: str) -> tuple[Scenario, str]:
    """Return the scenario as drives on a bus run it, and what to be warned of."""
    from ebac.simulation import on_bus

    if through != "can":
        raise ValueError(f"--through {through}: must be can, or left out")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        chosen = on_bus(scenario, through)
    return chosen, str(caught[0].message) if caught else ""


def _check_length(scenario: Scenario) -> None:
    ticks = scenario.seconds / scenario.timing.dt + 1
    if not TICKS[0] <= ticks <= TICKS[1]:
        raise ValueError(
            f"{scenario.seconds:g} s at {1 / scenario.timing.dt:g} Hz are {ticks:.0f} ticks: must "
            f"lie in [{TICKS[0]}, {TICKS[1]}]; change --seconds or --rate"
        )


def _run(
    scenario: Scenario,
    laws: Mapping[str, AnyLaw],
    through: str | None,
    out: Path | None,
    logs: list[Path],
    to: ResultOptions,
    as_json: bool,
) -> None:
    from ebac.metrics import contact
    from ebac.simulation import LoopFault

    files: list[str] = []
    steps = len(laws) * (1 if out is None else 2) + (out is not None) + len(logs)
    try:
        with (
            output.results(out) as draft,
            output.progress(steps, quiet=as_json) as step,
        ):
            with output.refusing():
                traces = _simulate(scenario, laws, through, step)
                contacts = [contact(trace) for trace in traces]
                bodies = wall_results.in_world(traces)
            text = wall_results.document(scenario, contacts, through, bodies)
            if draft is not None:
                files = wall_results.write(draft, scenario, traces, text, to, step)
            wall_results.write_logs(logs, traces, step)
    except LoopFault as fault:
        wall_results.report_fault(fault, out)
    for trace in traces:
        doubtful.note_left(trace)
    doubtful.note_untouched(scenario, contacts)
    if as_json:
        typer.echo(text)
        return
    wall_results.show(
        scenario, contacts, through, bodies, limited=wall_results.limited_by_i2t(traces)
    )
    wall_results.show_fallbacks(traces)
    if out is not None:
        output.list_files(out, files)
    for path in logs:
        output.say("Log:", style="bold")
        output.path(path)


def _simulate(
    scenario: Scenario, laws: Mapping[str, AnyLaw], through: str | None, step: Callable[[str], None]
) -> list[Trace]:
    from ebac.simulation import simulate

    traces = []
    for name, law in laws.items():
        step(f"simulating {name}")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            trace = simulate(scenario, law, through=through)
        trace.law = name  # with what was changed of it
        traces.append(trace)
        for one in caught:
            if "engine" in str(one.message):  # the load of the bus has been reported
                output.console(stderr=True).print(
                    f"Warning: {name}: {one.message}.", style="yellow"
                )
    return traces
