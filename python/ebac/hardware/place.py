"""Where the drives of a run are: on an interface of the kernel, or on a bus inside this process."""

from __future__ import annotations

import itertools
import os
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
    from ebac._core import LoopbackHub, LoopbackJoystick
    from ebac.hardware.configuration import Configuration
    from ebac.scenario import Scenario

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
    """

    interface: str
    channel: str
    bus: str | LoopbackHub
    about: str


@contextmanager
def hardware(configuration: Configuration) -> Iterator[Place]:
    """Give the bus a configuration names."""
    interface, channel = configuration.interface, configuration.channel
    if interface == "socketcan":
        yield Place(interface=interface, channel=channel, bus=channel, about=f"drives on {channel}")
        return
    from ebac.can_interface import hub_of

    with hub_of(channel) as hub:
        about = f"the bus {channel!r} inside this process"
        yield Place(interface=interface, channel=channel, bus=hub, about=about)


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
        with _in_a_process(channel, scenario, first):
            about = f"simulated drives in another process, on {channel}"
            yield Place(interface="socketcan", channel=channel, bus=channel, about=about)
        return
    from ebac._core import LoopbackJoystick
    from ebac.can_interface import standing

    def nodes(hub: LoopbackHub) -> AbstractContextManager[object]:
        served = LoopbackJoystick(hub, scenario.setup(), first=first, wait_for_power=True)
        return _at_work(served)

    channel = f"run-{os.getpid()}-{next(_numbers)}"
    with standing(channel, nodes) as hub:
        about = "simulated drives in a thread of their own, on a bus inside this process"
        yield Place(interface="ebac", channel=channel, bus=hub, about=about)


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
def _at_work(served: LoopbackJoystick) -> Iterator[LoopbackJoystick]:
    """Start simulated drives, with a priority where the system grants it: a thread has that of who makes it."""
    policy, parameter = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        with suppress(PermissionError):
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
        served.start()
    finally:
        os.sched_setscheduler(0, policy, parameter)
    try:
        yield served
    finally:
        served.stop()


@contextmanager
def _in_a_process(channel: str, scenario: Scenario, first: int) -> Iterator[None]:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scenario.toml"
        scenario.save(file)
        command = [sys.executable, "-m", "ebac.cli", "drive", "simulate"]
        command += ["--channel", channel, "--scenario", str(file), "--first", str(first)]
        command += ["--wait-for-power", "--until-eof"]
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
                if not process.stdout.readline():
                    _, told = process.communicate(timeout=_START)
                    raise BusError(f"simulated drives on {channel}: {' '.join(told.split())}")
                yield
            finally:
                assert process.stdin is not None
                process.stdin.close()
                try:
                    process.wait(timeout=5)
                except subprocess.TimeoutExpired:
                    process.kill()
