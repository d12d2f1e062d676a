"""Read a recording from any kind of log."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number, require_file, unknown
from ebac._util.plural import plural
from ebac._util.text_file import says_simulated
from ebac._util.wrong_calls import plain_function
from ebac.identify.columns import QUANTITIES, assign, listed
from ebac.identify.files import Columns, Table, archive_of, read_columns
from ebac.identify.held_force import without_held
from ebac.identify.load_options import refuse_unused, words_by_signal
from ebac.identify.missing import not_found
from ebac.identify.of_trace import path_of, signals_of, trace_facts, where_met
from ebac.identify.plausible import plausible
from ebac.identify.quantisation import count_of
from ebac.identify.recording import LEAST_ROWS, Recording
from ebac.identify.rotary import Conversion, in_si
from ebac.identify.rows import on_rows
from ebac.identify.times import not_rising
from ebac.trace import Trace

#: A rate that is asked for differs from that of the column of time, if by more than this share.
OTHER = 0.05


@plain_function
def load(
    path: str | Path,
    *,
    columns: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    rate: float | None = None,
    lag: float | None = None,
    current_lag: float | None = None,
    count: float | None = None,
    axis: int = 0,
    flip_force: bool = False,
    flip_motor: bool = False,
    lever: float | None = None,
    counts_per_turn: float | None = None,
    torque_constant: float | None = None,
    force_constant: float | None = None,
) -> Recording:
    """Read MCAP, CSV, .mat, or NPZ (of `Trace.to_npz`, or plain arrays).

    A log of a knob or a joint contains angles (rad, deg, turns, counts) and torques (N m, mN m, currents). Its
    recording is `rotary`, in rad and N m, unless a `lever` is given.

    Parameters
    ----------
    path : str or Path
        The file; its extension gives the format.
    columns : mapping, optional
        Names of the columns for `t`, `x`, `force`, `motor`, `desired`, `target`: `{"force": "Fz"}`. Columns that are
        not given are guessed by name, and listed in `remarks`.
    units : mapping, optional
        Unit of each column, as `{"x": "mm"}`; default: the unit in the heading, `pos [mm]`, or SI.
    rate : float, optional
        Rows per second [Hz], for a file without times or with wrong times, which are then not used.
    lag : float, optional
        Lag of the force sensor [s]; default: that of the scenario of a trace, else 0.
    current_lag : float, optional
        Lag of the motor's current loop [s]; default: that of the scenario of a trace, else 0.3 ms.
    count : float, optional
        Step of the encoder at the handle [m], for a rotary log [rad], 0 for none; default: found in the position.
    axis : int
        Axis of a trace, with `columns` too, where these do not name another; other files have one axis.
    flip_force : bool
        Whether the force of the hand is logged with the opposite sign: positive if the handle pushes the hand to +x.
    flip_motor : bool
        Whether the force of the motor is logged with the opposite sign: positive if it drives to +x.
    lever : float, optional
        Radius at which the hand holds a rotary device [m]: angles become displacements of the handle, torques forces.
    counts_per_turn : float, optional
        Counts of the encoder for one turn of the knob or joint, all edges and the gear included.
    torque_constant : float, optional
        Torque at the knob or joint per ampere [N m/A], gear included, for a motor logged as a current; per volt
        [N m/V] if the voltage command of its drive was logged.
    force_constant : float, optional
        Force of a slide per ampere [N/A] or per volt [N/V], for a motor logged as a current or a voltage.

    Returns
    -------
    Recording

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    IsADirectoryError
        When it is a folder.
    TypeError
        For an option of another type.
    ValueError
        When it cannot be read, a column is missing or is not numeric, or a unit is unknown; for an option that does not
        apply to this file.

    Warns
    -----
    UserWarning
        When the last line of a CSV file has no end, and so its last number may be cut.
    """
    require_file(path, "ebac.identify.load")
    path = Path(path)
    if rate is not None and not 0 < number("rate", rate) < np.inf:
        raise ValueError(f"rate = {rate:g} Hz: must be greater than 0, and finite")
    columns, units = words_by_signal("columns", columns), words_by_signal("units", units)
    how = Conversion(
        lever=lever,
        torque_constant=torque_constant,
        force_constant=force_constant,
        counts_per_turn=counts_per_turn,
        count=count,
    )
    trace, origin, wrong = _trace(path)
    if trace is not None and not columns:
        refuse_unused(
            path.name,
            rate=rate,
            units=units or None,
            lever=lever,
            counts_per_turn=counts_per_turn,
            torque_constant=torque_constant,
            force_constant=force_constant,
        )
        found = _of_trace(trace, path.name, axis, wrong)
    else:
        if trace is None:
            refuse_unused(path.name, axis=axis or None)
        table = read_columns(path) if trace is None else _flat(trace, axis, columns.values())
        found = _recording(path.name, table, columns, units, rate, how)
        if trace is not None:
            found = replace(found, path=path_of(trace, axis))
        elif found.motor is not None and np.ptp(found.motor) == 0:
            left_out = f"motor is left out: constant at {found.motor[0]:g} {found.units[1]}"
            found = replace(found, motor=None, remarks=(*found.remarks, left_out))
    changes: dict[str, Any] = {"origin": origin}
    for name, value in (("lag", lag), ("current_lag", current_lag), ("count", count)):
        if value is not None:
            changes[name] = value
    if how.step is not None:
        changes.setdefault("count", how.step)
    found = replace(found, **changes)
    if found.count and (count or how.step):
        _in_steps(found, found.count)
    turned = [name for name, on in (("force", flip_force), ("motor", flip_motor)) if on]
    return found.flipped(*turned) if turned else found


def _in_steps(r: Recording, count: float) -> None:
    """Refuse a count [m or rad] that is none of a position."""
    read = r.x if r.known is None else r.x[r.known]
    steps = np.diff(read) / count
    way, unit = float(np.ptp(read)), r.units[0]
    if way < count:
        raise ValueError(
            f"{r.name}: count = {count:g} {unit}: x spans {way:.4g} {unit} in all, less than one count; give the step "
            "of the encoder, or leave it out"
        )
    if (np.abs(steps - np.round(steps)) < 0.1).mean() < 0.95:
        shown = count_of(read)
        what = f"it shows steps of {shown:.6g} {unit}" if shown else "it shows none"
        raise ValueError(
            f"{r.name}: count = {count:g} {unit}: x does not move in such steps; {what}"
        )


def _trace(path: Path) -> tuple[Trace | None, str, list[str]]:
    """Return the trace in a file of ours, its origin, what is wrong with it; None for another file."""
    if path.suffix == ".mcap":
        from ebac.logs import read

        log = read(path)
        if len(log.trace) == 0:
            raise ValueError(f"{path.name}: the log has no rows; ebac log info shows its contents")
        cut = "the log is not whole: its end is missing, as that of a run that was cut short"
        remarks = [] if log.condition.complete else [cut]
        remarks += filter(None, [log.condition.damage])
        remarks += [
            f"{plural(gap.rows, 'row')} {'is' if gap.rows == 1 else 'are'} missing after t = {gap.t:.4g} s"
            for gap in log.gaps
        ]
        return log.trace, log.trace.origin, remarks
    if path.suffix != ".npz":
        return None, "simulated" if says_simulated(path) else "recorded", []
    with archive_of(path) as archive:
        ours = "about" in archive
    trace = Trace.from_npz(path) if ours else None
    return trace, "recorded" if trace is None else trace.origin, []


def _of_trace(trace: Trace, name: str, axis: int, wrong: list[str]) -> Recording:
    """Return one axis of a trace; rows that are missing, or late, are put on equal steps, with a remark."""
    if not 0 <= axis < trace.axes:
        raise ValueError(f"{name}: axis = {axis}: must lie in [0, {trace.axes - 1}]")
    t = np.array(trace["t"], dtype=float)
    step = np.diff(t)
    if len(t) > 1 and (step > 0).all() and np.ptp(step) <= 1e-3 * float(np.median(step)):
        found = Recording.from_trace(trace, axis=axis, name=name)
        return replace(found, remarks=(*found.remarks, *wrong))
    signals = signals_of(trace, axis)
    even = _evenly(name, {"t": t, **signals}, wrong)
    facts = trace_facts(trace, axis)
    facts["count"] = facts["count"] or count_of(signals["x"])
    values: dict[str, Any] = dict(even)
    return Recording(name=name, remarks=(*facts.pop("remarks"), *wrong), **facts, **values)


def _flat(trace: Trace, axis: int, asked: Collection[str]) -> Table:
    """Return the columns of one axis by their names, and those of any axis that are asked for."""
    own = {name: trace.axis(name, axis) for name in trace}
    named = {name.lower() for name in asked}
    own |= {name: values for name, _, values in trace.flat() if name.lower() in named}
    return Table(columns={name: np.array(values, dtype=float) for name, values in own.items()})


def _recording(
    name: str,
    table: Table,
    columns: Mapping[str, str],
    units: Mapping[str, str],
    rate: float | None,
    how: Conversion,
) -> Recording:
    raw = table.columns
    for key in (*columns, *units):
        if key not in QUANTITIES:
            raise ValueError(unknown(f"{name}: signal {key}", key, list(QUANTITIES)))
    asked = [column for column in columns.values() if column in table.text]
    chosen, remarks = assign(name, [*raw, *table.mixed, *asked], columns)
    words = {**table.text, **table.mixed}
    for column in chosen.values():
        if column in words:
            raise ValueError(words[column])
    remarks += [f"column {column!r} is left out: it contains text" for column in words]
    left = [heading for heading in raw if heading not in chosen.values()]
    lacks = [key for key in ("t", "x", "force") if key not in chosen and (key != "t" or not rate)]
    if "x" in lacks:
        raise ValueError(f"{name}: {not_found(lacks, list(raw), left)}")
    signals: dict[str, Any]
    signals, rotary, said = in_si(
        name, raw, chosen, units, how, guessed=chosen.keys() - columns.keys()
    )
    remarks += said
    if len({len(values) for values in signals.values()}) > 1:
        rows = (f"{key} (column {chosen[key]!r}) has {len(v)} rows" for key, v in signals.items())
        raise ValueError(
            f"{name}: {', '.join(rows)}; name columns of one trial: columns={{'x': 'NAME'}}"
        )
    if rate is not None and "t" in signals:
        own_time = signals.pop("t")
        remarks = [text for text in remarks if not text.startswith("t: ")]
        remarks.append(_not_its_own(rate, chosen["t"], own_time))
    if "t" not in signals:
        if rate is None:
            ask = (
                f"{not_found(lacks, list(raw), left)}. Or say"
                if left
                else f"found no time among {listed(list(raw))}; say"
            )
            raise ValueError(f"{name}: {ask} how many rows a second: rate=... or --rate")
        signals["t"] = np.arange(len(signals["x"])) / rate
    ours = {heading.partition(" [")[0]: values for heading, values in raw.items()}
    if "desired" in signals and {"est.x_act", "est.weight"} <= set(ours):
        signals |= where_met(signals["x"], ours["est.x_act"], ours["est.weight"])
    even: dict[str, Any] = dict(_evenly(name, without_held(signals, remarks), remarks))
    guessed = any(text.startswith("x: no unit") for text in remarks)
    plausible(name, even, rotary=rotary, guessed=guessed, rate=rate)
    read = signals["x"][np.isfinite(signals["x"])]
    found = count_of(read)  # before anything is put between them
    step = f"{1e3 * found:.4g} {'mrad' if rotary else 'mm'}"
    remarks.append(f"encoder step of {step} found in x" if found else "x shows no encoder step")
    return Recording(
        name=name, count=found, remarks=tuple(remarks), rotary=rotary, unread=tuple(left), **even
    )


def _not_its_own(rate: float, column: str, t: NDArray[np.float64]) -> str:
    """Return that a rate was given, and what the column of time says instead."""
    step = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    own = (
        f", which says {1 / step:.4g} rows a second,"
        if step > 0 and abs(rate * step - 1) > OTHER
        else ""
    )
    return f"t: {rate:g} rows a second as asked, column {column!r}{own} is not used"


def _evenly(name: str, signals: Columns, remarks: list[str]) -> Columns:
    """Return the signals on rows of equal time steps, see `on_rows`; a log that cannot be is refused."""
    t = signals["t"]
    if len(t) < LEAST_ROWS:
        raise ValueError(f"{name}: {plural(len(t), 'row')}; needs at least {LEAST_ROWS}")
    for key, values in signals.items():
        wrong = np.flatnonzero(~np.isfinite(values))
        if wrong.size:
            raise ValueError(
                f"{name}: {key} is no number in {wrong.size} of {len(t)} rows, first in row {wrong[0] + 1} below the "
                "heading; cut these rows out or fill them"
            )
    step = np.diff(t)
    if not (step > 0).all():
        raise ValueError(f"{name}: {not_rising(step, 1)}")
    return on_rows(name, signals, remarks)
