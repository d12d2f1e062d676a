"""Every key of the files that describe a run: unit, default, range, meaning. Only what is not known elsewhere is here.

Numbers of the core have unit, range and meaning in its lists of fields, keys of a profile in `drives.profile_fields`,
parts of a configuration in the docstrings of their classes. `key_notes` adds what a user needs to know besides.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isinf
from typing import Any

from ebac import _core, presets
from ebac._core import BridgeParams, Device, Fault, Limits, Observer, RealTime, TimedBus, Timing
from ebac._util.docstrings import parameters
from ebac._util.serialisation import CHOICES
from ebac.drives.load import BITRATES, Traffic
from ebac.drives.network import BUILT_IN, Network, Node
from ebac.drives.objects import find
from ebac.drives.pdo import NAMES, TIMES, Pdo
from ebac.drives.profile_fields import KEYS, Key, Value
from ebac.hardware.configuration import Configuration
from ebac.hardware.configuration_fields import BUS, RECORDING, RUN
from ebac.hardware.key_notes import FAULTS, NOTES, WARNINGS
from ebac.hardware.reading import INTERFACES
from ebac.hardware.signs import Signs
from ebac.hardware.zero import LEAST, MOST, Zero
from ebac.laws import LAWS
from ebac.realtime.mode import MODES
from ebac.scenario import EVERY_LAW, LEARNS_SCALE, Scenario
from ebac.sensor.configuration import MODELS, SensorConfig

CONFIGURATION, SCENARIO, PROFILE, NETWORK = "configuration", "scenario", "profile", "network file"
BOTH = (CONFIGURATION, SCENARIO)
#: Tables that may stand in a file several times: [[node]].
ARRAYS = frozenset({"simulated.hand.path", "bus.other", "node"})
#: Device from which a configuration starts; a scenario starts from "reference".
STARTS_FROM = "joystick"


@dataclass(frozen=True, kw_only=True)
class FileKey:
    """One key of a file.

    Parameters
    ----------
    files : tuple of str
        Kinds of files that have it: "configuration" of `ebac run`, "scenario", drive "profile", "network file".
    table : str
        Its table, as "device.motor"; empty for the top of the file.
    type : str
        Value of the key `type` with which the table has it; empty if it always has.
    name : str
        The key.
    unit : str
        Unit of a number, "1" for a pure one; empty for what is no number.
    default : number, bool, str, list or None
        None for a key without a default.
    configuration_default : number, str or None
        Default in a configuration, which starts from the joystick, where it differs from that of a scenario.
    low, high : float or None
        Range of a number.
    choices : tuple
        Values it may have, where they are few.
    meaning, note, warning : str
        What it is, what to know besides, and what must not be overlooked.
    sets : str
        Object of the drive that a key of a profile sets, with the unit there.
    """

    files: tuple[str, ...] = (CONFIGURATION,)
    table: str
    type: str = ""
    name: str
    unit: str = ""
    default: Any = None
    configuration_default: Any = None
    low: float | None = None
    high: float | None = None
    choices: tuple[Any, ...] = ()
    meaning: str
    note: str = ""
    warning: str = ""
    sets: str = ""

    @property
    def heading(self) -> str:
        """Return the heading of its table in a file."""
        if not self.table:
            return "top of the file"
        return f"[[{self.table}]]" if self.table in ARRAYS else f"[{self.table}]"

    @property
    def default_text(self) -> str:
        """Return the default as a file has it."""
        text, other = as_toml(self.default), as_toml(self.configuration_default)
        return f"{text}; in a configuration {other}" if other else text

    @property
    def range_text(self) -> str:
        """Return what it may be."""
        if self.choices:
            return ", ".join(as_toml(one) for one in self.choices)
        if self.low is None or self.high is None or (isinf(self.low) and isinf(self.high)):
            return ""
        if isinf(self.high):
            return f"from {_short(self.low)}"
        return f"{_short(self.low)} to {_short(self.high)}"

    @property
    def text(self) -> str:
        """Return meaning and note in one line."""
        return "; ".join(part for part in (self.meaning, self.note) if part)

    @property
    def warning_text(self) -> str:
        """Return the warning as a sentence."""
        return f"{self.warning[:1].upper()}{self.warning[1:]}." if self.warning else ""

    def row(self) -> dict[str, Any]:
        """Return it as plain values, as JSON takes them; a bound or default that is infinite as text."""
        plain = dataclasses.asdict(self)
        return {name: _finite(value) for name, value in plain.items()}


def file_keys() -> tuple[FileKey, ...]:
    """Return every key of a configuration, a scenario, a drive profile and a network file."""
    return tuple(_noted(one) for one in (*_configuration(), *_profile(), *_network()))


def as_toml(value: Any) -> str:
    """Return a value as a file has it, numbers with four digits; "" for None."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(as_toml(one) for one in value)}]"
    if isinstance(value, float):
        return f"{value:.4g}"
    return f'"{value}"' if isinstance(value, str) else str(value)


def _said_of(kind: type) -> dict[str, str]:
    """Return the parameters of a docstring, worded as the meanings of the core are: without capital and full stop."""
    said = {name: text.removesuffix(".") for name, text in parameters(kind).items()}
    return {
        name: text[:1].lower() + text[1:] if text[1:2].islower() or text[1:2] == " " else text
        for name, text in said.items()
    }


def _short(bound: float) -> str:
    """Return a bound with all its digits, in few."""
    if isinstance(bound, int):
        return str(bound)
    return f"{bound:g}" if float(f"{bound:g}") == bound else f"{bound:.17g}"


def _finite(value: Any) -> Any:
    return str(value) if isinstance(value, float) and isinf(value) else value


def _noted(key: FileKey) -> FileKey:
    """Return a key with its note and its warning."""
    table = f"profile.{key.table}" if PROFILE in key.files else key.table
    of_type = f"{table}.{key.type}.{key.name}"
    where = of_type if of_type in NOTES else f"{table}.{key.name}"
    said = [key.note, NOTES.get(where, "")]
    if key.table == "limits" and CONFIGURATION in key.files and key.name in FAULTS:
        numbers = ", ".join(str(int(Fault[name])) for name in FAULTS[key.name])
        said.append(f"the run then ends by fault {numbers}")
    return dataclasses.replace(
        key, note="; ".join(one for one in said if one), warning=WARNINGS.get(where, "")
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


def _configuration() -> Iterator[FileKey]:
    plain = Configuration.from_toml("")
    said = _said_of(Configuration)
    yield from _top()
    yield from _bus(plain, said)
    yield from _device()
    signs, zero = _said_of(Signs), _said_of(Zero)
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
    said = _said_of(Scenario)
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
    said = _said_of(SensorConfig)
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


def _profile() -> Iterator[FileKey]:
    files = (PROFILE,)
    yield FileKey(files=files, table="", name="about", default="", meaning="which drives it is for")
    yield FileKey(
        files=files,
        table="",
        name="vendor",
        unit="1",
        default=0,
        low=0,
        high=0xFFFFFFFF,
        meaning="the maker's number in 0x1018:1, for the simulated drive; 0 for any maker",
    )
    yield FileKey(
        files=files,
        table="",
        name="without",
        default=[],
        meaning="keys that `ebac` needs for scaling but the drive has no object for; a drive that has the object is "
        "refused",
    )
    for key in KEYS:
        table, _, name = key.name.partition(".")
        pure = key.choices is None
        yield FileKey(
            files=files,
            table=table,
            name=name,
            unit=(key.unit or "1") if pure else "",
            default=key.default,
            low=key.low if pure else None,
            high=key.high if pure else None,
            choices=() if key.choices is None else tuple(key.choices),
            meaning="; ".join(part for part in (key.why, key.remedy) if part),
            sets=_sets(key),
        )
    yield FileKey(
        files=files,
        table="objects",
        name='"0x3001:1"',
        meaning="an object of the maker's own, by index and sub-index: `985`, the number as the drive holds "
        'it; `{ value = -5, type = "i16", why = "..." }`; or a number that follows from a key, '
        '`{ of = "limits.rated_current", unit = 1e-3 }`, with the drive\'s unit in SI units. Nothing that commands',
    )
    yield FileKey(
        files=files,
        table="pdo",
        name="others",
        default="off",
        choices=("off", "keep"),
        meaning="whether PDOs that the profile does not list are switched off or stay as they are",
    )
    yield from _pdo(files)


def _pdo(files: tuple[str, ...]) -> Iterator[FileKey]:
    said = _said_of(Pdo)
    table = f"pdo.{NAMES[0]}"
    yield FileKey(
        files=files, table=table, name="objects", sets="0x1600, 0x1A00",
        meaning=f"{said['objects']}; names as `ebac drive show` prints them",
    )  # fmt: skip
    yield FileKey(
        files=files, table=table, name="type", unit="1", default=1,
        meaning=said["type"], sets="0x1400:2, 0x1800:2",
    )  # fmt: skip
    for name, (longest, _) in TIMES.items():
        where = {"inhibit": "0x1800:3", "event": "0x1400:5, 0x1800:5"}[name]
        yield FileKey(
            files=files, table=table, name=name, unit="s", default=0.0, low=0.0, high=longest,
            meaning=said[name], sets=where,
        )  # fmt: skip


#: Objects of the keys that set one in a way of their own.
_OBJECTS = {
    "emcy.on": ("emcy_cob_id",),
    "heartbeat.consumer": ("heartbeat_consumer",),
    "heartbeat.master": ("heartbeat_consumer",),
    "heartbeat.guard": ("guard_time", "life_time_factor"),
}


def _sets(key: Key) -> str:
    """Return the objects of a key, each with its unit on the drive."""
    names: tuple[Value, ...] = _OBJECTS.get(key.name, (key.sets,) if key.sets else ())
    objects = [find(str(name)) for name in names]
    return ", ".join(
        f"{one.where} [{one.unit}]" if one.unit and not one.hexadecimal else one.where
        for one in objects
    )


def _network() -> Iterator[FileKey]:
    files = (NETWORK,)
    bus, node, other = _said_of(Network), _said_of(Node), _said_of(Traffic)
    rate = next(one.default for one in dataclasses.fields(Network) if one.name == "bitrate")
    yield FileKey(
        files=files, table="bus", name="bitrate", unit="bit/s", default=rate, choices=BITRATES,
        meaning=bus["bitrate"], note="without it what --bitrate gives",
    )  # fmt: skip
    yield FileKey(
        files=files, table="node", name="id", unit="1", low=1, high=127, meaning=node["id"]
    )
    yield FileKey(files=files, table="node", name="name", default="", meaning=node["name"])
    yield FileKey(
        files=files,
        table="node",
        name="profile",
        meaning=node["profile"],
        note="the name of a profile, or of a file beside this one; keys of the profile but its PDOs may stand in the "
        "table of the node and replace those of the profile",
    )
    yield FileKey(
        files=files,
        table="node",
        name="eds",
        meaning=node["sheet"],
        note="checked whenever this file is read",
    )
    yield FileKey(files=files, table="bus.other", name="name", default="", meaning=other["name"])
    yield FileKey(
        files=files,
        table="bus.other",
        name="size",
        unit="bytes",
        low=0,
        high=8,
        meaning=other["size"],
    )
    yield FileKey(
        files=files,
        table="bus.other",
        name="rate",
        unit="Hz",
        low=0,
        high=1e5,
        meaning=other["rate"],
    )
