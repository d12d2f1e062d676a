"""Numbers of a configuration of `ebac run` that are possible, but more likely not meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac._util.doubts import device as of_device
from ebac._util.doubts import drives, law, sensor, wall

if TYPE_CHECKING:
    from ebac.hardware import Configuration

#: Limits that end a run when something goes wrong, and how many times its default makes one doubtful.
PROTECTS = (
    "speed",
    "jump",
    "end",
    "force_age",
    "unexplained",
    "overruns",
    "pause",
    "starved",
    "slew",
)
LOOSE = 10


def all_doubts(known: Configuration, *, no_observer: str = "observer = false") -> tuple[str, ...]:
    """Return what of a configuration is likely not meant: of device, wall, force sensor, and their limits.

    `no_observer` is how the reader turns the observer off.
    """
    found = [
        *of_device.doubts(known.device, no_observer=no_observer),
        wall.of_world(known.environment),
        *([] if known.sensor is None else sensor.doubts(known.sensor)),
        *doubts(known),
    ]
    return tuple(filter(None, found))


def doubts(known: Configuration) -> list[str]:
    """Return a sentence for each number of the run that is likely not meant, with the remedy."""
    return [
        *_default_wall(known),
        *_weight_of_the_joystick(known),
        *_edge_behind_the_stops(known),
        *drives.doubts(known),
        *_winding_of_the_reference(known),
        *_loose_limits(known),
        *_sensor_of_the_device_alone(known),
        *_other_device_of_the_law(known),
    ]


def _other_device_of_the_law(known: Configuration) -> list[str]:
    device, timing = known.device, known.timing
    has_sensor = known.sensor is not None
    return law.doubts(known.law, known.changes, device, timing, sensor=has_sensor)


def _winding_of_the_reference(known: Configuration) -> list[str]:
    from ebac.hardware.rating import unknown_winding

    return [f"{text}; {remedy}" for text, remedy in unknown_winding(known)]


def _sensor_of_the_device_alone(known: Configuration) -> list[str]:
    from ebac._util.toml import parsed

    table = parsed(known.text).get("device", {}).get("sensor", {})
    if known.sensor is not None or not table or not table.get("fitted", True):
        return []
    return [
        "[device.sensor] without [sensor]: this run has no force sensor, the gains of its force loop are 0, and "
        "[device.sensor] is not used; add [sensor] with host and "
        "counts_per_force, or leave out [device.sensor]"
    ]


def _default_wall(known: Configuration) -> list[str]:
    from ebac._core import Wall
    from ebac._util.toml import parsed

    wall = known.environment
    if (
        known.engine
        or not known.text
        or "environment" in parsed(known.text)
        or not isinstance(wall, Wall)
    ):
        return []
    return [
        f"no [environment]: the default wall of {wall.stiffness:g} N/m stands at {wall.position:g} m, where the zero "
        'of the handle is; write [environment], with type = "Free" for none'
    ]


def _weight_of_the_joystick(known: Configuration) -> list[str]:
    from ebac._util.toml import parsed

    table = parsed(known.text).get("device", {})
    gravity = known.device.mechanics.gravity
    if not table or "preset" in table or "gravity" in table.get("mechanics", {}) or not gravity:
        return []
    weight = known.device.mechanics.handle_mass * gravity
    return [
        f"device.mechanics.gravity = {gravity:g} m/s^2 is that of the joystick, from which [device] starts without a "
        f"preset: the handle has a weight of {weight:.3g} N; write gravity = 0.0 where a spring or counterweight "
        f"carries it, else gravity = {gravity:g}"
    ]


def _edge_behind_the_stops(known: Configuration) -> list[str]:
    kinematics = known.device.kinematics
    way = float((kinematics.travel * kinematics.stops)[0])
    if known.limits.edge <= way:
        return []
    return [
        f"limits.edge = {known.limits.edge:g} m: the stops lie before it, {way:.4g} m from the middle "
        f"(device.kinematics.limit = {kinematics.limit:g} rad), so that the soft wall there never acts; lower edge and "
        "end, or leave them out: then they follow from the stops"
    ]


def _loose_limits(known: Configuration) -> list[str]:
    from ebac._core import Limits

    usual = Limits.of(known.device)
    loose = [
        (one.name, getattr(known.limits, one.name), getattr(usual, one.name), one.unit)
        for one in Limits.fields()
        if one.name in PROTECTS
        and getattr(known.limits, one.name) >= LOOSE * getattr(usual, one.name)
    ]
    return [
        f"limits.{name} = {value:g} {unit}: the default for this device is {default:.3g} {unit}; so loose a limit "
        "hardly protects: lower it, or leave it out"
        for name, value, default, unit in loose
    ]
