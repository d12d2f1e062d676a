"""The rows between two times."""

from __future__ import annotations

from math import isnan
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number


def rows_between(
    t: NDArray[np.float64], start: float | None, stop: float | None, step: object = None
) -> tuple[int, int]:
    """Return the first row of start <= t < stop [s], and the row behind the last; as `Trace.between`."""
    if step is not None:
        raise ValueError("a trace is sliced by time [s]: trace[start:stop], without a step")
    times: list[Any] = [one for one in (start, stop) if one is not None]
    if not all(isinstance(time, (Real, np.number)) for time in times):
        raise TypeError(f"trace[{start!r}:{stop!r}]: must be times [s], as in trace[1.0:2.5]")
    check_order(start, stop)
    first = 0 if start is None else int(np.searchsorted(t, start))
    last = len(t) if stop is None else int(np.searchsorted(t, stop))
    if len(t) and is_outside(start, stop, (t[0], t[-1])):
        begin = "" if start is None else f"{start:g}"
        end = "" if stop is None else f"{stop:g}"
        raise ValueError(
            f"trace[{begin}:{end}]: outside the run, which spans {t[0]:.6g} to {t[-1]:.6g} s"
        )
    return first, last


def is_outside(start: float | None, stop: float | None, span: tuple[float, float]) -> bool:
    """Return whether a part begins after the last time or ends before the first one [s]."""
    first, last = span
    return (start is not None and start > last) or (stop is not None and stop < first)


def check_order(start: float | None, stop: float | None) -> None:
    """Refuse a part that ends before it begins, NaN [s], and what is no number."""
    for name, time in (("start", start), ("stop", stop)):
        if time is not None:
            number(name, time)
        if time is not None and isnan(time):
            raise ValueError(f"{name} = nan s: must be a time; without one the part is open")
    if start is not None and stop is not None and stop < start:
        raise ValueError(f"stop = {stop:g} s: must be at least start, {start:g} s")
