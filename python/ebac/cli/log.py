"""`ebac log`: what is in a log, its export, its repair, its figure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import typer

from ebac.cli import output

if TYPE_CHECKING:
    from ebac.logs import Log
    from ebac.trace import Trace

log = typer.Typer(
    no_args_is_help=True,
    help="Logs of runs (MCAP): look into one, export, repair, draw it.",
)

LogFile: TypeAlias = Annotated[Path, typer.Argument(metavar="FILE", help="A log, run.mcap.")]
From: TypeAlias = Annotated[
    float | None, typer.Option("--from", help="Only rows from this time on [s].")
]
To: TypeAlias = Annotated[
    float | None, typer.Option("--to", help="Only rows before this time [s].")
]

#: Gaps, faults and events shown to people; `--json` has all.
MOST_SHOWN = 10


@log.command("info")
def info(file: LogFile, as_json: output.AsJson = False) -> None:
    """Tell what is in a log: rows, time, columns with units, gaps, faults, versions, and whether it is whole.

    A log whose recorder was killed is read up to its last whole chunk.

    **Examples**

    * `ebac log info run.mcap`

    * `ebac log info run.mcap --json`: as JSON.
    """
    read = _read(file, quiet=as_json)
    if as_json:
        typer.echo(_document(read))
    else:
        _show(read)


@log.command("export")
def export(
    file: LogFile,
    out: Annotated[
        Path,
        typer.Argument(
            metavar="OUT", help="The file to write: .csv, .parquet, .mat, .h5, .npz or .mcap."
        ),
    ],
    start: From = None,
    stop: To = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file of that name.")] = False,
    as_json: output.AsJson = False,
) -> None:
    """Write the rows of a log in the format of another program, by the extension of OUT.

    Every number keeps all its digits, every column its unit. MATLAB needs `pip install 'ebac[log]'`, so does HDF5;
    Parquet `ebac[sweep]`.

    **Examples**

    * `ebac log export run.mcap run.csv`

    * `ebac log export run.mcap run.mat --from 2 --to 5`: three seconds of it, for MATLAB.
    """
    from ebac.logs.files import FORMATS, extension

    with output.refusing():
        extension(out, tuple(FORMATS))
    if out.exists() and not force:
        output.fail(f"{out}: there is such a file; give another name, or --force to replace it")
    trace = _part(_read(file, quiet=as_json).trace, start, stop)
    with output.refusing(), output.counting(f"writing {out.name}", quiet=as_json) as told:
        try:
            trace.save(out, progress=told)
        except ModuleNotFoundError as error:
            output.fail(str(error))
        except OSError as error:
            output.fail(f"{out}: cannot be written ({error.strerror})")
    if as_json:
        row = {"file": str(out), "rows": len(trace), "bytes": out.stat().st_size}
        typer.echo(output.document("log export", [row]))
    else:
        output.say(f"{out}: {len(trace)} rows, {len(list(trace))} columns.")


@log.command("repair")
def repair(
    file: LogFile,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="The new log.", show_default="run.repaired.mcap"),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Make a whole log of one that was cut or damaged; the old one stays as it is.

    Rows and events that can be read go to a new file with a summary, which every reader of MCAP accepts.
    Nothing is ever written over.

    **Examples**

    * `ebac log repair run.mcap`: writes run.repaired.mcap.
    """
    from ebac.logs import repair as repaired

    with output.refusing(), output.counting(f"reading {file.name}", quiet=as_json) as told:
        try:
            new = repaired(file, out, progress=told)
        except FileExistsError as error:
            output.fail(f"{error.filename}: there is such a file; give another name by --out")
        except OSError as error:
            if str(error.filename) == str(file):
                raise
            output.fail(f"{error.filename}: cannot be written ({error.strerror})")
    if as_json:
        row = {
            "file": str(new.path),
            "rows": len(new.trace),
            "events": len(new.events),
            "lost_rows": new.lost,
        }
        typer.echo(output.document("log repair", [row]))
    else:
        output.say(f"{new.path}: {len(new.trace)} rows, {len(new.events)} events.")


@log.command("plot")
def plot(
    file: LogFile,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="The picture: .png, .pdf or .svg.", show_default="run.png"),
    ] = None,
    column: Annotated[
        list[str] | None,
        typer.Option(
            "--column",
            "-c",
            help="A column to draw, repeated for several; position, force, beta and energy if not given.",
        ),
    ] = None,
    start: From = None,
    stop: To = None,
) -> None:
    """Draw a log over time: position, force, beta and energy, or columns by name, those of one unit together.

    **Examples**

    * `ebac log plot run.mcap`: writes run.png.

    * `ebac log plot run.mcap -c lateness -c x -c v --from 1 --to 2`
    """
    picture = file.with_suffix(".png") if out is None else out
    if picture.suffix not in (".png", ".pdf", ".svg"):
        output.fail(f"--out {picture}: must end in .png, .pdf or .svg")
    trace = _part(_read(file, quiet=False).trace, start, stop)
    with output.refusing():
        from ebac.plot import plot_columns, plot_trace

        figure = plot_columns(trace, column) if column else plot_trace(trace)
        figure.savefig(picture)
    output.say(f"{picture}: {len(trace)} rows.")


def _read(file: Path, *, quiet: bool) -> Log:
    from ebac.logs import read

    with output.refusing(), output.counting(f"reading {file.name}", quiet=quiet) as told:
        return read(file, progress=told)


def _part(trace: Trace, start: float | None, stop: float | None) -> Trace:
    if start is None and stop is None:
        return trace
    part = trace.between(start, stop)
    if len(part) == 0:
        t = trace["t"]
        has = f"the log has {t[0]:g} to {t[-1]:g} s" if len(t) else "the log has none"
        wanted = " ".join(
            f"{word} {t:g} s" for word, t in (("from", start), ("to", stop)) if t is not None
        )
        output.fail(f"no rows {wanted}: {has}")
    return part


def _document(read: Log) -> str:
    trace = read.trace
    t = trace["t"]
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
        complete=read.condition.complete,
        damaged=read.condition.damaged,
        bytes_left=read.condition.bytes_left,
        remarks=read.condition.remarks,
        log_rows=len(trace),
        first_s=float(t[0]) if len(t) else None,
        last_s=float(t[-1]) if len(t) else None,
        rate_Hz=_rate(trace),
        axes=trace.axes,
        law=trace.law or None,
        law_repr=trace.law_repr or None,
        start_s=read.about.start_ns / 1e9 if read.about.start_ns else None,
        made_by=dict(read.about.made_by),
        attachments=list(read.about.attachments),
        lost_rows=read.lost,
        gaps=[{"after_tick": g.after_tick, "t_s": g.t, "rows": g.rows} for g in read.gaps],
        faults=[{"fault": n, "t_s": at, "tick": tick} for n, at, tick in read.faults],
        events=[{"kind": e.kind, "message": e.message, "tick": e.tick, "t_s": e.t, "values": e.values}
                for e in read.events],
    )  # fmt: skip


def _rate(trace: Trace) -> float | None:
    """Return ticks per second: the median, which no gap changes."""
    import numpy as np

    if len(trace) < 2:
        return None
    step = float(np.median(np.diff(trace["t"])))
    return 1 / step if step > 0 else None


def _show(read: Log) -> None:
    from ebac.logs.recorder import fault_name

    grid = output.table(["", read.path.name])
    for name, text in _lines(read):
        grid.add_row(name, _escaped(text))
    output.console().print(grid)
    output.console().print(_columns(read.trace))
    _list("Gaps", [f"{g.rows} rows after tick {g.after_tick}, {g.t:.3f} s" for g in read.gaps])
    _list(
        "Faults",
        [f"{n} ({fault_name(n)}) in tick {tick}, {t:.3f} s" for n, t, tick in read.faults],
    )
    _list("Events", [f"{e.kind} in tick {e.tick}, {e.t:.3f} s: {e.message}" for e in read.events])


def _lines(read: Log) -> list[tuple[str, str]]:
    from datetime import UTC, datetime

    trace, condition = read.trace, read.condition
    t = trace["t"]
    rate = _rate(trace)
    span = f"{t[0]:.3f} to {t[-1]:.3f} s" if len(t) else "none"
    state = "complete" if condition.complete else "cut: its end is missing"
    if condition.damaged:
        state += f", {condition.damaged} damaged parts left out"
    start = read.about.start_ns
    lines = [
        ("file", f"{state}; {read.bytes / 1e6:.3g} MB"),
        ("rows", f"{len(trace)}, {trace.axes} axis(es), {read.lost} missing between them"),
        ("time", span + (f" at {rate:.6g} Hz" if rate else "")),
        ("law", trace.law_repr or trace.law or "not told"),
        ("events", str(len(read.events))),
        ("attached", ", ".join(read.about.attachments) or "nothing"),
        (
            "made by",
            ", ".join(f"{k} {v}" for k, v in read.about.made_by.items() if v) or "not told",
        ),
    ]
    if start:
        began = datetime.fromtimestamp(start / 1e9, UTC)
        lines.insert(3, ("began", f"{began:%Y-%m-%d %H:%M:%S} UTC"))
    lines += [("remark", remark) for remark in condition.remarks]
    return lines


def _columns(trace: Trace) -> Any:
    import numpy as np

    grid = output.table(["column", "unit", "least", "most", "meaning"], numbers=(2, 3))
    for name, info, values in trace.flat():
        known = values[np.isfinite(values)].astype(float) if len(values) else values
        least, most = (f"{known.min():.4g}", f"{known.max():.4g}") if len(known) else ("-", "-")
        grid.add_row(name, info.unit, least, most, _escaped(info.meaning))
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
