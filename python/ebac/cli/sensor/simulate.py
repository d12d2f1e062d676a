"""`ebac sensor simulate`: a force sensor on the network that is none."""

from __future__ import annotations

import sys
import time
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac.cli import options, output, simulated
from ebac.cli.sensor import options as sensor_options

if TYPE_CHECKING:
    from ebac.scenario import Scenario

_TROUBLE = "Trouble"
#: Largest force along an axis [N].
MOST_FORCE = 1e4


def _share(what: str) -> Any:
    return typer.Option(
        help=f"Share of the packets that {what}.", min=0, max=1, rich_help_panel=_TROUBLE
    )


def simulate(
    host: Annotated[str, typer.Option(help="Address of this machine to use.")] = "127.0.0.1",
    port: Annotated[
        int, typer.Option(help="UDP port; 0 takes any free one.", min=0, max=65535)
    ] = 49152,
    http_port: Annotated[
        int | None,
        typer.Option(
            help="Port of the sensor's web page.", show_default="no page", min=0, max=65535
        ),
    ] = None,
    hand_force: Annotated[
        tuple[float, float, float] | None,
        typer.Option(help="A steady force of the hand on the handle [N].", show_default=False),
    ] = None,
    scenario: simulated.PlantFile = None,
    device: simulated.PlantDevice = None,
    hand: simulated.PlantHand = None,
    seed: options.Seed = None,
    rate: Annotated[float, typer.Option(help="Records per second [Hz].", min=1, max=7000)] = 1000.0,
    load: Annotated[
        float,
        typer.Option(
            help="Weight on the z axis of the sensor in addition to the hand, until a bias is set [N]."
        ),
    ] = 0.0,
    model: Annotated[
        str, typer.Option(help="Model whose status bits it uses: net-ft, axia, other.")
    ] = "net-ft",
    loss: Annotated[float, _share("are not sent")] = 0.0,
    duplicate: Annotated[float, _share("are sent twice")] = 0.0,
    reorder: Annotated[float, _share("are sent after the next one")] = 0.0,
    seconds: simulated.Seconds = None,
) -> None:
    """Put a simulated force sensor on the network, in real time, until Ctrl-C. A simulation.

    It uses the protocol of the ATI Net F/T (RDT over UDP), so every program for that sensor can read it. It measures
    the hand of a scenario, which moves its device without power, or a steady force. Like the real sensor it has one
    client at a time: the last one to ask gets the stream. The hand holds the handle 20 mm from the sensor along its z
    axis, so a force across that axis also shows as a torque: 3 N along x as 0.06 N m about y.

    **Examples**

    * `ebac sensor simulate --hand-force 3 0 0`, and in another terminal `ebac sensor read --host 127.0.0.1`

    * `ebac wall --out first`, then `ebac sensor simulate --scenario first/scenario.toml --rate 7000 --loss 0.01`

    * `ebac sensor simulate --http-port 8080`, then `ebac sensor read --host 127.0.0.1 --page --http-port 8080`
    """
    from ebac.sensor import EmulatorOptions, EmulatorTrouble, SimulatedSensor

    with output.refusing():
        source = _source(hand_force, scenario, device, hand, seed)
        built = EmulatorOptions(rate=rate, load=load)
        trouble = EmulatorTrouble(loss=loss, duplicate=duplicate, reorder=reorder)
    with output.refusing(), sensor_options.reporting():
        work = SimulatedSensor(
            source,
            host=host,
            port=port,
            http_port=http_port,
            options=built,
            model=model,
            seed=1 if seed is None else seed,
        )
    work.inject(trouble)
    with work, simulated.signalled() as over:
        at = "{}:{}".format(*work.address)
        page = (
            ""
            if work.http_address is None
            else ", its page at http://{}:{}".format(*work.http_address)
        )
        output.say(f"Simulated force sensor at {at}{page}. Ctrl-C stops it.")
        sys.stdout.flush()
        end = time.monotonic() + (inf if seconds is None else seconds)
        while time.monotonic() < end and not over.wait(min(0.1, max(0.0, end - time.monotonic()))):
            pass
    counts = work.counts
    output.say(
        f"Stopped: {output.plural(counts.requests, 'request')} obeyed, {counts.refused} refused, "
        f"{output.plural(counts.sent, 'packet')} sent, "
        f"{counts.dropped:,} dropped."
    )


def _source(
    force: tuple[float, float, float] | None,
    scenario: Path | None,
    device: str | None,
    hand: str | None,
    seed: int | None,
) -> Scenario | tuple[float, float, float]:
    """Return what it feels: a steady force, or a hand on a device."""
    if force is not None and max(map(abs, force)) > MOST_FORCE:
        given = " ".join(f"{one:g}" for one in force)
        raise ValueError(
            f"--hand-force = {given} N: each must lie in [-{MOST_FORCE:g}, {MOST_FORCE:g}] N"
        )
    if force is None:
        return simulated.plant_of(scenario, device, hand, seed)
    if scenario is not None or device is not None or hand is not None:
        raise ValueError("--hand-force: stands for hand and device; give it alone")
    return force
