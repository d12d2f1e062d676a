"""The world of an engine that answers beside the loop: in a thread, or in another process."""

from __future__ import annotations

from collections.abc import Callable

from ebac import _core
from ebac._core import BridgeParams
from ebac.worlds.engines import BridgeReport, ForeignWorld, report_of, warning_of


class PostedWorld(ForeignWorld):
    """What an engine beside the loop has posted last, rendered in every tick, also in real time.

    Parameters
    ----------
    end : compiled end of its channel
    rendering : BridgeParams
    what : str
        Name for messages.
    trouble : callable, optional
        Returns what has happened to the engine, empty if nothing.
    """

    in_real_time = True

    def __init__(
        self,
        end: _core._EngineEnd | _core._SharedEngineChannel,
        rendering: BridgeParams,
        what: str,
        trouble: Callable[[], str] = str,
    ) -> None:
        super().__init__(end.world(rendering))
        self.rendering, self._what, self._trouble = rendering, what, trouble

    def for_run(self) -> PostedWorld:
        """Return itself: one run at a time has the engine."""
        return self

    @property
    def what(self) -> str:
        """Name for messages."""
        return self._what

    def remark(self) -> str:
        """Return what the run must say, empty if nothing."""
        said = (self._trouble(), warning_of(self.report, self.rendering))
        return "; ".join(one for one in said if one)

    @property
    def report(self) -> BridgeReport:
        """How the engine served the runs so far."""
        return report_of(self)

    def __repr__(self) -> str:
        """Return what it is."""
        return f"PostedWorld({self._what!r}, rendering={self.rendering!r})"
