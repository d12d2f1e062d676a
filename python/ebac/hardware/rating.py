"""Limits of a run against what the data sheet of the motor allows."""

from __future__ import annotations

from ebac._core import Device, Limits
from ebac.hardware.tables import ConfigurationError

#: Share by which a limit may exceed the data sheet: rounding in a file is no overload.
_ROUNDING = 1e-3


def check_rating(limits: Limits, device: Device) -> None:
    """Refuse limits that let through more current, or for longer, than motor and drive are made for.

    Parameters
    ----------
    limits : Limits
        Of the run.
    device : Device
        Its motor's rated torque and torque constant, and its drive's peak, give the largest currents [A]. The largest
        time constant of the winding [s] is that of an RE 30 for every motor.

    Raises
    ------
    ConfigurationError
        For the first limit beyond; the message has both numbers and the remedy.
    """
    rated = Limits.of(device)
    for name, what in (
        ("continuous_current", "current that the motor takes for ever (motor.rated_torque)"),
        ("peak_current", "peak of its drive (drive.peak_ratio)"),
        ("thermal_time", "time constant of an RE 30's winding, from memory of its data sheet"),
    ):
        asked, most = float(getattr(limits, name)), float(getattr(rated, name))
        if asked > most * (1 + _ROUNDING):
            of_winding = name == "thermal_time"
            unit = "s" if of_winding else "A"
            other = (
                "look it up in your motor's data sheet"
                if of_winding
                else "correct the device's motor"
            )
            raise ConfigurationError(
                f"limits.{name} = {asked:g} {unit}: is beyond the {what}, {most:.4g} {unit}: the motor may burn; lower "
                f"it, {other}, or pass --beyond-rating (in Python beyond_rating=True)"
            )
