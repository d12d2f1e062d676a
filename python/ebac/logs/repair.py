"""Makes a whole log of one that was cut or damaged."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from ebac.logs.files import CHUNK_ROWS, extension
from ebac.logs.layout import Layout
from ebac.logs.log import Log
from ebac.logs.reader import read, whole
from ebac.logs.writer import LogWriter


def repair(
    path: str | Path,
    out: str | Path | None = None,
    *,
    progress: Callable[[int, int], None] | None = None,
) -> Log:
    """Write what can be read of a log to a new file, with the summary that any reader of MCAP accepts.

    Rows, events, law, scenario and attachments are those of the old file, to the bit. The old file stays as it is.

    Parameters
    ----------
    path : str or Path
        The log.
    out : str or Path, optional
        The new file; `run.repaired.mcap` beside `run.mcap`, if not given.
    progress : callable, optional
        Called with bytes read and bytes in all.

    Returns
    -------
    Log
        The new log, read back.

    Raises
    ------
    FileExistsError
        When `out` exists: nothing is ever written over.
    FileNotFoundError, ValueError
        As `read`; ValueError also for an `out` that does not end in .mcap, and where no row can be read.
    """
    new = new_name(Path(path), out)
    return rewritten(read(path, progress=progress), new)


def new_name(path: Path, out: str | Path | None) -> Path:
    """Return where the repaired log goes. Raises FileExistsError, and ValueError as `repair`."""
    new = path.with_name(f"{path.stem}.repaired.mcap") if out is None else Path(out)
    extension(new, (".mcap",))
    if new.exists():
        raise FileExistsError(17, "File exists", str(new))
    return new


def rewritten(log: Log, out: Path) -> Log:
    """Write what was read of a log to a new file; return that, read back."""
    if not len(log.trace) and not log.events:
        raise ValueError(f"{log.path}: nothing can be recovered: no row of it can be read")
    data = {name: log.trace[name] for name in log.trace}
    try:
        with LogWriter(out, layout=Layout.of(data, log.trace.columns), about=log.about) as new:
            for first in range(0, len(log.trace), CHUNK_ROWS):
                new.write({name: v[first : first + CHUNK_ROWS] for name, v in data.items()})
            if log.events:
                new.write({name: v[:0] for name, v in data.items()}, log.events)
            numbers = {name: whole(text) for name, text in log.ended.items()}
            ended = {name: n for name, n in numbers.items() if n is not None}
            new.close(**{"rows": len(log.trace), **ended, "repaired": 1})
    except FileExistsError:
        raise
    except BaseException:
        out.unlink(missing_ok=True)  # ours, and not whole
        raise
    return read(out)
