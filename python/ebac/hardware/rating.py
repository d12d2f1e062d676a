"""Limits of a run against what the data sheet of the motor allows."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac._core import Limits, Motor
from ebac._util.toml import parsed
from ebac._util.toml_lines import placed
from ebac.hardware.tables import ConfigurationError

if TYPE_CHECKING:
    from ebac.hardware.configuration import Configuration

#: Share by which a current may exceed the data sheet: rounding in a file is no overload.
_ROUNDING = 1e-3
#: The same for the time constant, of which only a number from memory is known.
_FROM_MEMORY = 0.05


def check_rating(known: Configuration) -> None:
    """Refuse limits that let through more current, or for longer, than motor and drive are made for.

    Parameters
    ----------
    known : Configuration
        Its motor's rated torque and torque constant, and its drive's peak, give the largest currents [A]. The largest
        time constant of the winding [s] is that of an RE 30 for every motor, and 5 % more.

    Raises
    ------
    ConfigurationError
        For the first limit beyond; the message has file, line, both numbers and the remedy.
    """
    for name, wrong in beyond_rating(known):
        raise ConfigurationError(f"{wrong}: the motor may burn; {remedy(name)}")


def remedy(name: str) -> str:
    """Return what to do about a limit that is beyond the data sheet."""
    other = (
        "look it up in your motor's data sheet"
        if name == "thermal_time"
        else "correct the device's motor"
    )
    return (
        f"lower it, {other}, or run it with `ebac run --beyond-rating` (in Python beyond_rating=True), "
        "which allows every limit beyond and notes each"
    )


def beyond_rating(known: Configuration) -> list[tuple[str, str]]:
    """Return each limit beyond the data sheet: its name, and file, line and both numbers in words."""
    rated = Limits.of(known.device)
    found = []
    for name, unit, what, share in (
        ("continuous_current", "A", "current that the motor takes for ever (motor.rated_torque)", _ROUNDING),
        ("peak_current", "A", "peak of its drive (drive.peak_ratio)", _ROUNDING),
        ("thermal_time", "s", "time constant of an RE 30's winding, from memory of its data sheet", _FROM_MEMORY),
    ):  # fmt: skip
        asked, most = float(getattr(known.limits, name)), float(getattr(rated, name))
        if asked > most * (1 + share):
            text = f"limits.{name} = {asked:g} {unit}: is beyond the {what}, {most:.4g} {unit}"
            found.append((name, placed(known.name, known.text, ("limits", name), text)))
    return found


def unknown_winding(known: Configuration) -> list[tuple[str, str]]:
    """Return in words, and with the remedy, that another motor is limited by the time constant of an RE 30."""
    time = known.limits.thermal_time
    given = "thermal_time" in parsed(known.text).get("limits", {})
    if given or time != Limits.of(known.device).thermal_time or known.device.motor == Motor():
        return []
    text = (
        f"limits.thermal_time is not given: {time:g} s of an RE 30 are taken, but [device.motor] is another motor, "
        "which may burn"
    )
    return [(text, "give the thermal time constant of the winding [s] from its data sheet")]
