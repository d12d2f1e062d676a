"""A device on a virtual clock, for runs that are changed on their way: it takes its ticks when asked to."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING, Any, cast

from ebac import _core
from ebac.drives.errors import DriveError
from ebac.hardware.interrupts import Interrupts
from ebac.hardware.rating import check_rating
from ebac.hardware.run import Run

if TYPE_CHECKING:
    from ebac.hardware.configuration import Configuration
    from ebac.scenario import Environment


class VirtualRun(Run):
    """A run whose ticks are taken by `advance` alone; nothing of it depends on how late a machine is."""

    def advance(self, ticks: int) -> int:
        """Take this many ticks, fewer where the run ends; return how many."""
        return self._stepped.advance(ticks)

    def aim_now(self, target: Sequence[float]) -> None:
        """Set the target of the hand before the next tick [m], NaN for an axis that stays; not noted in the log."""
        self._stepped.aim_now(list(target))

    @property
    def _stepped(self) -> _core.SteppedRun:
        return cast("_core.SteppedRun", self._running)


class VirtualDevice:
    """The device of a configuration as `Configuration.simulate` has it, whose runs go on by `VirtualRun.advance`.

    Parameters
    ----------
    configuration : Configuration
        What is there, and what is wanted.
    delay : int
        Of bus and drives [samples]; with a `timing.delay` above it a run holds back the rest (`Run.hold_back`).

    Raises
    ------
    ConfigurationError
        When signs or zero of the simulated device are others than those of the configuration, or a limit exceeds the
        data sheet of the motor.
    """

    def __init__(self, configuration: Configuration, *, delay: int) -> None:
        configuration._refuse_wrong_wiring()
        check_rating(configuration)
        self.configuration = configuration
        self._delay = delay
        self._run: VirtualRun | None = None

    def start(self, law: Any, environment: Environment) -> VirtualRun:
        """Begin a run; its first tick is taken by `VirtualRun.advance`. Raises as `Configuration.simulate`."""
        from ebac.simulation import on_bus

        known, bus = self.configuration, self.configuration.timed_bus()
        scenario = on_bus(known._on_virtual_clock().replace(environment=environment), "can", bus)
        setup = _core.Setup(
            device=scenario.device,
            hand=scenario.hand,
            environment=scenario.environment,
            timing=scenario.timing.replace(delay=self._delay),
            seconds=float(scenario.seconds),
            jitter=float(scenario.jitter),
            seed=scenario.seed,
            observer=scenario.designed_observer(),
        )
        setup = _core._with_loop(
            setup, soft_start=known.soft_start, ramp_down=known.ramp_down, limits=known.limits
        )
        rows = ceil(known.memory / known.timing.dt)
        running: _core.SteppedRun = law._stepped(setup, bus, rows)

        def power_off() -> list[str]:
            try:
                running.switch_off()
            except RuntimeError as error:
                raise DriveError(str(error)) from error
            return []  # no drive is left to ask

        self._run = VirtualRun(
            running,
            law=law,
            scenario=scenario,
            interrupts=Interrupts(),
            power_off=power_off,
            hand=True,
            detached=True,
        )
        return self._run

    def close(self) -> None:
        """End the run."""
        if self._run is not None:
            self._run.end()
