"""`ebac run`: a law on the device, or on a simulated one, in real time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ebac.cli import options, output
from ebac.cli.drive.options import Yes, reporting
from ebac.cli.files import PANEL, FigureOptions
from ebac.cli.run import carry_out, engine
from ebac.cli.run.chosen import chosen, first_run
from ebac.cli.run.confirm import can_ask, names_its_drives
from ebac.cli.run.names import free_stem, leave

DEFAULT_OUT = Path("ebac-run")


def run(
    wall: options.WallOptions,
    person: options.HandOptions,
    style: FigureOptions,
    configuration: Annotated[
        Path,
        typer.Argument(
            help="Configuration of device and run in TOML: `ebac demo joystick` writes one, `ebac keys` lists its keys."
        ),
    ],
    simulated: Annotated[
        bool,
        typer.Option(
            "--simulated",
            help="Use simulated drives, device and hand; clock and thread are real.",
        ),
    ] = False,
    virtual: Annotated[
        bool,
        typer.Option(
            "--virtual",
            help="Simulate everything, also the clock: no tick is late, however busy the machine is.",
        ),
    ] = False,
    bus_time: Annotated[
        bool,
        typer.Option(
            "--bus-time/--no-bus-time",
            help="With --virtual: model the time that frames take on the bus, or deliver each one at once.",
        ),
    ] = True,
    first: Annotated[
        bool,
        typer.Option(
            "--first",
            help="First run of a device: in free air, with at most 0.1 A and 1 m/s. The file stays as it is.",
        ),
    ] = False,
    law: Annotated[
        str | None, options.one_law(default="as configured", own=options.COMPILED)
    ] = None,
    rate: Annotated[
        float | None,
        options.option(text="Ticks per second [Hz]", default="as configured", panel=options.RUN),
    ] = None,
    seconds: Annotated[
        float | None,
        options.option(text="Time the law acts [s]", default="as configured", panel=options.RUN),
    ] = None,
    observer: Annotated[bool | None, options.observer(default="as configured")] = None,
    engine_command: Annotated[
        str | None,
        typer.Option(
            "--engine-command",
            help="Program that computes the virtual world, and its arguments: it is started beside the loop and ended "
            "with it.",
            show_default="as configured",
            rich_help_panel=options.WALL,
        ),
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
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="Folder for log, figure and numbers, named by the time; with --json, written only if given.",
            show_default="ebac-run",
            rich_help_panel=PANEL,
        ),
    ] = None,
    no_files: Annotated[
        bool, typer.Option("--no-files", help="Write neither files nor a log.")
    ] = False,
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
        typer.Option(
            "--detached", help="Continue when the program that started this one has died."
        ),
    ] = False,
    beyond_rating: Annotated[
        bool,
        typer.Option(
            "--beyond-rating", help="Allow limits beyond the data sheet of the motor. It may burn."
        ),
    ] = False,
    yes: Yes = False,
    as_json: output.AsJson = False,
) -> None:
    """Run a law on a device in real time.

    **The motors get power and the device moves.**

    The drives are checked against their profiles, enabled, run under the law for the given time, and switched off
    however the run ends: by any key, Ctrl-C, a closed terminal, a fault, or the death of the program that started
    this one. A fault gives exit code 1; the log contains the rows up to it.

    Before the drives get power, the command shows the position of each axis relative to the zero of its encoder and
    the distance to the wall, and asks you to confirm it; `--yes` skips the question (`ebac drive zero` sets the
    zero). With simulated drives it does not ask.

    With `--simulated` nothing moves: the drives, the device and the hand are simulated, in another process on a
    virtual CAN interface if there is one (`ip link add vcan0 type vcan`), otherwise in a thread of this process.
    Everything else is the same as on hardware.

    With `--first` the run has no virtual world, no force loop (`kp` and `kd` of the law are 0) and at most 0.1 A
    (`limits.peak_current`, `limits.continuous_current`) and 1 m/s (`limits.speed`), or the limits of the file where
    these are lower. All else is as configured. What differs is printed and stands in the log; `--virtual` and
    `--simulated` try it without hardware.

    **Examples**

    * `ebac demo joystick`, then `ebac run joystick.toml --simulated`: ten seconds at the wall, without hardware.

    * `ebac run joystick.toml --simulated --law tca --wall-stiffness 20000`: plain torque control, which shakes
      there and may end by fault 13 or 14.

    * `ebac run joystick.toml --virtual`: the same on a virtual clock, as fast as the machine computes.

    * `ebac run joystick.toml --virtual --first`: what the first run on a device will be.

    * `ebac run joystick.toml --simulated --observer`: the same wall at the estimated state, from encoder and force.

    * `ebac demo engine`, then `ebac run joystick.toml --simulated --seconds 3 --engine-command "python engine.py"`: the
      world of a program that calls `ebac.worlds.serve_engine`, or in C++ has an `EngineClient`. If it dies, its force
      fades to zero, and the run says so.

    * `ebac run joystick.toml --simulated --at "3 environment.stiffness=2e4" --at "6 hand.target=0"`: a
      harder wall after 3 s; the hand goes back after 6 s. The log has the tick from which each acts.

    """
    from ebac.hardware import rating
    from ebac.hardware.schedule import Schedule

    if no_files and out is not None:
        output.fail("--no-files and --out exclude each other: leave one of them out")
    in_time = {"--simulated": simulated, "--at": at, "--live": live, "--detached": detached}
    if virtual and (given := [name for name, value in in_time.items() if value]):
        output.fail(
            f"--virtual excludes {', '.join(given)}, which belongs to a run in real time: leave out one or the other"
        )
    style.check()
    with output.refusing(), reporting():
        schedule = Schedule.parse(at or [])
        known = chosen(configuration, law, seconds, rate, observer, wall, person)
        changed: tuple[str, ...] = ()
        if first:
            known, changed = first_run(known, wall, engine_command, schedule)
        known = engine.with_engine(known, engine_command, wall, schedule)
        if virtual and known.engine:
            raise ValueError(
                "--virtual: the engine is a program in real time; run it with --simulated, or leave out the engine"
            )
        if not virtual:
            schedule.check(known, simulated=simulated)
    if not (virtual or simulated):
        names_its_drives(known, "add --simulated or --virtual for a simulation")
        can_ask(known, yes)
    if beyond_rating:
        for _, text in rating.beyond_rating(known):
            output.note(f"{text}; --beyond-rating allows it: the motor may burn")
    for line in changed:
        output.console(stderr=as_json).print(f"First run, {line}", soft_wrap=True, markup=False)
    folder = None if no_files else out or (None if as_json else DEFAULT_OUT)
    stem = free_stem(folder)
    shown = output.console(stderr=True).is_terminal if live is None else live
    try:
        if virtual:
            if not beyond_rating:
                with output.refusing():
                    rating.check_rating(known)
            carry_out.run_virtual(known, stem, as_json, style, bus_time=bus_time, first=changed)
        else:
            how = {"simulate": simulated, "detached": detached, "beyond_rating": beyond_rating}
            with engine.started(known) as (with_world, process):
                carry_out.run_in_real_time(
                    with_world, how, yes, stem, shown and not as_json, as_json, schedule, style, process, changed,
                )  # fmt: skip
    finally:
        if stem is not None:
            leave(stem)
