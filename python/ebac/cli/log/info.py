"""The output of `ebac log info`: a JSON document, or tables for people."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.logs import Log
    from ebac.trace import Trace

#: Gaps, faults and events shown to people; `--json` has all.
MOST_SHOWN = 10


def document(read: Log) -> str:
    """Return the JSON document."""
    from dataclasses import asdict

    from ebac.metrics import current_limits, observer_use

    trace = read.trace
    t = trace["t"]
    used, limits = observer_use(trace), current_limits(trace)
    rows = [
        {"column": name, "unit": info.unit, "meaning": info.meaning, "type": str(trace[name].dtype),
         "values_per_row": 1 if trace[name].ndim == 1 else trace[name].shape[1]}
        for name, info in trace.columns.items()
    ]  # fmt: skip
    return output.document(
        "log info",
        rows,
        file=str(read.path),
        bytes=read.bytes,
        **condition(read),
        log_rows=len(trace),
        first_s=float(t[0]) if len(t) else None,
        last_s=float(t[-1]) if len(t) else None,
        rate_Hz=_rate(trace),
        axes=trace.axes,
        law=trace.law or None,
        law_repr=trace.law_repr or None,
        observer=None if used is None else asdict(used),
        current_limited=None if limits is None else asdict(limits),
        start_s=read.about.start_ns / 1e9 if read.about.start_ns else None,
        made_by=dict(read.about.made_by),
        attachments=list(read.about.attachments),
        lost_rows=read.lost,
        gaps=[{"after_tick": g.after_tick, "t_s": g.t, "rows": g.rows} for g in read.gaps],
        faults=[{"fault": n, "t_s": at, "tick": tick} for n, at, tick in read.faults],
        events=[{"kind": e.kind, "message": e.message, "tick": e.tick, "t_s": e.t, "values": e.values}
                for e in read.events],
    )  # fmt: skip


def condition(read: Log) -> dict[str, Any]:
    """Return what is wrong with a log, for JSON."""
    return {
        "complete": read.condition.complete,
        "damaged": read.condition.damaged,
        "bytes_left": read.condition.bytes_left,
        "remarks": read.condition.remarks,
    }


def _rate(trace: Trace) -> float | None:
    """Return ticks per second: the median, which no gap changes."""
    import numpy as np

    if len(trace) < 2:
        return None
    step = float(np.median(np.diff(trace["t"])))
    return 1 / step if step > 0 else None


def show(read: Log, *, meanings: bool = False) -> None:
    """Print it; with the meaning of each column where asked."""
    from ebac.logs.events import fault_name

    grid = output.table(["", read.path.name])
    for name, text in _lines(read):
        grid.add_row(name, _escaped(text))
    output.show(grid)
    output.console().print(_columns(read.trace, meanings=meanings))
    _list(
        "Gaps",
        [
            f"{output.plural(g.rows, 'row')} after tick {g.after_tick}, {g.t:.3f} s"
            for g in read.gaps
        ],
    )
    _list(
        "Faults",
        [f"{n} ({fault_name(n)}) in tick {tick}, {t:.3f} s" for n, t, tick in read.faults],
    )
    _list("Events", [f"{e.kind} in tick {e.tick}, {e.t:.3f} s: {e.message}" for e in read.events])


def _lines(read: Log) -> list[tuple[str, str]]:
    from datetime import UTC, datetime

    from ebac.metrics import current_limits, observer_use

    trace, condition = read.trace, read.condition
    t = trace["t"]
    rate = _rate(trace)
    span = f"{t[0]:.3f} to {t[-1]:.3f} s" if len(t) else "none"
    state = "complete" if condition.complete else "cut: its end is missing"
    if condition.damaged:
        state += f", {output.plural(condition.damaged, 'damaged part')} left out"
    start = read.about.start_ns
    lines = [
        ("file", f"{state}; {read.bytes / 1e6:.3g} MB"),
        (
            "rows",
            f"{len(trace)}, {output.plural(trace.axes, 'axis', 'axes')}, {read.lost:,} missing between them",
        ),
        ("time", span + (f" at {rate:.6g} Hz" if rate else "")),
        *_law(trace),
        ("events", str(len(read.events))),
        ("attached", ", ".join(read.about.attachments) or "nothing"),
        (
            "made by",
            ", ".join(f"{k} {v}" for k, v in read.about.made_by.items() if v) or "not in the log",
        ),
    ]
    if (used := observer_use(trace)) is not None:
        lines.append(("observer", str(used)))
    if (limits := current_limits(trace)) is not None:
        lines.append(("current held back", f"by {limits}"))
    if start:
        began = datetime.fromtimestamp(start / 1e9, UTC)
        lines.insert(3, ("began", f"{began:%Y-%m-%d %H:%M:%S} UTC"))
    lines += [("remark", remark) for remark in condition.remarks]
    return lines


def _law(trace: Trace) -> list[tuple[str, str]]:
    """Return the law and its parameters, with four digits as in the columns."""
    shown = re.sub(
        r"\d+\.\d+(e[+-]?\d+)?", lambda number: f"{float(number[0]):.4g}", trace.law_repr
    )
    inside = re.fullmatch(r"\w+\((.+)\)", shown, re.DOTALL)
    if not trace.law or inside is None:
        return [("law", trace.law or shown or "not in the log")]
    return [("law", trace.law), ("parameters", f"{inside[1].replace('=', ' = ')} (SI units)")]


def _extreme(name: str, value: float) -> str:
    """Return the least or most of a column; those with a meaning in words."""
    from ebac._core import LoopState
    from ebac.drives.faults import emergency
    from ebac.logs.events import fault_name

    if name == "fault":
        return f"{value:.0f} ({fault_name(int(value))})"
    if name == "state" and value in list(LoopState):
        return f"{value:.0f} ({LoopState(int(value)).name.lower()})"
    match re.sub(r"_\d$", "", name):
        case "bus.statusword":
            return f"0x{int(value):04X}{_drive_state(int(value))}"
        case "bus.controlword":
            return f"0x{int(value):04X}"
        case "bus.emergency" if value:
            return f"0x{int(value):04X} ({emergency(int(value))})"
    return f"{value:.4g}"


def _drive_state(statusword: int) -> str:
    from ebac.drives.state import State

    try:
        return f" ({State.of(statusword).value})"
    except ValueError:
        return ""


def _columns(trace: Trace, *, meanings: bool) -> Any:
    import numpy as np

    more = ["meaning"] if meanings else []
    grid = output.table(["column", "unit", "least", "most", *more], numbers=(2, 3))
    for name, info, values in trace.flat():
        known = values[np.isfinite(values)].astype(float) if len(values) else values
        ends = (known.min(), known.max()) if len(known) else ()
        least, most = (_extreme(name, end) for end in ends) if len(ends) else ("-", "-")
        unit = "" if info.unit == "1" else info.unit
        grid.add_row(name, unit, least, most, *([_escaped(info.meaning)] if meanings else []))
    return grid


def _escaped(text: str) -> str:
    from rich.markup import escape

    return escape(text)


def _list(title: str, lines: list[str]) -> None:
    if not lines:
        return
    output.say(f"{title}:", style="bold")
    for line in lines[:MOST_SHOWN]:
        output.indented(line)
    if len(lines) > MOST_SHOWN:
        output.indented(f"and {len(lines) - MOST_SHOWN} more, see --json")
