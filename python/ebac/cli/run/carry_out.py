"""What `ebac run` does once all is chosen: the run on either clock, its log, its result or its end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from ebac.cli import interrupts, output
from ebac.cli.drive.options import reporting
from ebac.cli.files import FigureOptions
from ebac.cli.run import engine, results
from ebac.cli.run.confirm import confirm

if TYPE_CHECKING:
    from ebac.hardware import Configuration, OpenDevice, Run
    from ebac.hardware.schedule import Schedule
    from ebac.simulation import LoopFault
    from ebac.trace import Trace
    from ebac.worlds import EngineProcess


def run_in_real_time(
    known: Configuration,
    how: dict[str, bool],
    yes: bool,
    stem: Path | None,
    live: bool,
    as_json: bool,
    schedule: Schedule,
    style: FigureOptions,
    process: EngineProcess | None,
    first: tuple[str, ...],
) -> None:
    """Run on drives, real or simulated, on the real clock, and give what a run gives.

    `process` computes the world; `first` is what --first changed.
    """
    from ebac.hardware import OpenDevice
    from ebac.simulation import LoopFault

    log = None if stem is None else stem.with_suffix(".mcap")
    fault: LoopFault | None = None
    with reporting():
        with OpenDevice.open(known, **how) as device:
            confirm(device, yes, stderr=as_json)
            try:
                trace = _watched(device, log, live, schedule, engine.watch(process))
            except LoopFault as error:
                fault, trace = error, error.trace
            except BaseException:
                _show_end(device, as_json)
                raise
            finally:
                _keep(log)
        report, place = device.report, device.backend
    assert report is not None
    with output.refusing():
        result = results.Result.of(
            known,
            trace,
            report,
            place.about,
            how["simulate"],
            fault,
            changed=bool(schedule.orders),
            process=process,
        )
    give(replace(result, first_run=first), stem, as_json, style, fault)


def _keep(log: Path | None) -> None:
    """From here on, whatever ends the command: the log is there."""
    if log is not None and log.exists():
        interrupts.keeping(
            f"look at the rows with `ebac log info {log}`, plot them with `ebac log plot {log}`"
        )


def run_virtual(
    known: Configuration,
    stem: Path | None,
    as_json: bool,
    style: FigureOptions,
    *,
    bus_time: bool,
    first: tuple[str, ...],
) -> None:
    """Run the same on a virtual clock and give what a run gives."""
    from ebac._util.atomic_file import draft
    from ebac.logs.about import CONFIGURATION_FILE
    from ebac.logs.files import write_mcap
    from ebac.simulation import LoopFault

    log = None if stem is None else stem.with_suffix(".mcap")
    fault: LoopFault | None = None
    with reporting():
        try:
            trace = known.simulate(bus_time=bus_time)
        except LoopFault as error:
            fault, trace = error, error.trace
        if log is not None:
            with draft(log) as file:
                write_mcap(trace, file, files={CONFIGURATION_FILE: known.text})
            _keep(log)
        result = results.Result.of_virtual(known, trace, log, fault)
    give(replace(result, first_run=first), stem, as_json, style, fault)


def give(
    result: results.Result,
    stem: Path | None,
    as_json: bool,
    style: FigureOptions,
    fault: LoopFault | None,
) -> None:
    """Write and print the result; a fault ends the command."""
    from ebac.hardware.lateness import explained

    files = results.write(result, stem, style)
    if as_json:
        typer.echo(result.document())
    else:
        results.show(result)
        if stem is not None:
            output.list_files(stem.parent, files)
    if fault is not None:
        log = result.report.log
        kept = "" if log is None else f"; its rows are in {log}"
        other = "--virtual instead of --simulated runs it on a virtual clock"
        text = explained(fault, other if result.simulated else "", file=result.configuration.name)
        output.fail(f"{text}{kept}", code=output.FAILED)
    if result.engine is not None and not result.engine.lasted:
        raise typer.Exit(output.FAILED)  # its own sentence stands above


def _show_end(device: OpenDevice, as_json: bool) -> None:
    """Say on what a run ended that gives no result, and that nothing has power."""
    report = device.report
    if report is None:
        return
    console = output.console(stderr=as_json)
    states = ", ".join(report.drives) or "not known"
    kept = (
        "" if report.log is None else f"; {output.plural(report.recorded, 'row')} in {report.log}"
    )
    console.print(
        f"Ended by {report.ended_by}. Drives after it: {states}{kept}.",
        soft_wrap=True,
        markup=False,
    )


def _watched(
    device: OpenDevice,
    log: Path | None,
    live: bool,
    schedule: Schedule,
    watch: Callable[[Run], None],
) -> Trace:
    from ebac.cli.run.any_key import any_key
    from ebac.cli.run.live import view

    with view(device.configuration, shown=live) as picture, any_key() as key:

        def look(run: Run) -> None:
            key(run)
            schedule.look(run)
            watch(run)
            picture(run)

        return device.run(log=log, look=look)
