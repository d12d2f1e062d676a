"""Times of a claim that the run does not have, as milliseconds in place of seconds give."""

from __future__ import annotations

from ebac._util.arrays import Values


def within_run(name: str, time: float, t: Values, end: str) -> None:
    """Raise ValueError for a time [s] beyond the last row: what is claimed of it would hold for any run.

    `end` is what the last of the times `t` of the rows is.
    """
    __tracebackhide__ = True
    last = float(t[-1]) if len(t) else 0.0
    row = float(t[-1] - t[-2]) if len(t) > 1 else 0.0
    if time <= last + 1.5 * row:
        return
    more = f"; {time:g} ms are {time / 1e3:g} s" if 1 <= time <= 1e3 * last else ""
    raise ValueError(f"{name} = {time:g} s: must be at most {last:g} s, {end}{more}")
