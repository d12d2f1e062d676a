"""How a law is made for a device, or checked if it is finished."""

from __future__ import annotations

import inspect
import warnings
from typing import TYPE_CHECKING, Any

from ebac._core import Device, DeviceFacts, Timing
from ebac._util.arguments import require, shown
from ebac._util.copying import refuse_uncopyable
from ebac._util.design_errors import by_cause
from ebac.laws.protocols import CoreLaw, PythonLaw, is_core_law
from ebac.laws.tuned_laws import tuned, tuned_laws
from ebac.laws.variant import AnyLaw, Variant, class_of, law_name

if TYPE_CHECKING:
    from ebac.scenario import Scenario


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
        kind = class_of(law)
        names = [field.name for field in kind.fields()]
        if not fitted:
            changes = {**{gain: 0.0 for gain in FORCE_GAINS if gain in names}, **changes}
        try:
            made = kind.design(device, timing, **changes)
        except ValueError as error:
            raise ValueError(by_cause(str(error), device, timing, changes)) from None
    elif changes:
        raise TypeError(f"{law!r} is finished: make it with {', '.join(changes)}, or give its name")
    else:
        made = checked(law)
        if is_core_law(made) and made.timing.dt != timing.dt:
            warnings.warn(
                f"{law_name(made)} is made for dt = {made.timing.dt:g} s and runs at {timing.dt:g} s: give its name or "
                f"class to have it designed, changes as in ebac.Variant({law_name(made)!r}, {{'kp': 0.2}})",
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


#: Why a law in Python is refused by a loop in real time, and what to do.
IN_PYTHON = (
    "is written in Python, and this loop runs no Python; write it in C++ (docs/how-to/write_a_law.md), or try it with "
    "`ebac wall` or ebac.simulate"
)


def compiled(law: CoreLaw | PythonLaw) -> CoreLaw:
    """Return a finished law that is compiled, for a loop that runs no Python. Raises TypeError for one in Python."""
    if not is_core_law(law):
        raise TypeError(f"law {law_name(law)}: {IN_PYTHON}")
    return law


def reserve_of(law: CoreLaw | PythonLaw, scenario: Scenario) -> float | None:
    """Return the energy [J] that a law's account begins with in a scenario; None for a law without a reserve.

    Less where the law acts on the estimate of a state observer, which needs a force sensor.
    """
    observed = scenario.designed_observer() is not None and getattr(law, "observer", False)
    reserve: float | None = getattr(law, "observed_reserve" if observed else "reserve", None)
    return reserve
