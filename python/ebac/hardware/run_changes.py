"""Change a loop while it runs: its law, its virtual world, the target of a simulated hand."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

from ebac import _core
from ebac.hardware.current_parameters import CurrentParameters
from ebac.hardware.live_status import LiveStatus

if TYPE_CHECKING:
    from ebac.laws import CoreLaw
    from ebac.scenario import Environment, Scenario


class RunChanges(LiveStatus):
    """Changes of a running loop. Each takes effect at the next tick; any thread may make them."""

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
        """Change parameters of the law from the next tick on and return it. It keeps its internal state.

        Parameters
        ----------
        **changes
            New values in SI units. Declared parameters of the device cannot change while the law runs.

        Raises
        ------
        ValueError
            For a number out of range, or a parameter that cannot change.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            return self._parameters.retune(**changes)

    def replace_law(self, law: CoreLaw) -> CoreLaw:
        """Let another law take over from the next tick on, and return it.

        It begins with its initial state, and the step between the two forces fades out within 50 ms. A law that
        differs only in its gains continues with the present state, as in `retune`. The columns `law.*` are those of
        the law with which the run began, and 0 under another law.

        Parameters
        ----------
        law : law of the core
            Designed for the device, as by `ebac.design`.

        Raises
        ------
        TypeError
            For a law that is not compiled in C++.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            return self._parameters.replace_law(law)

    def hold_back(self, ticks: int) -> int:
        """Delay every command by some more ticks from the next tick on, and return their number; simulated drives only.

        Parameters
        ----------
        ticks : int
            Delay in addition to that of drives and bus [samples], 0 to 7.

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

    def change(
        self, environment: Environment | None = None, *, into_hand: bool = False, **changes: Any
    ) -> Environment:
        """Replace the virtual world, or change parameters of the present one, from the next tick on, and return it.

        Parameters
        ----------
        environment : Free, Wall, Corner, Disc or worlds.World, optional
            The new world; default: the present one.
        into_hand : bool
            Whether a surface may come to stand more than 1 mm deeper behind the handle than now, which throws the hand
            out.
        **changes
            Parameters of the world, in SI units: `stiffness=5e3`.

        Raises
        ------
        ValueError, TypeError
            For a number out of range, a name that the world does not have, or a surface behind the handle.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            place = None if into_hand else self._place()
            return self._parameters.change(environment, place, **changes)

    def set_target(self, *target: float | None) -> tuple[float | None, ...]:
        """Move the target of a simulated hand from the next tick on, and return all its targets.

        Parameters
        ----------
        *target
            Target of each axis, -10 to 10 m; None for an axis whose target does not change.

        Returns
        -------
        tuple
            Target of each axis [m]; None where it still follows its path.

        Raises
        ------
        ValueError
            For a number out of range, for more numbers than axes, if the path is a recorded one, and on hardware:
            only the target of a simulated hand can be set.
        RuntimeError
            When the loop has ended.
        """
        with self._lock:
            self._check()
            return self._parameters.set_target(*target)

    def _place(self) -> list[float] | None:
        """Return where the handle is [m]; None before the first row."""
        last = self.tail(1)
        return [float(one) for one in last["x"].reshape(-1)] if len(last) else None

    def _check(self) -> None:
        if self.done:
            raise RuntimeError("the loop has ended: start another run")
