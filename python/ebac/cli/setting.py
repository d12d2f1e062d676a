"""A scenario from options: what is given comes on top of a scenario file or of the defaults."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac import presets
from ebac._util.arguments import unknown

if TYPE_CHECKING:
    from ebac._core import Device, Hand, Timing
    from ebac.operators import Operators
    from ebac.scenario import Environment, Scenario
    from ebac.worlds import World

#: What the library calls the numbers that options give.
OPTIONS = {
    "Wall.stiffness": "--wall-stiffness",
    "Wall.damping": "--wall-damping",
    "Wall.position": "--wall-position",
    "environment.position": "--wall-position",
    "Elastic.stiffness": "--wall-stiffness",
    "Elastic.damping": "--wall-damping",
    "Body.friction": "--world-friction",
    "Hand.mass": "--hand-mass",
    "Hand.damping": "--hand-damping",
    "Hand.stiffness": "--hand-stiffness",
    "Step.target": "--hand-target",
    "MinimumJerk.target": "--hand-target",
    "Tapping.target": "--hand-target",
    "ForceSensor.noise": "--device-noise",
    "Mechanics.coulomb": "--device-coulomb",
    "Timing.delay": "--delay",
    "Scenario.jitter": "--jitter",
    "Scenario.seconds": "--seconds",
    "Scenario.seed": "--seed",
    "approach_m": "--approach",
    "EngineTiming.rate": "--engine-rate",
    "EngineTiming.jitter": "--engine-jitter",
    "EngineTiming.compute": "--engine-compute",
    "SensorConfig.counts_per_force": "--sensor-counts",
    "SensorConfig.counts_per_torque": "--sensor-counts",
}
#: The options of the command that runs, by the names of its parameters.
current: dict[str, str] = {}
#: Range of the rate [Hz]; the sample time lies in [1e-5, 0.1] s.
RATES = (10.0, 1e5)


def base_scenario(file: Path | None) -> Scenario:
    """Return the scenario to start from."""
    from ebac.scenario import Scenario

    return Scenario() if file is None else Scenario.load(file)


def one_law(name: str, option: str = "--law") -> str:
    """Return a law by its name, in any case, where there can be one only."""
    names = law_names([name], option)
    if len(names) != 1:
        raise ValueError(f"{option} {name}: one law only; give one of {', '.join(names)}")
    return names[0]


def law_names(given: Sequence[str], option: str = "--law") -> list[str]:
    """Return the laws of names in any case, separated by commas, each once, in the order given; `all` is every law."""
    from ebac.laws import LAWS, tuned_laws

    known = (*LAWS, *tuned_laws())
    names: list[str] = []
    for word in _words(given, option):
        name = word.lower().replace("_", "-")
        if name not in known and name != "all":
            raise ValueError(unknown(f"{option} {word}", name, [*known, "all"], "law"))
        names += LAWS if name == "all" else [name]
    chosen = list(dict.fromkeys(names))
    _tell_tuned([name for name in chosen if name not in LAWS])
    return chosen


def _tell_tuned(names: Sequence[str]) -> None:
    """Say on stderr what a law with tuned parameters is."""
    from ebac.cli import output

    for name in names:
        law, _, end = name.partition("-tuned")
        how = ", acting on the observer's estimate: use it with --observer-every-law" if end else ""
        output.note(
            f"{name} is {law} with the parameters that `ebac tune` found for the reference device at 1 kHz{how}"
        )


def _words(given: Sequence[str], option: str) -> list[str]:
    """Return the names of lists separated by commas."""
    names = [word.strip() for text in given for word in text.split(",")]
    for name in names:
        if " " in name:
            raise ValueError(
                f"{option} {name}: separate names by commas: {option} {','.join(name.split())}"
            )
    return names


def _is_condition(name: str) -> bool:
    from ebac.studies import conditions

    try:
        return bool(conditions([name]))
    except ValueError:
        return False


def condition_names(given: Sequence[str]) -> list[str]:
    """Return the conditions and groups of lists with commas."""
    from ebac.studies import conditions

    for text in given:
        joined = "".join(text.split())
        if " " in text.strip() and "," not in text and _is_condition(joined):
            raise ValueError(f"--condition {text}: a condition is one word: --condition {joined}")
    names = _words(given, "--condition")
    for name in names:
        try:
            conditions([name])
        except ValueError as error:
            raise ValueError(f"--{error}") from None
    return names


def one_condition(name: str) -> str:
    """Return a condition by its name, where there can be one only; a group is refused by who searches."""
    names = condition_names([name])
    if len(names) != 1:
        raise ValueError(f"--condition {name}: one condition only; give one of {', '.join(names)}")
    return names[0]


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
    """Return what the library says of a value, by the name of the option that gave it."""
    message = message.replace("resume=False", "--force instead of --resume")
    message = re.sub(r"""columns=\{'(\w+)': (['"])(.*?)\2\}""", _column, message)
    for pattern in (r"(?:[\w ]+: )?([A-Za-z_.]+)(?= ?= )", r"(?:[a-z_]+: )?([a-z_]+)(?= \S+: )"):
        found = re.match(pattern, message)
        if found is None:
            continue
        name = found[1]
        option = OPTIONS.get(name)
        if option not in current.values():
            option = current.get(name.rpartition(".")[2])
        if option is not None:
            return option + message[found.end() :]
    return message


def _column(found: re.Match[str]) -> str:
    """Return the option for columns={'x': 'Handle Pos'}: --column "x=Handle Pos"."""
    pair = f"{found[1]}={found[3]}"
    return f'--column "{pair}"' if re.search(r"\s|'", pair) else f"--column {pair}"


def given(**options: Any) -> dict[str, Any]:
    """Return the options that were given."""
    return {name: value for name, value in options.items() if value is not None}


def known_hand(name: str, option: str = "--hand") -> Hand:
    """Return the hand of a name, in any case."""
    return presets.hand(known_name("hand", option, name, list(presets.HANDS)))


def known_device(name: str, option: str = "--device") -> Device:
    """Return the device of a name, in any case."""
    return presets.device(known_name("device", option, name, list(presets.DEVICES)))


def known_name(kind: str, option: str, name: str, names: Iterable[str]) -> str:
    """Return a name in lower case that is one of `names`; ValueError names the option and the nearest."""
    names = list(names)
    if name.lower() not in names:
        raise ValueError(unknown(f"{option} {name}", name.lower(), names, kind))
    return name.lower()


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
        by_option = in_options(str(error))
        if option and by_option.startswith("--"):
            raise ValueError(by_option) from error
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


def choose_device(
    device: Device,
    name: str | None,
    *,
    noise: float | None = None,
    coulomb: float | None = None,
    permille: bool | None = None,
) -> Device:
    """Return the device of that name, or `device`, with sensor noise [N], Coulomb friction [N] and drive as given."""
    chosen = known_device(name) if name is not None else device
    changes: dict[str, Any] = {}
    if noise is not None:
        changes["sensor"] = chosen.sensor.replace(noise=noise)
    if coulomb is not None:
        changes["mechanics"] = chosen.mechanics.replace(coulomb=coulomb)
    if permille is not None:
        changes["drive"] = chosen.drive.replace(permille=permille)
    return chosen.replace(**changes) if changes else chosen


def choose_timing(timing: Timing, rate: float | None, delay: int | None) -> Timing:
    """Return the timing with a rate [Hz] and a delay [samples] as given."""
    if rate is not None and not RATES[0] <= rate <= RATES[1]:
        raise ValueError(f"--rate = {rate:g} Hz: must lie in [{RATES[0]:g}, {RATES[1]:g}] Hz")
    changes = given(dt=None if rate is None else 1 / rate, delay=delay)
    return timing.replace(**changes) if changes else timing
