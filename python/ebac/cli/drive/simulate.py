"""`ebac drive simulate`: simulated drives on a bus that any CANopen tool can use."""

from __future__ import annotations

import errno
import json
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ebac._util.arguments import unknown
from ebac.cli import options, output, simulated
from ebac.cli.drive import described
from ebac.cli.drive.options import Bitrate, SheetFile, known_interface, reporting
from ebac.cli.machine.grants import show_refused
from ebac.cli.sensor.options import reporting as reporting_of_sensor

if TYPE_CHECKING:
    from ebac._core import Grant, Setup, SocketCanJoystick
    from ebac.drives.simulate import Simulation
    from ebac.hardware.simulated_parts import Request

#: How often the main thread looks after the others [s].
_LOOK = 0.1


def simulate(
    configuration: Annotated[
        Path | None,
        typer.Argument(
            help="Configuration of `ebac run`: simulate the drives, device and hand that it describes.",
            show_default="the paper's joystick",
        ),
    ] = None,
    channel: Annotated[
        str, typer.Option(help="Channel of the interface: vcan0, can0, ...", rich_help_panel="Bus")
    ] = "vcan0",
    interface: Annotated[
        str, typer.Option(help="Interface of python-can.", rich_help_panel="Bus")
    ] = "socketcan",
    bitrate: Bitrate = None,
    eds: SheetFile = None,
    first: Annotated[
        int | None,
        typer.Option(
            "--first", help="Node id of the first drive.", show_default="1", min=1, max=126
        ),
    ] = None,
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
        tuple[float, float] | None,
        typer.Option(
            "--sensor-counts",
            help="Counts of that sensor per N and per N m.",
            show_default="1000000, 1000000",
        ),
    ] = None,
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
    wiring: Annotated[Path | None, typer.Option(hidden=True)] = None,
) -> None:
    """Put simulated drives on a bus, in real time, until Ctrl-C: those of a configuration, or a joystick's.

    Every CANopen tool can talk to them: `ebac drive scan` in another terminal, canopen, candump. They move the
    simulated device and hand, so positions and torques on the bus are those of the device.

    With a configuration of `ebac run` they have its node ids, its device, and the dictionary that each drive's
    profile or data sheet describes; [zero] and [signs] are right for them, or [simulated.zero] and [simulated.signs]
    where the file has these. They begin without settings, like new drives, and the hand of [simulated.hand] starts
    when a motor first has power. Interface and channel are those of the options: the bus of the file may be a real
    one. A hand of a scenario file starts its path when the command starts. Virtual world and delay of the files are
    not used, since they belong to the loop that connects over the bus.

    **Examples**

    * `sudo ip link add vcan0 type vcan && sudo ip link set vcan0 up`, once, then

    * `ebac drive simulate --channel vcan0`

    * `ebac demo joystick`, then `ebac drive simulate joystick.toml --channel vcan0`: the drives of a configuration.

    * `ebac drive scan --interface socketcan --channel vcan0`, in another terminal.

    * `ebac drive simulate --interface udp_multicast --channel 239.74.163.2`: without SocketCAN.

    * `ebac drive simulate --eds MAKER.eds --channel vcan0`: with the objects of that data sheet, and no others.

    * `ebac wall --out first`, then `ebac drive simulate --scenario first/scenario.toml --channel vcan0`: the hand of
      a scenario.
    """
    from ebac._core import DriveWiring, RealTime, SharedForce, SharedHandTarget
    from ebac.drives.simulate import Simulation
    from ebac.hardware.simulated_parts import Request, sensor_of, unheld
    from ebac.realtime.mode import MODES

    if realtime not in MODES:
        output.fail(unknown(f"--realtime {realtime}", realtime, MODES))
    grants: list[Grant] = []
    with reporting():
        if configuration is None:
            plant = simulated.plant_of(scenario, device, hand, seed)
            found = described.by_options(plant, first, zero, eds, sensor_counts, wiring)
        else:
            elsewhere = {"--first": first, "--scenario": scenario, "--device": device, "--zero": zero or None,
                         "--sensor-counts": sensor_counts}  # fmt: skip
            described.refuse(elsewhere, configuration)
            found = described.by_configuration(configuration, hand, seed, eds)
        if sensor and found.sensor is None:
            raise ValueError(
                f"--sensor: {configuration} has no table [sensor]; add one, or leave --sensor out"
            )
        own = found.scenario.device.sensor
        setup = (unheld(found.scenario) if sensor else found.scenario).setup()
        loop = RealTime(priority=beside, lock_memory=lock_memory)
        request = Request.beside(realtime, loop)
        cell = None if aim is None else SharedHandTarget(aim)
    with reporting(), reporting_of_sensor(), simulated.signalled() as over:
        shared_force = SharedForce([0.0, 0.0, 0.0])
        more = {
            "wiring": DriveWiring(**found.wiring),
            "force": shared_force,
            "wait_for_power": wait_for_power or configuration is not None,
            "aim": cell,
        }
        measured = found.sensor if sensor else None
        ids = found.wiring["nodes"]
        with (
            sensor_of(measured, own, shared_force, request, grants, port=found.sensor_port) as at,
            _at_work(
                setup, interface, channel, bitrate or found.bitrate, ids, more, request, grants
            ) as work,
        ):
            also = "" if at is None else f" and a force sensor at {at.host}:{at.port}"
            named = ", ".join(str(node) for node in ids)
            one = len(ids) == 1
            what = "Simulated drive, node" if one else "Simulated drives, nodes"
            them = "it" if one and at is None else "them"
            typer.echo(  # one line, for whoever waits for it
                f"{what} {named}, on {interface} {channel}{also}. Ctrl-C stops {them}."
            )
            for line in found.about:
                output.say(line)
            _show_grants(grants, as_json=until_eof)
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
    output.say(
        f"Stopped: {output.plural(counts.received, 'frame')} received, {counts.sent} sent{refused}{lost}."
    )


@contextmanager
def _at_work(
    setup: Setup,
    interface: str,
    channel: str,
    bitrate: int | None,
    ids: Sequence[int],
    more: dict[str, Any],
    request: Request,
    grants: list[Grant],
) -> Iterator[SocketCanJoystick | Simulation]:
    """Put the drives on a bus until the end of the block: SocketCAN is served by C++."""
    from ebac._core import Joystick, SocketCanJoystick
    from ebac.drives import BusError
    from ebac.drives.bus import open_bus
    from ebac.drives.simulate import Simulation, refuse_taken
    from ebac.hardware.simulated_parts import at_work

    known_interface(interface)
    if interface == "ebac":
        raise ValueError(
            "--interface ebac: a bus within one process, where no other program would meet these "
            "drives; its channel 'joystick' has some for every program that opens it"
        )
    if interface == "socketcan":
        try:
            bus = open_bus(interface=interface, channel=channel)
        except BusError:
            pass  # reported below, with the remedies for drives
        else:
            with bus:
                refuse_taken(bus, f"{interface} {channel}", ids)
        try:
            served = SocketCanJoystick(channel, setup, **more)
        except OSError as error:
            if error.errno == errno.EAFNOSUPPORT:
                raise BusError(
                    f"CAN interface {channel!r}: this kernel has no CAN sockets; load them: "
                    "`sudo modprobe can_raw`. All commands but those with a configuration (`ebac run`, `ebac drive "
                    "signs` and `zero`) also take --interface udp_multicast --channel 239.74.163.2"
                ) from error
            raise BusError(error.strerror or str(error)) from error
        with at_work(served, request, "the simulated drives", grants):
            yield served
        return
    nodes = Joystick(setup, **more)
    with open_bus(interface=interface, channel=channel, bitrate=bitrate) as bus:
        refuse_taken(bus, f"{interface} {channel}", ids)
        with Simulation(bus, nodes) as simulation:
            yield simulation


def _show_grants(grants: list[Grant], *, as_json: bool) -> None:
    """Print what the threads were not granted; for a program, all they asked for, as JSON."""
    from ebac.hardware.report import grant_row

    if as_json:
        typer.echo(json.dumps([grant_row(one) for one in grants]))
    else:
        show_refused(grants)


def _until_eof(over: threading.Event) -> None:
    """Wait for the end of standard input, then stop all."""
    while sys.stdin is not None and sys.stdin.read(1024):
        pass
    over.set()
