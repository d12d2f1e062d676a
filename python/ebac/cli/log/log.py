"""`ebac log`: what is in a log, its export, its repair, its figure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from ebac.cli import log_info, output

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
        typer.echo(log_info.document(read))
    else:
        log_info.show(read)


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
