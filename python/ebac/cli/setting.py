"""A scenario from options: what is given comes on top of a scenario file or of the defaults."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac import presets
from ebac.cli import by_name, by_option, doubtful, output

if TYPE_CHECKING:
    from ebac._core import Device, Hand, Timing
    from ebac.operators import Operators
    from ebac.scenario import Environment, Scenario
    from ebac.worlds import World

#: Range of the rate [Hz]; the sample time lies in [1e-5, 0.1] s.
RATES = (10.0, 1e5)


def base_scenario(file: Path | None) -> Scenario:
    """Return the scenario to start from; what of its device and wall is likely in a wrong unit is said on stderr."""
    from ebac._util.text_file import read_text
    from ebac._util.toml import parsed
    from ebac.scenario import Scenario

    if file is None:
        return Scenario()
    found = Scenario.load(file)
    if not parsed(read_text(file)):
        output.note(f"{file}: sets nothing, so this is the reference device at the reference wall")
    doubtful.note_device(file, found.device)
    doubtful.note_world(file, found.environment)
    return found


def device_base(file: Path | None) -> Scenario:
    """Return the scenario to start from where no run is simulated: of a scenario, or a configuration of `ebac run`."""
    from ebac.scenario_text import is_configuration

    try:
        configuration = file is not None and is_configuration(file)
    except (OSError, ValueError):
        configuration = False  # refused as a scenario is
    if file is None or not configuration:
        return base_scenario(file)
    from ebac.hardware import Configuration

    known = Configuration.load(file, device_alone=True)
    doubtful.note_drives(file, known)
    found = known.scenario()
    doubtful.note_device(file, found.device)
    doubtful.note_world(file, found.environment)
    return found


def has_seconds(file: Path) -> bool:
    """Return whether a scenario that can be read says how long a run is; else each command has a length of its own."""
    from ebac._util.text_file import read_text
    from ebac._util.toml import parsed

    return "seconds" in parsed(read_text(file))


def parse_change(text: str) -> dict[str, Any]:
    """Return the parameters of `--change`: "kp=0,guard=off"."""
    changes: dict[str, Any] = {}
    for part in text.split(","):
        name, equals, value = (word.strip() for word in part.partition("="))
        if name in changes:
            raise ValueError(f"--change {text}: {name} is given twice; give it once")
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


def given(**options: Any) -> dict[str, Any]:
    """Return the options that were given."""
    return {name: value for name, value in options.items() if value is not None}


def known_hand(name: str, option: str = "--hand") -> Hand:
    """Return the hand of a name, in any case."""
    return presets.hand(by_name.known_name("hand", option, name, list(presets.HANDS)))


def known_device(name: str, option: str = "--device") -> Device:
    """Return the device of a name, in any case."""
    return presets.device(by_name.known_name("device", option, name, list(presets.DEVICES)))


def choose_wall(environment: Environment, **options: float | None) -> Environment:
    """Return the wall with `stiffness` [N/m], `damping` [N s/m], `position` [m] as given."""
    from ebac._core import Wall

    changes = given(**options)
    if not changes:
        return environment
    if not isinstance(environment, Wall):
        kind = type(environment).__name__
        raise ValueError(
            f"--wall-{next(iter(changes))} changes a wall, but the scenario's environment is a {kind}: "
            "change it in the file"
        )
    return environment.replace(**changes)


def choose_world(name: str, option: str = "--world", **options: float | None) -> World:
    """Return the world of a name, in any case, with `stiffness`, `damping`, `friction`, `position` as given."""
    from ebac.worlds import preset

    kind, colon, file = name.partition(":")
    try:
        return preset(kind.lower() + colon + file, **given(**options))
    except (ValueError, FileNotFoundError, ImportError) as error:
        message = by_option.in_options(str(error))
        if option and message.startswith("--"):
            raise ValueError(message) from error
        missing = isinstance(error, FileNotFoundError)
        said = f"{file}: there is no such file" if missing else str(error)
        raise ValueError(f"{option} {name}: {said}" if option else said) from error


def choose_engine(environment: Environment, options: dict[str, Any]) -> Environment:
    """Return the world behind an engine, if one is asked for by `engine_rate` [Hz]."""
    rate = options.get("engine_rate")
    if not isinstance(rate, float):  # `ebac engines` has several, and puts them in itself
        others = [name for name in ("jitter", "compute", "held") if options.get(f"engine_{name}")]
        if others:
            raise ValueError(f"--engine-{others[0]}: needs an engine; add --engine-rate 60")
        return environment
    from ebac.studies.engines import behind_engine

    compute = options.get("engine_compute")
    return behind_engine(
        environment,
        rate=rate,
        jitter=options.get("engine_jitter") or 0.0,
        compute=compute,
        held=bool(options.get("engine_held")),
    )


def choose_hand(
    hand: Hand, name: str | None, target: float | None, **options: float | None
) -> Hand:
    """Return the hand of that name, or `hand`, with mass, damping, stiffness, target as given."""
    chosen = known_hand(name) if name is not None else hand
    changes = given(**options)
    if target is not None:
        first, *others = chosen.path
        if not hasattr(first, "target"):
            raise ValueError(
                f"--hand-target = {target:g} m: the hand follows a {type(first).__name__} path, "
                "which has no target; change it in the scenario file"
            )
        changes["path"] = [first.replace(target=target), *others]
    return chosen.replace(**changes) if changes else chosen


#: Options that change a part of the device: the part, and what of it.
DEVICE_PARTS = {
    "device_noise": ("sensor", "noise"),
    "device_lag": ("sensor", "lag"),
    "device_sensor": ("sensor", "fitted"),
    "device_coulomb": ("mechanics", "coulomb"),
    "device_friction_compensation": ("compensation", "friction"),
    "device_counts": ("encoder", "counts_per_turn"),
    "device_permille": ("drive", "permille"),
}


def choose_device(device: Device, options: Mapping[str, Any]) -> Device:
    """Return the device that an option names, or `device`, with the parts that options change."""
    name = options.get("device")
    chosen = known_device(name) if name is not None else device
    fitted = options.get("device_sensor")
    if not (chosen.sensor.fitted if fitted is None else fitted):
        for option in ("device_noise", "device_lag"):
            if options.get(option):
                _, has = DEVICE_PARTS[option]
                raise ValueError(
                    f"--{option.replace('_', '-')}: the device has no force sensor that could have {has}; leave it out"
                )
    for option, (part, field) in DEVICE_PARTS.items():
        if options.get(option) is not None:
            before = chosen
            changed = getattr(chosen, part).replace(**{field: options[option]})
            chosen = chosen.replace(**{part: changed})
            doubtful.note_change(f"--{option.replace('_', '-')}", before, chosen)
    return chosen


def choose_timing(timing: Timing, rate: float | None, delay: int | None) -> Timing:
    """Return the timing with a rate [Hz] and a delay [samples] as given."""
    if rate is not None and not RATES[0] <= rate <= RATES[1]:
        raise ValueError(f"--rate = {rate:g} Hz: must lie in [{RATES[0]:g}, {RATES[1]:g}] Hz")
    changes = given(dt=None if rate is None else 1 / rate, delay=delay)
    return timing.replace(**changes) if changes else timing
