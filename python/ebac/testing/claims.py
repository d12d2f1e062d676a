"""Claims on a run that end in an AssertionError naming the tick, the time and the number."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number, require
from ebac._util.plural import plural
from ebac._util.wrong_calls import plain_function
from ebac.metrics import FEWEST_ROWS, STILL_SWING, TAIL_SHARE
from ebac.testing.times import within_run
from ebac.trace import Trace

#: What the rounding of an energy may come to [J].
ROUNDING = 1e-9


@plain_function
def assert_passive(
    trace: Trace, *, reserve: float = 0.0, damping: float | None = None, tolerance: float = ROUNDING
) -> None:
    """Assert that no more energy left the port than the reserve, eq. (3).

    Parameters
    ----------
    trace : Trace
        A run. Its column `true.energy` is taken where there is one (integral of f v + b v^2 + friction, exact in a
        simulation), summed over the axes; otherwise `work` + sum of (damping/dt) dx^2, what can be observed, with
        the sum of f_applied dx for a trace without `work`.
    reserve : float
        Reserve e(0) of eq. (3) [J], >= 0.
    damping : float, optional
        Physical damping of the device per axis [N s/m], >= 0, for a trace without `true.energy`.
    tolerance : float
        What rounding may come to [J], >= 0.

    Raises
    ------
    AssertionError
        When more was drawn.
    ValueError
        When the trace lacks a column, or a number is out of range.
    """
    __tracebackhide__ = True
    require(trace, Trace, "ebac.testing.assert_passive", "a Trace")
    _not_negative(reserve=reserve, tolerance=tolerance)
    if damping is not None:
        _not_negative(damping=damping)
    _not_empty(trace)
    energy, how = _energy(trace, damping)
    _finite("energy", energy, trace)
    least = int(energy.argmin())
    assert energy[least] >= -(reserve + tolerance), (
        f"not passive: {how} falls to {1e3 * energy[least]:.6g} mJ at {_when(trace, least)}; "
        f"the reserve is {1e3 * reserve:.6g} mJ"
    )


@plain_function
def assert_settles(
    trace: Trace, *, within: float, band: float = STILL_SWING / 2, axis: int = 0
) -> None:
    """Assert that the position comes to rest in time.

    Parameters
    ----------
    trace : Trace
        At least 10 rows; `true.x` is taken where there is one, otherwise `x`.
    within : float
        Latest time, from the first row, from which on it must stay near its rest [s]; at most the length of the run.
    band : float
        How near: |x - rest| <= band [m], default 0.125 mm. Rest is the mean over the last 30 % of the run.
    axis : int
        Which axis, [0, trace.axes).

    Raises
    ------
    AssertionError
        When it comes to rest later or never.
    ValueError
        When the trace is too short, also for `within`, or has no such axis.
    """
    __tracebackhide__ = True
    require(trace, Trace, "ebac.testing.assert_settles", "a Trace")
    _not_negative(within=within, band=band)
    if len(trace) < FEWEST_ROWS:
        raise ValueError(f"the trace has {plural(len(trace), 'row')}: needs at least {FEWEST_ROWS}")
    t = trace["t"] - trace["t"][0]
    within_run("within", within, t, "the length of the run")
    x = trace.axis("true.x" if "true.x" in trace else "x", axis)
    _finite("position", x, trace)
    tail = x[-max(2, int(TAIL_SHARE * len(x) + 0.5)) :]  # the same rows as in `ebac.contact`
    rest, swing = float(tail.mean()), float(np.ptp(tail))
    outside = np.flatnonzero(np.abs(x - rest) > band)
    last = int(outside[-1]) if len(outside) else -1
    settles = last < len(x) - 1 and (swing < 2 * band or swing == 0)
    assert settles, (
        f"never settles: still {1e3 * abs(x[last] - rest):.4g} mm from its rest of {1e3 * rest:.4g} mm "
        f"at {_when(trace, last)}; it swings by {1e3 * swing:.4g} mm, allowed are +-{1e3 * band:.4g} mm"
    )
    settled = float(t[last + 1])
    assert settled <= within, (
        f"settles too late: within {1e3 * band:.4g} mm of its rest of {1e3 * rest:.4g} mm "
        f"from {settled:.6g} s on, allowed are {within:g} s"
    )


@plain_function
def assert_force_continuous(
    trace: Trace, *, step: float, column: str = "f_applied", axis: int | None = None
) -> None:
    """Assert that a force never jumps from one tick to the next.

    Parameters
    ----------
    trace : Trace
        A run.
    step : float
        Largest change in one tick [N]. How large a knock has to be depends on the handle; a wall of stiffness K
        hit at a speed v needs K v T.
    column : str
        Which force, default the one that acted.
    axis : int, optional
        Which axis; default: all.

    Raises
    ------
    AssertionError
        When it jumps by more.
    """
    __tracebackhide__ = True
    require(trace, Trace, "ebac.testing.assert_force_continuous", "a Trace")
    _not_negative(step=step)
    _not_empty(trace)
    for i in range(trace.axes) if axis is None else [axis]:
        force = trace.axis(column, i)
        _finite(column, force, trace)
        jumps = np.abs(np.diff(force))
        if not len(jumps):
            continue
        most = int(jumps.argmax())
        assert jumps[most] <= step, (
            f"{column} of axis {i} jumps by {jumps[most]:.6g} N at {_when(trace, most + 1)}, "
            f"from {force[most]:.6g} N to {force[most + 1]:.6g} N; allowed are {step:g} N a tick, "
            f"exceeded in {int((jumps > step).sum())} ticks"
        )


@plain_function
def assert_within_limits(
    trace: Trace,
    *,
    force: float | None = None,
    current: float | None = None,
    travel: float | None = None,
    speed: float | None = None,
) -> None:
    """Assert that a run has no fault, no number that is not finite where it matters, and keeps its limits.

    Parameters
    ----------
    trace : Trace
        A run.
    force : float, optional
        Largest |f_cmd| [N]; default: what the scenario's device can give at its peak.
    current : float, optional
        Largest |current_applied| [A]; default: the peak current of the scenario's drive.
    travel : float, optional
        Largest |x| [m]; default: no limit.
    speed : float, optional
        Largest |v| [m/s]; default: no limit.

    Raises
    ------
    AssertionError
        When one is exceeded.
    ValueError
        When neither a limit nor a scenario is given.
    """
    __tracebackhide__ = True
    require(trace, Trace, "ebac.testing.assert_within_limits", "a Trace")
    if trace.scenario is not None:
        device = trace.scenario.device
        force = device.peak_force if force is None else force
        current = device.drive.peak_current(device.motor) if current is None else current
    given = {"force": force, "current": current, "travel": travel, "speed": speed}
    _not_negative(**{name: limit for name, limit in given.items() if limit is not None})
    limits = {"f_cmd": force, "current_applied": current, "x": travel, "v": speed}
    known = {name: limit for name, limit in limits.items() if limit is not None}
    if not known:
        raise ValueError(
            "no limit given, and the trace has no scenario: give force=, current=, ..."
        )
    _not_empty(trace)
    if "fault" in trace and trace["fault"].any():
        row = int((trace["fault"] != 0).argmax())
        raise AssertionError(f"fault {int(trace['fault'][row])} at {_when(trace, row)}")
    for name, limit in known.items():
        for axis in range(trace.axes):
            values = trace.axis(name, axis)
            _finite(name, values, trace)
            size = np.abs(values)
            most = int(size.argmax())
            unit = trace.columns[name].unit
            assert size[most] <= limit * (1 + 1e-12), (
                f"{name} of axis {axis} reaches {values[most]:.9g} {unit} at {_when(trace, most)}; "
                f"allowed are +-{limit:.9g} {unit}, exceeded in {int((size > limit).sum())} rows"
            )


def _energy(trace: Trace, damping: float | None) -> tuple[NDArray[Any], str]:
    if "true.energy" in trace:
        return trace["true.energy"].reshape(len(trace), -1).sum(axis=1), "the port energy"
    if damping is None:
        raise ValueError(
            "the trace has no column true.energy: give damping= [N s/m] of the device, to count what can be observed"
        )
    # `dt` has one value per axis where `dx` has.
    dt, dx, force = (trace[name].reshape(len(trace), -1) for name in ("dt", "dx", "f_applied"))
    rate = np.divide(damping, dt, out=np.zeros_like(dt), where=dt > 0)
    damped = np.cumsum(rate * dx**2, axis=0)
    # Without the static compensation, which is no work of the law, where a loop has recorded it.
    work = (
        trace["work"].reshape(len(trace), -1) if "work" in trace else np.cumsum(force * dx, axis=0)
    )
    return (work + damped).sum(axis=1), "the energy observed at the port"


def _not_empty(trace: Trace) -> None:
    if not len(trace):
        raise ValueError("the trace has 0 rows: needs at least 1")


def _when(trace: Trace, row: int) -> str:
    tick = int(trace["tick"][row]) if "tick" in trace else row
    return f"tick {tick}, t = {trace['t'][row]:.6g} s"


def _finite(name: str, values: NDArray[Any], trace: Trace) -> None:
    __tracebackhide__ = True
    bad = ~np.isfinite(values)
    assert not bad.any(), f"{name} is {values[bad][0]} at {_when(trace, int(bad.argmax()))}"


def _not_negative(**numbers: float) -> None:
    for name, value in numbers.items():
        if not number(name, value) >= 0:
            raise ValueError(f"{name} = {value}: must not be negative")
