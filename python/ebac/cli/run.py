"""`ebac run`: a law on the device, or on a simulated one, in real time."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import options, output, run_results, setting
from ebac.cli.drive_options import telling

if TYPE_CHECKING:
    from ebac.hardware import Configuration, OpenDevice
    from ebac.trace import Trace

DEFAULT_OUT = Path("ebac-run")


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
    stiffness: options.Stiffness = None,
    damping: options.Damping = None,
    position: options.Position = None,
    hand: options.HandName = None,
    target: options.Target = None,
    rate: options.Rate = None,
    seconds: options.Seconds = None,
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

    * `ebac log info ebac-run/run-20260101-120000.mcap`: what the log holds.
    """
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
    folder = None if no_files else out or (None if as_json else DEFAULT_OUT)
    stem = _stem(folder)
    shown = output.console(stderr=True).is_terminal if live is None else live
    _run(known, simulated, stem, shown and not as_json, as_json)


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
    known: Configuration, simulated: bool, stem: Path | None, live: bool, as_json: bool
) -> None:
    from ebac.hardware import OpenDevice
    from ebac.simulation import LoopFault

    log = None if stem is None else stem.with_suffix(".mcap")
    fault: LoopFault | None = None
    with telling():
        with OpenDevice.open(known, simulate=simulated) as device:
            try:
                trace = _watched(device, log, live)
            except LoopFault as error:
                fault, trace = error, error.trace
            finally:
                if log is not None and log.exists() and not as_json:
                    output.say(f"Log: {log}")
        report, place = device.report, device.place
    assert report is not None
    with output.refusing():
        result = run_results.Result.of(known, trace, report, place.about, simulated, fault)
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


def _watched(device: OpenDevice, log: Path | None, live: bool) -> Trace:
    from ebac.cli.live import view

    with view(device.configuration, shown=live) as look:
        return device.run(log=log, look=look)
