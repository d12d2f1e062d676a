"""Target position of the hand: X0 of eq. (4) over time, in levels between switches."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from numbers import Real
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ebac._core import Hand, MinimumJerk, Recorded, Sine, Step, Tapping
from ebac._util.arguments import number, require, whole
from ebac._util.wrong_calls import plain_constructor, plain_function
from ebac.identify.recording import Recording

#: More than this of tapping are no recording, but a wrong unit.
MOST_PERIODS = 1e5

Path: TypeAlias = MinimumJerk | Recorded | Sine | Step | Tapping


@plain_constructor
@dataclass(frozen=True, kw_only=True, eq=False)
class Target:
    """X0(t): `levels` that are fitted, between known switches, plus a known path.

    Parameters
    ----------
    switches : tuple of float
        Times [s] at which the target goes to the next level; the reaction time may be fitted as `onset`.
    segments : tuple of int
        Index of the level before the first switch, between the first two, and so on.
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
        for before, at in pairwise((-np.inf, *self.switches)):
            if not before < at < np.inf:
                raise ValueError(f"Target.switches = {self.switches} s: must be finite and rise")
        if self.path is not None and self.path.ndim != 1:
            raise ValueError(f"Target.path: shape {self.path.shape}: must be (rows,)")
        if self.path is not None and not np.isfinite(self.path).all():
            row = int(np.argmin(np.isfinite(self.path)))
            raise ValueError(f"Target.path: is no number in row {row} (counted from 0)")

    @property
    def levels(self) -> int:
        """Number of fitted levels."""
        return max(self.segments) + 1

    def late(self, seconds: float) -> Target:
        """Return the target with every switch delayed by some time [s]."""
        number("Target.late: seconds", seconds)
        return replace(self, switches=tuple(at + seconds for at in self.switches))

    def cut(self, recording: Recording, part: slice) -> tuple[Target, tuple[int, ...]]:
        """Return the target over some rows of a recording, and which of the levels it has there."""
        start, end = float(recording.t[part.start]), float(recording.t[part.stop - 1])
        passed = sum(at <= start for at in self.switches)
        inside = tuple(at for at in self.switches if start < at < end)
        segments = self.segments[passed : passed + len(inside) + 1]
        used = tuple(sorted(set(segments)))
        path = None if self.path is None else self.path[part]
        numbers = tuple(used.index(level) for level in segments)
        return Target(switches=inside, segments=numbers, path=path), used

    @classmethod
    def held(cls) -> Target:
        """Return a target that stays in one place."""
        return cls()

    @classmethod
    def steps(cls, *at: float) -> Target:
        """Return a target with a new place from each time [s] on."""
        for time in at:
            require(time, (Real, np.number), "Target.steps", "times [s]")
        return cls(switches=tuple(at), segments=tuple(range(len(at) + 1)))

    @classmethod
    @plain_function
    def tapping(cls, frequency: float, seconds: float, start: float = 0.0) -> Target:
        """Return a target with level 0 in the first half of each period and level 1 in the second, like `Tapping`.

        Parameters
        ----------
        frequency : float
            Of the periods [Hz], above 0.
        seconds : float
            Length of the recording [s], above 0: a switch within it is one place more to fit.
        start : float
            Time of its first row [s].

        Raises
        ------
        ValueError
            For a frequency or a length that is not above 0, more than 100,000 periods, or a start that is not finite.
        """
        number("Target.tapping: frequency", frequency)
        number("Target.tapping: seconds", seconds)
        if not np.isfinite(number("Target.tapping: start", start)):
            raise ValueError(f"Target.tapping: start = {start} s: must be finite")
        if not (frequency > 0 and seconds > 0):
            raise ValueError(
                f"Target.tapping: frequency = {frequency} Hz, seconds = {seconds} s: must be positive"
            )
        if not frequency * seconds <= MOST_PERIODS:
            raise ValueError(
                f"Target.tapping: frequency = {frequency} Hz, seconds = {seconds} s: must be at most "
                f"{MOST_PERIODS:g} periods"
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
    @plain_function
    def following(cls, path: NDArray[np.float64]) -> Target:
        """Return a target along a path that is known except for its start, one value [m] per row."""
        return cls(path=np.asarray(path, dtype=float))

    @classmethod
    @plain_function
    def recorded(cls, recording: Recording) -> Target:
        """Return the target that a recording has, as a column or in its scenario; else one that stays in one place."""
        if recording.target is not None:
            return cls.following(recording.target)
        return cls.held() if recording.path is None else cls.along(recording.path, recording.t)

    @classmethod
    @plain_function
    def of(cls, hand: Hand, t: NDArray[np.float64], axis: int = 0) -> Target:
        """Return what an experimenter knows of a simulated hand's target along an axis: its times, not its levels."""
        require(hand, Hand, "Target.of", "a Hand")
        if not 0 <= whole("axis", axis) < len(hand.path):
            raise ValueError(f"axis = {axis}: must lie in [0, {len(hand.path) - 1}]")
        return cls.along(hand.path[axis], t)

    @classmethod
    @plain_function
    def along(cls, path: Path, t: NDArray[np.float64]) -> Target:
        """Return the target that follows the path of a hand along one axis."""
        start, end = float(t[0]), float(t[-1])
        dt = float(np.median(np.diff(t)))  # a log may pause
        if isinstance(path, Step):
            return cls.steps(path.at) if start < path.at < end else cls.held()
        if isinstance(path, Tapping):
            taps = cls.tapping(path.frequency, end - start, start)
            # A simulated hand changes its mind at a tick; one at the last row changes nothing that is recorded.
            ticks = np.ceil(np.array(taps.switches) / dt - 1e-9)
            at = tuple(s for s in (ticks * dt).tolist() if s < end - 0.5 * dt)
            return cls(switches=at, segments=taps.segments[: len(at) + 1])
        return cls.following(_positions(path, t))


def require_target(recording: Recording, target: object, function: str) -> None:
    """Raise TypeError unless it is a Target, ValueError unless its path has a value for each row of the recording."""
    require(target, Target, f"ebac.identify.{function}", "a Target, such as Target.held()")
    path, rows = getattr(target, "path", None), len(recording.t)
    if path is not None and np.shape(path) != (rows,):
        raise ValueError(
            f"{recording.name}: the path of its target has the shape {np.shape(path)}: must be ({rows},), one value "
            "a row"
        )


def longest(recording: Recording, target: Target) -> tuple[Recording, Target]:
    """Return the longest stretch of a recording between two pauses, and the target there."""
    if len(recording.stretches) == 1:
        return recording, target
    part = max(recording.stretches, key=lambda rows: rows.stop - rows.start)
    return recording.rows(part), target.cut(recording, part)[0]


def in_words(path: Path) -> str:
    """Return what a path is: "taps at 1.5 Hz"."""
    if isinstance(path, Tapping):
        return f"taps at {path.frequency:g} Hz"
    if isinstance(path, Step):
        return f"steps at {path.at:g} s" if path.at > 0 else "held in one place"
    if isinstance(path, Sine):
        return f"swings at {path.frequency:g} Hz"
    return "a recorded path" if isinstance(path, Recorded) else "a smooth reach"


def _positions(path: MinimumJerk | Sine | Recorded, t: NDArray[np.float64]) -> NDArray[np.float64]:
    if isinstance(path, Recorded):
        return np.interp(t, path.t, path.x)
    if isinstance(path, Sine):
        return path.centre + path.amplitude * np.sin(2 * np.pi * path.frequency * t + path.phase)
    s = np.clip((t - path.at) / path.duration, 0, 1)
    smooth: NDArray[np.float64] = path.target * s**3 * (10 + s * (6 * s - 15))
    return smooth


def indicators(recording: Recording, target: Target) -> NDArray[np.float64]:
    """Return one row per level, shape (levels, rows): the share of the tick before that it held, behind the lag."""
    t, dt = recording.t, recording.dt
    out = np.zeros((target.levels, len(t)))
    begins = np.array([-np.inf, *target.switches])
    ends = np.array([*target.switches, np.inf])
    first = np.searchsorted(t, begins, side="right")
    last = np.searchsorted(t - dt, ends, side="left")
    for level, a, b, i, k in zip(target.segments, begins, ends, first, last, strict=True):
        inside = t[i:k]
        out[level, i:k] += (np.minimum(b, inside) - np.maximum(a, inside - dt)) / dt
    return np.array([lagged(row, dt, recording.lag, stepping=True) for row in out])


#: A lag has settled after this many of its time constants: to 1e-11.
SETTLES = 25


def lagged(
    values: NDArray[np.float64], dt: float, lag: float, *, stepping: bool = False
) -> NDArray[np.float64]:
    """Return a signal behind a first-order lag [s], by its impulse response.

    Between two rows it is straight; `stepping`, it has the value of a row since the row before.
    """
    if lag <= 0:
        return values
    keep = np.exp(-dt / lag)
    response = keep ** np.arange(int(np.ceil(SETTLES * lag / dt)) + 1)
    if not stepping:
        ramp = lag / dt * (1 - keep)
        response = np.concatenate([[1 - ramp], ramp * (1 - keep) * response])
    response /= response.sum()
    padded = np.concatenate([np.full(len(response) - 1, values[0]), values])
    return np.convolve(padded, response, mode="valid")
