"""What a law is: written in C++, or in Python; those of the package by name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, Protocol, TypeGuard, runtime_checkable

from ebac import _core
from ebac._core import (
    Corner,
    Device,
    DeviceFacts,
    Disc,
    Field,
    Free,
    Port,
    ReplayLog,
    Rows,
    Setup,
    TimedBus,
    Timing,
    Wall,
    _World,
)


@runtime_checkable
class CoreLaw(Protocol):
    """A law written in C++: of this package, or bound out of tree by `bind_controller`."""

    name: ClassVar[str]
    summary: ClassVar[str]
    passive: ClassVar[bool]

    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: Any) -> CoreLaw:
        """Make the law for a device."""
        ...

    @property
    def timing(self) -> Timing:
        """Sample time and delay it was designed for."""
        ...

    def step(self, port: Port) -> float:
        """Return the force [N] for one tick of one axis."""
        ...

    def reset(self) -> None:
        """Forget everything but the parameters."""
        ...

    def replace(self, **changes: Any) -> CoreLaw:
        """Return a copy with some parameters changed."""
        ...

    @staticmethod
    def fields() -> Sequence[Field]:
        """Return its parameters: names, units, meanings, ranges."""
        ...

    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...

    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...


@runtime_checkable
class PythonLaw(Protocol):
    """A law written in Python: the same loop runs it, some ten times slower.

    One independent deep copy is made for each axis. With an attribute `observer` that is true it uses the estimate of
    the state observer, as `EBAC(observer=True)`: the world is met where the handle will be, and `port.est` is what
    the law goes by. What it raises ends the run: `simulate` raises a `LoopFault` that names the law.

    Its parameters are the fields of its dataclass. The metadata of a field may declare `unit`, `low`, `high` and
    `meaning`: `damping: float = field(default=30.0, metadata={"unit": "N s/m", "low": 0, "high": 100})`.
    """

    def step(self, port: Port) -> float:
        """Return the force [N] for one tick of one axis; positive resists +x."""
        ...

    def reset(self) -> None:
        """Forget everything but the parameters; called before the first tick."""
        ...


#: Every law of this package by its name, in the order in which they are bound.
LAWS: dict[str, type[CoreLaw]] = {
    law.name: law for law in vars(_core).values() if hasattr(law, "_simulate")
}


def is_core_law(law: object) -> TypeGuard[CoreLaw]:
    """Return whether a law is one of the core, not a class.

    `isinstance` compares every member of the protocol, which takes longer than a run of 0.1 s.
    """
    return hasattr(type(law), "_simulate")
