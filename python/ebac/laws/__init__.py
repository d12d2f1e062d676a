"""The laws by name, and how a law is made for a device."""

from __future__ import annotations

import dataclasses
import inspect
import warnings
from collections.abc import Mapping, Sequence
from typing import (
    TYPE_CHECKING,
    Any,
    ClassVar,
    Protocol,
    TypeAlias,
    TypeGuard,
    cast,
    runtime_checkable,
)

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
from ebac._util.arguments import refuse_unknown, require, shown, unknown_name
from ebac._util.copying import refuse_uncopyable
from ebac._util.design_errors import by_cause
from ebac._util.wrong_calls import plain_constructor
from ebac.laws.tuned_laws import tuned, tuned_laws

if TYPE_CHECKING:
    from ebac.scenario import Scenario

__all__ = [
    "LAWS",
    "AnyLaw",
    "CoreLaw",
    "PythonLaw",
    "Variant",
    "changed",
    "design",
    "law_name",
]


def __dir__() -> list[str]:
    return __all__


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


#: Every law of this package by its name, in the order in which they are bound.
LAWS: dict[str, type[CoreLaw]] = {
    law.name: law for law in vars(_core).values() if hasattr(law, "_simulate")
}


def is_core_law(law: object) -> TypeGuard[CoreLaw]:
    """Return whether a law is one of the core, not a class.

    `isinstance` compares every member of the protocol, which takes longer than a run of 0.1 s.
    """
    return hasattr(type(law), "_simulate")


@runtime_checkable
class PythonLaw(Protocol):
    """A law written in Python: the same loop runs it, some ten times slower.

    One independent deep copy is made for each axis. With an attribute `observer` that is true it uses the estimate of
    the state observer, as `EBAC(observer=True)`: the world is met where the handle will be, and `port.est` is what
    the law goes by. What it raises ends the run: `simulate` raises a `LoopFault` that names the law.
    """

    def step(self, port: Port) -> float:
        """Return the force [N] for one tick of one axis; positive resists +x."""
        ...

    def reset(self) -> None:
        """Forget everything but the parameters; called before the first tick."""
        ...


@plain_constructor
@dataclasses.dataclass(frozen=True)
class Variant:
    """A law with parameters changed on top of its design, designed again wherever the law would be.

    Attributes
    ----------
    law : str or law class
        A name of `LAWS`, or a class of the core.
    changes : mapping
        Parameters by name, in their SI units.

    Raises
    ------
    KeyError
        For a name that is no law.
    ValueError
        For a parameter out of range.
    TypeError
        For something that is no law, a parameter that it does not have, or a value of a wrong type.
    """

    law: str | type[CoreLaw]
    changes: Mapping[str, Any]

    def __post_init__(self) -> None:
        """Check law and changes."""
        require(self.law, (str, type), "Variant", "a law of ebac.LAWS or its class")
        require(self.changes, Mapping, "Variant", "changes by name, as in {'kp': 0.2}")
        kind = _class_of(self.law)
        refuse_unknown(kind.__name__, self.changes, [field.name for field in kind.fields()])
        kind(**self.changes)

    @property
    def name(self) -> str:
        """The law's name and its changes: "ebac, guard = off"."""
        return ", ".join(
            [law_name(self.law), *(f"{n} = {shown_value(v)}" for n, v in self.changes.items())]
        )


AnyLaw: TypeAlias = str | type[CoreLaw] | type[PythonLaw] | CoreLaw | PythonLaw | Variant


def design(
    law: AnyLaw, device: Device | DeviceFacts, timing: Timing, **changes: Any
) -> CoreLaw | PythonLaw:
    """Make a law for a device.

    Parameters
    ----------
    law : str, law class, Variant, law or PythonLaw
        A name of `LAWS`, a class of the core or a `Variant` is designed from `device` and `timing`, never from the
        wall or the hand; so is a class in Python that has a classmethod `design(facts, timing)`, `facts` being a
        `DeviceFacts`. A finished law comes back as it is. "tca-damped-tuned" is `tca-damped` with what
        `ebac tune` found for the reference device and the nearest delay; "tca-damped-tuned-observer" with what it found
        for a law that acts on the observer's estimate, as it then does.
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
        For a parameter out of range, and for gains of a force loop that are not 0 where the device has no force sensor
        (`Device(sensor=None)`); those of a design are 0 then.
    TypeError
        For something that is no law, whose `step` or `reset` takes other arguments, or that cannot be copied.

    Warns
    -----
    UserWarning
        When a finished law of the core was made for another sample time.
    """
    require(
        device, (Device, DeviceFacts), "ebac.design", "a Device, or its DeviceFacts, behind the law"
    )
    require(timing, Timing, "ebac.design", "a Timing behind the device")
    if isinstance(law, Variant):
        return design(law.law, device, timing, **{**law.changes, **changes})
    fitted = device.sensor.fitted if isinstance(device, Device) else device.force_sensor
    if isinstance(law, type) and not hasattr(law, "_simulate") and hasattr(law, "design"):
        facts = device.facts if isinstance(device, Device) else device
        made: CoreLaw | PythonLaw = checked(law.design(facts, timing, **changes))
    elif isinstance(law, (str, type)):
        if isinstance(law, str) and law in tuned_laws():
            changes = {**tuned(law, timing.delay)[1], **changes}
        kind = _class_of(law)
        names = [field.name for field in kind.fields()]
        if not fitted:
            changes = {**{gain: 0.0 for gain in FORCE_GAINS if gain in names}, **changes}
        try:
            made = kind.design(device, timing, **changes)
        except ValueError as error:
            raise ValueError(by_cause(str(error), device, changes)) from None
    elif changes:
        raise TypeError(f"{law!r} is finished: make it with {', '.join(changes)}, or give its name")
    else:
        made = checked(law)
        if is_core_law(made) and made.timing.dt != timing.dt:
            warnings.warn(
                f"{law_name(made)} is made for dt = {made.timing.dt:g} s and runs at {timing.dt:g} s: give its name or "
                f"class to have it designed, changes as in Variant({law_name(made)!r}, {{'kp': 0.2}})",
                stacklevel=3,
            )
    if not fitted and is_core_law(made):
        _refuse_force_loop(made)
    elif not fitted and getattr(made, "observer", False):
        raise ValueError(
            f"the law {law_name(made)} has observer = True: it goes by the estimate of the state observer, which needs "
            "a force sensor, and the device has none; set the law's observer to False, or give the device a sensor"
        )
    return made


#: Gains of the force loop, eq. (2): they feed back a measured force.
FORCE_GAINS = ("kp", "kd")


def _refuse_force_loop(law: CoreLaw) -> None:
    """Raise ValueError for a law that feeds back a measured force."""
    for gain in FORCE_GAINS:
        if value := getattr(law, gain, 0.0):
            raise ValueError(
                f"{law.name}.{gain} = {value:g}: feeds back a measured force, but the device has no force sensor; "
                f"{gain} = 0, or a device with one, on hardware a table [sensor]"
            )


def _class_of(law: str | type) -> type[CoreLaw]:
    """Return the class of a law, which may go by its name or that of one with tuned parameters."""
    if isinstance(law, str):
        name = law.partition("-tuned")[0] if law in tuned_laws() else law
        if name not in LAWS:
            raise unknown_name("law", law, [*LAWS, *tuned_laws()])
        return LAWS[name]
    if not hasattr(law, "_simulate"):
        name = law.__name__
        raise TypeError(
            f"{name} is a class: give an instance of it, {name}(...), or give it a classmethod design(facts, timing)"
        )
    return cast("type[CoreLaw]", law)


#: What makes a law, and how it is written.
_NEEDS = {"step": "step(port) -> float", "reset": "reset()"}


def checked(law: Any) -> CoreLaw | PythonLaw:
    """Return a finished law. Raises TypeError unless it has step(port) and reset(), and can be copied."""
    if is_core_law(law):
        return law
    if not isinstance(law, PythonLaw) or isinstance(law, type):
        lacks = [needs for name, needs in _NEEDS.items() if not hasattr(law, name)]
        what = type(law).__name__ if len(lacks) < len(_NEEDS) else shown(law)
        raise TypeError(f"{what} is no law: it needs {' and '.join(lacks)}")
    for name, given, what in (("step", ["port"], "the port of one axis"), ("reset", [], "nothing")):
        try:
            takes = inspect.signature(getattr(law, name))
        except (TypeError, ValueError):  # not callable, or without a signature
            continue
        try:
            takes.bind(*given)
        except TypeError:
            raise TypeError(
                f"{type(law).__name__}.{name}({', '.join(takes.parameters)}) is called with {what}: write it as "
                f"{name}({', '.join(['self', *given])})"
            ) from None
    refuse_uncopyable(law, "law")
    return law


def changed(law: AnyLaw, **changes: Any) -> AnyLaw:
    """Return a law with some parameters changed, to be used wherever the law can be.

    Parameters
    ----------
    law : str, law class, Variant, law or PythonLaw
        What is designed stays so, as a `Variant`; a finished law is copied, one in Python when it is a dataclass.
    **changes
        Parameters in their SI units.

    Raises
    ------
    TypeError
        For a law in Python that is no dataclass.
    """
    if isinstance(law, Variant):
        return Variant(law.law, {**law.changes, **changes})
    if isinstance(law, (str, type)):
        return Variant(cast("str | type[CoreLaw]", law), changes)
    if is_core_law(law):
        return law.replace(**changes)
    if not hasattr(law, "__dataclass_fields__"):
        raise TypeError(f"{law!r} cannot be changed: a law in Python must be a dataclass for that")
    own: Any = law
    return cast(PythonLaw, dataclasses.replace(own, **changes))


def reserve_of(law: CoreLaw | PythonLaw, scenario: Scenario) -> float | None:
    """Return the energy [J] that a law's account begins with in a scenario; None for a law without a reserve.

    Less where the law acts on the estimate of a state observer, which needs a force sensor.
    """
    observed = scenario.designed_observer() is not None and getattr(law, "observer", False)
    reserve: float | None = getattr(law, "observed_reserve" if observed else "reserve", None)
    return reserve


def law_name(law: AnyLaw) -> str:
    """Return the name a law goes by in tables and plots.

    Parameters
    ----------
    law : str, type or law
        A name, a law or a `Variant`.
    """
    if isinstance(law, str):
        return law
    kind = law if isinstance(law, type) else type(law)
    return str(getattr(law, "name", kind.__name__))


def shown_value(value: bool | float) -> str:
    """Return a parameter's value as people read it: on, off or a number."""
    return ("on" if value else "off") if isinstance(value, bool) else f"{value:g}"
