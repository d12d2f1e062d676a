"""`ebac drive simulate`: the simulated joystick's drives on a bus that any CANopen tool can use."""

from __future__ import annotations

import json
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from math import inf
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac._util.arguments import unknown
from ebac.cli import options, output, simulated
from ebac.cli.drive.options import (
    Bitrate,
    BusOptions,
    SheetFile,
    known_interface,
    opened,
    telling,
)
from ebac.cli.machine.grants import show_refused

if TYPE_CHECKING:
    from ebac._core import Grant, Setup, SocketCanJoystick
    from ebac.drives.simulate import Simulation
    from ebac.hardware.backends import Request

#: Largest counts of a unit.
MOST_COUNTS = 1e9
MODES = ("auto", "enforce", "off")
#: How often the main thread looks after the others [s].
_LOOK = 0.1


def simulate(
    channel: Annotated[
        str, typer.Option(help="Channel of the interface: vcan0, can0, ...", rich_help_panel="Bus")
    ] = "vcan0",
    interface: Annotated[
        str, typer.Option(help="Interface of python-can.", rich_help_panel="Bus")
    ] = "socketcan",
    bitrate: Bitrate = None,
    eds: SheetFile = None,
    first: Annotated[
        int, typer.Option("--first", help="Node id of the first drive.", min=1, max=126)
    ] = 1,
    scenario: simulated.PlantFile = None,
    device: simulated.PlantDevice = None,
    hand: simulated.PlantHand = None,
    seed: options.Seed = None,
    seconds: simulated.Seconds = None,
    wait_for_power: Annotated[
        bool,
        typer.Option(
            "--wait-for-power", help="The hand holds still until a motor first has power."
        ),
    ] = False,
    zero: Annotated[
        list[int] | None,
        typer.Option(
            "--zero",
            help="What a drive counts with the handle at its zero [counts]; once for each axis.",
            show_default="0 for each",
            min=-(2**31),
            max=2**31 - 1,
        ),
    ] = None,
    sensor: Annotated[
        bool,
        typer.Option("--sensor", help="Also simulate a force sensor at the handle, on 127.0.0.1."),
    ] = False,
    sensor_counts: Annotated[
        tuple[float, float],
        typer.Option("--sensor-counts", help="Counts of that sensor per N and per N m."),
    ] = (1e6, 1e6),
    realtime: Annotated[
        str,
        typer.Option(
            help="Real-time priority of their threads on SocketCAN: auto, enforce or off.",
            rich_help_panel="Real time",
        ),
    ] = "auto",
    beside: Annotated[
        int,
        typer.Option(
            help="Priority of the loop; the threads of the drives run one below it.",
            min=1,
            max=99,
            rich_help_panel="Real time",
        ),
    ] = 80,
    lock_memory: Annotated[
        bool,
        typer.Option(
            "--lock-memory/--no-lock-memory",
            help="Keep all pages of this process in memory.",
            rich_help_panel="Real time",
        ),
    ] = True,
    until_eof: Annotated[
        bool,
        typer.Option(
            "--until-eof",
            help="Stop when standard input ends, as it does with a parent process; print what the threads were "
            "granted as JSON, in a second line.",
        ),
    ] = False,
    aim: Annotated[int | None, typer.Option(hidden=True, min=0, max=2**31 - 1)] = None,
) -> None:
    """Put the simulated drives of a joystick on a bus, in real time, until Ctrl-C. A simulation.

    Every CANopen tool can talk to them: `ebac drive scan` in another terminal, canopen, candump. They move the
    simulated device and hand, so positions and torques on the bus are those of the joystick. A hand of a scenario
    file starts its path when the command starts; virtual world and delay of the file are not used, since they belong
    to the loop that connects over the bus.

    **Examples**

    * `sudo ip link add vcan0 type vcan && sudo ip link set vcan0 up`, once, then

    * `ebac drive simulate --channel vcan0`

    * `ebac drive scan --interface socketcan --channel vcan0`, in another terminal.

    * `ebac drive simulate --interface udp_multicast --channel 239.74.163.2`: without SocketCAN.

    * `ebac drive simulate --eds MAKER.eds --channel vcan0`: with the objects of that data sheet, and no others.

    * `ebac wall --out first`, then `ebac drive simulate --scenario first/scenario.toml --channel vcan0`: the hand of
      a scenario.
    """
    from ebac._core import RealTime, SharedForce, SharedHandTarget
    from ebac.drives import read_eds
    from ebac.drives.simulate import Simulation
    from ebac.hardware.backends import Request, sensor_of
    from ebac.sensor import SensorConfig

    if not all(1 <= counts <= MOST_COUNTS for counts in sensor_counts):
        given = " ".join(f"{counts:g}" for counts in sensor_counts)
        output.fail(f"--sensor-counts = {given}: each must lie in [1, {MOST_COUNTS:g}]")
    if realtime not in MODES:
        output.fail(unknown(f"--realtime {realtime}", realtime, MODES))
    grants: list[Grant] = []
    with output.refusing():
        plant = simulated.plant_of(scenario, device, hand, seed)
        setup = plant.setup()
        if zero and len(zero) != plant.device.axes:
            raise ValueError(
                f"--zero: {output.plural(len(zero), 'number')} for {plant.device.axes} axes; give it once for each axis"
            )
        loop = RealTime(priority=beside, lock_memory=lock_memory)
        request = Request.beside(realtime, loop)
        cell = None if aim is None else SharedHandTarget(aim)
    with telling(), simulated.signalled() as over:
        known = SensorConfig(counts_per_force=sensor_counts[0], counts_per_torque=sensor_counts[1])
        shared_force = SharedForce([0.0, 0.0, 0.0])
        more = {
            "first": first,
            "force": shared_force,
            "wait_for_power": wait_for_power,
            "aim": cell,
            "zero": zero or [],
            "sheet": [] if eds is None else read_eds(eds).rows(first),
        }
        with (
            sensor_of(known if sensor else None, shared_force, request, grants) as found,
            _at_work(setup, interface, channel, bitrate, more, request, grants) as work,
        ):
            also = "" if found is None else f" and a force sensor at {found.host}:{found.port}"
            ids = ", ".join(str(first + axis) for axis in range(plant.device.axes))
            typer.echo(  # one line, for whoever waits for it
                f"Simulated drives, nodes {ids}, on {interface} {channel}{also}. Ctrl-C stops them."
            )
            _tell(grants, as_json=until_eof)
            sys.stdout.flush()
            if until_eof:
                threading.Thread(target=_until_eof, args=(over,), daemon=True).start()
            end = time.monotonic() + (inf if seconds is None else seconds)
            while not over.wait(min(_LOOK, max(0.0, end - time.monotonic()))):
                if isinstance(work, Simulation):
                    work.check()
                if time.monotonic() >= end:
                    break
        counts = work.counts
    refused = f", {counts.refused} refused by the bus" if counts.refused else ""
    lost = f", {counts.lost} lost before they were read" if counts.lost else ""
    output.say(f"Stopped: {counts.received} frames received, {counts.sent} sent{refused}{lost}.")


def inject(
    where: BusOptions,
    fault: Annotated[
        list[str] | None,
        typer.Argument(
            help="over-voltage, under-voltage, short-circuit, over-temperature, motor-temperature, encoder-lost, "
            "brake-stuck, torque-off (STO), enable-missing, silent.",
            show_default="none: all are over",
        ),
    ] = None,
    node: Annotated[
        int, typer.Option("--node", "-n", help="Node id of the simulated drive.", min=1, max=127)
    ] = 1,
) -> None:
    """Put a simulated drive into the named faults, and clear all others. Real drives are refused.

    **Examples**, with `ebac drive simulate` in another terminal

    * `ebac drive inject under-voltage --node 1 --interface socketcan --channel vcan0`

    * `ebac drive inject --interface ebac --channel joystick`: no fault
    """
    from ebac.drives import inject as put

    with opened(where) as bus:
        put(bus.drive(node, timeout=where.timeout), fault or [])
    output.say(f"Node {node}: {', '.join(fault) if fault else 'no fault is injected'}.")


@contextmanager
def _at_work(
    setup: Setup,
    interface: str,
    channel: str,
    bitrate: int | None,
    more: dict[str, Any],
    request: Request,
    grants: list[Grant],
) -> Iterator[SocketCanJoystick | Simulation]:
    """Put the drives on a bus until the end of the block: SocketCAN is served by C++."""
    from ebac._core import Joystick, SocketCanJoystick
    from ebac.drives import BusError
    from ebac.drives.bus import open_bus
    from ebac.drives.simulate import Simulation
    from ebac.hardware.backends import at_work

    known_interface(interface)
    if interface == "ebac":
        raise ValueError(
            "--interface ebac: a bus within one process, where no other program would meet these "
            "drives; its channel 'joystick' has some for every program that opens it"
        )
    if interface == "socketcan":
        try:
            served = SocketCanJoystick(channel, setup, **more)
        except OSError as error:
            raise BusError(error.strerror or str(error)) from error
        with at_work(served, request, "the simulated drives", grants):
            yield served
        return
    nodes = Joystick(setup, **more)
    with (
        open_bus(interface=interface, channel=channel, bitrate=bitrate) as bus,
        Simulation(bus, nodes) as simulation,
    ):
        yield simulation


def _tell(grants: list[Grant], *, as_json: bool) -> None:
    """Print what the threads were not granted; for a program, all they asked for, as JSON."""
    from ebac.hardware.report import grant_row

    if as_json:
        typer.echo(json.dumps([grant_row(one) for one in grants]))
    else:
        show_refused(grants)


def _until_eof(over: threading.Event) -> None:
    """Wait for the end of standard input, then stop all."""
    while sys.stdin.read(1024):
        pass
    over.set()
