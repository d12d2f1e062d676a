"""`ebac wall`: the paper's virtual wall under several laws."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import options, output, setting, wall_results

if TYPE_CHECKING:
    from ebac.scenario import Scenario
    from ebac.trace import Trace

DEFAULT_LAWS = ("tca", "eba", "ebac")
DEFAULT_OUT = Path("ebac-wall")
#: Fewer rows have no tail to measure; more belong into a script, their logs would fill gigabytes.
TICKS = (10, 2_000_000)


def wall(
    law: options.Law = None,
    stiffness: options.Stiffness = None,
    damping: options.Damping = None,
    position: options.Position = None,
    hand: options.HandName = None,
    mass: options.Mass = None,
    hand_damping: options.HandDamping = None,
    hand_stiffness: options.HandStiffness = None,
    target: options.Target = None,
    device: options.DeviceName = None,
    noise: options.Noise = None,
    permille: options.Permille = None,
    rate: options.Rate = None,
    delay: options.Delay = None,
    jitter: options.Jitter = None,
    through: options.Through = None,
    seconds: options.Seconds = None,
    seed: options.Seed = None,
    scenario: options.ScenarioFile = None,
    out: Annotated[
        Path | None, options.out_folder("table, figure, logs and scenario", DEFAULT_OUT)
    ] = None,
    log: Annotated[
        Path | None,
        typer.Option(
            "--log",
            help="Also write the rows to this file: .mcap (PlotJuggler, Foxglove), .npz, .csv, .parquet, .mat or .h5; "
            "with several laws, run.mcap becomes run-tca.mcap, run-eba.mcap, ...",
            show_default=False,
        ),
    ] = None,
    no_files: Annotated[bool, typer.Option("--no-files", help="Write no files.")] = False,
    as_json: output.AsJson = False,
) -> None:
    """Press a hand against a virtual wall under several laws (paper, Fig. 10 and 11). A simulation.

    The table tells where each law comes to rest, how far it swings, when it has settled and how
    little energy its port ever held. A law that keeps its promise is *exact and quiet*.

    **Examples**

    * `ebac wall`: the paper's experiment. TCA swings, EBA rests too deep, EBAC does neither.

    * `ebac wall --law all --stiffness 20000 --delay 2`: every law, 20 kN/m, 2 ms of delay.

    * `ebac wall --hand finger --target 0.02 --json`: a finger pressing to 20 mm, as JSON.

    * `ebac wall --law ebac --log ebac.mcap`: a log for PlotJuggler or Foxglove.

    * `ebac wall --through can`: the same over a CAN bus, through simulated drives.

    * `ebac wall --scenario ebac-wall/scenario.toml --seed 7`: the same again, another seed.
    """
    if no_files and out is not None:
        output.fail("--no-files and --out exclude each other: leave one of them out")
    with output.refusing():
        names = setting.law_names(law or DEFAULT_LAWS)
        logs = wall_results.log_names(log, names)
        base = setting.base_scenario(scenario)
        chosen = base.replace(
            device=setting.choose_device(base.device, device, noise=noise, permille=permille),
            hand=setting.choose_hand(
                base.hand, hand, target, mass=mass, damping=hand_damping, stiffness=hand_stiffness
            ),
            environment=setting.choose_wall(
                base.environment, stiffness=stiffness, damping=damping, position=position
            ),
            timing=setting.choose_timing(base.timing, rate, delay),
            **setting.given(jitter=jitter, seconds=seconds, seed=seed),
        )
        _check_length(chosen)
        warning = ""
        if through is not None:
            chosen, warning = _on_bus(chosen, through)
    if warning and not as_json:
        output.say(f"Warning: {warning}.", style="yellow")
    folder = None if no_files else out or (None if as_json else DEFAULT_OUT)
    _run(chosen, names, through, folder, logs, as_json)


def _on_bus(scenario: Scenario, through: str) -> tuple[Scenario, str]:
    """Return the scenario as drives on a bus run it, and what to be warned of."""
    from ebac.simulation import on_bus

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        chosen = on_bus(scenario, through)
    return chosen, str(caught[0].message) if caught else ""


def _check_length(scenario: Scenario) -> None:
    ticks = scenario.seconds / scenario.timing.dt + 1
    if not TICKS[0] <= ticks <= TICKS[1]:
        raise ValueError(
            f"{scenario.seconds:g} s at {1 / scenario.timing.dt:g} Hz are {ticks:.0f} ticks: must "
            f"be {TICKS[0]} to {TICKS[1]}; change --seconds or --rate"
        )


def _run(
    scenario: Scenario,
    names: list[str],
    through: str | None,
    out: Path | None,
    logs: list[Path],
    as_json: bool,
) -> None:
    from ebac.metrics import contact
    from ebac.simulation import LoopFault

    files: list[str] = []
    steps = len(names) * (1 if out is None else 2) + (out is not None) + len(logs)
    try:
        with (
            output.results(out) as draft,
            output.progress(steps, quiet=as_json) as step,
        ):
            with output.refusing():
                traces = _simulate(scenario, names, through, step)
                contacts = [contact(trace) for trace in traces]
            text = wall_results.document(scenario, contacts, through)
            if draft is not None:
                files = wall_results.write(draft, scenario, traces, text, step)
            wall_results.write_logs(logs, traces, step)
    except LoopFault as fault:
        wall_results.report_fault(fault, out)
    if as_json:
        typer.echo(text)
        return
    wall_results.show(scenario, contacts, through)
    if out is not None:
        output.list_files(out, files)
    for path in logs:
        output.say(f"Log: {path}")


def _simulate(
    scenario: Scenario, names: list[str], through: str | None, step: Callable[[str], None]
) -> list[Trace]:
    from ebac.simulation import simulate

    traces = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # the load of the bus has been told
        for name in names:
            step(f"simulating {name}")
            traces.append(simulate(scenario, name, through=through))
    return traces
