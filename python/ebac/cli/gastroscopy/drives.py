"""`ebac gastroscopy master` and `slave`: joystick and gastroscope on CANopen drives, over a network."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import by_name, interrupts, options, output, simulated
from ebac.cli.drive.options import Yes, reporting
from ebac.cli.gastroscopy.line_printer import LinePrinter
from ebac.cli.gastroscopy.side_table import show
from ebac.cli.run.confirm import can_ask, confirm
from ebac.cli.teleop.consent import Consent
from ebac.cli.teleop.processes import HOST, PORT, peer_of

if TYPE_CHECKING:
    from ebac.gastroscope.far_side import LinkAtWork, LinkEvent, SideReport
    from ebac.hardware import Configuration
    from ebac.laws import AnyLaw

Simulated = Annotated[
    bool,
    typer.Option("--simulated", help="Use simulated drives; clock, threads and network are real."),
]
GiveUp = Annotated[
    float,
    typer.Option(
        help="Time without a link after which the run ends, with the drives at rest [s].",
        min=0.5,
        max=1e7,
    ),
]
Timeout = Annotated[
    float, typer.Option(help="Silence after which the link counts as lost [s].", min=0.01, max=10)
]
Log = Annotated[
    Path | None,
    typer.Option("--log", help="Record every tick to this file, .mcap.", show_default=False),
]


def master(
    configuration: Annotated[
        Path | None,
        typer.Argument(
            help="Configuration of the joystick in TOML, as `ebac demo gastroscope-master` writes it.",
            show_default="that one, with --simulated",
        ),
    ] = None,
    peer: Annotated[
        str,
        typer.Option(
            help="Address of the slave, or of a network in front of it, such as 127.0.0.1:49200."
        ),
    ] = "127.0.0.1:49201",
    host: Annotated[str, HOST] = "127.0.0.1",
    port: Annotated[int, PORT] = 0,
    on_simulated: Simulated = False,
    law: Annotated[
        str | None, options.one_law(default="as configured", own=options.COMPILED)
    ] = None,
    consent_after: Annotated[
        float | None,
        typer.Option(
            help="With --simulated: the hand consents this long after the link is back [s].",
            show_default="press Enter",
            min=0,
            max=1e7,
        ),
    ] = None,
    give_up: GiveUp = 10.0,
    timeout: Timeout = 0.5,
    seconds: simulated.Seconds = None,
    log: Log = None,
    yes: Yes = False,
    as_json: output.AsJson = False,
) -> None:
    """Run a joystick on its drives, with a gastroscope at the other end of a network as its world.

    **The motors get power and the joystick moves.** Limits, faults, log and the question before the motors get power
    are those of `ebac run`. Two axes bend the tip, and the slide of the lever advances it; the load of the
    gastroscope's drives is fed back as a force, through the law. When the link is lost, the force fades to zero
    within 0.2 s; once it is back, the hand has to consent (Enter). Without a link for `--give-up`, or when the slave
    reports that its drives have stopped, the run ends with the drives at rest and exit code 1.

    **Examples**

    * `ebac gastroscopy slave --simulated`, then `ebac gastroscopy master --simulated --seconds 20`

    * `ebac gastroscopy master --simulated --peer 127.0.0.1:49299 --seconds 3 --json`: no slave answers, so it waits
    """
    from ebac.gastroscope.on_drives import run_master

    with output.refusing(), reporting(), LinePrinter(err=as_json) as printer:
        if consent_after is not None and not on_simulated:
            output.fail(
                f"--consent-after {consent_after:g}: only with --simulated; on your drives the hand agrees, by Enter"
            )
        wanted = None if law is None else by_name.any_law(law)
        at = peer_of(peer, "--peer")
        (known,) = _known({"master": configuration}, on_simulated)
        check_law(wanted, known)
        if not on_simulated:
            can_ask(known, yes)
        _keep(log)
        enter = Consent() if consent_after is None else None
        found = run_master(
            known,
            peer=at,
            law=wanted,
            host=host,
            port=port,
            simulate=on_simulated,
            consent_after=consent_after,
            give_up=give_up,
            timeout=timeout,
            seconds=seconds,
            log=log,
            notify=_notifier("master", printer, enter),
            confirm=lambda device: confirm(device, yes, stderr=as_json),
            look=lambda run, link: _consent(link, enter),
        )
    _give(found, as_json, on_simulated)


def slave(
    feed: Annotated[
        Path | None,
        typer.Option(
            help="Drives for insertion and rotation, in TOML, as `ebac demo gastroscope-feed` writes it.",
            show_default="that one, with --simulated",
        ),
    ] = None,
    bend: Annotated[
        Path | None,
        typer.Option(
            help="Drives for both bends, as `ebac demo gastroscope-bend` writes it.",
            show_default="that one, with --simulated",
        ),
    ] = None,
    host: Annotated[str, HOST] = "127.0.0.1",
    port: Annotated[int, PORT] = 49201,
    on_simulated: Simulated = False,
    give_up: GiveUp = 10.0,
    timeout: Timeout = 0.5,
    seconds: simulated.Seconds = None,
    log: Log = None,
    announce: Annotated[
        bool,
        typer.Option("--announce", help="Print the UDP port as JSON when the drives have power."),
    ] = False,
    yes: Yes = False,
    as_json: output.AsJson = False,
) -> None:
    """Run the four drives of a gastroscope, which follow a joystick over a network and send their load back.

    **The motors get power and the gastroscope moves.** Insertion and rotation are on one bus, both bends on another:
    four drives at 1 kHz do not fit on one of 1 Mbit/s. Each pair runs like `ebac run`, with its limits, faults and
    log (the log of the bends has `-bend` in its name); a fault of one pair stops both at once, with zero torque, and
    is reported to the master. Without a link the drives hold their position, and after `--give-up` the run ends with
    the drives at rest and exit code 1.

    With `--simulated` the drives move a simulated gastroscope in a patient: tendons, tube, wall.

    **Examples**

    * `ebac gastroscopy slave --simulated --seconds 3`

    * `ebac gastroscopy slave --simulated --port 49202 --log slave.mcap --seconds 3`, then `ebac log info slave.mcap`
    """
    from ebac.gastroscope.on_drives import run_slave

    with output.refusing(), reporting(), LinePrinter(err=as_json) as printer:
        both = _known({"feed": feed, "bend": bend}, on_simulated)
        for known in both if not on_simulated else ():
            can_ask(known, yes)
        _keep(log)
        found = run_slave(
            *both,
            host=host,
            port=port,
            simulate=on_simulated,
            give_up=give_up,
            timeout=timeout,
            seconds=seconds,
            log=log,
            notify=_notifier("slave", printer),
            confirm=lambda device: confirm(device, yes, stderr=as_json),
            ready=lambda at: _ready(at, announce, None if as_json else printer),
        )
    _give(found, as_json, on_simulated)


def check_law(law: AnyLaw | None, known: Configuration) -> None:
    """Refuse a law that the loop of a joystick cannot run, before its drives are opened."""
    if law is not None:
        known.replace(law=law, changes={}).design()


def _known(given: Mapping[str, Path | None], on_simulated: bool) -> list[Configuration]:
    """Return the configurations of files; those that come with `ebac` where there are none, for simulated drives."""
    from ebac.gastroscope.on_drives import configuration
    from ebac.hardware import Configuration

    found = {part: Configuration.load(file) for part, file in given.items() if file is not None}
    for part in given:
        if part in found:
            continue
        if not on_simulated:
            what = "CONFIGURATION" if part == "master" else f"--{part}"
            output.fail(
                f"{what}: must name a configuration of your drives; `ebac demo gastroscope-{part}` writes one, "
                "--simulated needs none"
            )
        found[part] = configuration(part)
    return [found[part] for part in given]


def _keep(log: Path | None) -> None:
    """Whatever ends the command: the log is there."""
    if log is not None:
        interrupts.keeping(f"look at the rows with `ebac log info {log}`")


def _ready(port: int, announce: bool, printer: LinePrinter | None) -> None:
    if announce:
        typer.echo(json.dumps({"port": port}))
        sys.stdout.flush()
    elif printer is not None:
        printer.say(f"slave on UDP port {port}: the drives have power. Ctrl-C stops it.")


def _notifier(name: str, printer: LinePrinter, enter: Consent | None = None) -> Any:
    def notify(event: LinkEvent) -> None:
        printer.say(f"{event.t:8.2f} s  {name}: {event.text}")
        if enter is None:
            return
        enter.withdraw()
        if event.what == "back":
            printer.say(f"            {enter.question}")
            enter.ask()

    return notify


def _consent(link: LinkAtWork, enter: Consent | None) -> None:
    if enter is not None and enter.given():
        link.end.consent()


def _give(found: SideReport, as_json: bool, on_simulated: bool) -> None:
    row = found.row()
    if as_json:
        # One line, so that a program may read it while others write.
        typer.echo(json.dumps({"command": f"gastroscopy {found.name}", **row}))
    else:
        show({found.name: row}, [], simulated=on_simulated)
        for log in found.logs:
            output.path(log)
    if not found.good:
        raise typer.Exit(1)
