"""`ebac log`: what is in a log, its export, its repair, its figure."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeAlias

import typer

from ebac.cli import interrupts, output
from ebac.cli.command import Group, add
from ebac.cli.files import FigureOptions, free_file, new_file
from ebac.cli.log import info as log_info

if TYPE_CHECKING:
    from ebac.logs import Log

log = typer.Typer(
    cls=Group,
    no_args_is_help=True,
    help="Inspect, export, repair and plot the logs of runs.",
)

LogFile: TypeAlias = Annotated[
    Path, typer.Argument(metavar="FILE", help="A log: .mcap, .npz, .csv, .parquet, .mat, .h5.")
]
From: TypeAlias = Annotated[
    float | None, typer.Option("--from", help="Only rows from this time on [s].")
]
To: TypeAlias = Annotated[
    float | None, typer.Option("--to", help="Only rows before this time [s].")
]


class Profile(StrEnum):
    """What an MCAP file is made for."""

    EBAC = "ebac"
    ROS2 = "ros2"


def info(
    file: LogFile,
    meanings: Annotated[
        bool, typer.Option("--meanings", help="Explain what each column means.")
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Print the contents of a log: rows, time, columns with units, gaps, faults, versions.

    Also reads logs that a crash cut short. Exit code 3 when parts are damaged.

    **Examples**

    * `ebac wall --law ebac --log run.mcap`, then `ebac log info run.mcap`

    * `ebac log info run.mcap --meanings`: what each column means

    * `ebac log info run.mcap --json`: as JSON
    """
    read = _read(file, quiet=as_json)
    if as_json:
        typer.echo(log_info.document(read))
    else:
        log_info.show(read, meanings=meanings)
    _report(read, quiet=True)


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
    profile: Annotated[
        Profile, typer.Option("--profile", help="For .mcap: a log of ebac, or a bag of ROS 2.")
    ] = Profile.EBAC,
    force: Annotated[
        bool, typer.Option("--force", help="Replace a file of the same name.")
    ] = False,
    as_json: output.AsJson = False,
) -> None:
    """Export the rows of a log to another format, chosen by the extension of OUT.

    Every number keeps all its digits and every column its unit. MATLAB and HDF5 need `pip install 'ebac[log]'`,
    Parquet needs `ebac[sweep]`. Only the requested rows are loaded into memory. Exit code 3 when parts of the log are
    damaged; their rows are missing.

    **Examples**

    * `ebac wall --law ebac --log run.mcap`, then `ebac log export run.mcap run.csv`

    * `ebac log export run.mcap part.npz --from 2 --to 5`: three seconds of it, for NumPy

    * `ebac log export run.mcap run-ros2.mcap --profile ros2`: a bag for ROS 2, rosbags and mcap-ros2-support
    """
    from ebac.logs.files import FORMATS, check_profile, extension

    _check_times(start, stop)
    with output.refusing():
        extension(out, tuple(FORMATS))
        check_profile(out, profile)
    new_file("OUT", out, force=force)
    interrupts.keeping("nothing was written")
    if profile == Profile.ROS2:
        _export_ros2(file, out, start, stop, as_json=as_json)
        return
    read = _read(file, start, stop, quiet=as_json)
    trace = read.trace
    with (
        output.refusing(),
        output.writing(f"OUT {out}"),
        output.counting(f"writing {out.name}", quiet=as_json) as progress,
    ):
        trace.save(out, progress=progress)
    if as_json:
        row = {"file": str(out), "rows": len(trace), "bytes": out.stat().st_size}
        typer.echo(output.document("log export", [row], **log_info.condition(read)))
    else:
        output.path(out)
        output.say(
            f"{output.plural(len(trace), 'row')}, {output.plural(len(list(trace)), 'column')}."
        )
    _report(read, quiet=as_json)


def repair(
    file: LogFile,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="The new log.", show_default="run.repaired.mcap"),
    ] = None,
    as_json: output.AsJson = False,
) -> None:
    """Write a complete log from one that was cut or damaged; the old file is not changed.

    Rows and events that can be read go to a new MCAP file with a summary, which every reader accepts.

    **Examples**

    * `ebac wall --law ebac --log run.mcap`, then `ebac log repair run.mcap`: writes run.repaired.mcap
    """
    from ebac.logs import read
    from ebac.logs.repair import new_name, rewritten

    if file.exists() and file.suffix.lower() != ".mcap":
        output.fail(f"{file}: only .mcap logs can be repaired")
    with output.refusing(), output.counting(f"reading {file.name}", quiet=as_json) as progress:
        try:
            name = new_name(file, out)
            old = read(file, progress=progress)
            new = rewritten(old, name)
        except FileExistsError as error:
            output.fail(f"{error.filename}: there is such a file; give another name by --out")
        except OSError as error:
            if str(error.filename) == str(file):
                raise
            output.cannot_write(f"--out {error.filename}", error)
    if as_json:
        row = {
            "file": str(new.path),
            "rows": len(new.trace),
            "events": len(new.events),
            "lost_rows": new.lost,
        }
        typer.echo(output.document("log repair", [row], **log_info.condition(old)))
    else:
        whole = f"{file.name} was complete and undamaged: the new log has the same rows."
        for line in _missing(old) or [whole]:
            output.say(line, style="yellow")
        output.path(new.path)
        output.say(
            f"{output.plural(len(new.trace), 'row')}, {output.plural(len(new.events), 'event')}."
        )


def plot(
    file: LogFile,
    style: FigureOptions,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            help="The figure: .png, .pdf or .svg.",
            show_default="run.png, run-2.png, ...",
        ),
    ] = None,
    column: Annotated[
        list[str] | None,
        typer.Option(
            "--column",
            "-c",
            help="Columns to draw, separated by commas; x_0 is axis 0 of x alone.",
            show_default="position, force, beta and energy",
        ),
    ] = None,
    start: From = None,
    stop: To = None,
    force: Annotated[
        bool, typer.Option("--force", help="Replace a file of the same name.")
    ] = False,
) -> None:
    """Draw a log over time: position, force, beta and energy, or columns by name.

    Exit code 3 when parts of the log are damaged; their rows are missing.

    **Examples**

    * `ebac wall --law ebac --log run.mcap`, then `ebac log plot run.mcap`: writes run.png

    * `ebac log plot run.mcap -c x,v,f_env --from 1 --to 2 --format pdf`: columns of one unit together
    """
    style.check()
    _check_times(start, stop)
    if out is not None and out.suffix not in (".png", ".pdf", ".svg"):
        output.fail(f"--out {out}: must end in .png, .pdf or .svg")
    if out is not None and style.figure_format is not None:
        output.fail(
            "--out and --format: the extension of --out is the format; leave one of them out"
        )
    if out is not None:
        new_file("--out", out, force=force)
    read = _read(file, start, stop, quiet=False)
    trace = read.trace
    with output.refusing():
        from ebac.plot import plot_columns, plot_trace

        chosen = output.words(column)
        figure = plot_columns(trace, chosen) if chosen else plot_trace(trace, events=read.events)
        figure.suptitle(f"{file.name}: {figure.get_suptitle()}", fontsize="medium")
        files = [out] if out else [free_file(file.with_suffix(f".{e}")) for e in style.formats()]
        for picture in files:
            with output.writing(f"--out {picture}"):
                style.write(figure, picture)
    for picture in files:
        output.path(picture)
    output.say(f"{output.plural(len(trace), 'row')} drawn.")
    _report(read, quiet=False)


add(log, info)
add(log, export)
add(log, repair)
add(log, plot)


def _check_times(start: float | None, stop: float | None) -> None:
    """Refuse a part that ends before it begins."""
    if start is not None and stop is not None and stop <= start:
        output.fail(f"--to = {stop:g} s: must be larger than --from, {start:g} s")


def _read(file: Path, start: float | None = None, stop: float | None = None, *, quiet: bool) -> Log:
    from ebac.logs import read

    with output.refusing(), output.counting(f"reading {file.name}", quiet=quiet) as progress:
        try:
            return read(file, start=start, stop=stop, progress=progress)
        except ModuleNotFoundError as error:
            output.fail(f"{file}: {error}")


def _export_ros2(
    file: Path, out: Path, start: float | None, stop: float | None, *, as_json: bool
) -> None:
    from ebac.logs import to_ros2

    with output.refusing(), output.counting(f"writing {out.name}", quiet=as_json) as progress:
        try:
            bag = to_ros2(file, out, start=start, stop=stop, progress=progress)
        except ModuleNotFoundError as error:
            output.fail(f"{file}: {error}")
    if as_json:
        rows, size = bag.messages["/ebac/row"], out.stat().st_size
        row = {"file": str(out), "rows": rows, "messages": bag.messages, "bytes": size}
        typer.echo(output.document("log export", [row], **log_info.condition(bag.log)))
    else:
        output.path(out)
        for topic, number in bag.messages.items():
            output.say(f"{topic}: {output.plural(number, 'message')}")
    _report(bag.log, quiet=as_json)


def _report(read: Log, *, quiet: bool) -> None:
    """Say what is missing of a log, and end with exit code 3 where it is damaged."""
    for line in [] if quiet else _missing(read):
        output.say(line, style="yellow")
    if read.condition.damaged:
        raise typer.Exit(output.DAMAGED)


def _missing(read: Log) -> list[str]:
    """Return what is missing of a log, a sentence each; none for a whole one."""
    condition, name = read.condition, read.path.name
    lines = [] if condition.complete else [f"{name} was cut: its end is missing."]
    return [*lines, f"{name}: {condition.damage}"] if condition.damaged else lines
