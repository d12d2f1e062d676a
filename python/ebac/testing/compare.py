"""A trace beside a golden one, channel by channel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ebac._util import formatting
from ebac._util.arguments import require
from ebac._util.plural import plural
from ebac._util.sequences import several
from ebac.testing.tolerance import Tolerance, default_tolerance
from ebac.trace import Trace


@dataclass(frozen=True, kw_only=True)
class Divergence:
    """One channel that differs from its golden one, where it first does, and where most.

    Attributes
    ----------
    channel : str
        Name of the column, with the axis where there are several: `f_cmd_1`.
    unit : str
        Its SI unit.
    tick, t : int, float
        First tick that differs and its time [s].
    found, golden : float
        The values there.
    tolerance : Tolerance
        What was allowed.
    largest, largest_tick, largest_t : float, int, float
        Largest error, in `unit`, its tick and its time [s].
    rows, of : int
        How many rows differ, of how many.
    """

    channel: str
    unit: str
    tick: int
    t: float
    found: float
    golden: float
    tolerance: Tolerance
    largest: float
    largest_tick: int
    largest_t: float
    rows: int
    of: int

    def __str__(self) -> str:
        """Return it in one line, with units."""
        allowed = f"{self.tolerance.absolute:g} + {self.tolerance.relative:g} |golden|"
        return (
            f"{self.channel}: first at tick {self.tick}, t = {self.t:.6g} s: {_shown(self.found, self.unit)}, "
            f"golden {_shown(self.golden, self.unit)}; largest error {_shown(self.largest, self.unit)} at tick "
            f"{self.largest_tick}, t = {self.largest_t:.6g} s; {self.rows} of {self.of} rows "
            f"beyond {allowed} {'' if self.unit == '1' else self.unit}"
        ).rstrip()


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """All channels of a trace beside their golden ones.

    Attributes
    ----------
    channels : tuple of str
        What was compared.
    divergences : tuple of Divergence
        What differs, the earliest first.
    """

    channels: tuple[str, ...]
    divergences: tuple[Divergence, ...]

    @property
    def first(self) -> Divergence | None:
        """The earliest divergence; None where all agree."""
        return self.divergences[0] if self.divergences else None

    def __repr__(self) -> str:
        """Return how many channels agree, and the first that does not."""
        some = f"{len(self.divergences)} of {len(self.channels)} channels differ"
        return f"<Comparison: {some}; {self.first or 'all agree'}>"


def check_columns(tolerances: Mapping[str, Tolerance], compared: Sequence[str]) -> None:
    """Raise ValueError for a tolerance of a column that is not compared, TypeError for what is no tolerance."""
    require(
        tolerances,
        Mapping,
        "tolerances",
        "tolerances by column, as in {'x': Tolerance(absolute=1e-6)}",
    )
    for name, one in tolerances.items():
        require(
            one, Tolerance, f"tolerance for {name}", "a Tolerance, as in Tolerance(absolute=1e-6)"
        )
    unknown = sorted(set(tolerances) - set(compared))
    if unknown:
        raise ValueError(
            f"tolerance for {', '.join(unknown)}: compared are only {', '.join(compared)}"
        )


def compare(
    trace: Trace,
    golden: Trace,
    *,
    columns: Sequence[str] | None = None,
    tolerances: Mapping[str, Tolerance] | None = None,
) -> Comparison:
    """Compare a trace with a golden one of the same ticks.

    Parameters
    ----------
    trace, golden : Trace
        Of the same number of rows and axes, at the same times.
    columns : sequence of str, optional
        What to compare; default: every column of `golden` but `tick`.
    tolerances : mapping of str to Tolerance, optional
        By column; default: `default_tolerance` of its unit.

    Returns
    -------
    Comparison

    Raises
    ------
    ValueError
        When the two do not have the same rows or axes, or a tolerance is for a column that is not compared.
    KeyError
        When a column does not exist in one of them.
    """
    for one in (trace, golden):
        require(one, Trace, "ebac.testing.compare", "two traces")
    if trace.axes != golden.axes or len(trace) != len(golden):
        raise ValueError(
            f"the trace has {_shape(trace)}, the golden one {_shape(golden)}: "
            "only traces of the same rows and axes can be compared"
        )
    chosen = (
        [name for name in golden if name != "tick"]
        if columns is None
        else several("columns", columns)
    )
    own = dict(tolerances or {})
    check_columns(own, chosen)
    found: list[Divergence] = []
    channels: list[str] = []
    for name in chosen:
        unit = golden.columns[name].unit if name in golden else ""
        kind = golden[name].dtype.kind
        tolerance = own.get(name, default_tolerance(unit, kind))
        by_axis = golden.axes > 1 and golden[name].ndim > 1
        for axis in range(golden.axes if by_axis else 1):
            channel = f"{name}_{axis}" if by_axis else name
            channels.append(channel)
            difference = _channel(trace, golden, name, axis, channel, tolerance)
            if difference is not None:
                found.append(difference)
    found.sort(key=lambda d: d.tick)
    return Comparison(channels=tuple(channels), divergences=tuple(found))


def _channel(
    trace: Trace, golden: Trace, name: str, axis: int, channel: str, tolerance: Tolerance
) -> Divergence | None:
    values, wanted = trace.axis(name, axis), golden.axis(name, axis)
    passes, error = tolerance.allows(values, wanted)
    if passes.all():
        return None
    first, most = int((~passes).argmax()), int(error.argmax())
    ticks = golden["tick"] if "tick" in golden else np.arange(len(golden))
    t = golden["t"]
    return Divergence(
        channel=channel,
        unit=golden.columns[name].unit,
        tick=int(ticks[first]),
        t=float(t[first]),
        found=float(values[first]),
        golden=float(wanted[first]),
        tolerance=tolerance,
        largest=float(error[most]),
        largest_tick=int(ticks[most]),
        largest_t=float(t[most]),
        rows=int((~passes).sum()),
        of=len(passes),
    )


def _shown(value: float, unit: str) -> str:
    """Return a number in SI with as many digits as a small difference needs."""
    shown = "" if unit == "1" else f" {unit}"
    if not np.isfinite(value):
        return f"{value}{shown}"
    readable = formatting.quantity(value, unit) if unit in formatting.SHOWN else ""
    exact = f"{value:.9g}{shown}"
    return f"{exact} ({readable})" if readable and value != 0 and unit == "m" else exact


def _shape(trace: Trace) -> str:
    t = trace["t"]
    span = f" from {t[0]:.6g} to {t[-1]:.6g} s" if len(t) else ""
    return f"{len(trace)} rows{span} on {plural(trace.axes, 'axis', 'axes')}"
