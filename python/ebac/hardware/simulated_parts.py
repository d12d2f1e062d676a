"""What stands in for hardware beside a loop: threads of what is simulated, and its force sensor on the network."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

from ebac.hardware.report import grant_row

if TYPE_CHECKING:
    from ebac._core import (
        ForceSensor,
        Grant,
        LoopbackJoystick,
        RealTime,
        RealTimeMode,
        SharedForce,
        SocketCanJoystick,
    )
    from ebac.scenario import Scenario
    from ebac.sensor import SensorConfig, SimulatedSensor


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
        from ebac.realtime.mode import mode_named

        lock = loop.lock_memory if lock_memory is None else lock_memory
        priority = max(1, loop.priority - 1)
        asked = loop.replace(priority=priority, cpu=-1, lock_memory=lock, stay_awake=False)
        return cls(mode=mode_named(mode), realtime=asked)


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
