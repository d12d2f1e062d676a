"""`ebac drive simulate`: the simulated joystick's drives on a bus that any CANopen tool can use."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from math import inf
from types import FrameType
from typing import TYPE_CHECKING, Annotated

import typer

from ebac.cli import options, output
from ebac.cli.drive_options import Bitrate, telling

if TYPE_CHECKING:
    from ebac._core import Joystick

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
    first: Annotated[
        int, typer.Option("--first", help="Node id of the first drive.", min=1, max=126)
    ] = 1,
    device: options.DeviceName = "joystick",
    hand: options.HandName = "open",
    seed: options.Seed = None,
    seconds: Annotated[
        float | None,
        typer.Option(help="Stop after so long [s].", show_default="until Ctrl-C", min=0),
    ] = None,
) -> None:
    """Put the simulated drives of a joystick on a bus, in real time, until Ctrl-C. A simulation.

    Every CANopen tool can talk to them: `ebac drive scan` in another terminal, canopen, candump. They
    move the simulated device and hand, so positions and torques on the bus are those of the joystick.

    **Examples**

    * `sudo ip link add vcan0 type vcan && sudo ip link set vcan0 up`, once, then

    * `ebac drive simulate --channel vcan0`

    * `ebac drive scan --interface socketcan --channel vcan0`, in another terminal.

    * `ebac drive simulate --interface udp_multicast --channel 239.74.163.2`: without SocketCAN.
    """
    from ebac.drives.bus import open_bus
    from ebac.drives.simulate import Simulation

    with output.refusing():
        joystick = _joystick(device or "joystick", hand or "open", seed, first)
    with telling(), _signalled() as over:
        bus = open_bus(interface=interface, channel=channel, bitrate=bitrate)
        with bus, Simulation(bus, joystick) as simulation:
            ids = ", ".join(str(first + axis) for axis in range(joystick.axes))
            output.say(f"Simulated drives, nodes {ids}, on {bus.channel_info}. Ctrl-C stops them.")
            end = time.monotonic() + (inf if seconds is None else seconds)
            while not over.wait(min(_LOOK, max(0.0, end - time.monotonic()))):
                simulation.wait(0)
                if time.monotonic() >= end:
                    break
    lost = f", {simulation.lost} refused by the bus" if simulation.lost else ""
    output.say(f"Stopped: {simulation.received} frames received, {simulation.sent} sent{lost}.")


def _joystick(device: str, hand: str, seed: int | None, first: int) -> Joystick:
    from ebac import presets
    from ebac._core import Joystick
    from ebac.scenario import Scenario

    scenario = Scenario(device=presets.device(device), hand=presets.hand(hand), seed=seed or 1)
    return Joystick(scenario.setup(), first=first)


@contextmanager
def _signalled() -> Iterator[threading.Event]:
    """Give an event that Ctrl-C and SIGTERM set."""
    over = threading.Event()

    def stop(number: int, frame: FrameType | None) -> None:
        over.set()

    before = {number: signal.signal(number, stop) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield over
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
