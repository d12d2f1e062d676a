"""The configuration of a run on hardware, in TOML, SI units throughout."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

from ebac._core import BridgeParams, Device, Hand, Limits, Observer, RealTime, Timing, Wall
from ebac._util.arguments import require, require_path
from ebac._util.foreign_worlds import refuse_python
from ebac._util.text_file import read_text
from ebac._util.wrong_calls import plain_constructor
from ebac.drives.errors import ProfileError
from ebac.drives.network import Network
from ebac.drives.toml_positions import Source
from ebac.hardware.configuration_fields import check_seconds
from ebac.hardware.law import designed
from ebac.hardware.reading import needs_force, read
from ebac.hardware.signs import Signs
from ebac.hardware.tables import ConfigurationError
from ebac.hardware.zero import Zero
from ebac.laws import CoreLaw
from ebac.scenario import Environment, Scenario

if TYPE_CHECKING:
    from ebac._core import TimedBus
    from ebac.sensor import SensorConfig
    from ebac.trace import Trace


@plain_constructor
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
    signs : Signs
        Of every axis: -1 turns the current of its motor, the counts of its encoder.
    simulated_signs : Signs or None
        Those that the simulated device needs; None for the same, a device that is wired as configured.
    zero : Zero
        What each drive counts with the handle at its zero.
    simulated_zero : Zero or None
        The same of the simulated drives; None for those of `zero`.
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
    environment : Free, Wall, Corner, Disc or worlds.World
        The virtual world.
    engine : str
        Program that computes the virtual world, and its arguments, empty for none: `ebac run` starts it in place of
        `environment`; in Python start a `worlds.EngineProcess` and give its world to the run.
    rendering : BridgeParams
        How the models of the engine take over from each other and fade.
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
    observer : bool or Observer
        Whether the state of the device is estimated from encoder, force sensor and currents, as in a `Scenario`. Needs
        a sensor.
    hand : Hand
        Who holds the simulated device.
    simulated_bus : mapping
        Fields of `drives.TimedBus` on top of those that follow from drives and bus.

    Raises
    ------
    ValueError
        For an observer without a force sensor.
    """

    name: str = "a configuration"
    text: str = ""
    interface: str = "socketcan"
    channel: str = "can0"
    drives: Network
    signs: Signs = field(default_factory=Signs)
    simulated_signs: Signs | None = None
    zero: Zero = field(default_factory=Zero)
    simulated_zero: Zero | None = None
    setup: Literal["verify", "apply"] = "verify"
    silent: int = 3
    answer_share: float = 0.7
    device: Device
    timing: Timing = field(default_factory=Timing)
    environment: Environment = field(default_factory=Wall)
    engine: str = ""
    rendering: BridgeParams = field(default_factory=BridgeParams)
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
    observer: Observer | bool = False
    hand: Hand = field(default_factory=Hand)
    simulated_bus: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse an observer without a force, and a world that a tick cannot wait for."""
        if self.observer:
            needs_force(self.sensor)
        refuse_python(self.environment)

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
        require_path(path, "Configuration.load")
        try:
            text = read_text(path)
        except ValueError as error:
            raise ConfigurationError(f"{path}: {error}") from None
        return cls.from_toml(text, name=str(path))

    @classmethod
    def from_toml(cls, text: str, *, name: str = "configuration") -> Self:
        """Read a configuration from TOML text. Raises as `load`."""
        require(text, str, "Configuration.from_toml", "text")
        try:
            return cls(**read(Source(name=name, text=text)))
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

    @property
    def counts_of_simulated_drives(self) -> tuple[int, ...]:
        """What simulated drives count with the handle at its zero: as real ones do, if not configured otherwise."""
        return (self.simulated_zero or self.zero).counts

    def scenario(self, *, seconds: float | None = None) -> Scenario:
        """Return device, hand, virtual world and time as a scenario, for simulations and logs.

        Parameters
        ----------
        seconds : float, optional
            Length [s], [0.01, 1e5]; that of the configuration, if not given.

        Raises
        ------
        ValueError
            For a length out of range.
        """
        if seconds is not None:
            check_seconds(seconds)
        return Scenario(
            device=self.device,
            hand=self.hand,
            environment=self.environment,
            timing=self.timing,
            seconds=self.seconds if seconds is None else seconds,
            observer=self.observer,
        )

    def timed_bus(self) -> TimedBus:
        """Return the bus as a simulated run has it: bit rate, watches and waiting time as configured."""
        from ebac.hardware.timed_bus import timed_bus

        return timed_bus(
            self.drives,
            silent=self.silent,
            answer_share=self.answer_share,
            changes=self.simulated_bus,
        )

    def simulate(self, *, seconds: float | None = None, bus_time: bool = True) -> Trace:
        """Run it on a virtual clock: same law, drives and bus, every tick on time. What a run should come to.

        Time begins as the drives have power. Frames take their time on the bus, and an answer that the loop did not
        wait for is late, as on hardware. The force is read at the handle without a network, and the first run after
        power-on is meant: the drives count from 0.

        Parameters
        ----------
        seconds : float, optional
            Length of the run [s]; default as configured.
        bus_time : bool
            False lets every frame arrive at once.

        Raises
        ------
        LoopFault
            When the device leaves its limits, or answers stay away; carries the trace.
        ConfigurationError
            When `[simulated.signs]` or `[simulated.zero]` differ from `[signs]` and `[zero]`, which are taken as right.
        ValueError
            When the loop does not wait long enough for the answers, with both times.
        """
        from ebac.simulation import simulate

        self._refuse_wrong_wiring()
        return simulate(
            self.scenario(seconds=seconds),
            self.design(),
            through="can",
            bus=self.timed_bus() if bus_time else None,
            limits=self.limits,
            soft_start=self.soft_start,
        )

    def _refuse_wrong_wiring(self) -> None:
        axes = self.device.axes
        wrong = []
        if self.signs.against(self.simulated_signs).of_all(axes) != Signs().of_all(axes):
            wrong.append("[simulated.signs] is other than [signs]")
        if self.simulated_zero is not None and (
            self.simulated_zero.of_all(axes) != self.zero.of_all(axes)
        ):
            wrong.append("[simulated.zero] is other than [zero]")
        if wrong:
            raise ConfigurationError(
                f"{self.name}: {' and '.join(wrong)}: on the virtual clock signs and zero are taken as right; "
                "--simulated has them as configured"
            )

    def __repr__(self) -> str:
        """Return one line: name, bus, drives, law, timing."""
        nodes = ", ".join(str(node.id) for node in self.drives.nodes)
        return (
            f"<Configuration {self.name}: {self.interface} {self.channel}, nodes {nodes}; {self.law}, "
            f"{1e3 * self.timing.dt:g} ms, {self.seconds:g} s; its TOML in .text>"
        )
