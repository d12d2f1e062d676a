"""The virtual clock of a session: whole steps, in which the hand moves, at most as quick as the clock on the wall."""

from __future__ import annotations

import time

from ebac.hardware.virtual_device import VirtualRun
from ebac.live.intended_hand import IntendedHand

#: The hand moves, and what is changed acts, every so often [s].
STEP = 8e-3
#: What is made up at a time of a machine that was late; the rest is left out, and time stood still [steps].
MOST = 8


class VirtualTime:
    """Time that goes on by `advance` alone.

    Attributes
    ----------
    now : float
        The time in all runs so far [s].
    """

    def __init__(self) -> None:
        self.now = 0.0
        self._shown: float | None = None

    def advance(self, run: VirtualRun, hand: IntendedHand, steps: int) -> None:
        """Take steps of 8 ms, in each of which the hand goes on first."""
        dt = run._scenario.timing.dt
        ticks = max(1, round(STEP / dt))
        for _ in range(steps):
            if run.done:
                return
            self.now += ticks * dt
            hand.go_on(run)
            run.advance(ticks)

    def due(self) -> int:
        """Return how many steps the clock on the wall is ahead since the last call, at most 8."""
        now = time.monotonic()
        if self._shown is None:
            self._shown = now
        steps = int((now - self._shown) / STEP)
        self._shown = self._shown + steps * STEP if steps <= MOST else now
        return min(steps, MOST)
