"""Traces as files: the format by the extension."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ebac._util.arguments import require_file, require_path
from ebac._util.at_user import warn
from ebac._util.atomic_file import draft
from ebac._util.plural import plural
from ebac._util.progress import Progress
from ebac.logs.about import SIMULATED_DRIVES, SIMULATED_FILE, About
from ebac.logs.layout import Layout
from ebac.logs.ticks import numbered
from ebac.scenario_text import warn_without_text

if TYPE_CHECKING:
    from ebac.trace import Trace


#: Rows of a chunk in a log written at once: some 0.5 MB.
CHUNK_ROWS = 2048

#: What each extension is.
FORMATS = {
    ".mcap": "MCAP: PlotJuggler, Foxglove, ebac",
    ".npz": "NumPy archive",
    ".csv": "CSV, units in the headings",
    ".parquet": "Parquet, units in the metadata of each column",
    ".mat": "MATLAB, with structs `units` and `meanings`",
    ".h5": "HDF5, units as attributes",
}
#: Those that can be read back as a trace.
READABLE = tuple(FORMATS)


#: What an MCAP file can be made for: a log of ebac, or ROS 2.
PROFILES = ("ebac", "ros2")


def save(
    trace: Trace, path: str | Path, *, profile: str = "ebac", progress: Progress | None = None
) -> None:
    """Write a trace in the format of the extension; the file appears when it is whole.

    Parameters
    ----------
    trace : Trace
        Any number of rows.
    path : str or Path
        Ends in one of `FORMATS`; a file of that name is replaced.
    profile : str
        Of .mcap: `ebac`, or `ros2` for a bag of ROS 2, see `to_ros2`, which ebac does not read back.
    progress : callable, optional
        Called with rows written and rows in all, where the format is written in parts.

    Raises
    ------
    ValueError
        For another extension or profile, or columns that the format cannot hold.
    ModuleNotFoundError
        When the library of a format is not installed; the message names it.
    OSError
        When the file cannot be written.
    """
    from ebac.logs import export, ros2
    from ebac.trace.files import write_csv, write_npz

    require_path(path, "Trace.save")
    path = Path(path)
    known = extension(path, tuple(FORMATS))
    check_profile(path, profile)
    writers: dict[str, Callable[[Trace, Path, Progress], Any]] = {
        ".mcap": ros2.write_trace if profile == "ros2" else write_mcap,
        ".npz": lambda t, p, _: write_npz(t, p),
        ".csv": write_csv,
        ".parquet": export.to_parquet,
        ".mat": export.to_mat,
        ".h5": export.to_hdf5,
    }
    with draft(path) as name:
        writers[known](trace, name, progress or (lambda done, total: None))
    if known != ".csv":  # which holds no scenario
        warn_without_text(trace.scenario, path, stacklevel=3)


def check_profile(path: Path, profile: str) -> None:
    """Refuse a profile that is none, or that the format of a file does not have.

    Raises
    ------
    ValueError
        Then.
    """
    if profile not in PROFILES:
        raise ValueError(f"profile {profile!r}: must be {' or '.join(PROFILES)}")
    if profile != "ebac" and path.suffix.lower() != ".mcap":
        raise ValueError(f"{path}: the profile {profile} must end in .mcap")


def extension(path: Path, known: tuple[str, ...]) -> str:
    """Return the extension of a file, one of `known`.

    Raises
    ------
    ValueError
        For another one.
    """
    found = path.suffix.lower()
    if found not in known:
        raise ValueError(f"{path}: must end in {', '.join(known)}")
    return found


def load(
    path: str | Path,
    *,
    start: float | None = None,
    stop: float | None = None,
    progress: Progress | None = None,
) -> Trace:
    """Read a trace, the format by the extension: MCAP (whole or cut), NPZ, CSV, Parquet, MATLAB or HDF5.

    Parameters
    ----------
    path : str or Path
        What `Trace.save` or a recorder wrote. CSV holds neither scenario nor law.
    start, stop : float, optional
        Only rows with start <= t < stop [s]; of MCAP no others come into memory.
    progress : callable, optional
        Called with bytes read and bytes in all, for MCAP.

    Warns
    -----
    UserWarning
        When parts of an MCAP file are damaged: the rows in them are missing; when its end is missing, because it was
        cut or is still being written. `ebac.logs.read` gives more, and does not warn. When the last line of a CSV file
        of another program has no end, and so its last number may be cut.

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    ValueError
        For another extension, a file that is not in the format of its extension, is damaged or, of a CSV file of ebac,
        cut, or a part that lies outside it or ends before it begins.
    ModuleNotFoundError
        When the library of a format is not installed; the message names it.
    """
    from ebac.logs import imports
    from ebac.logs.csv_file import read_csv
    from ebac.logs.reader import check_part, read
    from ebac.trace import Trace
    from ebac.trace.time_slice import check_order

    require_path(path, "ebac.load")
    check_order(start, stop)
    path = Path(path)
    kind = extension(path, READABLE)
    require_file(path, "ebac.load")
    if kind == ".mcap":
        log = read(path, start=start, stop=stop, progress=progress)
        if log.condition.damaged:
            warn(f"{path}: {log.condition.damage}")
        if not log.condition.complete:
            rows = plural(len(log.trace), "whole row")
            warn(
                f"{path}: was cut, or is still being written: its end is missing; {rows} read. "
                f"`ebac log repair {path}` makes a complete log of a cut one"
            )
        return log.trace
    readers: dict[str, Callable[[Path], Trace]] = {
        ".npz": Trace.from_npz,
        ".csv": read_csv,
        ".parquet": imports.from_parquet,
        ".mat": imports.from_mat,
        ".h5": imports.from_hdf5,
    }
    trace = readers[kind](path)
    if (start is None and stop is None) or len(trace) == 0:
        return trace
    check_part(path, (float(trace["t"][0]), float(trace["t"][-1])), start, stop)
    return trace.between(start, stop)


def write_mcap(
    trace: Trace,
    path: Path,
    progress: Progress = lambda done, total: None,
    *,
    files: Mapping[str, str] | None = None,
) -> None:
    """Write a trace as a log, with text files attached; its time is t itself, so the same run gives the same file.

    Rows of another program, which have no column `tick`, get one from their times.
    """
    from ebac.logs.writer import LogWriter

    data, columns = numbered(trace)
    about = about_trace(trace, files or {})
    with LogWriter(path, layout=Layout.of(data, columns), about=about) as log:
        for first in range(0, len(trace), CHUNK_ROWS):
            log.write({name: v[first : first + CHUNK_ROWS] for name, v in data.items()})
            progress(min(first + CHUNK_ROWS, len(trace)), len(trace))
        log.close(rows=len(trace), lost=0)


def about_trace(trace: Trace, files: Mapping[str, str]) -> About:
    """Return what stands beside the rows of a trace in a log, with text files attached."""
    simulated = {SIMULATED_FILE: ""} if trace.origin == SIMULATED_DRIVES else {}
    return About(
        axes=trace.axes,
        law=trace.law,
        law_repr=trace.law_repr,
        scenario=trace.scenario,
        changed=trace.changed,
        simulated=trace.origin == "simulated" and "true.x" not in trace,
        files={**simulated, **files},
    )
