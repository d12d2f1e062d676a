"""The configuration of a run on hardware, in TOML, SI units throughout."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

from ebac._core import BridgeParams, Device, Hand, Limits, Observer, RealTime, Timing, Wall
from ebac._util.arguments import plain, require, require_path
from ebac._util.foreign_worlds import refuse_python
from ebac._util.text_file import read_text
from ebac._util.wrong_calls import plain_constructor
from ebac.drives.errors import ProfileError
from ebac.drives.network import Network
from ebac.drives.toml_positions import Source
from ebac.hardware.configuration_fields import BUS, RECORDING, RUN, check_seconds
from ebac.hardware.law import designed
from ebac.hardware.reading import needs_force, read
from ebac.hardware.signs import Signs
from ebac.hardware.tables import ConfigurationError
from ebac.hardware.zero import Zero
from ebac.laws import AnyLaw, CoreLaw, law_name
from ebac.laws.tuned_laws import on_its_observer
from ebac.realtime.mode import Mode
from ebac.scenario import Environment, Scenario

if TYPE_CHECKING:
    from ebac._core import TimedBus
    from ebac.sensor import SensorConfig
    from ebac.trace import Trace


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Configuration:
    """The configuration that `Device.open` and `ebac run` use.

    Parameters
    ----------
    name : str
        Name of the file, for messages.
    text : str
        Text of the file; it is stored in every log.
    interface : str
        Interface of the CAN bus: "socketcan", or "ebac" for a bus inside this process.
    channel : str
        Channel of the bus: "can0", or any name for a bus inside this process.
    drives : Network
        The drives, one per axis, each with its profile.
    signs : Signs
        Signs of every axis: -1 reverses the current of its motor or the counts of its encoder.
    simulated_signs : Signs or None
        Signs that the simulated device needs; None for the same signs, so that it is wired as configured.
    zero : Zero
        Counts of each drive with the handle at its zero.
    simulated_zero : Zero or None
        The same for the simulated drives; None for the counts of `zero`.
    setup : "verify" or "apply"
        Whether a drive whose objects differ from its profile is refused ("verify") or written ("apply").
    silent : int or None
        Number of ticks in a row without process data that is a fault [samples], 1 to 1000. None, or a file without the
        key, means 3 on hardware and on the virtual clock, and 10 with simulated drives in real time, which share the
        processors with their loop.
    answer_share : float
        How long the drives may take to answer, as a share of the sample time.
    device : Device
        The haptic device.
    timing : Timing
        Sample time and delay.
    environment : Free, Wall, Corner, Disc or worlds.World
        The virtual world.
    engine : str
        Program that computes the virtual world, with its arguments; empty for none. `ebac run` starts it and uses it
        in place of `environment`. In Python start a `worlds.EngineProcess` and pass its world to the run.
    rendering : BridgeParams
        How one model of the engine replaces the previous one, and how the force fades.
    law : str, law class, Variant or law
        Name of the law, or a law compiled in C++ as `ebac.design` takes it.
    changes : mapping
        Parameters of the law that replace those of its design, in SI units.
    limits : Limits
        Limits that the loop enforces.
    seconds : float
        Length of a run [s].
    soft_start : float
        Time in which the force is ramped up at the beginning of a run [s].
    ramp_down : float
        Time in which it is ramped down at the end of a run [s].
    mode : "auto", "enforce" or "off"
        Whether real-time settings that the system does not grant are an error ("enforce"), are tolerated ("auto") or
        are not requested ("off").
    realtime : RealTime
        Real-time settings that the loop's thread requests from the system.
    memory : float
        Length of time whose rows stay in memory [s]; all rows are written to the log.
    sync : float or None
        Interval at which the log is flushed to the disk [s].
    sensor : SensorConfig or None
        The force sensor, where there is one.
    observer : bool or Observer
        Whether the state of the device is estimated from encoder, force sensor and currents, as in a `Scenario`. Needs
        a sensor.
    hand : Hand
        The hand that holds the simulated device.
    simulated_bus : mapping
        Fields of `drives.TimedBus` that replace those derived from drives and bus.

    Raises
    ------
    ValueError
        For a number out of range, an observer without a force sensor, or where the device says that none is fitted.
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
    silent: int | None = None
    answer_share: float = 0.7
    device: Device
    timing: Timing = field(default_factory=Timing)
    environment: Environment = field(default_factory=Wall)
    engine: str = ""
    rendering: BridgeParams = field(default_factory=BridgeParams)
    law: AnyLaw = "ebac"
    changes: Mapping[str, Any] = field(default_factory=dict)
    limits: Limits
    seconds: float = 10.0
    soft_start: float = 0.2
    ramp_down: float = 0.2
    mode: Mode = "auto"
    realtime: RealTime = field(default_factory=RealTime)
    memory: float = 60.0
    sync: float | None = None
    sensor: SensorConfig | None = None
    observer: Observer | bool = False
    hand: Hand = field(default_factory=Hand)
    simulated_bus: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse a number out of range, an observer without a force, and a world that a tick cannot wait for."""
        for key in (*BUS, *RUN, *RECORDING):
            value = plain(getattr(self, key.name))
            if value is not None and (wrong := key.check(value)) is not None:
                raise ValueError(f"Configuration.{wrong}")
        if self.observer:
            needs_force(self.sensor, self.device)
        refuse_python(self.environment)

    @classmethod
    def load(cls, path: str | Path, *, device_alone: bool = False) -> Self:
        """Read a configuration file.

        Parameters
        ----------
        path : str or Path
            The file.
        device_alone : bool
            True to look at the device: its drives may be set up for another motor. A run needs False.

        Raises
        ------
        ConfigurationError
            When the file cannot be read, or for an invalid entry; the message contains file, line, key, value, unit,
            range and remedy.
        """
        require_path(path, "Configuration.load")
        try:
            text = read_text(path)
        except FileNotFoundError:
            raise ConfigurationError(
                f"{path}: there is no such file; give the path of a configuration, of which "
                "`ebac demo joystick` writes one"
            ) from None
        except OSError as error:
            raise ConfigurationError(
                f"{path}: cannot be read ({error.strerror or error}); give the path of a configuration"
            ) from None
        except ValueError as error:
            raise ConfigurationError(f"{path}: {error}") from None
        return cls.from_toml(text, name=str(path), device_alone=device_alone)

    @classmethod
    def from_toml(
        cls, text: str, *, name: str = "configuration", device_alone: bool = False
    ) -> Self:
        """Read a configuration from TOML text. `device_alone` is that of `load`, as are the errors."""
        require(text, str, "Configuration.from_toml", "text")
        try:
            return cls(**read(Source(name=name, text=text), device_alone=device_alone))
        except ConfigurationError:
            raise
        except ProfileError as error:
            raise ConfigurationError(str(error)) from None

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some parts changed."""
        return dataclasses.replace(self, **changes)

    def first_run(self) -> Self:
        """Return the configuration of the first run of a device: the same in free air, with small limits.

        There is no virtual world, and the gains of a force loop are 0, so that the force of a law of the package is
        zero. `limits.peak_current` and `limits.continuous_current` are at most 0.1 A, `limits.speed` is at most 1 m/s;
        lower ones stay, and so does all else. What differs stands as comments at the end of `text`, and thus in the
        log. `ebac run FILE --first` runs it.

        Raises
        ------
        TypeError, ValueError
            As `design`, for a law that cannot run.
        """
        from ebac.hardware.first_run import changed_parts, differences

        first = self.replace(**changed_parts(self))
        notes = "".join(f"# {line}\n" for line in differences(self, first))
        return first.replace(text=f"{self.text}\n# A first run, with:\n{notes}")

    def design(self) -> CoreLaw:
        """Return the law, designed for the device. Without a force sensor the gains of its force loop are 0."""
        with_sensor = self.sensor is not None
        return designed(self.law, self.changes, self.device, self.timing, sensor=with_sensor)

    @property
    def counts_of_simulated_drives(self) -> tuple[int, ...]:
        """Counts of the simulated drives with the handle at its zero; those of the real drives by default."""
        return (self.simulated_zero or self.zero).counts

    def scenario(self, *, seconds: float | None = None) -> Scenario:
        """Return device, hand, virtual world and time as a scenario, for simulations and logs.

        Without a table `[sensor]` the device has no force sensor.

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
        device = self.device
        if self.sensor is None:
            device = device.replace(sensor=None)
        made = Scenario(
            device=device,
            hand=self.hand,
            environment=self.environment,
            timing=self.timing,
            seconds=self.seconds if seconds is None else seconds,
            observer=self.observer,
        )
        return on_its_observer(made, self.law)

    def doubts(self) -> tuple[str, ...]:
        """Return what is possible, but more likely not meant, a text for each, with the remedy; commands print these.

        They are those of the device as in `Scenario.doubts`, a stiffness or counts of the force sensor in a wrong
        unit, drives for another motor, with limits below or above those of the device, or for another sample time, a
        default wall or weight that no table names, limits that hardly protect, and parameters of the law that are
        those of another device.
        """
        from ebac._util.doubts.configuration import all_doubts

        return all_doubts(self)

    def timed_bus(self) -> TimedBus:
        """Return the simulated bus, with bit rate, monitors and waiting time as configured."""
        from ebac.hardware.timed_bus import timed_bus

        return timed_bus(
            self.drives,
            silent=self.silent,
            answer_share=self.answer_share,
            changes=self.simulated_bus,
        )

    def simulate(self, *, seconds: float | None = None, bus_time: bool = True) -> Trace:
        """Simulate the run on a virtual clock, with the same law, drives and bus and every tick on time.

        The result is what a run on hardware should give. Time begins when the drives have power. Frames take time on
        the bus, and an answer that the loop did not wait for is late, as on hardware. The force is read at the handle,
        in the counts and the range of the configured sensor, without a network. The simulated run is the first one
        after power-on: the drives count from 0.

        Parameters
        ----------
        seconds : float, optional
            Length of the run [s]; default: as configured.
        bus_time : bool
            False lets every frame arrive at once.

        Raises
        ------
        LoopFault
            When the device exceeds its limits or answers are missing; it contains the trace.
        ConfigurationError
            When `[simulated.signs]` or `[simulated.zero]` differ from `[signs]` and `[zero]`, which this simulation
            assumes to be correct.
        PositionError
            When the handle, which begins at its zero, would begin inside the virtual world.
        ValueError
            When the loop does not wait long enough for the answers; the message contains both times.

        Warns
        -----
        DoubtWarning
            For what `doubts` lists before the run, and `Trace.doubts` after it.
        """
        from ebac._util import remarks
        from ebac.hardware.axis_positions import check_outside, positions_at_zero
        from ebac.hardware.drive_limits import held_back
        from ebac.simulation import hidden_by_pytest, simulate, warn_of

        __tracebackhide__ = hidden_by_pytest
        self._refuse_wrong_wiring()
        check_outside(self, positions_at_zero(self), self.environment)
        scenario = self._on_virtual_clock(seconds)
        if not bus_time:  # a bus that takes time has the limits of its drives
            scenario = scenario.replace(device=held_back(scenario.device, self.drives))
        if by_user := remarks.wanted():
            warn_of(self.doubts())
        trace = simulate(
            scenario,
            self.design(),
            through="can",
            bus=self.timed_bus() if bus_time else None,
            limits=self.limits,
            soft_start=self.soft_start,
            ramp_down=self.ramp_down,
        )
        if by_user:
            warn_of(trace.doubts())
        return trace

    def _on_virtual_clock(self, seconds: float | None = None) -> Scenario:
        """Return the scenario with the counts and the range of the configured sensor, which no network applies."""
        made = self.scenario(seconds=seconds)
        if self.sensor is None:
            return made
        own = made.device.sensor
        read = own.replace(
            quantum=max(own.quantum, 1 / self.sensor.counts_per_force),
            range=min(own.range, self.sensor.force_range or own.range),
        )
        return made.replace(device=made.device.replace(sensor=read))

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
        many = "" if len(self.drives.nodes) == 1 else "s"
        return (
            f"<Configuration {self.name}: {self.interface} {self.channel}, node{many} {nodes}; {law_name(self.law)}, "
            f"{1e3 * self.timing.dt:g} ms, {self.seconds:g} s; its TOML in .text>"
        )
