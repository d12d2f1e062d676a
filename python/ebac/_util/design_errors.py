"""What is wrong with a device of which no law can be designed, by the number of it that the user gave."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from ebac._core import Device, DeviceFacts


def by_cause(message: str, device: Device | DeviceFacts, changes: Mapping[str, Any]) -> str:
    """Return what is wrong with a design, by the number of the device that it follows from."""
    found = re.match(r"(\w+\.(force_noise|damping)) = \S+ N(?: s/m)?: (.*)", message)
    if found is None or found[2] in changes or not isinstance(device, Device):
        return message
    if found[2] == "damping":
        return _spent_by_compensation(device, found[1]) or message
    noise = device.sensor.noise
    return f"ForceSensor.noise = {noise:g} N: {found[3]}, as {found[1]} follows from it"


def _spent_by_compensation(device: Device, parameter: str) -> str | None:
    """Return which compensation takes the damping that a law is designed from, if one does."""
    given, mechanics, left = device.compensation, device.mechanics, device.facts.damping
    leaves = f"leaves {left:.3g} N s/m of the device's damping of {mechanics.damping:g} N s/m for {parameter}"
    if given.friction > mechanics.coulomb:
        return (
            f"Compensation.friction = {given.friction:g} N: more than the Coulomb friction of the device, "
            f"{mechanics.coulomb:g} N, which {leaves}; compensate less, or declare the friction that is surely there"
        )
    if given.inertia > 0:
        remedy = "compensate less, or raise Compensation.inertia_lag"
        return f"Compensation.inertia = {given.inertia:g} kg: {leaves}; {remedy}"
    return None
