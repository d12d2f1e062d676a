"""A configuration from its document, table by table."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac import presets
from ebac._core import BridgeParams, Device, Limits, Observer, RealTime, TimedBus, Timing
from ebac._util.file_kinds import PROFILE, kind_of
from ebac._util.mesh_paths import seen_from_here
from ebac._util.serialisation import from_document
from ebac.drives.errors import ProfileError
from ebac.drives.toml_positions import Source
from ebac.hardware.configuration_fields import BUS, RECORDING, RUN, number, word
from ebac.hardware.fit import check_fit
from ebac.hardware.signs import Signs
from ebac.hardware.tables import known, on_its_preset, on_top, refusing, table
from ebac.hardware.zero import Zero
from ebac.laws import LAWS, design
from ebac.realtime.mode import MODES
from ebac.scenario import Environment

if TYPE_CHECKING:
    from ebac.sensor import SensorConfig

TABLES = [
    "about",
    "bus",
    "device",
    "signs",
    "zero",
    "timing",
    "environment",
    "engine",
    "law",
    "limits",
    "run",
    "realtime",
    "recording",
    "sensor",
    "observer",
    "simulated",
]

#: Interfaces of a loop, and what follows where it is another one.
INTERFACES = (
    ["socketcan", "ebac"],
    "; a loop runs over no other interface of python-can: udp_multicast, for one, is for `ebac drive` alone; leave "
    "interface out where the drives are simulated (--simulated)",
)
#: Keys of [bus].
OF_BUS = ["interface", "channel", "drives", "setup", *(key.name for key in BUS)]
#: What only a scenario has.
_OF_A_SCENARIO = ("seconds", "jitter", "seed", "hand")


def read(source: Source, *, device_alone: bool = False) -> dict[str, Any]:
    """Return the parts of a configuration; with `device_alone` the drives may be those of another device.

    Raises
    ------
    ProfileError
        For what cannot be, with file and line.
    """
    for name in _OF_A_SCENARIO:
        if name in source.table and "bus" not in source.table:
            raise source.refuse(
                (name,),
                f"{name}: this is a scenario, as of `ebac wall --scenario`, not a configuration of `ebac run`: "
                "`ebac demo joystick` writes one, into which its tables [device], [timing], [environment], and [hand] "
                "as [simulated.hand] can be copied",
            )
    if "node" in source.table:
        wrong = "node: this is a network file; give the configuration of `ebac run` that names it in bus.drives"
        raise source.refuse(("node",), f"{wrong}: `ebac demo joystick` writes one")
    if kind_of(source.table) == PROFILE:
        wrong = "this is a profile of a drive; give the configuration of `ebac run` whose network file names it"
        raise source.refuse(
            (next(iter(source.table)),), f"{wrong}: `ebac demo joystick` writes one"
        )
    _refuse_without_heading(source)
    known(source, (), TABLES)
    values: dict[str, Any] = {"name": source.name, "text": source.text}
    values |= _bus(source)
    values["device"] = read_device(source)
    axes = values["device"].axes
    values["signs"] = _signs(source, ("signs",), axes) or Signs()
    values["simulated_signs"] = _signs(source, ("simulated", "signs"), axes)
    values["zero"] = _zero(source, ("zero",), ["counts", "absolute"], axes) or Zero()
    values["simulated_zero"] = _zero(source, ("simulated", "zero"), ["counts"], axes)
    values["timing"] = _timing(source)
    values["environment"] = _environment(source)
    values |= _engine(source)
    values |= _law(source, values)
    values["limits"] = _limits(source, values["device"])
    values |= {key.name: number(source, ("run",), key) for key in RUN}
    known(source, ("run",), [key.name for key in RUN])
    values |= _realtime(source)
    known(source, ("recording",), [key.name for key in RECORDING])
    values |= {key.name: number(source, ("recording",), key) for key in RECORDING}
    values["sensor"] = _sensor(source)
    values["observer"] = _observer(source, values)
    known(source, ("simulated",), ["hand", "signs", "zero", "bus"])
    values["hand"] = on_its_preset(source, ("simulated", "hand"), presets.hand, "reference")
    values["simulated_bus"] = _simulated_bus(source, values)
    check_fit(source, values, device_alone=device_alone)
    return values


def read_device(source: Source) -> Device:
    """Return the device of a configuration, whatever its drives are set up for.

    Raises
    ------
    ProfileError
        For what cannot be, with file and line.
    """
    made: Device = on_its_preset(source, ("device",), presets.device, "joystick")
    return made


def _refuse_without_heading(source: Source) -> None:
    """Refuse a key of a table whose heading was left out."""
    of_tables = {
        "bus": OF_BUS,
        "timing": [one.name for one in Timing.fields()],
        "limits": [one.name for one in Limits.fields()],
        "run": [key.name for key in RUN],
        "recording": [key.name for key in RECORDING],
    }
    for name in source.table:
        heading = next((one for one, keys in of_tables.items() if name in keys), None)
        if heading is not None and name not in TABLES:
            wrong = f"{name}: stands in no table; write [{heading}] in a line above it"
            raise source.refuse((name,), wrong)


def _bus(source: Source) -> dict[str, Any]:
    from ebac.drives.network import load

    found = known(source, ("bus",), OF_BUS)
    asked = word(source, ("bus", "drives"), found.get("drives", "joystick"))
    beside = Path(source.name).parent / asked
    try:
        network = load(beside if beside.is_file() else asked)
    except ProfileError as error:
        raise source.refuse(("bus", "drives"), f"bus.drives: {error}") from None
    return {
        "interface": word(
            source, ("bus", "interface"), found.get("interface", "socketcan"), *INTERFACES
        ),
        "channel": word(source, ("bus", "channel"), found.get("channel", "can0")),
        "drives": network,
        "setup": word(source, ("bus", "setup"), found.get("setup", "verify"), ["verify", "apply"]),
        **{key.name: number(source, ("bus",), key) for key in BUS},
    }


def _timing(source: Source) -> Timing:
    made: Timing = on_top(source, ("timing",), Timing())
    if made.delay < 1:
        raise source.refuse(
            ("timing", "delay"),
            f"timing.delay = {made.delay:g} samples: over a CAN bus a command acts one tick later at the earliest; "
            "must lie in [1, 8] samples",
        )
    return made


def _signs(source: Source, path: tuple[str, ...], axes: int) -> Signs | None:
    """Return the signs of motors and encoders of a table; None where there is none."""
    found = known(source, path, ["motor", "encoder"])
    if not found:
        return None
    made: Signs = refusing(source, path, lambda: Signs.from_table(found, axes))
    return made


def _zero(source: Source, path: tuple[str, ...], keys: list[str], axes: int) -> Zero | None:
    """Return the zero of the encoders of a table; None where there is none."""
    found = known(source, path, keys)
    if not found:
        return None
    made: Zero = refusing(source, path, lambda: Zero.from_table(found, axes))
    return made


def _simulated_bus(source: Source, values: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return what a simulated run changes of its bus."""
    from ebac.hardware.timed_bus import timed_bus

    path = ("simulated", "bus")
    own = ["bit_rate", "answer_share", "silent_ticks"]  # in [bus] and the network file
    names = [name for name in TimedBus().as_dict() if name not in own]
    found = dict(known(source, path, names))
    bus = {key: values[key] for key in ("silent", "answer_share")}
    refusing(source, path, lambda: timed_bus(values["drives"], **bus, changes=found))
    return found


def _sensor(source: Source) -> SensorConfig | None:
    if "sensor" not in source.table:
        return None
    from ebac.sensor import SensorConfig

    found = known(source, ("sensor",), [one.name for one in dataclasses.fields(SensorConfig)])
    made: SensorConfig = refusing(source, ("sensor",), lambda: SensorConfig.from_table(found))
    return made


def needs_force(sensor: SensorConfig | None, device: Device) -> None:
    """Raise ValueError for an observer without a force sensor, or with one that the device says it lacks."""
    if sensor is None:
        raise ValueError(
            "observer: estimates the state from a measured force, but no force sensor is configured; leave out the "
            "observer, or add a table [sensor]"
        )
    if not device.sensor.fitted:
        raise ValueError(
            "observer: estimates the state from a measured force; there is a table [sensor], but [device.sensor] says "
            "fitted = false: take that line out if the device has the sensor, else leave out the observer and the "
            "table [sensor]"
        )


def _observer(source: Source, values: Mapping[str, Any]) -> Observer | bool:
    """Return the observer of the table, on top of its design; True for the design itself."""
    if "observer" not in source.table:
        return False
    refusing(source, ("observer",), lambda: needs_force(values["sensor"], values["device"]))
    designed = Observer.of(values["device"], values["timing"])
    made: Observer = on_top(source, ("observer",), designed)
    return True if made == designed else made


def _environment(source: Source) -> Environment:
    found = seen_from_here(table(source, ("environment",)), Path(source.name).parent)
    made: Environment = refusing(
        source, ("environment",), lambda: from_document("environment", found, ("environment",))
    )
    return made


def _engine(source: Source) -> dict[str, Any]:
    found = table(source, ("engine",))
    command = found.get("command")
    return {
        "engine": "" if command is None else word(source, ("engine", "command"), command),
        "rendering": on_top(source, ("engine",), BridgeParams(), apart=("command",)),
    }


def _law(source: Source, values: Mapping[str, Any]) -> dict[str, Any]:
    found = table(source, ("law",))
    name = word(source, ("law", "name"), found.get("name", "ebac"), list(LAWS))
    kind = LAWS[name]
    known(source, ("law",), ["name", *(one.name for one in kind.fields())], kind.__name__)
    changes = {key: value for key, value in found.items() if key != "name"}
    refusing(
        source,
        ("law",),
        lambda: design(name, values["device"], values["timing"], **changes),
    )
    return {"law": name, "changes": changes}


def _limits(source: Source, device: Device) -> Limits:
    from ebac._core import _check_limits

    own = Limits.of(device)
    try:
        _check_limits(own)
    except ValueError as error:
        name, wrong = str(error).removeprefix("Limits.").split(" ", 1)
        if name not in table(source, ("limits",)):
            raise source.refuse(*_by_device(device, name, wrong)) from None
    limits: Limits = on_top(source, ("limits",), own)
    asked = table(source, ("limits",))
    if limits.peak_current < limits.continuous_current and "continuous_current" not in asked:
        raise source.refuse(
            ("limits", "peak_current"),
            f"limits.peak_current = {limits.peak_current:g} A: lies below limits.continuous_current, "
            f"{limits.continuous_current:.4g} A, which follows from the motor (device.motor.rated_torque / "
            "torque_constant); raise peak_current, or give a lower continuous_current as well",
        )
    refusing(source, ("limits",), lambda: _check_limits(limits))
    return limits


def _by_device(device: Device, name: str, wrong: str) -> tuple[tuple[str, ...], str]:
    """Return the table that a limit follows from, and what is wrong with this limit."""
    if name != "continuous_current":
        return ("device",), f"device: limits.{name}, which follows from it, {wrong}"
    motor = device.motor
    value, unit = wrong.removeprefix("= ").split(" ", 1)
    wrong = f"= {float(value):.6g} {unit}"
    return ("device", "motor"), (
        f"device.motor: rated_torque = {motor.rated_torque:g} N m and torque_constant = {motor.torque_constant:g} N m/A"
        f" give limits.continuous_current {wrong}; correct the motor: 1 mN m is 0.001 N m, 1 mN m/A is 0.001 N m/A"
    )


def _realtime(source: Source) -> dict[str, Any]:
    found = table(source, ("realtime",))
    return {
        "mode": word(source, ("realtime", "mode"), found.get("mode", "auto"), MODES),
        "realtime": on_top(source, ("realtime",), RealTime(), apart=("mode",)),
    }
