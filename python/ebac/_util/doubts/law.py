"""Parameters of a law that say something of the device other than the device itself."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ebac._core import Device, Timing
    from ebac.laws import AnyLaw

#: Parameters that a design takes from the device, and what sets them there.
OF_THE_DEVICE = {
    "mass": "handle_mass in [device.mechanics] and rotor_inertia in [device.motor]",
    "damping": "damping in [device.mechanics]",
    "count": "[device.encoder] and [device.capstan]",
    "current_lag": "current_lag in [device.drive]",
    "peak_force": "[device.motor], and peak_ratio in [device.drive]",
}
#: Share by which a number may differ: one that is rounded is no other device.
ROUNDING = 0.01


def doubts(
    law: AnyLaw, changes: Mapping[str, Any], device: Device, timing: Timing, *, sensor: bool
) -> list[str]:
    """Return a sentence for each parameter of a configured law that differs from the device, with both values.

    Parameters
    ----------
    law, changes
        Law, and parameters that replace those of its design.
    device, timing
        What the law is designed for.
    sensor : bool
        Whether the device has a force sensor.
    """
    from ebac.hardware.law import designed
    from ebac.laws import Variant

    if isinstance(law, Variant):
        changes = {**law.changes, **changes}
        law = law.law
    named = [name for name in OF_THE_DEVICE if name in changes]
    if not named or not isinstance(law, (str, type)):
        return []
    others = {name: value for name, value in changes.items() if name not in named}
    usual: Any = designed(law, others, device, timing, sensor=sensor)
    units = {field.name: field.unit for field in usual.fields()}
    found = []
    for name in named:
        own, known, unit = float(changes[name]), float(getattr(usual, name)), units[name]
        if abs(own - known) > ROUNDING * abs(known):
            found.append(
                f"law.{name} = {own:.4g} {unit}, but the device has {known:.4g} {unit}: the law is made for a device "
                f"that this one is not; leave out law.{name}, or correct {OF_THE_DEVICE[name]}"
            )
    return found
