"""A scenario, a device, a hand, a world in words, each in one line."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, isclose
from typing import TYPE_CHECKING, Any

from ebac._core import (
    Corner,
    Device,
    Disc,
    Gimbal,
    Hand,
    MinimumJerk,
    SlidingGimbal,
    Step,
    Wall,
    _World,
)

if TYPE_CHECKING:
    from ebac.scenario import Environment, Scenario


def describe(scenario: Scenario) -> str:
    """Return device, hand, virtual world and time of a scenario in one line."""
    return "; ".join(
        (
            described_device(scenario.device),
            described_hand(scenario.hand),
            described_environment(scenario.environment),
            described_time(scenario),
        )
    )


def described_time(scenario: Scenario) -> str:
    """Return ticks, delay and observer of a scenario, then its length and seed."""
    timing = scenario.timing
    samples = "1 sample" if timing.delay == 1 else f"{timing.delay} samples"
    jitter = f", jitter {100 * scenario.jitter:g} %" if scenario.jitter else ""
    used = scenario.designed_observer()
    observer = ""
    if used is not None:
        learns = " that learns the scale" if used.learn_scale else ""
        laws = "every law" if used.every_law else "laws made for it"
        observer = f", state observer{learns} for {laws}"
    ticks = f"{_kilo(1 / timing.dt, 'Hz')}, {samples} of delay{jitter}{observer}"
    return f"{ticks}; {scenario.seconds:g} s, seed {scenario.seed}"


def _kilo(value: float, unit: str) -> str:
    return f"{value / 1e3:.6g} k{unit}" if value >= 1e3 else f"{value:.6g} {unit}"


def described_device(device: Device) -> str:
    """Return a device in words: "the reference device (0.25 kg, 2 N s/m, sensor without noise)"."""
    from ebac import presets

    kind = "joystick" if isinstance(device.kinematics, (Gimbal, SlidingGimbal)) else "device"
    known = [f"the {n} {kind}" for n, p in presets.DEVICES.items() if p.device == device]
    name = (
        known[0]
        .replace("joystick joystick", "joystick")
        .replace("joystick-3 joystick", "3-axis joystick")
        if known
        else f"a {kind}"
    )
    coulomb = device.mechanics.coulomb
    friction = f", friction {coulomb:g} N" if coulomb else ""
    if given_back := device.compensation.friction:
        friction += f", {given_back:g} N of friction compensated"
    weight = device.mechanics.handle_mass * device.mechanics.gravity
    hanging = f", weight {weight:.4g} N" if weight else ""
    level = device.sensor.noise
    noise = f", sensor noise {level:g} N" if level else ", sensor without noise"
    if not device.sensor.fitted:
        noise = ", no force sensor"
    permille = ", torque in per mille" if device.drive.permille else ""
    others = "" if known else "".join(f", {one}" for one in _unusual(device))
    dynamics = f"{device.mass:.4g} kg, {device.mechanics.damping:g} N s/m"
    return f"{name} ({dynamics}{hanging}{friction}{noise}{permille}{others})"


#: Fields of a device that its description has words of its own for.
_SAID = {
    "noise",
    "fitted",
    "permille",
    "handle_mass",
    "damping",
    "coulomb",
    "gravity",
    "peak_ratio",
}


def _unusual(device: Device) -> Iterator[str]:
    """Yield what else of a device is not as in the reference device: "count 5 um", "sensor bias 0.2 N"."""
    usual = Device()
    for name, value, reference, unit in (
        ("count", device.count, usual.count, "m"),
        ("peak force", device.peak_force, usual.peak_force, "N"),
    ):
        if not isclose(value, reference, rel_tol=1e-3):
            yield f"{name} {_prefixed(value, unit)}"
    for part in ("sensor", "drive", "motor", "mechanics"):
        given, reference = getattr(device, part), getattr(usual, part)
        if part == "sensor" and not given.fitted:
            continue
        for field in type(given).fields():
            value = getattr(given, field.name)
            if field.name in _SAID | _IN_FORCE or value == getattr(reference, field.name):
                continue
            name = f"{'' if part == 'mechanics' else part} {field.name.replace('_', ' ')}".strip()
            yield name if value is True else f"{name} {_prefixed(value, field.unit)}"


def _prefixed(value: float, unit: str) -> str:
    """Return a value with a prefix where it has one: "5 um", "2 ms", "0.2 N", "100 kN/m"."""
    if abs(value) >= 1e4:
        return f"{value / 1e3:.4g} k{unit}"
    if unit not in ("m", "s", "A") or not 0 < abs(value) < 1:
        return f"{value:.4g} {'' if unit == '1' else unit}".rstrip()
    small = abs(value) < 1e-3
    return f"{value * (1e6 if small else 1e3):.4g} {'u' if small else 'm'}{unit}"


#: Fields of the motor that its peak force and the mass at the handle stand for.
_IN_FORCE = {"torque_constant", "rated_torque", "rated_current", "stall_current", "rotor_inertia"}


def described_hand(hand: Hand) -> str:
    """Return a hand in words: "a hand (0.3 kg, 4 N s/m, 300 N/m, target 45 mm)"."""
    from ebac import presets
    from ebac.hands import is_own

    known = [f"the {name} hand" for name, p in presets.HANDS.items() if p.hand == hand]
    paths = list(hand.path)
    while len(paths) > 1 and paths[-1] == Step(target=0):
        paths.pop()
    targets = [path.target for path in paths if isinstance(path, (Step, MinimumJerk))]
    if is_own(hand.model):
        goal = "a force of its own"
    elif len(targets) == len(paths):
        goal = f"target {', '.join(f'{1e3 * target:g}' for target in targets)} mm"
    else:
        goal = " and ".join(dict.fromkeys(f"a {type(path).__name__} path" for path in paths))
    if hand.tremor_amplitude:
        goal += f", tremor {1e3 * hand.tremor_amplitude:g} mm at {hand.tremor_frequency:g} Hz"
    name = known[0] if known else "a hand"
    if hand.model is not None and not known:
        name = f"a hand with {type(hand.model).__name__}"
    return f"{name} ({hand.mass:g} kg, {hand.damping:g} N s/m, {hand.stiffness:g} N/m, {goal})"


def described_environment(environment: Environment) -> str:
    if isinstance(environment, Corner):
        return f"a corner of {described_environment(environment.first)} and {described_environment(environment.second)}"
    if isinstance(environment, Disc):
        centre = f"({1e3 * environment.x:g}, {1e3 * environment.y:g}) mm"
        size = f"{1e3 * environment.radius:g} mm"
        return f"a disc of {_kilo(environment.stiffness, 'N/m')}, radius {size}, at {centre}"
    if isinstance(environment, _World):
        return world(environment)
    if not isinstance(environment, Wall):
        return "free air"
    damping = f" and {environment.damping:g} N s/m" if environment.damping else ""
    angle = f", turned by {degrees(environment.angle):.3g} deg" if environment.angle else ""
    place = f"{1e3 * environment.position:g} mm"
    moves = ""
    if swing := environment.motion_amplitude:
        moves = f", swinging by {1e3 * swing:g} mm at {environment.motion_frequency:g} Hz"
    return f"a wall of {_kilo(environment.stiffness, 'N/m')}{damping} at {place}{angle}{moves}"


#: Solids that are not called by their type.
NAMES = {"HeightField": "ground", "Mesh": "mesh"}


def world(given: Any) -> str:
    """Return what a world is made of: "a world of a sphere, 10 kN/m"."""
    if not hasattr(given, "bodies"):
        return _foreign(given)
    names = [_solid(body.solid) for body in given.bodies]
    shown = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
    materials = {_material(body.material) for body in given.bodies}
    frictions = {body.friction for body in given.bodies} - {0.0}
    held = f", friction {max(frictions):g}" if frictions else ""
    return f"a world of {shown}, {' and '.join(sorted(materials))}{held}"


def _foreign(given: Any) -> str:
    """Return what an engine computes, and how often: "a world of a plane, 10 kN/m, by an engine at 60 Hz"."""
    ideal = given.ideal()
    what = given.what if ideal is None else f"{world(ideal)}, by an engine"
    timing = getattr(given, "timing", None)
    if timing is None:
        return str(what)
    late = [f"{1e3 * timing.compute:.3g} ms late"] if timing.compute else []
    late += [f"{1e3 * timing.jitter:g} ms of jitter"] if timing.jitter else []
    held = ", its force held" if given.held else ""
    return f"{what} at {timing.rate:g} Hz{''.join(f', {one}' for one in late)}{held}"


def _solid(solid: Any) -> str:
    """Return what a solid is made of: "a sphere", "a cavity of a tube"."""
    kind = type(solid).__name__
    if kind == "Placed":
        return _solid(solid.solid)
    if kind == "Cavity":
        return f"the inside of {_solid(solid.solid)}"
    if kind in ("Union", "Intersection", "Difference"):
        first, *others = map(_solid, solid.solids)
        word = {"Union": "and", "Intersection": "within", "Difference": "less"}[kind]
        return f"{first} {word} {others[0] if len(others) == 1 else f'{len(others)} more'}"
    if kind == "Textured":
        return f"{_solid(solid.solid)} with a texture"
    article = "an" if kind[0] in "AEIOU" else "a"
    return f"{article} {NAMES.get(kind, kind.lower())}"


def _material(material: Any) -> str:
    kind = type(material).__name__
    if kind == "Elastic":
        damping = f" and {material.damping:g} N s/m" if material.damping else ""
        return f"{_kilo(material.stiffness, 'N/m')}{damping}"
    if kind == "HuntCrossley":
        return "soft after Hunt and Crossley"
    return f"{len(material.layers)} layers of tissue"
