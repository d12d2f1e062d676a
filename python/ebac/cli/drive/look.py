"""`ebac drive scan`, `show`, `plan`, `verify`: look, and change nothing."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import output
from ebac.cli.drive import results
from ebac.cli.drive.options import (
    Bitrate,
    BusOptions,
    Nodes,
    ProfileName,
    ProfileNodes,
    about,
    checked,
    drives,
    network_of,
    opened,
    reporting,
    sheet_of,
)

if TYPE_CHECKING:
    from ebac.drives import BusTiming, Change, DriveBus, Network


def scan(
    where: BusOptions,
    as_json: output.AsJson = False,
) -> None:
    """List the nodes that answer on a bus. Nothing is changed.

    Exit code 1 when no node answers.

    **Examples**

    * `ebac drive scan --interface ebac --channel joystick`: a simulated joystick
    """
    with opened(where) as bus:
        sheet = sheet_of(where)
        nodes = bus.scan(seconds=where.timeout)
        rows = [results.who(bus.drive(node, eds=sheet, timeout=where.timeout)) for node in nodes]
    if as_json:
        typer.echo(output.document("drive scan", rows))
    elif rows:
        results.found(rows)
    else:
        output.say("Nobody answers: check power, bit rate, termination, and that the cable is in.")
    if not rows:
        raise typer.Exit(output.FAILED)


def show(
    where: BusOptions,
    node: Nodes = None,
    everything: Annotated[
        bool, typer.Option("--all", help="Also read the PDO parameters.")
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Read the objects of a drive that ebac knows by name, or with `--eds` all of its data sheet. Nothing is changed.

    **Examples**

    * `ebac drive show --node 1 --interface ebac --channel joystick`

    * `ebac drive show --all --json --interface ebac --channel joystick`: PDO parameters too, as JSON
    """
    from ebac.drives import DriveError

    rows, failures = [], []
    with opened(where) as bus:
        for one in drives(bus, node, where):
            try:
                for row in results.holdings(one, everything):
                    rows.append(row)
            except DriveError as error:
                failures.append(error)
        if as_json and (rows or not failures):
            typer.echo(output.document("drive show", rows))
        elif rows:
            results.objects(rows)
        if failures:
            raise failures[0]


def plan(
    where: BusOptions,
    profile: ProfileName = "joystick",
    node: ProfileNodes = None,
    as_json: output.AsJson = False,
) -> None:
    """Print what a profile would change on the drives, and the load of the bus. Nothing is changed.

    **Examples**

    * `ebac drive plan joystick --interface ebac --channel joystick`: both drives of the paper's joystick
    """
    network = network_of(profile, node, where)
    with opened(where) as bus:
        found = _differences(bus, network, where)
    if as_json:
        typer.echo(output.document("drive plan", [c.row() for c in found], **about(network)))
        return
    results.changes(found, "The drives hold all of it: nothing would change.")
    results.load(network)


def timing(
    profile: ProfileName = "joystick",
    node: ProfileNodes = None,
    bitrate: Bitrate = None,
    rate: Annotated[float, typer.Option(help="Ticks per second [Hz].", min=1.0, max=1e4)] = 1000.0,
    answer_share: Annotated[
        float | None,
        typer.Option(
            help="Share of a tick that the loop waits for answers.",
            show_default="0.7",
            min=0.0,
            max=1.0,
        ),
    ] = None,
    ticks: Annotated[int, typer.Option(help="Samples to simulate.", min=1, max=1_000_000)] = 1000,
    errors: Annotated[
        float, typer.Option(help="Share of frames that are destroyed.", min=0.0, max=1.0)
    ] = 0.0,
    broken: Annotated[
        int | None,
        typer.Option(
            help="Id of a node that destroys its every frame.", show_default="none", min=1, max=127
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of data and errors.", min=0)] = 0,
    as_json: output.AsJson = False,
) -> None:
    """Simulate how long the exchanges of a loop take on the bus, and whether answers arrive in time. No bus is opened.

    Exit code 1 when an answer came late or not at all.

    **Examples**

    * `ebac drive timing joystick`: two drives at 1 Mbit/s

    * `ebac drive timing generic-cia402 --node 1 --bitrate 500000 --answer-share 0.9`: one drive on a slower bus
    """
    from ebac import drives as library

    with reporting():
        network = library.load(profile, nodes=node or (), bitrate=bitrate)
        found = library.bus_timing(
            network,
            dt=1 / rate,
            answer_share=answer_share,
            ticks=ticks,
            error_rate=errors,
            broken=broken,
            seed=seed,
        )
    if as_json:
        typer.echo(output.document("drive timing", [_timing_row(found)], profile=network.name))
    else:
        output.say(f"Simulation. {found.describe()}.")
    if not found.good:
        raise typer.Exit(output.FAILED)


def _timing_row(found: BusTiming) -> dict[str, object]:
    units = {"bitrate": "bit_per_s", "load": "share"}
    units |= dict.fromkeys(("dt", "answer", "mean", "worst"), "s")
    return {
        f"{key}_{units[key]}" if key in units else key: value
        for key, value in asdict(found).items()
    }


def verify(
    where: BusOptions,
    profile: ProfileName = "joystick",
    node: ProfileNodes = None,
    as_json: output.AsJson = False,
) -> None:
    """Check whether the drives have the settings of a profile; exit code 1 if not. Nothing is changed.

    **Examples**

    * `ebac drive verify --interface ebac --channel joystick`: new simulated drives have none of them, so exit code 1
    """
    network = network_of(profile, node, where)
    with opened(where) as bus:
        found = _differences(bus, network, where)
    if as_json:
        typer.echo(output.document("drive verify", [c.row() for c in found], **about(network)))
    else:
        results.changes(found, f"Verified: the drives hold {network.name}.")
    if found:
        if not as_json:
            output.say(
                f"Not verified: {output.plural(len(found), 'object')} differ. `ebac drive apply` sets them."
            )
        raise typer.Exit(output.FAILED)


def _differences(bus: DriveBus, network: Network, where: BusOptions) -> list[Change]:
    from ebac.drives import plan as plan_of

    plans = [plan_of(checked(bus, node.id, where, node.sheet), node) for node in network.nodes]
    return [change for one in plans for change in one.changes]
