"""Where the simulated hand wants to be: at the mouse, or pressing and tapping by itself."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from math import cos, nan, pi
from typing import Any

from ebac._core import Hand, Step
from ebac._util.arguments import unknown
from ebac.hardware import Configuration, Run

#: What it does when nobody drags it.
MODES = ("press", "tap", "rest")
#: In which a hand that was left alone lets its force fade [s], after it has held for so long [s].
FADE, HOLD = 0.5, 0.5
#: How fast it moves by itself [m/s], how often it taps [Hz].
SPEED, TAPS = 0.1, 0.5
#: How fast it follows the mouse [m/s].
DRAGGED = 0.5
_PLACES = 3
#: Farthest place [m].
REACH = 0.2


class IntendedHand:
    """The target of a simulated hand; from any thread.

    It begins at zero and moves at 0.1 m/s, or 0.5 m/s where it is dragged, so that the loop's limit of speed is not
    reached by a fling of the mouse. Left alone while it is dragged it holds for 0.5 s, and then its force fades in
    0.5 s: its target moves to where the handle is, so that its spring pulls no more.
    """

    def __init__(
        self,
        known: Configuration,
        *,
        goal: Sequence[float] | None = None,
        mode: str = "press",
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.axes = known.device.axes
        pressed = [getattr(path, "target", 0.0) for path in known.hand.path]
        self.pressed = [float(one) for one in pressed[: self.axes]]
        self.place = [0.0] * self.axes
        fits = goal is not None and len(goal) == self.axes
        self.mode = mode if fits or mode in MODES else "press"
        self.goal = list(goal) if goal is not None and fits else list(self.place)
        self.post: Callable[[list[float]], None] | None = None
        self.handle: list[float] | None = None
        self._left: float | None = None
        self._left_at: list[float] = []
        self._clock = clock
        self._begun = self._last = clock()
        self._lock = threading.Lock()

    def drag(self, place: Sequence[float]) -> None:
        """Go to `place` [m], by axis.

        Raises
        ------
        ValueError
            For as many numbers as there are no axes, or numbers out of range.
        """
        if len(place) != self.axes or not all(abs(x) <= REACH for x in place):
            raise ValueError(f"hand: must be {self.axes} numbers in [-{REACH}, {REACH}] m")
        with self._lock:
            self.mode, self._left = "mouse", None
            self.goal = [float(x) for x in place]
        self.move()

    def set_mode(self, mode: str) -> None:
        """Press, tap or rest by itself.

        Raises
        ------
        ValueError
            For another word.
        """
        if mode not in MODES:
            raise ValueError(unknown(f"hand mode {mode[:40]!r}", mode, MODES))
        with self._lock:
            self._begun, self._left, self.mode = self._clock(), None, mode

    def leave(self) -> None:
        """Nobody is there any more: hold, then let the force fade; nothing for a hand that moves by itself."""
        with self._lock:
            if self.mode == "mouse" and self._left is None:
                self._left, self._left_at = self._clock(), list(self.place)

    @property
    def fades(self) -> bool:
        """Whether it was left alone."""
        return self._left is not None

    def go_on(self, run: Run) -> None:
        """Go on by the time since the last call, with a look at the handle where it was left alone."""
        if self.fades and len(last := run.tail(1)):
            self.handle = [float(one) for one in last["x"].reshape(-1)]
        self.move()

    def move(self) -> None:
        """Go on by the time since the last call."""
        with self._lock:
            now = self._clock()
            passed, self._last = min(0.1, now - self._last), now
            if self._left is not None:
                share = min(1.0, max(0.0, (now - self._left - HOLD) / FADE))
                here = self.handle or self.place
                self.place = [
                    (1 - share) * held + share * x
                    for held, x in zip(self._left_at, here, strict=True)
                ]
            else:
                self._toward(self._wanted(now), passed)
            if self.post is not None:
                self.post([*self.place, *(nan for _ in range(_PLACES - self.axes))])

    def _toward(self, wanted: Sequence[float], passed: float) -> None:
        step = passed * (DRAGGED if self.mode == "mouse" else SPEED)
        self.place = [
            x + min(step, max(-step, w - x)) for x, w in zip(self.place, wanted, strict=True)
        ]

    def _wanted(self, now: float) -> list[float]:
        if self.mode == "mouse":
            return self.goal
        if self.mode == "rest":
            return [0.0] * self.axes
        if self.mode == "tap":
            share = 0.5 - 0.5 * cos(2 * pi * TAPS * (now - self._begun))
            return [share * one for one in self.pressed]
        return self.pressed

    def as_hand(self, hand: Hand) -> Hand:
        """Return a hand that steps to where this one wants to be."""
        path: list[Any] = [Step(target=one) for one in self._wanted(self._clock())]
        return hand.replace(path=path)
