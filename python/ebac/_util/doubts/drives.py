"""Drives of a configuration that allow too little or too much, or are for another motor or sample time."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.hardware import Configuration


def doubts(known: Configuration) -> list[str]:
    """Return a sentence for each value of the drives that is likely not meant, with the remedy."""
    return other_motor(known) or [*_weak(known), *_strong(known), *of_sync(known)]


def other_motor(known: Configuration) -> list[str]:
    """Return in what the drives are for another motor than that of the device."""
    from ebac.hardware import fit

    found = fit.other_motor(known.device, known.drives)
    return [f"bus.drives: {found}"] if found else []


def _weak(known: Configuration) -> list[str]:
    from ebac.hardware.drive_limits import ROUNDING, allowed_ratio

    motor = known.device.motor
    ratio, key = allowed_ratio(known.drives)
    allowed = ratio * motor.current(motor.rated_torque)
    if allowed >= known.limits.peak_current * (1 - ROUNDING):
        return []
    return [
        f"{key} in {known.drives.name}: the drive lets through {allowed:.4g} A, {known.device.force(allowed):.3g} N at "
        f"the handle, less than limits.peak_current = {known.limits.peak_current:.4g} A, and the law does not know it; "
        f"lower limits.peak_current (and continuous_current) to {allowed:.4g}, or raise the limit of the profile"
    ]


def _strong(known: Configuration) -> list[str]:
    from ebac.hardware.drive_limits import above_peak

    found = above_peak(known.drives, known.device)
    return [f"{text}; {remedy}" for _, text, remedy in found]


def of_sync(known: Configuration, option: str = "") -> list[str]:
    """Return which drives have another SYNC period than the loop; `option` is what gives that of the loop."""
    from ebac._util.toml import parsed
    from ebac.hardware.drive_setup import other_sync

    if "bus" not in parsed(known.text):  # its drives are only simulated
        return []
    alike: dict[str, list[str]] = {}
    for node, text, remedy in other_sync(known, option):
        if remedy:
            alike.setdefault(f"{text}; {remedy}", []).append(str(node))
    return [
        f"{'node' if len(ids) == 1 else 'nodes'} {', '.join(ids)} of {known.drives.name}: {text}"
        for text, ids in alike.items()
    ]
