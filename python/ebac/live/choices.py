"""What the page of `ebac live` lets one choose: devices, worlds, hands, laws."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal, Self

from ebac import presets
from ebac._core import Disc, Free, Limits, Wall
from ebac._util.arguments import nearest_float, plain, unknown_name
from ebac.hardware import Configuration
from ebac.laws import LAWS
from ebac.scenario import Environment, Scenario

#: The world as a file or a scenario has it.
CONFIGURED = "as configured"
#: Where the surface of a world stands, from the middle of the device [m].
SURFACE = 0.01
#: Ranges of what has a slider: of a wall's stiffness [N/m] and damping [N s/m], and of the delay [samples].
RANGES = {"stiffness": (100.0, 50e3), "damping": (0.0, 100.0), "delay": (1, 8)}
UNITS = {"stiffness": "N/m", "damping": "N s/m", "delay": "samples"}
_OWN_MATERIAL = ("soft", "tissue")


@dataclass(frozen=True, kw_only=True)
class Choices:
    """What is chosen. Stiffness and damping are those of the world's surface [N/m, N s/m], the delay in samples."""

    law: str = "ebac"
    observer: bool = False
    delay: int = 1
    hand: str = CONFIGURED
    world: str = CONFIGURED
    device: str = CONFIGURED
    stiffness: float = 10e3
    damping: float = 0.0

    def with_changes(self, changes: dict[str, Any], laws: Iterable[str] = LAWS) -> Self:
        """Return a copy with some of them changed, each checked; `laws` are the names of the laws there are.

        Raises
        ------
        KeyError
            For an unknown name.
        ValueError
            For a type or a number that cannot be.
        """
        changes = {name: plain(value) for name, value in changes.items()}
        for name, value in changes.items():
            _check(name, value, options(laws))
        return replace(self, **changes)

    def row(self) -> dict[str, Any]:
        """Return them by name."""
        return asdict(self)


def options(laws: Iterable[str] = LAWS) -> dict[str, list[str]]:
    """Return the names to choose from; `laws` as in `Choices.with_changes`."""
    from ebac.worlds.presets import PRESETS

    return {
        "law": list(laws),
        "hand": [CONFIGURED, *presets.HANDS],
        "world": [
            CONFIGURED,
            "wall",
            "disc",
            "free",
            *(n for n, p in PRESETS.items() if not p.extra),
        ],
        "device": [CONFIGURED, *presets.DEVICES],
    }


def _check(name: str, value: Any, names: dict[str, list[str]]) -> None:
    if name in names:
        if not isinstance(value, str) or value not in names[name]:
            raise unknown_name(name, str(value)[:40], names[name])
    elif name == "observer":
        if not isinstance(value, bool):
            raise ValueError(f"observer = {value!r}: must be true or false")
    elif name in RANGES:
        (low, high), unit = RANGES[name], UNITS[name]
        kinds = (int,) if name == "delay" else (int, float)
        if isinstance(value, bool) or not isinstance(value, kinds):
            a_number = "a whole number" if name == "delay" else "a number"
            raise ValueError(
                f"{name} = {str(value)[:40]!r}: must be {a_number} of {unit}, without unit"
            )
        if not low <= value <= high:
            raise ValueError(
                f"{name} = {nearest_float(value):.10g} {unit}: must lie in [{low:g}, {high:g}] {unit}"
            )
    else:
        raise unknown_name("setting", name[:40], [*names, "observer", *RANGES])


def world_of(choices: Choices, configured: Environment) -> Environment:
    """Return the world that is chosen."""
    surface = {"stiffness": choices.stiffness, "damping": choices.damping}
    match choices.world:
        case "as configured":
            return (
                configured.replace(**surface)
                if isinstance(configured, (Wall, Disc))
                else configured
            )
        case "wall":
            return Wall(position=SURFACE, **surface)
        case "disc":
            return Disc(x=SURFACE + 0.03, y=0.0, radius=0.03, **surface)
        case "free":
            return Free()
        case name:
            from ebac.worlds.presets import preset

            return preset(name, position=SURFACE, **({} if name in _OWN_MATERIAL else surface))


def base_of(
    given: Configuration | Scenario | None, device: Literal["reference", "joystick"] | str
) -> Configuration:
    """Return the configuration of simulated drives for a scenario, a device by name, or what comes with ebac."""
    from ebac import datasets  # a room above this one

    if isinstance(given, Configuration) and device == CONFIGURED:
        return given
    if isinstance(given, Scenario) and device == CONFIGURED:
        return _of_scenario(given)
    if device == "joystick-3":
        return Configuration.from_toml(datasets.joystick_text("joystick-3"), name="joystick-3")
    known = Configuration.from_toml(datasets.joystick_text("joystick"), name="joystick")
    if device in (CONFIGURED, "reference"):
        return known
    return _with_device(known, presets.device(device))


def _of_scenario(scenario: Scenario) -> Configuration:
    from ebac import datasets

    name = "joystick-3" if scenario.device.axes == 3 else "joystick"
    known = _with_device(
        Configuration.from_toml(datasets.joystick_text(name), name="a scenario"), scenario.device
    )
    return known.replace(
        hand=scenario.hand,
        environment=scenario.environment,
        timing=scenario.timing,
        observer=bool(scenario.observer) and scenario.device.sensor.fitted,
    )


def _with_device(known: Configuration, device: Any) -> Configuration:
    nodes = known.drives.nodes[: device.axes]
    return known.replace(
        device=device,
        limits=Limits.of(device).replace(speed=known.limits.speed),
        drives=replace(known.drives, nodes=nodes),
        sensor=known.sensor if device.sensor.fitted else None,
    )
