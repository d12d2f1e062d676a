"""A scenario from options: what is given comes on top of a scenario file or of the defaults."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac import presets

if TYPE_CHECKING:
    from ebac._core import Device, Hand, Timing
    from ebac.operators import Operators
    from ebac.scenario import Environment, Scenario

#: What the library calls the numbers that options give.
OPTIONS = {
    "Wall.stiffness": "--stiffness",
    "Wall.damping": "--damping",
    "Wall.position": "--position",
    "Hand.mass": "--mass",
    "Hand.damping": "--hand-damping",
    "Hand.stiffness": "--hand-stiffness",
    "Step.target": "--target",
    "MinimumJerk.target": "--target",
    "Tapping.target": "--target",
    "ForceSensor.noise": "--noise",
    "Timing.delay": "--delay",
    "through": "--through",
    "Scenario.jitter": "--jitter",
    "Scenario.seconds": "--seconds",
    "Scenario.seed": "--seed",
}
#: Range of the rate [Hz]; the sample time lies in [1e-5, 0.1] s.
RATES = (10.0, 1e5)


def base_scenario(file: Path | None) -> Scenario:
    """Return the scenario to start from."""
    from ebac.scenario import Scenario

    return Scenario() if file is None else Scenario.load(file)


def one_law(name: str) -> str:
    """Return the name of `--law` where there can be one only."""
    from ebac.document import unknown
    from ebac.laws import LAWS

    if name not in LAWS:
        raise ValueError(unknown(f"--law {name}", name, list(LAWS)))
    return name


def law_names(given: Sequence[str], option: str = "--law") -> list[str]:
    """Return the laws asked for, each once, in the order asked; `all` is every law."""
    from ebac.document import unknown
    from ebac.laws import LAWS

    names: list[str] = []
    for name in given:
        if name not in LAWS and name != "all":
            raise ValueError(unknown(f"{option} {name}", name, [*LAWS, "all"]))
        names += LAWS if name == "all" else [name]
    return list(dict.fromkeys(names))


def parse_change(text: str) -> dict[str, Any]:
    """Return the parameters of `--change`: "kp=0,guard=off"."""
    changes: dict[str, Any] = {}
    for part in text.split(","):
        name, equals, value = (word.strip() for word in part.partition("="))
        try:
            changes[name] = value == "on" if value in ("on", "off") else float(value)
        except ValueError:
            equals = ""
        if not name or not equals:
            raise ValueError(
                f"--change {text}: must be NAME=VALUE, a number in SI units, on or off"
            )
    return changes


def population(name: str, hands: int | None, seed: int, approach: float | None = None) -> Operators:
    """Return the population of `--population`, `--hands`, `--seed` and `--approach` [m]."""
    from ebac.operators import Operators

    if hands is not None and name != "random":
        raise ValueError(
            f"--hands {hands}: only a random population has a size; add --population random"
        )
    if name == "grid60":
        people = Operators.grid()
    elif name == "random":
        people = Operators.sample(500 if hands is None else hands, seed)
    elif Path(name).suffix or Path(name).exists():
        people = Operators.from_csv(name)
    else:
        raise ValueError(f"--population {name}: must be grid60, random or a CSV file")
    return people if approach is None else people.replace(approach_m=approach)


def in_options(message: str) -> str:
    """Return what the library says of a number, by the name of the option that gave it."""
    name, space, rest = message.partition(" ")
    return OPTIONS.get(name, name) + space + rest


def given(**options: Any) -> dict[str, Any]:
    """Return the options that were given."""
    return {name: value for name, value in options.items() if value is not None}


def choose_wall(environment: Environment, **options: float | None) -> Environment:
    """Return the wall with `stiffness` [N/m], `damping` [N s/m], `position` [m] as given."""
    from ebac._core import Wall

    changes = given(**options)
    if not changes:
        return environment
    if not isinstance(environment, Wall):
        kind = type(environment).__name__
        raise ValueError(
            f"--{next(iter(changes))} changes a wall, but the scenario's environment is a {kind}: "
            "change it in the file"
        )
    return environment.replace(**changes)


def choose_hand(
    hand: Hand, name: str | None, target: float | None, **options: float | None
) -> Hand:
    """Return the hand of that name, or `hand`, with mass, damping, stiffness, target as given."""
    chosen = presets.hand(name) if name is not None else hand
    changes = given(**options)
    if target is not None:
        first, *others = chosen.path
        if not hasattr(first, "target"):
            raise ValueError(
                f"--target = {target:g} m: the hand follows a {type(first).__name__} path, "
                "which has no target; change it in the scenario file"
            )
        changes["path"] = [first.replace(target=target), *others]
    return chosen.replace(**changes) if changes else chosen


def choose_device(
    device: Device, name: str | None, *, noise: float | None = None, permille: bool | None = None
) -> Device:
    """Return the device of that name, or `device`, with sensor noise [N] and drive as given."""
    chosen = presets.device(name) if name is not None else device
    changes: dict[str, Any] = {}
    if noise is not None:
        changes["sensor"] = chosen.sensor.replace(noise=noise)
    if permille is not None:
        changes["drive"] = chosen.drive.replace(permille=permille)
    return chosen.replace(**changes) if changes else chosen


def choose_timing(timing: Timing, rate: float | None, delay: int | None) -> Timing:
    """Return the timing with a rate [Hz] and a delay [samples] as given."""
    if rate is not None and not RATES[0] <= rate <= RATES[1]:
        raise ValueError(f"--rate = {rate:g} Hz: must lie in [{RATES[0]:g}, {RATES[1]:g}] Hz")
    changes = given(dt=None if rate is None else 1 / rate, delay=delay)
    return timing.replace(**changes) if changes else timing
