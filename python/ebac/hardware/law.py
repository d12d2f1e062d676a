"""The law of a run: one of the core, designed for the device."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ebac._core import Device, Timing
from ebac.laws import LAWS, AnyLaw, CoreLaw, design

#: The gains of the force loop, eq. (2): they need a measured force.
FORCE_GAINS = ("kp", "kd")


def designed(
    law: AnyLaw, changes: Mapping[str, Any], device: Device, timing: Timing, *, sensor: bool
) -> CoreLaw:
    """Return a law of the core, designed for a device. Without a force sensor the gains of its force loop are 0.

    Raises
    ------
    TypeError
        For a law written in Python: the loop's thread never runs Python code.
    ValueError
        When a gain of the force loop is requested without a force sensor.
    """
    given = dict(changes)
    if not sensor and (isinstance(law, (str, type))):
        kind: Any = LAWS.get(law) if isinstance(law, str) else law
        names = [one.name for one in kind.fields()] if kind is not None else []
        for gain in FORCE_GAINS:
            if gain in names:
                given.setdefault(gain, 0.0)
    made = design(law, device, timing, **given)
    if not isinstance(made, CoreLaw):
        raise TypeError(
            f"{law!r} is written in Python: the loop's thread never touches Python, so only a law of "
            f"the core runs on hardware: {', '.join(LAWS)}"
        )
    if not sensor:
        for gain in FORCE_GAINS:
            if getattr(made, gain, 0.0):
                raise ValueError(
                    f"{made.name}.{gain} = {getattr(made, gain):g}: feeds back a measured force, but no force "
                    f"sensor is configured; {gain} = 0, or add a table [sensor]"
                )
    return made
