"""What was read from a force sensor, and what was lost on the way."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ebac._core import SensorStatus
from ebac.sensor.configuration import Row


@dataclass(frozen=True, kw_only=True)
class SensorReading:
    """One record, in the handle's axes.

    Attributes
    ----------
    force, torque : 3 floats
        Force [N] and torque [N m], bias taken off.
    age : float
        Time since the record reached this machine [s].
    health : SensorStatus
        Good, saturated, an error of its own, or disconnected.
    status : int
        Its status bits; `explain` names them.
    rdt_sequence, ft_sequence : int
        Number of the record, and of the sample inside the sensor.
    """

    force: Row
    torque: Row
    age: float
    health: SensorStatus
    status: int
    rdt_sequence: int
    ft_sequence: int

    def row(self) -> dict[str, Any]:
        """Return its numbers as a row of `--json`."""
        named = zip("xyz", self.force, self.torque, strict=True)
        numbers = [(axis, f, t) for axis, f, t in named]
        return {
            **{f"force_{axis}_N": f for axis, f, _ in numbers},
            **{f"torque_{axis}_Nm": t for axis, _, t in numbers},
            "age_s": self.age,
            "health": self.health.name.lower(),
            "status": self.status,
            "rdt_sequence": self.rdt_sequence,
            "ft_sequence": self.ft_sequence,
        }


@dataclass(frozen=True, kw_only=True)
class SensorCounts:
    """What came from a sensor, and what did not, since it was opened.

    Attributes
    ----------
    received : int
        Records used.
    lost : int
        Records that did not come: gaps of the sequence that nothing filled.
    late, duplicate : int
        Records that came after a newer one, or again; not used.
    malformed : int
        Packets of the sensor that are no record, or out of all order.
    foreign : int
        Packets of somebody else.
    asked : int
        Streams asked for; more than one means silence in between.
    refused : int
        Requests that did not leave this machine.
    """

    received: int
    lost: int
    late: int
    duplicate: int
    malformed: int
    foreign: int
    asked: int
    refused: int

    def row(self) -> dict[str, int]:
        """Return them by name."""
        return asdict(self)
