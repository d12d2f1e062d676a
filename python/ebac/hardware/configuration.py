"""The configuration of a run on hardware, in TOML, SI units throughout."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

from ebac import presets
from ebac._core import Device, Hand, Limits, RealTime, Timing, Wall
from ebac.document import from_document
from ebac.drives.errors import ProfileError
from ebac.drives.network import Network
from ebac.drives.source import Source
from ebac.hardware.keys import BUS, RECORDING, RUN, number, word
from ebac.hardware.tables import ConfigurationError, known, on_top, refusing, table
from ebac.laws import LAWS, CoreLaw, design
from ebac.scenario import Environment, Scenario

if TYPE_CHECKING:
    from ebac.sensor import SensorConfig

TABLES = [
    "about",
    "bus",
    "device",
    "timing",
    "environment",
    "law",
    "limits",
    "run",
    "realtime",
    "recording",
    "sensor",
    "simulated",
]


@dataclass(frozen=True, kw_only=True)
class Configuration:
    """What `Device.open` and `ebac run` need to know.

    Parameters
    ----------
    name : str
        Of the file, for people.
    text : str
        The file itself; it goes into every log.
    interface, channel : str
        Of the CAN bus: "socketcan" and "can0", or "ebac" and a channel inside this process.
    drives : Network
        The drives, one per axis, each with its profile.
    setup : "verify" or "apply"
        Whether a drive that holds something else than its profile is refused, or written.
    silent : int
        Ticks in a row without process data that are a fault [samples].
    answer_share : float
        How long the drives may take to answer, as a share of the sample time.
    device : Device
        The haptic device.
    timing : Timing
        Sample time and delay.
    environment : Free, Wall, Corner or Disc
        The virtual world.
    law : str
        Name of the law.
    changes : mapping
        Parameters of the law on top of its design, SI units.
    limits : Limits
        What the loop allows.
    seconds, soft_start, ramp_down : float
        Length of a run, time in which force comes in and goes out [s].
    mode : "auto", "enforce" or "off"
        What the loop's thread insists on.
    realtime : RealTime
        What it asks of the system.
    memory : float
        Rows of so long a time stay in memory [s]; all of them go to the log.
    sync : float or None
        Time after which the log is forced to the disk [s].
    sensor : SensorConfig or None
        The force sensor, where there is one.
    hand : Hand
        Who holds the simulated device.
    """

    name: str = "a configuration"
    text: str = ""
    interface: str = "socketcan"
    channel: str = "can0"
    drives: Network
    setup: Literal["verify", "apply"] = "verify"
    silent: int = 3
    answer_share: float = 0.5
    device: Device
    timing: Timing = field(default_factory=Timing)
    environment: Environment = field(default_factory=Wall)
    law: str = "ebac"
    changes: Mapping[str, Any] = field(default_factory=dict)
    limits: Limits
    seconds: float = 10.0
    soft_start: float = 0.2
    ramp_down: float = 0.2
    mode: Literal["auto", "enforce", "off"] = "auto"
    realtime: RealTime = field(default_factory=RealTime)
    memory: float = 60.0
    sync: float | None = None
    sensor: SensorConfig | None = None
    hand: Hand = field(default_factory=Hand)

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a configuration file.

        Raises
        ------
        FileNotFoundError
            When there is no such file.
        ConfigurationError
            For what cannot be; the message names file, line, key, value, unit, range and remedy.
        """
        return cls.from_toml(Path(path).read_text(encoding="utf-8"), name=str(path))

    @classmethod
    def from_toml(cls, text: str, *, name: str = "configuration") -> Self:
        """Read a configuration from TOML text. Raises as `load`."""
        try:
            return cls(**_read(Source(name=name, text=text)))
        except ConfigurationError:
            raise
        except ProfileError as error:
            raise ConfigurationError(str(error)) from None

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some parts changed."""
        return dataclasses.replace(self, **changes)

    def design(self) -> CoreLaw:
        """Return the law, designed for the device; without a sensor the gains of a force loop are 0."""
        with_sensor = self.sensor is not None
        return designed(self.law, self.changes, self.device, self.timing, sensor=with_sensor)

    def scenario(self, *, seconds: float | None = None) -> Scenario:
        """Return device, hand, virtual world and time as a scenario, for simulations and logs."""
        return Scenario(
            device=self.device,
            hand=self.hand,
            environment=self.environment,
            timing=self.timing,
            seconds=seconds or self.seconds,
        )


#: The gains of the force loop, eq. (2): they need a measured force.
FORCE_GAINS = ("kp", "kd")


def designed(
    law: Any, changes: Mapping[str, Any], device: Device, timing: Timing, *, sensor: bool
) -> CoreLaw:
    """Return a law of the core for a device; without a sensor, the gains of its force loop are 0.

    Raises
    ------
    TypeError
        For a law in Python: the loop's thread never touches Python.
    ValueError
        When a gain of the force loop is asked for and nothing measures the force.
    """
    given = dict(changes)
    if not sensor and (isinstance(law, (str, type))):
        kind = LAWS.get(law) if isinstance(law, str) else law
        names = [one.name for one in kind.fields()] if kind is not None else []
        for gain in FORCE_GAINS:
            if gain in names:
                given.setdefault(gain, 0.0)
    made = design(law, device, timing, **given)
    if not isinstance(made, CoreLaw):
        raise TypeError(
            f"{law!r} is written in Python: the loop's thread never touches Python, so only a law of "
            f"the core runs on hardware: {', '.join(LAWS)}"
        )
    if not sensor:
        for gain in FORCE_GAINS:
            if getattr(made, gain, 0.0):
                raise ValueError(
                    f"{made.name}.{gain} = {getattr(made, gain):g}: feeds back a measured force, but no force "
                    f"sensor is configured; {gain} = 0, or add a table [sensor]"
                )
    return made


def _read(source: Source) -> dict[str, Any]:
    known(source, (), TABLES)
    values: dict[str, Any] = {"name": source.name, "text": source.text}
    values |= _bus(source)
    values["device"] = _device(source)
    values["timing"] = on_top(source, ("timing",), Timing())
    values["environment"] = _environment(source)
    values |= _law(source, values)
    values["limits"] = _limits(source, values["device"])
    values |= {key.name: number(source, ("run",), key) for key in RUN}
    known(source, ("run",), [key.name for key in RUN])
    values |= _realtime(source)
    known(source, ("recording",), [key.name for key in RECORDING])
    values |= {key.name: number(source, ("recording",), key) for key in RECORDING}
    values["sensor"] = _sensor(source)
    values["hand"] = _hand(source)
    _fit(source, values)
    return values


def _bus(source: Source) -> dict[str, Any]:
    from ebac.drives.network import load

    names = ["interface", "channel", "drives", "setup", *(key.name for key in BUS)]
    found = known(source, ("bus",), names)
    asked = word(source, ("bus", "drives"), found.get("drives", "joystick"))
    beside = Path(source.name).parent / asked
    try:
        network = load(beside if beside.is_file() else asked)
    except ProfileError as error:
        raise source.refuse(("bus", "drives"), f"bus.drives: {error}") from None
    return {
        "interface": word(
            source, ("bus", "interface"), found.get("interface", "socketcan"), ["socketcan", "ebac"]
        ),
        "channel": word(source, ("bus", "channel"), found.get("channel", "can0")),
        "drives": network,
        "setup": word(source, ("bus", "setup"), found.get("setup", "verify"), ["verify", "apply"]),
        **{key.name: number(source, ("bus",), key) for key in BUS},
    }


def _device(source: Source) -> Device:
    name = table(source, ("device",)).get("preset", "joystick")
    base = refusing(source, ("device", "preset"), lambda: presets.device(name))
    made: Device = on_top(source, ("device",), base, apart=("preset",))
    return made


def _hand(source: Source) -> Hand:
    known(source, ("simulated",), ["hand"])
    path = ("simulated", "hand")
    name = table(source, path).get("preset", "reference")
    base = refusing(source, (*path, "preset"), lambda: presets.hand(name))
    made: Hand = on_top(source, path, base, apart=("preset",))
    return made


def _sensor(source: Source) -> SensorConfig | None:
    if "sensor" not in source.table:
        return None
    from ebac.sensor import SensorConfig

    found = known(source, ("sensor",), [one.name for one in dataclasses.fields(SensorConfig)])
    made: SensorConfig = refusing(source, ("sensor",), lambda: SensorConfig.from_table(found))
    return made


def _environment(source: Source) -> Environment:
    found = table(source, ("environment",))
    made: Environment = refusing(
        source, ("environment",), lambda: from_document("environment", found, "environment")
    )
    return made


def _law(source: Source, values: Mapping[str, Any]) -> dict[str, Any]:
    found = table(source, ("law",))
    name = word(source, ("law", "name"), found.get("name", "ebac"), list(LAWS))
    known(source, ("law",), ["name", *(one.name for one in LAWS[name].fields())])
    changes = {key: value for key, value in found.items() if key != "name"}
    refusing(
        source,
        ("law",),
        lambda: design(name, values["device"], values["timing"], **changes),
    )
    return {"law": name, "changes": changes}


def _limits(source: Source, device: Device) -> Limits:
    from ebac._core import _check_limits

    limits: Limits = on_top(source, ("limits",), Limits.of(device))
    refusing(source, ("limits",), lambda: _check_limits(limits))
    return limits


def _realtime(source: Source) -> dict[str, Any]:
    found = table(source, ("realtime",))
    modes = ["auto", "enforce", "off"]
    return {
        "mode": word(source, ("realtime", "mode"), found.get("mode", "auto"), modes),
        "realtime": on_top(source, ("realtime",), RealTime(), apart=("mode",)),
    }


#: What profile and device must tell alike: key of the profile, value of the device, its name.
_SAME: tuple[tuple[str, Callable[[Device], float], str], ...] = (
    ("motor.torque_constant", lambda d: d.motor.torque_constant, "motor.torque_constant"),
    ("limits.rated_torque", lambda d: d.motor.rated_torque, "motor.rated_torque"),
    ("motor.counts_per_turn", lambda d: d.encoder.counts_per_turn, "encoder.counts_per_turn"),
)


def _fit(source: Source, values: Mapping[str, Any]) -> None:
    """Refuse what does not fit together."""
    axes, drives = values["device"].axes, values["drives"]
    if len(drives.nodes) != axes:
        raise source.refuse(
            ("bus", "drives"),
            f"bus.drives: {drives.name} has {len(drives.nodes)} drives, the device {axes} axes: must "
            "be as many; give another network file, or a device with as many axes",
        )
    for node in drives.nodes:
        for key, mine, name in _SAME:
            theirs, own = node.profile.values.get(key), mine(values["device"])
            if theirs is not None and abs(float(theirs) - own) > 0.01 * own:
                raise source.refuse(
                    ("bus", "drives"),
                    f"bus.drives: node {node.id} of {drives.name} has {key} = {float(theirs):g}, the device "
                    f"{name} = {own:g}: must be the same within 1 %, or every force is wrong; set one of them",
                )
    refusing(
        source,
        ("environment",),
        lambda: Scenario(
            device=values["device"],
            environment=values["environment"],
            hand=values["hand"],
            timing=values["timing"],
        ).setup(),
    )
