"""An open device: `with ebac.Device.open(config) as device: trace = device.run(law)`."""

from __future__ import annotations

import atexit
import tempfile
import weakref
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from ebac._util import remarks
from ebac._util.at_user import warn
from ebac._util.exception_notes import noted_on
from ebac._util.foreign_worlds import foreign
from ebac._util.parent import parent_gone
from ebac._util.wrong_calls import plain_constructor
from ebac.drives import Backups, check_pace, check_stall
from ebac.hardware import drive_setup
from ebac.hardware.axis_positions import (
    AxisPosition,
    PositionError,
    read_positions,
)
from ebac.hardware.backends import hardware, simulated
from ebac.hardware.configuration import Configuration
from ebac.hardware.held import Held
from ebac.hardware.interrupts import Interrupts
from ebac.hardware.law import designed
from ebac.hardware.power_up import power_up
from ebac.hardware.rating import check_rating
from ebac.hardware.report import Report
from ebac.hardware.run import Run
from ebac.hardware.run_log import free_log
from ebac.hardware.run_setup import run_setup

if TYPE_CHECKING:
    from ebac._core import _DrivenMachine
    from ebac.hardware.backends import Backend
    from ebac.laws import AnyLaw, CoreLaw
    from ebac.scenario import Environment
    from ebac.trace import Trace


@plain_constructor
class OpenDevice:
    """The drives of a device, set up and without power. A context manager; `ebac.Device.open` returns it.

    Only a run powers the motors. Every run ends with the power off, whatever ends it: its time, a fault, `stop`, an
    exception, a signal such as SIGINT, the end of the program or of its parent. If the process is killed, the drives
    switch off by their own monitors of the loop's torques and heartbeat.

    Parameters
    ----------
    configuration : Configuration
        The configuration of device and run.
    simulate : bool
        Whether simulated drives, with a simulated device in a simulated hand, replace the real ones. Everything else
        stays the same: the loop's thread, its clock, the bus, the set-up of the drives.
    detached : bool
        Whether a run continues when the program that started this process has ended.
    beyond_rating : bool
        Whether limits may exceed the data sheet of the motor.
    longest_step : float, optional
        For simulated drives: the longest time that the device moves from one tick to the next [s], however late the
        loop is; default: no limit, as for a real device.
    load : optional
        For simulated drives: the machine that they move in place of a hand.

    Attributes
    ----------
    configuration : Configuration
        The configuration as passed.
    backend : Backend
        The bus with the drives.

    Warns
    -----
    UserWarning
        When loop and drives take more than 70 % of the bus, or the web page of the force sensor cannot be read.

    Raises
    ------
    ConfigurationError
        When a limit exceeds the data sheet of the motor, without `beyond_rating`.
    SensorError
        When the force sensor scales its counts differently from the configuration.
    ProfileError
        When loop and drives take more than 90 % of the bus, or a drive would hold its torque without the loop.
    DriveError
        When a drive cannot be reached, is in fault, or its objects differ from its profile.
    """

    def __init__(
        self,
        configuration: Configuration,
        *,
        simulate: bool = False,
        detached: bool = False,
        beyond_rating: bool = False,
        longest_step: float | None = None,
        load: _DrivenMachine | None = None,
    ) -> None:
        if not beyond_rating:
            check_rating(configuration)
        self.configuration = configuration
        self.simulated = simulate
        self._confirmed = False
        self._cleared: Report | None = None  # of the fault that `reset` was called for
        self._detached = detached
        self._nodes = drive_setup.nodes_of(configuration, simulate=simulate)
        network = configuration.drives
        watched = replace(network, nodes=self._nodes)
        check_stall(watched)
        check_pace(watched, configuration.timing.dt)
        real = replace(network, nodes=drive_setup.nodes_of(configuration, simulate=False))
        loaded = configuration.interface == "socketcan"  # a bus inside this process has no bit rate
        if loaded and (warning := real.check_load()) is not None:
            warn(warning)
        with ExitStack() as stack:
            self.interrupts = stack.enter_context(Interrupts())
            self.backend: Backend = stack.enter_context(
                simulated(configuration, longest_step=longest_step, load=load)
                if simulate
                else hardware(configuration)
            )
            backups = None
            if simulate:
                backups = Backups(Path(stack.enter_context(tempfile.TemporaryDirectory())))
            write = simulate or configuration.setup == "apply"
            drive_setup.set_up(self.backend, self._nodes, write=write, backups=backups)
            if not simulate and configuration.sensor is not None:
                configuration.sensor.check_scale()
            self._held = Held(stack.pop_all())
        # What is forgotten, in a notebook or at the end of its program, is closed all the same.
        self._forgotten = weakref.finalize(self, self._held.close)
        self._forgotten.atexit = False  # another exit sees to that, in its place among others
        atexit.register(self._held.close)

    @property
    def report(self) -> Report | None:
        """Report of the last run."""
        return None if self._held.run is None else self._held.run.report

    @property
    def confirmed(self) -> bool:
        """Whether a run may begin: `confirm_zero` was called, the encoders are absolute, or drives are simulated."""
        return self._confirmed or not self.backend.real or self.configuration.zero.absolute

    def confirm_zero(self) -> None:
        """Confirm that `positions` are correct, for all runs until `reset` or until the device is closed.

        An incremental encoder counts from the position at which its drive was switched on; with a wrong zero the
        virtual world is displaced. On real drives no run may begin before the zero is confirmed.
        """
        self._confirmed = True

    def positions(self) -> list[AxisPosition]:
        """Read the position of each axis from the zero of the configuration; only between runs.

        Raises
        ------
        RuntimeError
            While a run is under way.
        DriveError
            When a drive does not answer.
        """
        self._between_runs()
        return read_positions(self.configuration, self.backend)

    def _between_runs(self) -> None:
        if self._held.run is not None and self._held.run.report is None:
            raise RuntimeError("a run is under way: end it first")

    @classmethod
    def open(
        cls,
        configuration: Configuration | str | Path,
        *,
        simulate: bool = False,
        detached: bool = False,
        beyond_rating: bool = False,
    ) -> Self:
        """Open the device of a configuration or a file. Raises the errors of `Configuration.load` and the class.

        Warns
        -----
        DoubtWarning
            For what `Configuration.doubts` lists, before anything is opened, and the warnings of the class.
        """
        if not isinstance(configuration, Configuration):
            configuration = Configuration.load(configuration)
        if remarks.wanted():
            from ebac.simulation import warn_of

            warn_of(configuration.doubts())
        return cls(configuration, simulate=simulate, detached=detached, beyond_rating=beyond_rating)

    def run(
        self,
        law: AnyLaw | None = None,
        environment: Environment | None = None,
        *,
        seconds: float | None = None,
        log: str | Path | None = None,
        look: Callable[[Run], None] = lambda run: None,
        **changes: Any,
    ) -> Trace:
        """Run a law for the configured time and return the rows.

        Parameters
        ----------
        law : str, law class, Variant or law, optional
            A law of the core; default: the law of the configuration.
        environment : Free, Wall, Corner, Disc or worlds.World, optional
            The virtual world; that of the configuration, if not given.
        seconds : float, optional
            How long the law acts [s]; that of the configuration, if not given.
        log : str or Path, optional
            File to record to, .mcap; must not exist.
        look : callable
            Called about 50 times a second with the run. An exception from it ends the run and is raised afterwards.
        **changes
            Parameters of the law that replace those of its design, in SI units.

        Returns
        -------
        Trace
            The rows in memory, from the last `configuration.memory` seconds at most; the log contains all rows.

        Raises
        ------
        LoopFault
            When the loop ended by a fault; it contains the rows. Call `reset` before the next run.
        RuntimeError
            When a run is under way, or the last one ended by a fault and `reset` was not called.
        PositionError
            When an axis stands outside the workspace or the handle inside the virtual world, or on real drives
            `confirm_zero` was not called.
        DriveError, OSError
            When a drive does not carry out a command, or the log cannot be written. Where the loop had ended by a
            fault, its `LoopFault` is the `__cause__`.
        KeyboardInterrupt, Terminated
            When the process received a signal; everything is stopped before this is raised.
        """
        run = self.start(law, environment, seconds=seconds, log=log, **changes)
        with run:
            run.wait(look=look)
        return run.finish()

    def start(
        self,
        law: AnyLaw | None = None,
        environment: Environment | None = None,
        *,
        seconds: float | None = None,
        log: str | Path | None = None,
        **changes: Any,
    ) -> Run:
        """Start a run and return at once, so that you can change parameters, read the rows and stop it. See `run`.

        Raises
        ------
        RuntimeError
            When a run is under way, when the last one ended by a fault and `reset` was not called, or when the process
            that started this one has ended and the device is not `detached`.
        """
        self._between_runs()
        if not self._detached and parent_gone():
            raise RuntimeError(
                "the program that started this one has ended, so nobody may be there to end a run: start it again, or "
                "open the device with detached=True (`ebac run --detached`), which goes on without"
            )
        if not self.confirmed:
            raise PositionError(
                "nobody has confirmed the zero of the encoders: compare `device.positions()` with the handle, then "
                "call `device.confirm_zero()`; on the command line `ebac run` asks"
            )
        if (
            self.report is not None
            and self.report.ended_by == "fault"
            and self.report is not self._cleared
        ):
            raise RuntimeError(
                "the last run ended by a fault: look at its rows and at the device, then call `reset()` and run again"
            )
        known = self.configuration
        if known.engine and environment is None and foreign(known.environment) is None:
            raise RuntimeError(
                f"the configuration has an engine, {known.engine!r}: start it by worlds.EngineProcess and give its "
                "world to the run, or give another environment"
            )
        finished = self._law(law, changes)
        chosen = known if environment is None else known.replace(environment=environment)
        length = known.seconds if seconds is None else seconds
        scenario = chosen.scenario(seconds=length)
        setup = run_setup(chosen, self._nodes, backend=self.backend, seconds=length)
        path = None if log is None else free_log(Path(log))
        return power_up(
            known, self.backend, self._nodes, self.interrupts, self._held,
            law=finished, scenario=scenario, setup=setup, log=path, detached=self._detached,
        )  # fmt: skip

    def reset(self) -> None:
        """Allow another run after one that ended by a fault. To reset a drive in fault, use `ebac drive reset-fault`.

        The zero must be confirmed again: after a loss of power an incremental encoder has lost its position.
        """
        self._confirmed = False
        self._cleared = self.report

    def _law(self, law: AnyLaw | None, changes: dict[str, Any]) -> CoreLaw:
        known = self.configuration
        if law is None:
            law, changes = known.law, {**known.changes, **changes}
        with_sensor = self.backend.sensor is not None
        return designed(law, changes, known.device, known.timing, sensor=with_sensor)

    def close(self) -> None:
        """End a run that is under way and close the bus. The drives have no power afterwards."""
        self._forgotten.detach()
        self._held.close()

    def __enter__(self) -> Self:
        """Return the device."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it, whatever was raised."""
        with noted_on(error, "and at the end"):
            self.close()

    def __repr__(self) -> str:
        """Return one line: the configuration and the backend."""
        return f"<OpenDevice of {self.configuration!r}>"
