"""The law of a run: one of the core, designed for the device."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ebac._core import Device, Timing
from ebac.laws import AnyLaw, CoreLaw, design
from ebac.laws.making import compiled


def designed(
    law: AnyLaw, changes: Mapping[str, Any], device: Device, timing: Timing, *, sensor: bool
) -> CoreLaw:
    """Return a law of the core, designed for a device. Without a force sensor the gains of its force loop are 0.

    Parameters
    ----------
    law : str, type or law
        As `ebac.design` takes it.
    changes : mapping of str to float
        Parameters that are not as designed [SI units].
    device : Device
        What it is designed for.
    timing : Timing
        Sample time and delay it is designed for.
    sensor : bool
        Whether the device has a force sensor.

    Raises
    ------
    TypeError
        For a law written in Python: the loop's thread never runs Python code.
    ValueError
        When a gain of the force loop is requested without a force sensor.
    """
    fitted = device if sensor else device.replace(sensor=None)
    return compiled(design(law, fitted, timing, **changes))
