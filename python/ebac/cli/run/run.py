"""`ebac run`: a law on the device, or on a simulated one, in real time."""

from __future__ import annotations

import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import options, output, run_results, setting
from ebac.cli.drive_options import telling

if TYPE_CHECKING:
    from ebac.hardware import Configuration, OpenDevice, Run
    from ebac.hardware.schedule import Schedule
    from ebac.trace import Trace

DEFAULT_OUT = Path("ebac-run")
_OWN = "as the configuration says"


def run(
    configuration: Annotated[
        Path, typer.Argument(help="The device and the run, in TOML: examples/joystick.toml.")
    ],
    simulated: Annotated[
        bool,
        typer.Option(
            "--simulated",
            help="On simulated drives, device and hand; clock, thread and bus are real.",
        ),
    ] = False,
    law: Annotated[
        str | None,
        typer.Option("--law", "-l", help="A law by name, see `ebac laws`.", show_default=False),
    ] = None,
    stiffness: Annotated[
        float | None, options.option("--stiffness", "Stiffness K of the wall [N/m]", _OWN, "Wall")
    ] = None,
    damping: Annotated[
        float | None, options.option("--damping", "Damping B of the wall [N s/m]", _OWN, "Wall")
    ] = None,
    position: Annotated[
        float | None, options.option("--position", "Where its surface is [m]", _OWN, "Wall")
    ] = None,
    hand: Annotated[
        str | None,
        options.option("--hand", "The simulated hand by name, see `ebac presets`", _OWN, "Hand"),
    ] = None,
    target: Annotated[
        float | None, options.option("--target", "Where it wants to be [m]", _OWN, "Hand")
    ] = None,
    rate: Annotated[
        float | None, options.option("--rate", "Ticks per second [Hz]", _OWN, "Run")
    ] = None,
    seconds: Annotated[
        float | None, options.option("--seconds", "How long the law acts [s]", _OWN, "Run")
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            help="Change parameters while it runs: the time [s], then law.NAME=NUMBER, environment.NAME=NUMBER or, "
            "simulated, hand.target=NUMBER. May be given several times.",
            show_default=False,
            rich_help_panel="Run",
        ),
    ] = None,
    out: Annotated[Path | None, options.out_folder("log, figure and numbers", DEFAULT_OUT)] = None,
    no_files: Annotated[bool, typer.Option("--no-files", help="Write no files, no log.")] = False,
    live: Annotated[
        bool | None,
        typer.Option(
            "--live/--no-live",
            help="Show force, position, load, lateness and faults while it runs.",
            show_default="live in a terminal",
        ),
    ] = None,
    detached: Annotated[
        bool,
        typer.Option("--detached", help="Go on when the program that started this one has died."),
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Run a law on a device in real time.

    **The motors get power and the device moves.**

    The drives are checked against their profiles, enabled, run under the law for the time asked, and left without
    power, however it ends: Ctrl-C, a closed terminal, a fault, the death of the program that started this one.
    A fault gives exit code 1 and the last rows stay in the log.

    With `--simulated` nothing moves: the drives, the device and the hand are simulated, in another process on a
    virtual CAN interface where there is one (`ip link add vcan0 type vcan`), else in a thread of this process. All the
    rest is what runs on hardware.

    **Examples**

    * `ebac run examples/joystick.toml --simulated`: ten seconds at the wall, without hardware.

    * `ebac run examples/joystick.toml --simulated --law tca --stiffness 20000`: what plain torque control does there.

    * `ebac run my-joystick.toml --seconds 60 --out session-3`: a minute on the device of that file.

    * `ebac run examples/joystick.toml --simulated --at "3 environment.stiffness=2e4" --at "6 hand.target=0"`: a
      harder wall after 3 s; the hand goes back after 6 s. The log has the tick from which each acts.

    * `ebac log info ebac-run/run-20260101-120000.mcap`: what the log holds.
    """
    from ebac.hardware.schedule import Schedule

    if no_files and out is not None:
        output.fail("--no-files and --out exclude each other: leave one of them out")
    with output.refusing(), telling():
        known = _configuration(
            configuration,
            law,
            seconds,
            rate,
            {"stiffness": stiffness, "damping": damping, "position": position},
            hand,
            target,
        )
        schedule = Schedule.parse(at or [])
        schedule.check(known, simulated=simulated)
    folder = None if no_files else out or (None if as_json else DEFAULT_OUT)
    stem = _stem(folder)
    shown = output.console(stderr=True).is_terminal if live is None else live
    try:
        _run(known, simulated, detached, stem, shown and not as_json, as_json, schedule)
    finally:
        if stem is not None:
            with suppress(OSError):  # not empty: it has what the run gave
                stem.parent.rmdir()


def _configuration(
    file: Path,
    law: str | None,
    seconds: float | None,
    rate: float | None,
    wall: dict[str, float | None],
    hand: str | None,
    target: float | None,
) -> Configuration:
    from ebac.hardware import Configuration

    known = Configuration.load(file)
    changes: dict[str, Any] = {
        "environment": setting.choose_wall(known.environment, **wall),
        "hand": setting.choose_hand(known.hand, hand, target),
        "timing": setting.choose_timing(known.timing, rate, None),
        **setting.given(seconds=seconds),
    }
    if law is not None and law != known.law:
        changes |= {"law": setting.one_law(law), "changes": {}}
    chosen = known.replace(**changes)
    chosen.scenario()
    chosen.design()
    return chosen


def _stem(folder: Path | None) -> Path | None:
    """Return the name of all files of this run, without extension; nothing is ever written over."""
    if folder is None:
        return None
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        output.fail(f"--out {folder}: is a file or lies inside one; give the name of a folder")
    except OSError as error:
        output.fail(f"--out {folder}: cannot be written ({error.strerror}); give another folder")
    now = time.strftime("run-%Y%m%d-%H%M%S", time.gmtime())
    names = [now, *(f"{now}-{i}" for i in range(2, 1000))]
    return next(folder / name for name in names if not (folder / f"{name}.mcap").exists())


def _run(
    known: Configuration,
    simulated: bool,
    detached: bool,
    stem: Path | None,
    live: bool,
    as_json: bool,
    schedule: Schedule,
) -> None:
    from ebac.hardware import OpenDevice
    from ebac.simulation import LoopFault

    log = None if stem is None else stem.with_suffix(".mcap")
    fault: LoopFault | None = None
    with telling():
        with OpenDevice.open(known, simulate=simulated, detached=detached) as device:
            try:
                trace = _watched(device, log, live, schedule)
            except LoopFault as error:
                fault, trace = error, error.trace
            except BaseException:
                _tell_end(device, as_json)
                raise
        report, place = device.report, device.place
    assert report is not None
    with output.refusing():
        result = run_results.Result.of(
            known, trace, report, place.about, simulated, fault, changed=bool(schedule.orders)
        )
    files = run_results.write(result, stem)
    if as_json:
        typer.echo(result.document())
    else:
        run_results.show(result)
        if stem is not None:
            output.list_files(stem.parent, files)
    if fault is not None:
        kept = "" if log is None else f"; its rows are in {log}"
        output.fail(f"{str(fault).partition('; see')[0]}{kept}", code=output.FAILED)


def _tell_end(device: OpenDevice, as_json: bool) -> None:
    """Say on what a run ended that gives no result, and that nothing has power."""
    report = device.report
    if report is None:
        return
    console = output.console(stderr=as_json)
    states = ", ".join(report.drives) or "not known"
    kept = "" if report.log is None else f"; {report.recorded:,} rows in {report.log}"
    console.print(
        f"Ended by {report.ended_by}. Drives after it: {states}{kept}.",
        soft_wrap=True,
        markup=False,
    )


def _watched(device: OpenDevice, log: Path | None, live: bool, schedule: Schedule) -> Trace:
    from ebac.cli.live import view

    with view(device.configuration, shown=live) as picture:

        def look(run: Run) -> None:
            schedule.look(run)
            picture(run)

        return device.run(log=log, look=look)
