"""The laws by name, and how a law is made for a device."""

from __future__ import annotations

from typing import Any, ClassVar, Protocol, TypeAlias, runtime_checkable

from ebac import _core
from ebac._core import Device, DeviceFacts, Port, Rows, Setup, Timing


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

    def step(self, port: Port) -> float:
        """Return the force [N] for one tick of one axis."""
        ...

    def reset(self) -> None:
        """Forget everything but the parameters."""
        ...

    def _simulate(self, setup: Setup, through_can: bool = False) -> Rows: ...


#: Every law of this package by its name, in the order in which they are bound.
LAWS: dict[str, type[CoreLaw]] = {
    law.name: law for law in vars(_core).values() if hasattr(law, "_simulate")
}


@runtime_checkable
class PythonLaw(Protocol):
    """A law written in Python: the same loop runs it, some ten times slower.

    One independent deep copy is made for each axis. What it raises stops the loop with zero force and is
    raised again after the run.
    """

    def step(self, port: Port) -> float:
        """Return the force [N] for one tick of one axis; positive resists +x."""
        ...

    def reset(self) -> None:
        """Forget everything but the parameters; called before the first tick."""
        ...


AnyLaw: TypeAlias = str | type[CoreLaw] | CoreLaw | PythonLaw


def design(
    law: AnyLaw, device: Device | DeviceFacts, timing: Timing, **changes: Any
) -> CoreLaw | PythonLaw:
    """Make a law for a device.

    Parameters
    ----------
    law : str, law class, law or PythonLaw
        A name of `LAWS` or a class of the core is designed from `device` and `timing`, never from the
        wall or the hand. A finished law comes back as it is.
    device : Device or DeviceFacts
        What a user can know of the device.
    timing : Timing
        Sample time [s] and transport delay [samples].
    **changes
        Parameters to set on top of the design, in their SI units.

    Returns
    -------
    law
        Ready to simulate.

    Raises
    ------
    KeyError
        For a name that is no law.
    ValueError
        For a parameter out of range.
    TypeError
        For something that is no law.
    """
    if isinstance(law, str):
        if law not in LAWS:
            raise KeyError(f"no law is called {law!r}; there are: {', '.join(LAWS)}")
        law = LAWS[law]
    if isinstance(law, type):
        if not hasattr(law, "_simulate"):
            raise TypeError(
                f"{law.__name__} is a class: give an instance of it, {law.__name__}(...)"
            )
        return law.design(device, timing, **changes)
    if changes:
        raise TypeError(f"{law!r} is finished: make it with {', '.join(changes)}, or give its name")
    if not isinstance(law, PythonLaw):
        raise TypeError(f"{law!r} is no law: it needs step(port) -> float and reset()")
    return law


def law_name(law: CoreLaw | PythonLaw) -> str:
    """Return the name a law goes by in tables and plots."""
    return str(getattr(law, "name", type(law).__name__))
