"""Where the hand wanted to be: X0 of eq. (4) over time, in levels between switches."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ebac._core import Hand, MinimumJerk, Recorded, Sine, Step, Tapping


@dataclass(frozen=True, kw_only=True, eq=False)
class Target:
    """X0(t): `levels` that are fitted, between known switches, plus a known path.

    Parameters
    ----------
    switches : tuple of float
        Times [s] at which the target goes to the next level; the reaction time may be fitted as `onset`.
    segments : tuple of int
        Which level holds before the first switch, between the first two, and so on.
    path : array or None
        Known part of the target [m], one value a row; None for none.
    """

    switches: tuple[float, ...] = ()
    segments: tuple[int, ...] = (0,)
    path: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        """Check that the lists fit each other."""
        if len(self.segments) != len(self.switches) + 1:
            raise ValueError(
                f"Target: {len(self.segments)} segments and {len(self.switches)} switches: "
                "needs one segment more than switches"
            )
        if sorted(set(self.segments)) != list(range(self.levels)):
            raise ValueError(f"Target.segments = {self.segments}: name each level from 0 on")
        if any(b <= a for a, b in zip(self.switches, self.switches[1:], strict=False)):
            raise ValueError("Target.switches: must rise")

    @property
    def levels(self) -> int:
        """How many levels are fitted."""
        return max(self.segments) + 1

    def late(self, seconds: float) -> Target:
        """Return the same with every switch later by some time [s]."""
        return replace(self, switches=tuple(at + seconds for at in self.switches))

    @classmethod
    def held(cls) -> Target:
        """One place, all the time."""
        return cls()

    @classmethod
    def steps(cls, *at: float) -> Target:
        """Return a target with a new place from each time [s] on."""
        return cls(switches=tuple(at), segments=tuple(range(len(at) + 1)))

    @classmethod
    def tapping(cls, frequency: float, seconds: float, start: float = 0.0) -> Target:
        """Level 0 for the first half of each period, level 1 for the second, as `ebac.Tapping`."""
        if not (frequency > 0 and seconds > 0):
            raise ValueError(
                f"Target.tapping: frequency = {frequency} Hz, seconds = {seconds} s: must be positive"
            )
        half = 0.5 / frequency
        first = int(np.floor(start / half))
        count = int(np.floor((start + seconds) / half)) - first
        at = [(first + k) * half for k in range(1, count + 1)]
        at = [t for t in at if start < t < start + seconds]
        if not at:  # one half of one period: one level
            return cls()
        return cls(switches=tuple(at), segments=tuple((first + k) % 2 for k in range(len(at) + 1)))

    @classmethod
    def following(cls, path: NDArray[np.float64]) -> Target:
        """Return a path known but for where it starts, one value [m] a row."""
        return cls(path=np.asarray(path, dtype=float))

    @classmethod
    def of(cls, hand: Hand, t: NDArray[np.float64]) -> Target:
        """Return what an experimenter knows of a simulated hand's target: its times, not its levels."""
        path = hand.path[0]
        start, end = float(t[0]), float(t[-1])
        dt = (end - start) / (len(t) - 1)
        if isinstance(path, Step):
            return cls.steps(path.at) if start < path.at < end else cls.held()
        if isinstance(path, Tapping):
            told = cls.tapping(path.frequency, end - start, start)
            # A simulated hand changes its mind at a tick; one at the last row changes nothing that is recorded.
            ticks = np.ceil(np.array(told.switches) / dt - 1e-9)
            at = tuple(s for s in (ticks * dt).tolist() if s < end - 0.5 * dt)
            return cls(switches=at, segments=told.segments[: len(at) + 1])
        return cls.following(_positions(path, t))


def _positions(path: MinimumJerk | Sine | Recorded, t: NDArray[np.float64]) -> NDArray[np.float64]:
    if isinstance(path, Recorded):
        return np.interp(t, path.t, path.x)
    if isinstance(path, Sine):
        return path.centre + path.amplitude * np.sin(2 * np.pi * path.frequency * t + path.phase)
    s = np.clip((t - path.at) / path.duration, 0, 1)
    smooth: NDArray[np.float64] = path.target * s**3 * (10 + s * (6 * s - 15))
    return smooth
