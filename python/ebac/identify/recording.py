"""A recording: the signals of one axis of a log, in SI units, on rows of a constant time step."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number, require, shown, unknown
from ebac._util.plural import plural
from ebac._util.wrong_calls import plain_constructor, plain_function
from ebac.identify.of_trace import signals_of, trace_facts
from ebac.identify.quantisation import count_of
from ebac.identify.times import not_rising
from ebac.trace.time_slice import rows_between

if TYPE_CHECKING:
    from ebac.identify.target import Path
    from ebac.trace import Trace

#: Fewer rows contain nothing about a hand.
LEAST_ROWS = 50
#: A longer step between two rows is a pause [rows].
PAUSE = 1.5


@plain_constructor
@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """Position and forces of one axis over time, on equally spaced rows that may pause.

    For a rotary device, read [rad] for [m] and [N m] for [N].

    Parameters
    ----------
    name : str
        Name in messages and tables.
    t : array, shape (rows,)
        Time [s], equally spaced except for pauses, which are longer steps.
    x : array, shape (rows,)
        Position of the handle [m].
    force : array, shape (rows,), or None
        Force of the hand on the handle [N], towards +x, as measured by the force sensor.
    motor : array, shape (rows,), or None
        Force of the motor over the interval that ends at each row [N], positive when it resists motion to +x. For a log
        with the opposite sign use `flipped("motor")`.
    desired : array, shape (rows,), or None
        Force of the virtual world, which the law is to render [N], F_D of eq. (2).
    met : array, shape (rows,), or None
        Position at which that force was computed [m], if the loop had a state observer; None: at `x`.
    target : array, shape (rows,), or None
        Instructed position of the hand [m], if it was recorded.
    early : array, shape (rows,), or None
        How long before the time of its row each position was read [s]; None: at that time.
    known : array of bool, shape (rows,), or None
        Which rows were recorded; the others bridge a few lost rows. None: all were recorded.
    count : float
        Step of the position [m]; 0 if it is not quantised.
    lag : float
        First-order lag of the force sensor [s].
    current_lag : float
        First-order lag of the motor's current loop [s].
    mass, damping : float or None
        Those of the device at the handle [kg, N s/m], from the scenario in the log.
    rotor : float or None
        Share of that mass that is the motor's rotor [kg], from the scenario in the log.
    path : Step, Tapping, Sine, MinimumJerk, Recorded or None
        Target path of the hand, from the scenario in the log.
    remarks : tuple of str
        What was guessed or changed when the log was read.
    unread : tuple of str
        Headings of the other columns of its file.
    origin : str
        Origin of the data for figures: "recorded", "simulated", or the origin stated in the log.
    rotary : bool
        Whether the recording is of a knob or a joint, in rad and N m.

    Raises
    ------
    TypeError
        When a column is no array of numbers.
    ValueError
        When a column contains a value that is not a number, is constant, too short or of a different length, or a lag
        or count is out of range.
    """

    name: str
    t: NDArray[np.float64]
    x: NDArray[np.float64]
    force: NDArray[np.float64] | None = None
    motor: NDArray[np.float64] | None = None
    desired: NDArray[np.float64] | None = None
    met: NDArray[np.float64] | None = None
    target: NDArray[np.float64] | None = None
    early: NDArray[np.float64] | None = None
    known: NDArray[np.bool_] | None = None
    count: float = 0.0
    lag: float = 0.0
    current_lag: float = 3e-4
    mass: float | None = None
    damping: float | None = None
    rotor: float | None = None
    path: Path | None = None
    remarks: tuple[str, ...] = field(default=())
    unread: tuple[str, ...] = field(default=())
    origin: str = "recorded"
    rotary: bool = False

    def __post_init__(self) -> None:
        """Check lengths, numbers and times."""
        for name, values in ({"t": self.t, "x": self.x} | self._columns()).items():
            object.__setattr__(self, name, _numbers(f"{self.name}: {name}", values))
        n = self.t.size
        if n < LEAST_ROWS:
            raise ValueError(f"{self.name}: {plural(n, 'row')}; needs at least {LEAST_ROWS}")
        for name, values in self._columns().items():
            if values.shape != (n,):
                raise ValueError(
                    f"{self.name}: {name} has the shape {values.shape}: must be ({n},), one value a row of t"
                )
            wrong = np.flatnonzero(~np.isfinite(values))
            if wrong.size:
                raise ValueError(
                    f"{self.name}: {name} is no number in {wrong.size} of {n} rows, first in row {wrong[0]} "
                    "(counted from 0); cut these rows out or fill them"
                )
        step = np.diff(self.t)
        if not (step > 0).all():
            raise ValueError(f"{self.name}: {not_rising(step, 0)}")
        within = step[step < PAUSE * self.dt]
        if np.ptp(within) > 1e-3 * self.dt:
            raise ValueError(
                f"{self.name}: t is not equally spaced; read it with ebac.identify.load"
            )
        if np.ptp(self.x) == 0:
            raise ValueError(
                f"{self.name}: x is constant at {self.x[0]:g} {self.units[0]}: nothing moved, or it is the wrong column"
            )
        for name, unit, most in (
            ("lag", "s", 0.1),
            ("current_lag", "s", 0.1),
            ("count", self.units[0], 1.0),
        ):
            value = number(f"{self.name}: {name}", getattr(self, name))
            if not 0 <= value <= most:
                raise ValueError(
                    f"{self.name}: {name} = {value:g} {unit}: must lie in [0, {most:g}] {unit}"
                )

    @property
    def units(self) -> tuple[str, str]:
        """Units of positions and of forces."""
        return ("rad", "N m") if self.rotary else ("m", "N")

    def at_lever(self, lever: float) -> Self:
        """Return a rotary recording as that of a handle `lever` [m] away from the axis, in m and N."""
        if not self.rotary:
            raise ValueError(
                f"{self.name}: is in m and N already; only a rotary recording wants a lever"
            )
        if not 0 < lever < np.inf:
            raise ValueError(f"{self.name}: lever = {lever:g} m: must be greater than 0")
        scales = {
            "x": lever,
            "target": lever,
            "met": lever,
            "force": 1 / lever,
            "motor": 1 / lever,
            "desired": 1 / lever,
        }
        channels = self.channels()
        changes: dict[str, Any] = {n: channels[n] * by for n, by in scales.items() if n in channels}
        return replace(self, **changes, count=lever * self.count, rotary=False)

    @cached_property
    def dt(self) -> float:
        """Time step [s]."""
        steps = np.diff(self.t)
        within = steps < PAUSE * np.median(steps)
        if within.all():
            return float(self.t[-1] - self.t[0]) / (len(self.t) - 1)
        return float(steps[within].mean())

    @property
    def seconds(self) -> float:
        """Length [s]."""
        return float(self.t[-1] - self.t[0])

    @property
    def missing(self) -> float:
        """Share of the rows that were lost and are bridged, pauses not among them [1]."""
        return 0.0 if self.known is None else float((~self.known).mean())

    def channels(self) -> dict[str, NDArray[np.float64]]:
        """Return the recorded signals by name, without the times."""
        every = {
            "t": self.t,
            "x": self.x,
            "force": self.force,
            "motor": self.motor,
            "desired": self.desired,
            "met": self.met,
            "target": self.target,
        }
        return {name: values for name, values in every.items() if values is not None}

    def _columns(self) -> dict[str, NDArray[Any]]:
        """Return everything that has one value a row, by name."""
        more = {"early": self.early, "known": self.known}
        return self.channels() | {n: v for n, v in more.items() if v is not None}

    def rows(self, part: slice) -> Self:
        """Return the given rows as a recording."""
        cut: dict[str, Any] = {name: values[part] for name, values in self._columns().items()}
        return replace(self, **cut)

    @cached_property
    def stretches(self) -> tuple[slice, ...]:
        """The rows between pauses."""
        ends = np.flatnonzero(np.diff(self.t) > PAUSE * self.dt) + 1
        edges = [0, *ends.tolist(), len(self.t)]
        return tuple(slice(a, b) for a, b in pairwise(edges))

    @property
    def longest(self) -> Self:
        """The longest stretch between two pauses."""
        return self.rows(max(self.stretches, key=lambda part: part.stop - part.start))

    def between(self, start: float, stop: float) -> Self:
        """Return the rows with start <= t < stop [s].

        Raises
        ------
        ValueError
            For a part outside the log, one that ends before it begins or is too short, and for NaN.
        TypeError
            For what is no time.
        """
        return self.rows(slice(*rows_between(self.t, start, stop)))

    def flipped(self, *signals: str) -> Self:
        """Return the recording with the opposite sign of some forces: "force" of the hand (default), "motor"."""
        said = {"force": "the force of the hand", "motor": "the force of the motor"}
        changes: dict[str, Any] = {}
        remarks = self.remarks
        for signal in signals or ("force",):
            if signal not in said:
                raise ValueError(unknown(f"{self.name}: signal {signal}", signal, list(said)))
            values = getattr(self, signal)
            if values is None:
                raise ValueError(f"{self.name}: has no {said[signal].removeprefix('the ')} to flip")
            changes[signal] = -values
            remarks = (*remarks, f"{said[signal]} was taken with the other sign")
        return replace(self, **changes, remarks=remarks)

    @classmethod
    @plain_function
    def from_trace(cls, trace: Trace, *, axis: int = 0, name: str = "trace") -> Self:
        """Return the recording of one axis of a `Trace`; count and lag are taken from its scenario, if it has one."""
        from ebac.trace import Trace

        require(trace, Trace, "ebac.identify.Recording.from_trace", "a Trace")
        columns: dict[str, Any] = signals_of(trace, axis)
        facts = trace_facts(trace, axis)
        if not facts["count"]:
            facts["count"] = count_of(columns["x"])
        t = np.array(trace["t"], dtype=float)
        return cls(name=name, t=t, origin=trace.origin, **facts, **columns)

    def __repr__(self) -> str:
        """Return one line: name, rows, rate, channels."""
        return (
            f"<Recording {self.name}: {len(self.t)} rows, {self.seconds:.4g} s at {1 / self.dt:.5g} Hz; "
            f"{', '.join(self.channels())}; count {1e3 * self.count:.4g} m{self.units[0]}>"
        )


def _numbers(name: str, values: Any) -> NDArray[Any]:
    """Return a column as an array of floats; flags stay flags."""
    try:
        array = np.array(values)  # a copy: what the caller writes into theirs later is not recorded
    except ValueError:  # rows of several lengths
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} = {shown(values)}: must be an array of numbers")
    return array if array.dtype.kind == "b" else array.astype(float, copy=False)
