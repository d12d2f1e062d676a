"""What can be changed of a loop while it runs: its law, its virtual world, the target of a simulated hand."""

from __future__ import annotations

import threading
import warnings
from typing import TYPE_CHECKING, Any

from ebac import _core
from ebac.hardware.current_parameters import CurrentParameters
from ebac.hardware.live_status import LiveStatus

if TYPE_CHECKING:
    from ebac.laws import CoreLaw
    from ebac.scenario import Environment, Scenario


class RunChanges(LiveStatus):
    """Changes of a running loop, each from the next tick on, by any thread."""

    def __init__(
        self,
        running: _core.Running,
        scenario: Scenario,
        parameters: CurrentParameters,
        *,
        origin: str,
    ) -> None:
        super().__init__(running, scenario, parameters, origin=origin)
        self._lock = threading.RLock()  # who changes or ends it

    def retune(self, **changes: Any) -> CoreLaw:
        """Change parameters of the law from the next tick on; its memory stays. Return the law with its new gains.

        Parameters
        ----------
        **changes
            In their SI units. What the law knows of the device cannot change while it runs.

        Raises
        ------
        ValueError
            For a number out of range, or one that cannot change.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            return self._parameters.retune(**changes)

    def replace_law(self, law: CoreLaw) -> CoreLaw:
        """Let another law take over from the next tick on, and return it.

        It begins without memory, and the step between the two forces fades out within 50 ms. A law that differs in its
        gains only takes over their memory, too, as in `retune`. The columns `law.*` are those of the law of the start,
        and 0 under another one.

        Parameters
        ----------
        law : law of the core
            Designed for the device, as by `ebac.design`.

        Raises
        ------
        TypeError
            For one that is not compiled in C++.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            return self._parameters.replace_law(law)

    def hold_back(self, ticks: int) -> int:
        """Hold every command back by some ticks more from the next tick on, and return how many; simulated drives only.

        Parameters
        ----------
        ticks : int
            On top of what drives and bus take [samples], 0 to 7.

        Raises
        ------
        ValueError
            For a number out of range, and on hardware.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            return self._parameters.hold_back(ticks)

    def change(self, environment: Environment | None = None, **changes: Any) -> Environment:
        """Change the virtual world from the next tick on: another one, or numbers of the present one. Return it.

        Parameters
        ----------
        environment : Free, Wall, Corner, Disc or worlds.World, optional
            The new one; the present one, if not given.
        **changes
            Numbers of it, in SI units: `stiffness=5e3`.

        Raises
        ------
        ValueError, TypeError
            For a number out of range, or a name it does not have.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            return self._parameters.change(environment, **changes)

    def set_target(self, *target: float | None) -> tuple[float | None, ...]:
        """Move the target of a simulated hand from the next tick on, and return all its targets.

        Parameters
        ----------
        *target
            By axis, -10 to 10 m; None for an axis that stays as it is.

        Returns
        -------
        tuple
            Target of each axis [m]; None where it still follows its path.

        Raises
        ------
        ValueError
            For a number out of range, for more numbers than axes, where the path is a recorded one, and on hardware:
            only a simulated hand has a target that can be set.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            return self._parameters.set_target(*target)

    def aim(self, *target: float | None) -> tuple[float | None, ...]:
        """Do what `set_target` does; the old name, until the next release."""
        warnings.warn("Run.aim is now Run.set_target", DeprecationWarning, stacklevel=2)
        return self.set_target(*target)

    def _check(self) -> None:
        if self.done:
            raise RuntimeError("the loop has ended: start another run")
