"""Keys of the files of a run: configuration and scenario."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from ebac import _core, presets
from ebac._core import BridgeParams, Device, Limits, Observer, RealTime, TimedBus, Timing
from ebac._util.serialisation import CHOICES
from ebac.drives.network import BUILT_IN
from ebac.drives.profile_fields import Key
from ebac.hardware.configuration import Configuration
from ebac.hardware.configuration_fields import BUS, RECORDING, RUN
from ebac.hardware.keys.file_key import BOTH, CONFIGURATION, SCENARIO, FileKey, said_of
from ebac.hardware.reading import INTERFACES
from ebac.hardware.signs import Signs
from ebac.hardware.zero import LEAST, MOST, Zero
from ebac.laws import LAWS
from ebac.realtime.mode import MODES
from ebac.scenario import EVERY_LAW, LEARNS_SCALE, Scenario
from ebac.sensor.configuration import MODELS, SensorConfig

#: Device from which a configuration starts; a scenario starts from "reference".
STARTS_FROM = "joystick"


def run_keys() -> Iterator[FileKey]:
    """Give the keys of a configuration and of a scenario, which share most of them."""
    plain = Configuration.from_toml("")
    said = said_of(Configuration)
    yield from _top()
    yield from _bus(plain, said)
    yield from _device()
    signs, zero = said_of(Signs), said_of(Zero)
    for name in ("motor", "encoder"):
        yield FileKey(table="signs", name=name, default=[], choices=(1, -1), meaning=signs[name])
    yield FileKey(
        table="zero",
        name="counts",
        unit="counts",
        default=[],
        low=LEAST,
        high=MOST,
        meaning=zero["counts"],
    )
    yield FileKey(
        table="zero",
        name="absolute",
        default=False,
        choices=(True, False),
        meaning=zero["absolute"],
    )
    yield from _fields("timing", Timing, files=BOTH)
    yield from _environment()
    yield FileKey(table="engine", name="command", default="", meaning=said["engine"])
    yield from _fields("engine", BridgeParams)
    yield FileKey(
        table="law",
        name="name",
        default=plain.law,
        choices=tuple(LAWS),
        meaning="a law of the package; its parameters stand beside it and replace those of its design: `ebac laws "
        "NAME` lists them",
    )
    yield from _fields("limits", Limits, value=Limits.of(Device()))
    values = {key.name: getattr(plain, key.name) for key in (*BUS, *RUN, *RECORDING)}
    yield from _of_keys("run", RUN, said, values)
    yield FileKey(
        table="realtime", name="mode", default=plain.mode, choices=MODES, meaning=said["mode"]
    )
    yield from _fields("realtime", RealTime)
    yield from _of_keys("recording", RECORDING, said, values)
    yield from _sensor()
    yield from _fields("observer", Observer, value=Observer.of(Device(), Timing()))
    yield from _simulated(plain, signs, zero)


def _top() -> Iterator[FileKey]:
    yield FileKey(table="", name="about", default="", meaning="what the file is for, for people")
    said = said_of(Scenario)
    ranges = {"seconds": ("s", 0.0, 1e5), "jitter": ("1", 0.0, 0.45), "seed": ("1", 0, 2**63 - 1)}
    for one in dataclasses.fields(Scenario):
        if one.name in ranges:
            unit, low, high = ranges[one.name]
            yield FileKey(
                files=(SCENARIO,), table="", name=one.name, unit=unit, default=one.default, low=low, high=high,
                meaning=said[one.name],
            )  # fmt: skip
    yield FileKey(
        files=(SCENARIO,),
        table="",
        name="observer",
        default=True,
        choices=(True, False, EVERY_LAW, LEARNS_SCALE),
        meaning=said["observer"],
        note="or a table [observer], whose keys that are left out are those of the reference device",
    )


def _bus(plain: Configuration, said: Mapping[str, str]) -> Iterator[FileKey]:
    yield FileKey(
        table="bus",
        name="interface",
        default=plain.interface,
        choices=tuple(INTERFACES[0]),
        meaning=said["interface"],
    )
    yield FileKey(table="bus", name="channel", default=plain.channel, meaning=said["channel"])
    drives = plain.drives.name.removeprefix(BUILT_IN)
    yield FileKey(table="bus", name="drives", default=drives, meaning=said["drives"])
    yield FileKey(
        table="bus",
        name="setup",
        default=plain.setup,
        choices=("verify", "apply"),
        meaning=said["setup"],
    )
    yield from _of_keys("bus", BUS, said, {key.name: getattr(plain, key.name) for key in BUS})


def _device() -> Iterator[FileKey]:
    reference, joystick = Device(), presets.device(STARTS_FROM)
    yield FileKey(
        files=BOTH,
        table="device",
        name="preset",
        default="reference",
        configuration_default=STARTS_FROM,
        choices=tuple(presets.DEVICES),
        meaning="name of a device: `ebac presets` lists them",
    )
    for name, part in reference.as_dict().items():
        table = f"device.{name}"
        if len(CHOICES[name]) > 1:
            own, other = (type(getattr(one, name)).__name__ for one in (reference, joystick))
            yield _types(table, name, BOTH, None if own == other else other)
            for kind in CHOICES[name]:
                yield from _fields(table, kind, named=True, files=BOTH)
        else:
            yield from _fields(
                table,
                type(part),
                value=part,
                configuration_default=getattr(joystick, name),
                files=BOTH,
            )


def _environment() -> Iterator[FileKey]:
    yield _types("environment", "environment", BOTH)
    yield from _fields("environment", _core.Wall, named=True, files=BOTH)
    yield from _fields("environment", _core.Disc, named=True, files=BOTH)
    for name in ("first", "second"):
        yield FileKey(
            files=BOTH,
            table="environment",
            type="Corner",
            name=name,
            meaning="a table with the keys of a Wall",
        )
    yield FileKey(
        files=BOTH,
        table="environment",
        type="World",
        name="bodies",
        meaning="bodies with their solids and materials: `ebac worlds NAME` prints those of a world",
    )


def _sensor() -> Iterator[FileKey]:
    said = said_of(SensorConfig)
    few = {"model": tuple(MODELS), "sign": (1, -1)}
    for one in dataclasses.fields(SensorConfig):
        more = dict(one.metadata)
        if isinstance(one.default, str):
            more["unit"] = ""
        yield FileKey(
            table="sensor", name=one.name, default=one.default, choices=few.get(one.name, ()),
            meaning=said[one.name], **more,
        )  # fmt: skip


def _simulated(
    plain: Configuration, signs: Mapping[str, str], zero: Mapping[str, str]
) -> Iterator[FileKey]:
    for name in ("motor", "encoder"):
        yield FileKey(table="simulated.signs", name=name, choices=(1, -1), meaning=signs[name])
    yield FileKey(
        table="simulated.zero",
        name="counts",
        unit="counts",
        low=LEAST,
        high=MOST,
        meaning=zero["counts"],
    )
    own = ("bit_rate", "answer_share", "silent_ticks")  # in [bus] and the network file
    yield from _fields("simulated.bus", TimedBus, value=plain.timed_bus(), without=own)
    table = "simulated.hand"
    yield FileKey(
        files=BOTH,
        table=table,
        name="preset",
        default="reference",
        choices=tuple(presets.HANDS),
        meaning="name of a hand: `ebac presets` lists them",
    )
    yield from _fields(table, _core.Hand, files=BOTH)
    for name in ("path", "model"):
        yield _types(f"{table}.{name}", name, BOTH)
        for kind in CHOICES[name]:
            if hasattr(kind, "fields"):
                yield from _fields(f"{table}.{name}", kind, named=True, files=BOTH)
            elif kind is _core.Recorded:
                yield from _recorded(f"{table}.{name}")


def _recorded(table: str) -> Iterator[FileKey]:
    for name, unit, meaning in (
        ("t", "s", "times, strictly rising"),
        ("x", "m", "positions at these times"),
    ):
        yield FileKey(
            files=BOTH, table=table, type="Recorded", name=name, unit=unit, meaning=meaning
        )


def _fields(
    table: str,
    kind: Any,
    *,
    value: Any = None,
    configuration_default: Any = None,
    named: bool = False,
    without: Sequence[str] = (),
    files: tuple[str, ...] = (CONFIGURATION,),
) -> Iterator[FileKey]:
    """Give the fields of a type of the core; the defaults are those of `value`."""
    for one in kind.fields():
        if one.name in without:
            continue
        default = one.default if value is None else getattr(value, one.name)
        other = (
            default if configuration_default is None else getattr(configuration_default, one.name)
        )
        flag = one.kind == "bool"
        yield FileKey(
            files=files,
            table=table,
            type=kind.__name__ if named else "",
            name=one.name,
            unit="" if flag else one.unit,
            default=default,
            configuration_default=None if other == default else other,
            low=None if flag else one.low,
            high=None if flag else one.high,
            choices=(True, False) if flag else (),
            meaning=one.meaning,
        )


def _of_keys(
    table: str,
    keys: Iterable[Key],
    meanings: Mapping[str, str],
    values: Mapping[str, Any] | None = None,
) -> Iterator[FileKey]:
    """Give keys that the package describes itself, with the default that a configuration has."""
    for key in keys:
        yield FileKey(
            table=table,
            name=key.name,
            unit=key.unit or "1",
            default=key.default if values is None else values[key.name],
            low=key.low,
            high=key.high,
            meaning=meanings[key.name],
        )


def _types(
    table: str, part: str, files: tuple[str, ...], configuration_default: str | None = None
) -> FileKey:
    """Return the key `type` of a part that may be of several types."""
    names = tuple(
        one.rpartition(".")[2] if isinstance(one, str) else one.__name__ for one in CHOICES[part]
    )
    choices = tuple(name for name in names if name != "Bridge")  # of Python only
    return FileKey(
        files=files,
        table=table,
        name="type",
        default=choices[0],
        configuration_default=configuration_default,
        choices=choices,
        meaning="what it is; each type has keys of its own",
    )
