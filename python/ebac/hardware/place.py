"""Where the drives of a run are: on an interface of the kernel, or on a bus inside this process."""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ebac.drives.errors import BusError

if TYPE_CHECKING:
    from ebac._core import ForceCell, LoopbackHub, LoopbackJoystick, SocketCanJoystick
    from ebac.hardware.configuration import Configuration
    from ebac.scenario import Scenario
    from ebac.sensor import SensorConfig, SimulatedSensor

#: Priority of the simulated drives' thread under SCHED_FIFO, where it is granted: below any loop's.
PRIORITY = 5
#: How long another process may take to put its drives on a bus [s].
_START = 60.0

_numbers = itertools.count(1)


@dataclass(frozen=True, kw_only=True)
class Place:
    """A bus with drives on it.

    Attributes
    ----------
    interface, channel : str
        As python-can calls it.
    bus : str or LoopbackHub
        As the C++ loop takes it.
    about : str
        For people.
    sensor : SensorConfig or None
        The force sensor, where there is one.
    """

    interface: str
    channel: str
    bus: str | LoopbackHub
    about: str
    sensor: SensorConfig | None = None


@contextmanager
def hardware(configuration: Configuration) -> Iterator[Place]:
    """Give the bus a configuration names."""
    interface, channel = configuration.interface, configuration.channel
    if interface == "socketcan":
        yield Place(
            interface=interface,
            channel=channel,
            bus=channel,
            about=f"drives on {channel}",
            sensor=configuration.sensor,
        )
        return
    from ebac.can_interface import hub_of

    with hub_of(channel) as hub:
        about = f"the bus {channel!r} inside this process"
        yield Place(
            interface=interface,
            channel=channel,
            bus=hub,
            about=about,
            sensor=configuration.sensor,
        )


@contextmanager
def simulated(configuration: Configuration) -> Iterator[Place]:
    """Put simulated drives with a device and a hand on a bus until the end of the block.

    On a virtual CAN interface, where there is one that is up, they are in another process; else in a thread of C++ on a
    bus inside this process. The hand holds still until the motors first have power.

    Raises
    ------
    BusError
        When the other process cannot put them there.
    """
    scenario = configuration.scenario(seconds=10)
    first = min(node.id for node in configuration.drives.nodes)
    channel = virtual_can()
    if channel is not None:
        with _in_a_process(channel, scenario, first, configuration.sensor) as sensor:
            about = f"simulated drives in another process, on {channel}"
            yield Place(
                interface="socketcan", channel=channel, bus=channel, about=about, sensor=sensor
            )
        return
    from ebac._core import ForceCell, LoopbackJoystick
    from ebac.can_interface import standing

    felt = ForceCell([0.0, 0.0, 0.0])

    def nodes(hub: LoopbackHub) -> AbstractContextManager[object]:
        setup = scenario.setup()
        served = LoopbackJoystick(hub, setup, first=first, felt=felt, wait_for_power=True)
        return at_work(served)

    channel = f"run-{os.getpid()}-{next(_numbers)}"
    about = "simulated drives in a thread of their own, on a bus inside this process"
    with standing(channel, nodes) as hub, sensor_of(configuration.sensor, felt) as sensor:
        yield Place(interface="ebac", channel=channel, bus=hub, about=about, sensor=sensor)


@contextmanager
def sensor_of(known: SensorConfig | None, felt: ForceCell) -> Iterator[SensorConfig | None]:
    """Put a simulated sensor that feels a force on this machine's own network; give where it is, None for none.

    It tells counts as the known one does, and sits in the handle as that one.
    """
    if known is None:
        yield None
        return
    from ebac._core import EmulatorOptions
    from ebac.sensor import SimulatedSensor

    options = EmulatorOptions(
        counts_per_force=known.counts_per_force, counts_per_torque=known.counts_per_torque
    )
    emulated = SimulatedSensor(
        felt, options=options, rotation=known.rotation, sign=known.sign, model=known.model
    )
    with at_work(emulated):
        host, port = emulated.address
        yield known.replace(host=host, port=port, bias=(0.0,) * 6)


def virtual_can(root: Path = Path("/sys/class/net")) -> str | None:
    """Return the first virtual CAN interface that is up."""
    for folder in sorted(root.glob("*")):
        try:
            kind = (folder / "type").read_text().strip()
            flags = int((folder / "flags").read_text(), 16)
        except (OSError, ValueError):
            continue
        bare = not (folder / "device").exists()
        if kind == "280" and bare and flags & 1 and folder.name.startswith("vcan"):
            return folder.name
    return None


@contextmanager
def at_work(served: LoopbackJoystick | SocketCanJoystick | SimulatedSensor) -> Iterator[None]:
    """Start what is simulated, with a priority where the system grants it: a thread has that of who makes it."""
    policy, parameter = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        with suppress(PermissionError):
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
        served.start()
    finally:
        os.sched_setscheduler(0, policy, parameter)
    try:
        yield
    finally:
        served.stop()


def _emulated(known: SensorConfig, port: int) -> SensorConfig:
    """Return where a simulated sensor in another process is; it sits straight in the handle."""
    straight = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    return known.replace(
        host="127.0.0.1", port=port, rotation=straight, sign=1, model="net-ft", bias=(0.0,) * 6
    )


@contextmanager
def _in_a_process(
    channel: str, scenario: Scenario, first: int, sensor: SensorConfig | None
) -> Iterator[SensorConfig | None]:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scenario.toml"
        scenario.save(file)
        command = [sys.executable, "-m", "ebac.cli", "drive", "simulate"]
        command += ["--channel", channel, "--scenario", str(file), "--first", str(first)]
        command += ["--wait-for-power", "--until-eof"]
        if sensor is not None:
            counts = [f"{sensor.counts_per_force!r}", f"{sensor.counts_per_torque!r}"]
            command += ["--sensor", "--sensor-counts", *counts]
        with (
            subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                start_new_session=True,  # Ctrl-C is for the loop: its drives must be there until it has stopped
            ) as process
        ):
            try:
                assert process.stdout is not None
                said = process.stdout.readline()
                if not said:
                    _, told = process.communicate(timeout=_START)
                    raise BusError(f"simulated drives on {channel}: {' '.join(told.split())}")
                port = re.search(r"force sensor at 127\.0\.0\.1:(\d+)", said)
                yield _emulated(sensor, int(port[1])) if sensor and port else None
            finally:
                assert process.stdin is not None
                process.stdin.close()
                try:
                    process.wait(timeout=5)
                except subprocess.TimeoutExpired:
                    process.kill()
