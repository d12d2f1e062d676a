"""`ebac drive scan`, `show`, `plan`, `verify`: look, and change nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import drive_results, output
from ebac.cli.drive_options import (
    Bitrate,
    Channel,
    Interface,
    Nodes,
    ProfileName,
    ProfileNodes,
    Timeout,
    about,
    drives,
    network_of,
    opened,
)

if TYPE_CHECKING:
    from ebac.drives import Change, DriveBus, Network


def scan(
    interface: Interface = None,
    channel: Channel = None,
    bitrate: Bitrate = None,
    timeout: Timeout = 0.3,
    as_json: output.AsJson = False,
) -> None:
    """Ask all 127 node ids who is there. Nothing is changed.

    **Example**

    * `ebac drive scan --interface socketcan --channel can0`
    """
    with opened(interface, channel, bitrate) as bus:
        nodes = bus.scan(seconds=timeout)
        rows = [drive_results.who(bus.drive(node, timeout=timeout)) for node in nodes]
    if as_json:
        typer.echo(output.document("drive scan", rows))
    elif rows:
        drive_results.found(rows)
    else:
        output.say("Nobody answers: check power, bit rate, termination, and that the cable is in.")


def show(
    node: Nodes = None,
    everything: Annotated[bool, typer.Option("--all", help="PDO parameters too.")] = False,
    interface: Interface = None,
    channel: Channel = None,
    bitrate: Bitrate = None,
    timeout: Timeout = 0.3,
    as_json: output.AsJson = False,
) -> None:
    """Read every object of a drive that ebac knows by name. Nothing is changed.

    **Examples**

    * `ebac drive show --node 1`

    * `ebac drive show --node 1 --all --json`: PDO parameters too, as JSON.
    """
    with opened(interface, channel, bitrate) as bus:
        chosen = drives(bus, node, timeout)
        rows = [row for one in chosen for row in drive_results.holdings(one, everything)]
    if as_json:
        typer.echo(output.document("drive show", rows))
    else:
        drive_results.objects(rows)


def plan(
    profile: ProfileName = "joystick",
    node: ProfileNodes = None,
    interface: Interface = None,
    channel: Channel = None,
    bitrate: Bitrate = None,
    timeout: Timeout = 0.3,
    as_json: output.AsJson = False,
) -> None:
    """Show what a profile would change on the drives, and how busy the bus will be. Nothing is changed.

    **Examples**

    * `ebac drive plan joystick`: both drives of the paper's joystick.

    * `ebac drive plan my-drive.toml --node 5`: a profile of your own, for node 5.
    """
    network = network_of(profile, node, bitrate)
    with opened(interface, channel, bitrate) as bus:
        found = _differences(bus, network, timeout)
    if as_json:
        typer.echo(output.document("drive plan", [c.row() for c in found], **about(network)))
        return
    drive_results.changes(found, "The drives hold all of it: nothing would change.")
    drive_results.load(network)


def verify(
    profile: ProfileName = "joystick",
    node: ProfileNodes = None,
    interface: Interface = None,
    channel: Channel = None,
    bitrate: Bitrate = None,
    timeout: Timeout = 0.3,
    as_json: output.AsJson = False,
) -> None:
    """Read back whether the drives hold a profile; exit code 1 when they do not. Nothing is changed.

    **Example**

    * `ebac drive verify joystick`
    """
    network = network_of(profile, node, bitrate)
    with opened(interface, channel, bitrate) as bus:
        found = _differences(bus, network, timeout)
    if as_json:
        typer.echo(output.document("drive verify", [c.row() for c in found], **about(network)))
    else:
        drive_results.changes(found, f"Verified: the drives hold {network.name}.")
    if found:
        if not as_json:
            output.say(f"Not verified: {len(found)} objects differ. `ebac drive apply` sets them.")
        raise typer.Exit(output.FAILED)


def _differences(bus: DriveBus, network: Network, timeout: float) -> list[Change]:
    from ebac.drives import plan as plan_of

    plans = [plan_of(bus.drive(node.id, timeout=timeout), node) for node in network.nodes]
    return [change for one in plans for change in one.changes]
