"""Backends: the drives of a run on a CAN interface of the kernel, or on a bus inside this process."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING

from ebac._util.arguments import number
from ebac.drives.bus import TIMEOUT
from ebac.drives.errors import BusError
from ebac.hardware.drives_subprocess import in_a_process
from ebac.hardware.simulated_parts import Request, at_work, sensor_of, unheld

if TYPE_CHECKING:
    from ebac._core import (
        Grant,
        LoopbackHub,
        SharedHandTarget,
        _DrivenMachine,
    )
    from ebac.hardware.configuration import Configuration
    from ebac.sensor import SensorConfig

#: How long a simulated drive may take to answer [s]: it shares its processors with all else.
_PATIENCE = 5.0

_numbers = itertools.count(1)


@dataclass(frozen=True, kw_only=True)
class Backend:
    """A bus with drives on it.

    Attributes
    ----------
    interface, channel : str
        Names by which python-can opens the bus.
    bus : str or LoopbackHub
        The bus as the C++ loop opens it.
    about : str
        Description for messages.
    sensor : SensorConfig or None
        The force sensor, where there is one.
    patience : float
        How long an SDO answer may take [s].
    aim : SharedHandTarget or None
        Shared target of a simulated hand; None on hardware.
    grants : sequence of Grant
        What the threads of the simulated parts requested from the system, and what was granted.
    real : bool
        Whether a hand may hold the device: its zero must be confirmed before it has power.
    """

    interface: str
    channel: str
    bus: str | LoopbackHub
    about: str
    sensor: SensorConfig | None = None
    patience: float = TIMEOUT
    aim: SharedHandTarget | None = None
    grants: Sequence[Grant] = ()
    real: bool = False


@contextmanager
def hardware(configuration: Configuration) -> Iterator[Backend]:
    """Open the bus that a configuration names.

    Raises
    ------
    BusError
        For a bus inside this process that has no drives.
    """
    interface, channel = configuration.interface, configuration.channel
    if interface == "socketcan":
        yield Backend(
            interface=interface,
            channel=channel,
            bus=channel,
            about=f"drives on {channel}",
            sensor=configuration.sensor,
            real=True,
        )
        return
    from ebac.can.channels import hub_of, without_nodes

    with hub_of(channel) as hub:
        if wrong := without_nodes(channel):
            raise BusError(f"bus.channel: {wrong}")
        about = f"the bus {channel!r} inside this process"
        yield Backend(
            interface=interface,
            channel=channel,
            bus=hub,
            about=about,
            sensor=configuration.sensor,
        )


@contextmanager
def simulated(
    configuration: Configuration,
    *,
    longest_step: float | None = None,
    load: _DrivenMachine | None = None,
) -> Iterator[Backend]:
    """Put simulated drives with a device and a hand on a bus until the end of the block.

    On a virtual CAN interface, where there is one that is up, they are in another process; else in a thread of C++ on a
    bus inside this process. The hand holds still until the motors first have power.

    With `longest_step` [s] they are always in this process, and time stands still for them while their loop is held up:
    the device moves for so long at most from one tick to the next. So they are with a `load`, which takes the
    hand's place: the hand's stiffness is that of its cables.

    Raises
    ------
    BusError
        When the other process cannot put them there.
    ValueError
        For a `longest_step` in which the device would never move.
    """
    if longest_step is not None and not number("longest_step", longest_step) > 0:
        raise ValueError(f"longest_step = {longest_step} s: must be above 0, or None for no limit")
    scenario = configuration.scenario(seconds=10)
    from ebac._core import DriveWiring, LoopbackJoystick, SharedForce, SharedHandTarget
    from ebac.hardware.wiring import wiring_of

    aim = SharedHandTarget()
    channel = virtual_can() if longest_step is None and load is None else None
    if channel is not None:
        with in_a_process(channel, configuration, scenario, aim) as (sensor, grants):
            yield Backend(
                interface="socketcan",
                channel=channel,
                bus=channel,
                about=f"simulated drives in another process, on {channel}",
                sensor=sensor,
                patience=_PATIENCE,
                aim=aim,
                grants=grants,
            )
        return
    from ebac.can.channels import standing

    # The loop's thread asks for the memory of this process.
    request = Request.beside(configuration.mode, configuration.realtime, lock_memory=False)
    shared_force, grants = SharedForce([0.0, 0.0, 0.0]), []
    own = scenario.device.sensor
    if configuration.sensor is not None:
        scenario = unheld(scenario)

    def nodes(hub: LoopbackHub) -> AbstractContextManager[object]:
        served = LoopbackJoystick(
            hub,
            scenario.setup(),
            wiring=DriveWiring(**wiring_of(configuration)),
            force=shared_force,
            wait_for_power=True,
            aim=aim,
            longest_step=inf if longest_step is None else longest_step,
            load=load,
        )
        return at_work(served, request, "the simulated drives", grants)

    channel = f"run-{os.getpid()}-{next(_numbers)}"
    with (
        standing(channel, nodes) as hub,
        sensor_of(configuration.sensor, own, shared_force, request, grants) as sensor,
    ):
        yield Backend(
            interface="ebac",
            channel=channel,
            bus=hub,
            about="simulated drives in a thread of their own, on a bus inside this process",
            sensor=sensor,
            patience=_PATIENCE,
            aim=aim,
            grants=grants,
        )


def virtual_can(root: Path = Path("/sys/class/net")) -> str | None:
    """Return the first virtual CAN interface that is up.

    Parameters
    ----------
    root : Path
        Where the system lists its network interfaces.

    Returns
    -------
    str or None
        Name, as `vcan0`; None where there is none.
    """
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
