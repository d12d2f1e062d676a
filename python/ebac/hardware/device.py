"""A device that is open: `with ebac.Device.open(config) as device: trace = device.run(law)`."""

from __future__ import annotations

import atexit
import io
import tempfile
import warnings
import weakref
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from ebac._util.exception_notes import noted_on
from ebac._util.wrong_calls import plain_constructor
from ebac.drives import Backups, check_stall
from ebac.hardware import drive_setup
from ebac.hardware.backends import hardware, simulated
from ebac.hardware.configuration import Configuration
from ebac.hardware.interrupts import Interrupts
from ebac.hardware.law import designed
from ebac.hardware.rating import check_rating
from ebac.hardware.report import Report
from ebac.hardware.run import Run
from ebac.hardware.run_setup import run_setup, started
from ebac.logs.about import SIMULATED_FILE
from ebac.logs.writer import discard, new_log

if TYPE_CHECKING:
    from ebac.hardware.backends import Backend
    from ebac.laws import AnyLaw, CoreLaw
    from ebac.scenario import Environment
    from ebac.trace import Trace


@plain_constructor
class OpenDevice:
    """The drives of a device, set up and without power. Get it from `ebac.Device.open`; a context manager.

    Only a run powers the motors. Each ends without power, however it ends: by its time, a fault, `stop`, an exception,
    a signal such as SIGINT, the end of the program or of its parent. One that is killed leaves the drives to their own
    watch over the loop's torques and heartbeat.

    Parameters
    ----------
    configuration : Configuration
        What is there, and what is wanted.
    simulate : bool
        Whether simulated drives, with a simulated device in a simulated hand, stand in for the real ones. All else is
        as it is: the loop's thread, its clock, the bus, the set-up of the drives.
    detached : bool
        Whether a run goes on when the program that started this one has died.
    beyond_rating : bool
        Whether limits may exceed the data sheet of the motor.

    Attributes
    ----------
    configuration : Configuration
        As given.
    backend : Backend
        The bus with the drives.

    Warns
    -----
    UserWarning
        When the process data take over 70 % of the bus, or the force sensor's own page cannot be read.

    Raises
    ------
    ConfigurationError
        When a limit exceeds the data sheet of the motor, without `beyond_rating`.
    SensorError
        When the force sensor scales its counts otherwise than configured.
    ProfileError
        When they take over 90 % of it, or a drive would hold its torque without the loop.
    DriveError
        When a drive cannot be reached, is in fault, or holds something else than its profile.
    """

    def __init__(
        self,
        configuration: Configuration,
        *,
        simulate: bool = False,
        detached: bool = False,
        beyond_rating: bool = False,
    ) -> None:
        if not beyond_rating:
            check_rating(configuration.limits, configuration.device)
        self.configuration = configuration
        self.simulated = simulate
        self._cleared: Report | None = None  # of the fault that `reset` was called for
        self._detached = detached
        self._nodes = drive_setup.nodes_of(configuration, simulate=simulate)
        network = replace(configuration.drives, nodes=self._nodes)
        check_stall(network)
        loaded = not simulate and configuration.interface == "socketcan"
        if loaded and (warning := network.check_load()) is not None:
            warnings.warn(warning, stacklevel=2)
        with ExitStack() as stack:
            self.interrupts = stack.enter_context(Interrupts())
            self.backend: Backend = stack.enter_context(
                simulated(configuration) if simulate else hardware(configuration)
            )
            backups = None
            if simulate:
                backups = Backups(Path(stack.enter_context(tempfile.TemporaryDirectory())))
            write = simulate or configuration.setup == "apply"
            drive_setup.set_up(self.backend, self._nodes, write=write, backups=backups)
            if not simulate and configuration.sensor is not None:
                configuration.sensor.check_scale()
            self._held = _Held(stack.pop_all())
        # What is forgotten, in a notebook or at the end of its program, is closed all the same.
        self._forgotten = weakref.finalize(self, self._held.close)
        self._forgotten.atexit = False  # another exit sees to that, in its place among others
        atexit.register(self._held.close)

    @property
    def report(self) -> Report | None:
        """How the last run went."""
        return None if self._held.run is None else self._held.run.report

    @classmethod
    def open(
        cls,
        configuration: Configuration | str | Path,
        *,
        simulate: bool = False,
        detached: bool = False,
        beyond_rating: bool = False,
    ) -> Self:
        """Open the device of a configuration, or of its file. Raises as `Configuration.load` and the class."""
        if not isinstance(configuration, Configuration):
            configuration = Configuration.load(configuration)
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
        """Run a law to the end of its time, and return the rows.

        Parameters
        ----------
        law : str, law class, Variant or law, optional
            One of the core; that of the configuration, if not given.
        environment : Free, Wall, Corner or Disc, optional
            The virtual world; that of the configuration, if not given.
        seconds : float, optional
            How long the law acts [s]; that of the configuration, if not given.
        log : str or Path, optional
            File to record to, .mcap; must not exist.
        look : callable
            Called about 50 times a second with the run; what it raises ends the run, and is raised after it.
        **changes
            Parameters of the law on top of its design, in SI units.

        Returns
        -------
        Trace
            The rows in memory, those of `configuration.memory` seconds at most; the log has all.

        Raises
        ------
        LoopFault
            When the loop ended by a fault; it carries the rows. The next run asks for `reset` first.
        RuntimeError
            When a run is under way, or the last one ended by a fault and `reset` was not called.
        DriveError, OSError
            When a drive does not obey, or the log cannot be written.
        KeyboardInterrupt, Terminated
            When a signal came; all has stopped before.
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
        """Start a run and return at once: to change parameters, to look at the rows, to stop it. As `run`.

        Raises
        ------
        RuntimeError
            When a run is under way, or the last one ended by a fault and `reset` was not called.
        """
        if self._held.run is not None and self._held.run.report is None:
            raise RuntimeError("a run is under way: end it first")
        if (
            self.report is not None
            and self.report.ended_by == "fault"
            and self.report is not self._cleared
        ):
            raise RuntimeError(
                "the last run ended by a fault: look at its rows and at the device, then call `reset()` and run again"
            )
        known = self.configuration
        finished = self._law(law, changes)
        chosen = known if environment is None else known.replace(environment=environment)
        length = known.seconds if seconds is None else seconds
        scenario = chosen.scenario(seconds=length)
        setup = run_setup(chosen, self._nodes, backend=self.backend, seconds=length)
        path = None if log is None else _free(Path(log))
        backend, nodes = self.backend, self._nodes

        def power_off() -> list[str]:
            return drive_setup.power_off(backend, nodes)

        file = None if path is None else new_log(path)  # before there is power
        with ExitStack() as undo:  # from the last to the first, each whatever the others raise
            undo.callback(_discard, file, path)
            drive_setup.start(backend, nodes)
            undo.callback(self.interrupts.forget)
            undo.callback(power_off)
            undo.callback(self.interrupts.ending)
            self.interrupts.moving()
            running = started(finished, backend, setup)
            run = self._held.run = Run(
                running,
                law=finished,
                scenario=scenario,
                interrupts=self.interrupts,
                power_off=power_off,
                grants=backend.grants,
                hand=backend.aim is not None,
                detached=self._detached,
            )
            undo.pop_all()
        try:
            if path is not None:
                files = {"configuration.toml": known.text}
                if backend.aim is not None:  # a simulated hand: drives and device are simulated too
                    files[SIMULATED_FILE] = f"{backend.about}\n"
                run.record(path, files=files, sync=known.sync, file=file)
            self._held.last_to_register()
        except BaseException:
            run.end()
            raise
        return run

    def reset(self) -> None:
        """Allow another run after one that ended by a fault. A drive in fault is reset by `ebac drive reset-fault`."""
        self._cleared = self.report

    def _law(self, law: AnyLaw | None, changes: dict[str, Any]) -> CoreLaw:
        known = self.configuration
        if law is None:
            law, changes = known.law, {**known.changes, **changes}
        with_sensor = self.backend.sensor is not None
        return designed(law, changes, known.device, known.timing, sensor=with_sensor)

    def close(self) -> None:
        """End a run that is under way, and let go of the bus. The drives have no power."""
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


class _Held:
    """What a device must let go of, whoever forgets it: its run first."""

    def __init__(self, stack: ExitStack) -> None:
        self.run: Run | None = None
        self._stack = stack

    def last_to_register(self) -> None:
        """Be the first to be called at the exit of the interpreter: before the recorder, and simulated drives."""
        atexit.unregister(self.close)
        atexit.register(self.close)

    def close(self) -> None:
        atexit.unregister(self.close)
        try:
            if self.run is not None:
                self.run.end()
        finally:
            self._stack.close()


def _discard(file: io.FileIO | None, path: Path | None) -> None:
    if file is not None and path is not None:
        discard(file, path)


def _free(path: Path) -> Path:
    if path.suffix != ".mcap":
        raise ValueError(
            f"log = {path}: must end in .mcap; `ebac log export` makes other formats of it"
        )
    if path.exists():
        raise FileExistsError(
            17, "There is such a file already; a log is never written over", str(path)
        )
    return path
