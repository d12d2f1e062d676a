"""Signals of a recording: smoothing, noise, repeats of the same rows, and the ripple of a motor's stair of forces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from itertools import pairwise
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ebac._util.arrays import Values
from ebac.identify.limits import at_limits
from ebac.identify.recording import Recording
from ebac.identify.target import Target, lagged


def rough(values: NDArray[np.float64]) -> float:
    """Return the standard deviation of white noise on a smooth signal, from third differences.

    Their median, so that jumps do not count.
    """
    third = np.diff(values, 3)
    return float(np.median(np.abs(third)) / 0.6745 / np.sqrt(20.0))


@dataclass(frozen=True, kw_only=True, eq=False)
class Readings:
    """Positions known from an encoder: value [m], variance [m^2], and how long before its row it was true [s]."""

    x: NDArray[np.float64]
    variance: NDArray[np.float64]
    early: NDArray[np.float64]


#: A run of one reading longer than this shows, in its middle, that the handle was within the count [rows].
REST = 30
#: Faster than this an edge is crossed in every tick [counts a tick].
FAST = 1.0


Found = TypeVar("Found")


def _once(look: Callable[[Recording], Found]) -> Callable[[Recording], Found]:
    """Look once in each recording."""
    known: WeakKeyDictionary[Recording, Found] = WeakKeyDictionary()

    @wraps(look)
    def looked(recording: Recording) -> Found:
        if recording not in known:
            known[recording] = look(recording)
        return known[recording]

    return looked


@_once
def readings(recording: Recording) -> Readings:
    """Return the positions the encoder determines.

    A count is most precise where it changes: then the handle crossed the edge between two counts, in the tick before,
    wherever in the tick. The rows between say the
    same thing again, with an error that follows the motion and that a law feeds back into it; they are left out. A
    long rest counts once.

    Where the handle crosses an edge in every tick, each row gives the position, to half a count. Which rows are read in
    which way follows from the smoothed speed alone: chosen by how many edges a tick crossed, the rows that crossed two
    would all lie ahead of the handle.
    """
    x, count, dt = recording.x, recording.count, recording.dt
    early = np.zeros(len(x)) if recording.early is None else recording.early.copy()
    rows = np.arange(len(x)) if recording.known is None else np.flatnonzero(recording.known)
    variance, position = np.full(len(x), np.inf), x.copy()
    if count <= 0:
        floor = 1e-6 * float(np.ptp(x))
        variance[rows] = max(rough(x), floor) ** 2
        return Readings(x=x, variance=variance, early=early)
    value, at = x[rows], rows * dt - early[rows]
    since = np.diff(at, prepend=at[0] - dt)  # s, from the reading before
    changed = np.flatnonzero(np.abs(np.diff(value, prepend=value[0])) > 0.5 * count)
    fast = np.abs(speed(x, dt))[rows] * dt > FAST * count
    plain = fast.copy()
    plain[changed] |= since[changed] > 1.5 * dt  # the edge may be any of the lost rows
    variance[rows[plain]] = count**2 / 12
    ends = np.concatenate([[0], changed, [len(rows)]])
    runs = np.diff(ends)
    lasts = np.minimum(runs[:-1], runs[1:])  # rows that a count lasts, before or after
    slow = ~plain[changed]
    edge = changed[slow]
    position[rows[edge]] = 0.5 * (value[edge] + value[edge - 1])
    early[rows[edge]] += 0.5 * since[edge]
    travel = count / np.maximum(lasts[slow], 1) * since[edge] / dt  # m, in the tick
    variance[rows[edge]] = travel**2 / 12 + (0.02 * count) ** 2
    for first, last in pairwise(ends.tolist()):
        if last - first > REST:
            variance[rows[(first + last) // 2]] = count**2 / 12
    return Readings(x=position, variance=variance, early=early)


@_once
def unknown_force(recording: Recording) -> NDArray[np.float64]:
    """Return the standard deviation of what is not known of the force [N], for each row; 0 where it was recorded.

    Where it bridges lost rows, what a straight line over as many rows misses elsewhere in the log, all of them the same
    way. Where the reading stands at a limit, the force may be any beyond, and half a tick before and after.
    """
    out = np.zeros(len(recording.t))
    if recording.force is None:
        return out
    cut = at_limits(recording.force)
    if cut.any():
        around = np.convolve(cut, np.ones(3), mode="same") > 0
        out[around] = float(np.ptp(recording.force))
    if recording.known is None or recording.known.all():
        return out
    force = recording.force
    steps = np.diff(np.concatenate([[0], ~recording.known, [0]]).astype(int))
    missed: dict[int, float] = {}  # by how many rows are lost
    for first, last in zip(np.flatnonzero(steps > 0), np.flatnonzero(steps < 0), strict=True):
        lost = int(last - first)
        if lost not in missed:
            missed[lost] = _missed(force, lost)
        out[first - 1 : last] = np.maximum(out[first - 1 : last], missed[lost])
    return out


def _missed(force: NDArray[np.float64], lost: int) -> float:
    """Return what a straight line over this many rows misses, all of them the same way [N]."""
    middle = (lost + 1) // 2
    share = middle / (lost + 1)
    line = (1 - share) * force[: -lost - 1] + share * force[lost + 1 :]
    missed = force[middle : middle + len(line)] - line
    return float(np.sqrt(np.mean(missed**2) * lost))


def speed(x: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """Return the velocity at each row behind the kernel of `smooth` [m/s]; at the ends the handle rests."""
    kernel = kernels(dt)[1]
    return smoothed(np.pad(x, len(kernel) // 2, mode="edge"), kernel)


#: Width of the kernel [s]: passes a hand's motion, 1/(2 pi 8 ms) = 20 Hz.
WIDTH = 8e-3


#: The kernel ends at this many of its widths: at 4 its second derivative would be off by 1 % at 20 Hz.
TAILS = 6


def kernels(dt: float, width: float = WIDTH) -> NDArray[np.float64]:
    """Return a Gaussian, its first and its second derivative, shape (3, taps).

    Exact on polynomials: the gains for 1, t and t^2 are set to what they must be.
    """
    half = max(3, int(np.ceil(TAILS * width / dt)))
    t = dt * np.arange(-half, half + 1)
    s = max(width, dt)
    g = np.exp(-0.5 * (t / s) ** 2)
    g /= g.sum()
    first = -t * g
    first /= np.sum(first * -t)
    second = (t**2 - np.sum(t**2 * g)) * g
    second /= 0.5 * np.sum(second * t**2)
    return np.array([g, first, second])


def every(dt: float) -> int:
    """Return of how many smoothed rows one holds what all of them do: they end far below half its rate."""
    return max(1, round(0.5 * WIDTH / dt))


def smoothed(
    values: NDArray[np.float64], kernel: NDArray[np.float64], step: int = 1
) -> NDArray[np.float64]:
    """Return the part of a convolution that sees no edge, shorter by taps - 1; of it, one of `step` rows."""
    if step == 1 or len(values) < len(kernel):
        return np.convolve(values, kernel, mode="valid")[::step]
    rows = (len(values) - len(kernel)) // step + 1
    mirrored, out = kernel[::-1], np.zeros(rows)
    for phase in range(min(step, len(kernel))):
        taps = mirrored[phase::step]
        out += np.convolve(values[phase::step][: rows + len(taps) - 1], taps[::-1], mode="valid")
    return out


Fold = NDArray[np.intp]
#: Rows in which a place is passed, where no count comes again.
PASSED_IN = 8


def by_target(recording: Recording, target: Target) -> Fold | None:
    """Return for each row how long its level has held, level after level [rows]; None when no level comes again."""
    segments = np.array(target.segments)
    if len(set(target.segments)) == len(segments):
        return None
    n, dt = len(recording.t), recording.dt
    switches = (np.array(target.switches) - recording.t[0]) / dt
    starts = np.concatenate([[0], np.ceil(switches - 1e-6)]).astype(int).clip(0, n)
    lengths = np.diff(np.append(starts, n))
    since = np.arange(n) - np.repeat(starts, lengths)
    return np.asarray(np.repeat(segments, lengths) * int(lengths.max()) + since, dtype=np.intp)


def by_place(recording: Recording, sign: NDArray[np.float64]) -> Fold:
    """Return for each row its count, first on the ways up, then on those down.

    `sign` is that of the velocity. Where the target is unknown, the same errors are those of the
    same count passed the same way. Without counts, or where they are so fine that none comes again, it is the place.
    """
    x = recording.x - recording.x.min()
    step = recording.count
    if x.max() > step * len(x):
        step = float(x.max()) * PASSED_IN / len(x)
    place = np.round(x / step).astype(np.intp)
    most = int(place.max()) + 1
    passed = np.where(sign >= 0, place, 2 * most - 1 - place)
    return np.asarray(np.unique(passed, return_inverse=True)[1], dtype=np.intp)  # counts it met


def folded(scores: NDArray[np.float64], fold: Fold) -> NDArray[np.float64]:
    """Return scores, shape (parameters, rows), summed where they lie on one another."""
    length = int(fold.max()) + 1
    return np.array([np.bincount(fold, weights=row, minlength=length) for row in scores])


def ripple(recording: Recording) -> Values:
    """Return how far the mean of the motor's force over the tick from each row on lies above its samples there [N].

    A drive holds its command for a tick. Behind its current loop and the lag of the sensor that stair is a curve with
    a ripple of one tick, and the rows always sample the same phase of it: read as a smooth force, it comes a few
    hundredths of a tick late or early, always to one side. Where the log has the motor's force, the mean is known:
    both lags are linear, and their answer to a stair has a closed form. Which share of it reaches the sensor is left
    to the fit. Zero where there is no motor.
    """
    if recording.motor is None:
        return np.zeros(len(recording.t))
    return stair(recording.motor, recording.dt, recording.current_lag, recording.lag)[1]


def stair(levels: Values, dt: float, first: float, second: float) -> tuple[Values, Values]:
    """Return a stair behind two lags [s]: at each row, and what its mean over the tick from there lies above that.

    `levels` holds over the interval that ends at each row. The mean of the samples is taken as the fit takes it, as
    that of a smooth curve through them.
    """
    ahead = np.append(levels[1:], levels[-1])  # of the tick to come
    if first == second:  # two equal poles: as near as makes no difference
        first, second = 1.01 * first, 0.99 * second
    if first == second == 0:
        return levels, ahead - _smooth_mean(levels)
    here, mean = np.zeros(len(levels)), np.zeros(len(levels))
    for lag, share in ((first, first / (first - second)), (second, second / (second - first))):
        follows = lagged(levels, dt, lag, stepping=True)
        kept = lag / dt * -np.expm1(-dt / lag) if lag > 0 else 0.0
        here += share * follows
        mean += share * (ahead + (follows - ahead) * kept)
    return here, mean - _smooth_mean(here)


def _smooth_mean(samples: Values) -> Values:
    """Return the mean over the tick from each row on of a smooth curve through samples, as the model takes it."""
    before = np.concatenate([samples[:1], samples[:-1]])
    after = np.append(samples[1:], samples[-1])
    sharp = samples - (after - 2 * samples + before) / 12
    return np.asarray(0.5 * (sharp + np.append(sharp[1:], sharp[-1])))
