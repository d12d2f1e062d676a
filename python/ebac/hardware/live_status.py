"""Status and rows of a loop while it runs and afterwards."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ebac import _core
from ebac.trace import Trace
from ebac.trace.columns import column_infos, row_views

if TYPE_CHECKING:
    from ebac.hardware.current_parameters import CurrentParameters
    from ebac.laws import CoreLaw
    from ebac.scenario import Environment, Scenario


class LiveStatus:
    """Rows and current parameters of a running loop; any thread may read them at any time."""

    def __init__(
        self,
        running: _core.Running,
        scenario: Scenario,
        parameters: CurrentParameters,
        *,
        origin: str,
    ) -> None:
        self._running = running
        self._scenario = scenario
        self._parameters = parameters
        self._origin = origin

    @property
    def law(self) -> CoreLaw:
        """The law with its current gains."""
        return self._parameters.law

    @property
    def environment(self) -> Environment:
        """The current virtual world."""
        return self._parameters.world

    @property
    def target(self) -> tuple[float | None, ...]:
        """Target of a simulated hand, by axis [m]; None for an axis that follows its path."""
        return self._parameters.target

    @property
    def done(self) -> bool:
        """Whether the loop has ended."""
        return self._running.done

    @property
    def ticks(self) -> int:
        """Number of rows so far."""
        return self._running.rows.count

    def tail(self, rows: int = 1000) -> Trace:
        """Return a copy of the last rows, also while it runs.

        Parameters
        ----------
        rows : int
            Largest number of rows, at least 1.

        Returns
        -------
        Trace

        Raises
        ------
        ValueError
            For a number below 1.
        """
        if rows < 1:
            raise ValueError(f"rows = {rows}: must be at least 1")
        all_rows = self._running.rows
        stop = all_rows.count
        _, raw = all_rows.copy(max(all_rows.first, stop - rows), stop)
        return Trace(
            data=row_views(all_rows, raw),
            columns=column_infos(all_rows),
            axes=all_rows.axes,
            scenario=self._scenario,
            law=self.law.name,
            law_repr=repr(self.law),
            origin=self._origin,
            changed=self._parameters.updates.sent,
        )

    @property
    def state(self) -> _core.LoopState:
        """State of the loop: arm, run, stop, idle or fault."""
        if self.done:
            return self._running.state
        last = self.tail(1)
        return _core.LoopState(int(last["state"][-1])) if len(last) else _core.LoopState.ARM

    def trace(self) -> Trace:
        """Return all rows in memory; they are shared instead of copied unless they are in a ring buffer."""
        return Trace.from_rows(
            self._running.rows,
            scenario=self._scenario,
            law=self.law.name,
            law_repr=repr(self.law),
            origin=self._origin,
            changed=self._parameters.updates.sent,
        )
