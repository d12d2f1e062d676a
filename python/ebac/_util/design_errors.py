"""What is wrong with a device or a timing of which no law can be designed, by the number that the user gave."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from ebac._core import Device, DeviceFacts, Timing
from ebac._util.plural import plural
from ebac._util.rated_current import LOOK


def by_cause(
    message: str, device: Device | DeviceFacts, timing: Timing, changes: Mapping[str, Any]
) -> str:
    """Return what is wrong with a design, by the number of the device, or the sample time, that it follows from."""
    facts = device.facts if isinstance(device, Device) else device
    made = re.match(r"(\w+)\.(\w+) = (\S+)( .*?)?: (must lie in \[[^]]*\][^;]*)", message)
    if made is not None and made[2] not in changes:
        if not hasattr(facts, made[2]):
            return _of_the_design(made, facts, timing)
        message = made[0]  # its unit is no mistake of the user either
    found = re.match(r"(\w+\.(force_noise|damping|peak_force)) = \S+ N(?: s/m)?: (.*)", message)
    if found is None or found[2] in changes or not isinstance(device, Device):
        return message
    if found[2] == "peak_force":
        motor = device.motor
        return (
            f"Motor.rated_torque = {motor.rated_torque:g} N m, torque_constant = {motor.torque_constant:g} N m/A: "
            f"{found[1]} = {device.peak_force:.4g} N, which follows from the motor, {found[3]}; {LOOK}, the radii of "
            "capstan and lever in m (mm x 1e-3)"
        )
    if found[2] == "damping":
        own = f"Mechanics.damping = {device.mechanics.damping:g} N s/m: {found[3]}, as {found[1]} follows from it"
        return _spent_by_compensation(device, found[1]) or own
    noise = device.sensor.noise
    return f"ForceSensor.noise = {noise:g} N: {found[3]}, as {found[1]} follows from it"


def _of_the_design(made: re.Match[str], facts: DeviceFacts, timing: Timing) -> str:
    """Return that a design computed a number out of its range, and from what."""
    law, name, value, unit, must = made.groups()
    return (
        f"Timing.dt = {timing.dt:g} s ({1 / timing.dt:.4g} Hz): for it, {plural(timing.delay, 'sample')} of delay and "
        f"a device of {facts.mass:.3g} kg the design of {law} gives {name} = {float(value):.4g}{unit or ''}, which "
        f"{must}; give another dt or mass, {name} itself, or another law"
    )


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
