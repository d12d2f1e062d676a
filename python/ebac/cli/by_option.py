"""What the library says of a value, by the name of the option that gave it."""

from __future__ import annotations

import ast
import re
from typing import Any

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
    "ForceSensor.lag": "--device-lag",
    "Mechanics.coulomb": "--device-coulomb",
    "Compensation.friction": "--device-friction-compensation",
    "Encoder.counts_per_turn": "--device-counts",
    "Limits.force": "--max-force",
    "Limits.current": "--max-current",
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
#: Those that were not given beside a file: a value of that name stands in the file.
left_to_file: set[str] = set()
#: Parameters that name such a file.
FILES = ("scenario", "configuration")


def begin(context: Any) -> None:
    """Take the options of a command that begins, from its context."""
    from ebac.cli.wrong_input import option_name

    current.clear()
    left_to_file.clear()
    params = context.command.params
    current.update({p.name: option_name(p) for p in params})
    if any(context.params.get(name) is not None for name in FILES):
        given = [p for p in params if context.get_parameter_source(p.name).name == "COMMANDLINE"]
        left_to_file.update(current[p.name] for p in params if p not in given)


def in_options(message: str) -> str:
    """Return what the library says of a value, by the name of the option that gave it."""
    message = message.replace("resume=False", "--force instead of --resume")
    message = message.replace("observer=True", "--observer")
    if "--device-counts" in current.values() and re.match(r"\w+\.count = ", message):
        message += "; it is the way of the handle per count of the encoder: give more counts per turn, --device-counts"
    if "--approach" in current.values():
        message = re.sub(
            r"start on the surface, as with Operators.*",
            "start on the surface: --approach 0",
            message,
        )
    message = columns_in_options(message)
    message = re.sub(r"limits=Limits\((.+?)\)", _limits, message)
    for pattern in (r"(?:[\w ]+: )?([A-Za-z_.]+)(?= ?= )", r"(?:[a-z_]+: )?([a-z_]+)(?= \S+: )"):
        found = re.match(pattern, message)
        if found is None:
            continue
        name = found[1]
        option = OPTIONS.get(name)
        if option not in current.values():
            option = current.get(name.rpartition(".")[2])
        if option is not None and option not in left_to_file:
            return option + message[found.end() :]
    return message


def columns_in_options(text: str) -> str:
    """Return a text of the library with the options that name columns, in place of the argument."""
    return re.sub(r"""columns=(\{'.+?['"]\})""", _columns, text)


def _limits(found: re.Match[str]) -> str:
    """Return the options for limits=Limits(force=..., energy=...): --max-force and --energy."""
    names = re.findall(r"\w+", found[1])
    return " and ".join(OPTIONS.get(f"Limits.{n}") or current.get(n, n) for n in names)


def _columns(found: re.Match[str]) -> str:
    """Return the options for columns={'t': 'Time', 'x': 'Handle Pos'}: --column t=Time --column "x=Handle Pos"."""
    pairs = [f"{signal}={column}" for signal, column in ast.literal_eval(found[1]).items()]
    return " ".join(
        f'--column "{pair}"' if re.search(r"\s|'", pair) else f"--column {pair}" for pair in pairs
    )
