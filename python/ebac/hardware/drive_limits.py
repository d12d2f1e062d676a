"""The largest torque and current that the profiles of the drives allow: a run may want more."""

from __future__ import annotations

from math import inf, sqrt
from typing import TYPE_CHECKING

from ebac.drives.profile_fields import BY_NAME
from ebac.hardware.world_place import ends_of

if TYPE_CHECKING:
    from ebac._core import Device
    from ebac.drives.network import Network
    from ebac.drives.profile import Profile
    from ebac.hardware.configuration import Configuration

#: Share by which a drive may allow less than the device: both are rounded.
ROUNDING = 2e-3
#: Share by which it may allow more: the rated torques of device and profile may differ by 1 %.
_SAME_PEAK = 0.02

_LIMITS = ("limits.max_torque", "limits.max_current")


def allowed_ratio(network: Network) -> tuple[float, str]:
    """Return the largest torque that every drive lets through, over its rated one, and what limits it.

    Parameters
    ----------
    network : Network
        The drives. A limit is a whole number of thousandths of the rated value (0x6072, 0x6073).

    Returns
    -------
    ratio : float
        inf where no profile has a limit.
    key : str
        Such as "node 1: limits.max_current = 0.1 A"; empty for inf.
    """
    least, key = inf, ""
    for node in network.nodes:
        for name in _LIMITS:
            ratio = _ratio(node.profile, name)
            if ratio < least:
                given = BY_NAME[name].show(node.profile.values[name])
                least, key = ratio, f"node {node.id}: {name} = {given}"
    return least, key


def above_peak(network: Network, device: Device | None = None) -> list[tuple[str, str, str]]:
    """Return each limit of the drives that lets through more than their motor is to take.

    Parameters
    ----------
    network : Network
        The drives, whose own limits hold where the loop is wrong.
    device : Device, optional
        The peak is `drive.peak_ratio` times the rated torque of its motor; without it, that of `motor.peak_torque` in
        each profile that has one.

    Returns
    -------
    list of (key, sentence, remedy)
        One for all nodes with the same value.
    """
    alike: dict[tuple[str, float, float], list[str]] = {}
    for node in network.nodes:
        for name, peak in _peaks(node.profile, device).items():
            value = node.profile.values.get(name)
            if value is not None and float(value) > peak * (1 + _SAME_PEAK):
                alike.setdefault((name, float(value), peak), []).append(str(node.id))
    whose, by, higher = ("motor", "motor.peak_torque", "motor.peak_torque")
    if device is not None:
        by = f"device.drive.peak_ratio {device.drive.peak_ratio:g} x the motor's rating"
        whose, higher = "device", "peak_ratio"
    found = []
    for (name, value, peak), ids in alike.items():
        key, nodes = BY_NAME[name], f"{'node' if len(ids) == 1 else 'nodes'} {', '.join(ids)}"
        sentence = (
            f"{nodes} of {network.name}: {name} = {key.show(value)}, more than the peak of the {whose}, {peak:.4g} "
            f"{key.unit} ({by}): the drive does not protect this motor"
        )
        remedy = f"give at most {peak:.4g} in the profile, or a higher {higher} where the motor takes more"
        found.append((name, sentence, remedy))
    return found


def _peaks(profile: Profile, device: Device | None) -> dict[str, float]:
    """Return the largest value of each limit by the motor of the device, or of the profile."""
    if device is not None:
        torque = device.drive.peak_ratio * device.motor.rated_torque
        current = device.drive.peak_current(device.motor)
        return dict(zip((*_LIMITS, "motor.peak_torque"), (torque, current, torque), strict=True))
    peak, rated = (
        profile.values.get(name) for name in ("motor.peak_torque", "limits.rated_torque")
    )
    if peak is None or rated is None:
        return {}
    ratio = float(peak) / float(rated)
    each = {name: profile.values.get(BY_NAME[name].per) for name in _LIMITS}
    return {name: ratio * float(one) for name, one in each.items() if one is not None}


def held_back(device: Device, network: Network) -> Device:
    """Return the device with a peak that every drive lets through; the same one where they let through its own."""
    ratio, _ = allowed_ratio(network)
    if ratio >= device.drive.peak_ratio * (1 - ROUNDING):
        return device
    return device.replace(drive=device.drive.replace(peak_ratio=max(ratio, 0.01)))


def thrown(known: Configuration, axis: int, seconds: float) -> tuple[float, float, float]:
    """Return what a drive that holds its largest torque does to a free handle at its zero.

    Parameters
    ----------
    known : Configuration
        Device, drives and limits.
    axis : int
        Which axis, from 0.
    seconds : float
        For how long the torque is held [s]; inf for ever.

    Returns
    -------
    force : float
        That of the least of the peak of the device, `limits.peak_current` and the drive's own limit [N].
    way : float
        How far it moves the handle in that time, without friction [m].
    to_the_end : float
        After what time the handle is at the end of the workspace [s].
    """
    device = held_back(known.device, known.drives)
    current = min(device.drive.peak_current(device.motor), known.limits.peak_current)
    gear = float(device.kinematics.travel[0] / device.kinematics.travel[axis])
    force = device.force(current) * gear
    acceleration = force / (device.mechanics.handle_mass + device.reflected_mass * gear**2)
    end = float(ends_of(device, known.limits)[axis])
    return force, 0.5 * acceleration * seconds**2, sqrt(2 * end / acceleration)


def _ratio(profile: Profile, name: str) -> float:
    value, rated = profile.values.get(name), profile.values.get(BY_NAME[name].per)
    if value is None or rated is None:
        return inf
    return round(1000 * float(value) / float(rated)) / 1000
