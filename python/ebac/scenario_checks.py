"""What a scenario takes: the types of its parts, their ranges, and where a parameter of other things belongs."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos
from typing import TYPE_CHECKING, Any, Final

from ebac._core import Corner, Device, Disc, Free, Hand, Observer, Step, Timing, Wall, _World
from ebac._util.arguments import did_you_mean, shown
from ebac._util.plural import plural
from ebac._util.serialisation import SHAPES

if TYPE_CHECKING:
    from ebac.scenario import Scenario

#: The observer that every law acts on.
EVERY_LAW: Final = "every-law"
LEARNS_SCALE: Final = "learns-scale"
#: What a name changes of the observer that is designed from device and timing.
NAMED_OBSERVERS: Final = {EVERY_LAW: {"every_law": True}, LEARNS_SCALE: {"learn_scale": True}}
_NAMES: Final = " or ".join(map(repr, NAMED_OBSERVERS))
#: What its numbers are.
NUMBERS: Final = {"seconds": "a number in s", "jitter": "a number", "seed": "a whole number"}
#: What its parts may be.
_TYPES: Final[Mapping[str, tuple[type, ...]]] = {
    "device": (Device,),
    "hand": (Hand,),
    "environment": (Free, Wall, Corner, Disc, _World),
    "timing": (Timing,),
    "seconds": (float, int),
    "jitter": (float, int),
    "seed": (int,),
    "observer": (Observer, bool, str),
}
PARTS: Final = tuple(_TYPES)


def as_environment(given: Any) -> Any:
    """Return the world of a solid or body of `ebac.worlds`, and anything else as it is."""
    if not type(given).__module__.startswith("ebac.worlds") and not isinstance(given, SHAPES):
        return given
    from ebac.worlds import World

    return given if isinstance(given, _World) else World(given)


def part_of(name: str) -> str:
    """Return where a parameter belongs that people look for in a scenario."""
    if name == "law":
        return "a law is an argument of ebac.simulate"
    owners = [("environment", kind) for kind in (Wall, Free, Corner, Disc)]
    for part, kind in (("timing", Timing), ("hand", Hand), ("device", Device), *owners):
        if name.lower() == kind.__name__.lower():
            return f"give {part}=ebac.{kind.__name__}(...)"
        if name in kind().as_dict():
            return f"it belongs to {kind.__name__}, {part}=ebac.{kind.__name__}({name}=...)"
    return ""


def check_types(scenario: Scenario) -> None:
    """Raise TypeError for a part of another type, and ValueError for an observer that does not exist."""
    for name, types in _TYPES.items():
        value = getattr(scenario, name)
        if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
            names = NUMBERS.get(name) or " or ".join(
                _NAMES if t is str else t.__name__.lstrip("_") for t in types
            )
            given = shown(value) if isinstance(value, type) else repr(value)
            raise TypeError(f"Scenario.{name} = {given}: must be {names}")
    observer = scenario.observer
    if isinstance(observer, str) and observer not in NAMED_OBSERVERS:
        raise ValueError(
            f"Scenario.observer = {observer!r}: must be True, False, {_NAMES}, or an Observer"
            f"{did_you_mean(observer, NAMED_OBSERVERS)}"
        )


def check_ranges(scenario: Scenario) -> None:
    """Raise ValueError for a number out of its range, or an observer of a device without a force sensor."""
    seconds, jitter, seed = scenario.seconds, scenario.jitter, scenario.seed
    if not isinstance(scenario.observer, bool) and not scenario.device.sensor.fitted:
        raise ValueError(
            "Scenario.observer: estimates the state from a measured force, but the device has no force sensor; "
            "leave the observer out, or give the device one"
        )
    if not 0 < seconds <= 1e5:
        raise ValueError(f"Scenario.seconds = {seconds} s: must lie in (0, 100000] s")
    if not 0 <= jitter <= 0.45:
        raise ValueError(f"Scenario.jitter = {jitter}: must lie in [0, 0.45] of a sample")
    if not 0 <= seed < 2**63:
        raise ValueError(f"Scenario.seed = {seed}: must lie in [0, 2^63)")
    if seconds < scenario.timing.dt:
        raise ValueError(
            f"Scenario.seconds = {seconds} s: must be at least one sample, {scenario.timing.dt} s"
        )


def check_axes(scenario: Scenario) -> None:
    """Raise ValueError for an environment or path on axes the device does not have."""
    axes, world = scenario.device.axes, scenario.environment
    across = isinstance(world, Wall) and abs(cos(world.angle)) < 1e-3
    if axes < 2 and (across or isinstance(world, (Corner, Disc))):
        raise ValueError(
            f"Scenario.environment = {world!r}: needs 2 axes, the device has {axes}; "
            "give a device with Linear(axes=2) or Gimbal(), or a Wall across the first axis"
        )
    for axis, path in enumerate(scenario.hand.path[axes:], start=axes):
        if path != Step(target=0):
            raise ValueError(
                f"Scenario.hand.path[{axis}] = {path!r}: the device has {plural(axes, 'axis', 'axes')}; "
                "give it one path for each, or a device with more"
            )
