"""Backends: the drives of a run on a CAN interface of the kernel, or on a bus inside this process."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Self

from ebac.drives.bus import TIMEOUT
from ebac.drives.errors import BusError
from ebac.hardware.drives_subprocess import in_a_process
from ebac.hardware.report import grant_row

if TYPE_CHECKING:
    from ebac._core import (
        ForceSensor,
        Grant,
        LoopbackHub,
        LoopbackJoystick,
        RealTime,
        RealTimeMode,
        SharedForce,
        SharedHandTarget,
        SocketCanJoystick,
        _DrivenMachine,
    )
    from ebac.hardware.configuration import Configuration
    from ebac.hardware.signs import Signs
    from ebac.scenario import Scenario
    from ebac.sensor import SensorConfig, SimulatedSensor

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

    def signs(self, known: Configuration) -> Signs:
        """Return the signs to apply. On a simulated device with other signs than configured, the error remains."""
        return known.signs if self.aim is None else known.signs.against(known.simulated_signs)


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
    """
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


@dataclass(frozen=True, kw_only=True)
class Request:
    """What the threads of what is simulated ask of the system."""

    mode: RealTimeMode
    realtime: RealTime

    @classmethod
    def beside(cls, mode: str, loop: RealTime, *, lock_memory: bool | None = None) -> Self:
        """Return the request of a loop, one priority below and on any CPU: metal is never kept waiting.

        That CPUs stay awake holds for the machine, so the loop's own request is enough.
        """
        from ebac._core import RealTimeMode

        lock = loop.lock_memory if lock_memory is None else lock_memory
        priority = max(1, loop.priority - 1)
        asked = loop.replace(priority=priority, cpu=-1, lock_memory=lock, stay_awake=False)
        return cls(mode=RealTimeMode[mode.upper()], realtime=asked)


@contextmanager
def sensor_of(
    known: SensorConfig | None,
    own: ForceSensor,
    shared_force: SharedForce,
    request: Request,
    grants: list[Grant],
    *,
    port: int = 0,
) -> Iterator[SensorConfig | None]:
    """Put a simulated sensor that measures a shared force on this machine's own network; None for none.

    It scales counts as the configured one does, and is mounted in the same way. It has no offset that the configured
    `bias` would take off, so its own is 0; `device.sensor.bias` is in the force. It sends a record in every period of
    the device's `own` sensor, 1000 a second without one. `grants` gets what its thread got; `port` 0 is any free UDP
    port.
    """
    if known is None:
        yield None
        return
    from ebac._core import EmulatorOptions
    from ebac.sensor import SimulatedSensor

    options = EmulatorOptions(
        rate=_records(own.period),
        counts_per_force=known.counts_per_force,
        counts_per_torque=known.counts_per_torque,
    )
    emulated = SimulatedSensor(
        shared_force,
        port=port,
        options=options,
        rotation=known.rotation,
        sign=known.sign,
        model=known.model,
    )
    with at_work(emulated, request, "the simulated sensor", grants):
        host, port = emulated.address
        yield known.replace(host=host, port=port, bias=(0.0,) * 6)


def _records(period: float) -> float:
    """Return the rate of a simulated sensor [Hz]: a record in every period of the device's own [s], 7000 at most."""
    from ebac._core import EmulatorOptions

    if period == 0:
        return EmulatorOptions().rate
    most = next(one.high for one in EmulatorOptions.fields() if one.name == "rate")
    return min(most, 1 / period)


def unheld(scenario: Scenario) -> Scenario:
    """Return the scenario for a plant beside a sensor on the network, whose records alone are as slow as its period."""
    device = scenario.device
    return scenario.replace(device=device.replace(sensor=device.sensor.replace(period=0.0)))


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
def at_work(
    served: LoopbackJoystick | SocketCanJoystick | SimulatedSensor,
    request: Request,
    whose: str,
    grants: list[Grant],
) -> Iterator[None]:
    """Start what is simulated, and stop it after the block; `grants` gets what its thread was granted.

    Raises
    ------
    RuntimeError
        When something is not granted that must be, and nothing has started.
    """
    from ebac._core import Grant

    served.start(request.mode, request.realtime)
    try:
        grants += [
            Grant(**{**grant_row(one), "name": f"{one.name} of {whose}"}) for one in served.grants
        ]
        yield
    finally:
        served.stop()
