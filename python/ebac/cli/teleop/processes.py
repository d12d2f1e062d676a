"""`ebac teleop master`, `network` and `slave`: three processes that talk over UDP."""

from __future__ import annotations

import json
import sys
import time
from math import inf
from typing import Annotated, Any

import typer

from ebac._util.headings import with_units
from ebac._util.plural import plural
from ebac.cli import completion, options, output, simulated
from ebac.cli.teleop.consent import Consent
from ebac.cli.teleop.options import NAMES, LinkOptions, MasterOptions

PORT = typer.Option(help="UDP port to listen on; 0 takes any free one.", min=0, max=65535)
HOST = typer.Option(help="Address of this machine to use.")
SCHEME = typer.Option(
    help=f"Scheme, the same on both sides: {NAMES}.", autocompletion=completion.schemes
)
CUT = 0.2
REPORT = 5.0
#: Nobody has answered for so long: time for a hint [s]. A network of the command delays by half a second at most.
PATIENCE = 2.0
NO_SLAVE = "no slave has answered; start it first, and give its address by --peer"
LOST, BACK = 2, 3
OTHER_SCHEME = (
    "the other side has another scheme, so nothing of it is obeyed; give both the same --scheme"
)


def peer_of(text: str, option: str) -> tuple[str, int]:
    """Return address and port of an option."""
    host, colon, port = text.rpartition(":")
    if not colon or not host or not port.isdecimal():
        output.fail(f"{option} {text}: must be an address and a port, as 127.0.0.1:49200")
    if not 1 <= int(port) <= 65535:
        output.fail(f"{option} {text}: the port must lie in [1, 65535]")
    return host, int(port)


def master(
    stick: MasterOptions,
    peer: Annotated[
        str, typer.Option(help="Address of the network or the slave, such as 127.0.0.1:49200.")
    ] = "127.0.0.1:49201",
    scheme: Annotated[str, SCHEME] = "ebac",
    host: Annotated[str, HOST] = "127.0.0.1",
    port: Annotated[int, PORT] = 0,
    consent_after: Annotated[
        float | None,
        typer.Option(
            help="A simulated hand consents this long after the link is back [s].",
            show_default="press Enter",
            min=0,
            max=1e7,
        ),
    ] = None,
    seconds: simulated.Seconds = None,
    seed: options.Seed = None,
    as_json: output.AsJson = False,
) -> None:
    """Run a simulated stick with its hand and law at 1 kHz, connected to a slave over UDP.

    The hand swings the stick between 5 and 35 mm. When the link is lost, the force fades to zero; once it is back,
    the hand has to consent (Enter) before the slave moves again. Give the slave the same scheme. Of `--scenario`
    device, timing and observer are used.

    **Examples**

    * `ebac teleop slave --port 49211`, then `ebac teleop master --peer 127.0.0.1:49211`

    * `ebac teleop master --peer 127.0.0.1:49200 --consent-after 1 --seconds 5 --json`
    """
    from ebac import Free, Hand, Sine
    from ebac.laws import design
    from ebac.teleop import processes
    from ebac.teleop import scheme as scheme_of

    with output.refusing():
        where = peer_of(peer, "--peer")
        chosen = scheme_of(scheme)
        path = Sine(centre=0.02, amplitude=0.015, frequency=0.2, phase=-1.5708)
        scenario = stick.stick().replace(
            environment=Free(), hand=Hand(path=[path]), seed=1 if seed is None else seed
        )
        law = design(chosen.law, scenario.device, scenario.known_timing)
        side = processes.Master(
            scenario, law, chosen, host=host, port=port, peer=where, consent_after=consent_after
        )
    _run("master", side, seconds, as_json, peer, by_hand=consent_after is None)


def slave(
    scheme: Annotated[str, SCHEME] = "ebac",
    contact_stiffness: Annotated[
        float, typer.Option(help="Stiffness of the contact at 20 mm [N/m].", min=0, max=1e5)
    ] = 500.0,
    host: Annotated[str, HOST] = "127.0.0.1",
    port: Annotated[int, PORT] = 49201,
    seconds: simulated.Seconds = None,
    as_json: output.AsJson = False,
) -> None:
    """Run a simulated slave that answers any master that sends valid packets; without them it holds its position.

    **Examples**

    * `ebac teleop slave --port 49221`

    * `ebac teleop slave --contact-stiffness 2000 --port 49301 --scheme waves`
    """
    from ebac.teleop import SlaveModel, processes
    from ebac.teleop import scheme as scheme_of

    with output.refusing():
        model = SlaveModel(contact_stiffness=contact_stiffness)
        side = processes.Slave(model, scheme_of(scheme), host=host, port=port)
    _run("slave", side, seconds, as_json)


def network(
    over: LinkOptions,
    slave: Annotated[
        str, typer.Option(help="Address of the slave, such as 127.0.0.1:49201.")
    ] = "127.0.0.1:49201",
    host: Annotated[str, HOST] = "127.0.0.1",
    port: Annotated[int, PORT] = 49200,
    seconds: simulated.Seconds = None,
    seed: options.Seed = None,
    announce: Annotated[
        bool, typer.Option("--announce", help="Print the UDP port as JSON at once.")
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Simulate a network between master and slave that delays, drops, reorders and damages packets and cuts the link.

    **Examples**

    * `ebac teleop network --delay 0.1 --jitter 0.01 --loss 0.1`

    * `ebac teleop network --port 49210 --delay 0.05 --corrupt 0.01 --cut-every 20 --cut-length 2`
    """
    from ebac.teleop import processes

    with output.refusing():
        where = peer_of(slave, "--slave")
        link = over.link()
        side = processes.Network(
            link, link, host=host, port=port, slave=where, seed=1 if seed is None else seed
        )
    if announce:
        typer.echo(json.dumps({"port": side.port}))
        sys.stdout.flush()
    _run("network", side, seconds, as_json, slave)


def _run(
    name: str,
    side: Any,
    seconds: float | None,
    as_json: bool,
    peer: str = "",
    by_hand: bool = False,
) -> None:
    from ebac.teleop.processes import STATES

    if not as_json:
        to = f", peer {peer}" if peer else ""
        output.say(f"{name} on UDP port {side.port}{to}. Ctrl-C stops it.")
        sys.stdout.flush()
    state, reported, report = None, time.monotonic(), side.run(0)
    losses, other, hinted = 0, False, name != "master"
    enter = Consent()
    end = time.monotonic() + (inf if seconds is None else seconds)
    with simulated.signalled() as over:
        while time.monotonic() < end and not over.is_set():
            report = side.run(CUT)
            if report["losses"] > losses and report["state"] != LOST:  # within one report
                _show_line(f"{report['seconds']:8.1f} s  {name}: {STATES[LOST]}", as_json)
            if report["other_scheme"] and not other:
                other = True
                _show_line(f"            {name}: {OTHER_SCHEME}", as_json)
            if not hinted and report["seconds"] > PATIENCE:
                hinted = True
                if not report["arrivals"]["received"] and not other:
                    _show_line(f"{report['seconds']:8.1f} s  {name}: {NO_SLAVE} ({peer})", as_json)
            losses = report["losses"]
            if name != "network" and report["state"] != state:
                state = report["state"]
                _show_line(f"{report['seconds']:8.1f} s  {name}: {STATES[state]}", as_json)
                enter.withdraw()
                if state == BACK and by_hand:
                    _show_line(f"            {enter.question}", as_json)
                    enter.ask()
            if enter.given():
                side.consent()
            if time.monotonic() - reported > REPORT and not as_json:
                reported = time.monotonic()
                output.say(_line(_own(name, report)))
    if as_json:
        # One line, so that a program may read it while others write.
        typer.echo(
            json.dumps({"command": f"teleop {name}", **_named(_own(name, report), side.units)})
        )
    else:
        output.say(f"Stopped: {_line(_own(name, report)).strip()}")
    if name == "master" and not report["arrivals"]["received"]:
        output.fail(
            OTHER_SCHEME if other else f"{NO_SLAVE} ({peer})",
            code=output.FAILED,
        )


#: What a side does not measure: only the master hears its own packets come back, and a network is no side.
NOT_MEASURED = {
    "master": ("moved_when_lost",),
    "slave": ("round_trip", "longest_round_trip", "force_when_lost", "fault"),
    "network": (
        "losses", "other_scheme", "state", "session", "away", "round_trip", "longest_round_trip", "position",
        "farthest", "force", "most_force", "most_force_at", "most_force_since", "force_when_lost", "moved_when_lost",
        "fault",
    ),
}  # fmt: skip


def _own(name: str, report: dict[str, Any]) -> dict[str, Any]:
    return {**report, **dict.fromkeys(NOT_MEASURED[name])}


def _named(report: dict[str, Any], units: dict[str, str]) -> dict[str, Any]:
    return with_units(
        {**report, "fault": None if report["fault"] is None else int(report["fault"])}, units
    )


def _show_line(text: str, as_json: bool) -> None:
    typer.echo(text, err=as_json)


def _line(report: dict[str, Any]) -> str:
    came = report["arrivals"]
    parts = [
        f"{report['seconds']:8.1f} s  {report['sent']:,} sent",
        f"{came['received']:,} received",
        f"{came['missing']:,} missing",
        f"{report['refused']:,} damaged",
    ]
    if not came["received"]:
        parts.append("nobody answered yet")
    elif report["losses"] is not None:
        parts.append(f"link lost {plural(report['losses'], 'time')}")
    if came["received"] and report["round_trip"] is not None:
        parts.append(f"round trip {1e3 * report['round_trip']:.0f} ms")
    if report["most_force"] is not None:
        parts.append(f"largest force {report['most_force']:.1f} N")
    return ", ".join(parts)
