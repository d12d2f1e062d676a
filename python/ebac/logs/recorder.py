"""Records a run while it runs: a thread of its own reads the rows and writes them to disk."""

from __future__ import annotations

import atexit
import contextlib
import errno
import io
import json
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ebac._util.at_user import warn
from ebac._util.plural import plural
from ebac._util.wrong_calls import plain_constructor
from ebac.logs.about import About
from ebac.logs.events import Event
from ebac.logs.layout import Layout
from ebac.logs.new_rows import NewRows
from ebac.logs.writer import LogWriter
from ebac.scenario import Scenario
from ebac.trace.columns import column_infos, row_views

if TYPE_CHECKING:
    from ebac._core import Rows

#: Time between two chunks [s]. Rows of at most this and of what the system lets the thread wait are lost by a kill.
INTERVAL = 0.02


@plain_constructor
class Recorder:
    """Writes the rows of a running loop to a log.

    The loop knows nothing of it: the recorder is one more reader of its rows. It wakes every `interval`, copies what
    is new and writes it as one chunk. Killed, the process loses the rows since the last chunk. Where the loop keeps its
    rows in a ring and the recorder comes too late, rows are lost: they are counted, written as an event and reported by
    `close`.

    Parameters
    ----------
    rows : Rows
        The rows of the loop, of any length, or a ring.
    path : str or Path
        The log; must not exist.
    scenario : Scenario, optional
        Goes into the log.
    law, law_repr : str
        Name of the law; the law with its parameters.
    files : mapping of str to str, optional
        Texts to attach by file name: the configuration of the run.
    watch : callable, optional
        Called before each chunk, in the thread of the recorder; the events it returns go into the log: how changes of
        parameters come from a running loop. What it raises ends the recording.
    interval : float
        Time between two chunks [s], in [0.001, 10]. At 0.02 s a kill costs less than 50 ms as long as the system
        lets the thread run within 30 ms; Python code that holds the interpreter longer than that delays it.
    sync : float, optional
        Time [s], in [0.1, 3600], after which what is written is forced to the disk, in another thread. Without it
        that happens at the end only: a killed process loses nothing by it, a computer without power does.
    start : float, optional
        When t was 0, in seconds since 1970 (UTC); now, if not given.
    first : int
        Number of the first row to write; 0 for all that the loop still has.
    file : FileIO, optional
        What `ebac.logs.writer.new_log` returned for this path: a log that was begun before the loop.

    Attributes
    ----------
    written, lost : int
        Rows so far.
    error : Exception or None
        Why nothing is written any more; raised by `close`.

    Raises
    ------
    FileExistsError
        When there is such a file.
    ValueError
        For an interval out of range.

    Examples
    --------
    >>> with Recorder(rows, "run.mcap", law="ebac") as recorder:  # doctest: +SKIP
    ...     recorder.event("parameter", "damping raised", damping_Ns_per_m=40)
    """

    def __init__(
        self,
        rows: Rows,
        path: str | Path,
        *,
        scenario: Scenario | None = None,
        law: str = "",
        law_repr: str = "",
        files: Mapping[str, str] | None = None,
        watch: Callable[[], Sequence[Event]] | None = None,
        interval: float = INTERVAL,
        sync: float | None = None,
        start: float | None = None,
        first: int = 0,
        file: io.FileIO | None = None,
    ) -> None:
        _check("interval", interval, 1e-3, 10)
        if sync is not None:
            _check("sync", sync, 0.1, 3600)
        self._interval = interval
        self._watch = watch or _nothing
        about = About(
            axes=rows.axes,
            law=law,
            law_repr=law_repr,
            scenario=scenario,
            start_ns=time.time_ns() if start is None else round(1e9 * start),
            files=dict(files or {}),
        )
        none = row_views(rows, np.empty(0, np.uint8))
        layout = Layout.of(none, column_infos(rows))
        self._writer = LogWriter(path, layout=layout, about=about, file=file)
        self._new = NewRows(rows, first)
        self._waiting: list[Event] = []
        self._lock = threading.Lock()
        self._ends = threading.Event()
        self._closed = False
        self.written = 0
        self.lost = 0
        self.error: Exception | None = None
        self._threads = [threading.Thread(target=self._run, name="ebac-recorder", daemon=True)]
        if sync is not None:
            self._threads.append(
                threading.Thread(target=self._sync, args=(sync,), name="ebac-sync", daemon=True)
            )
        atexit.register(self._at_exit)
        for thread in self._threads:
            thread.start()

    @property
    def path(self) -> Path:
        """The log."""
        return self._writer.path

    def event(self, kind: str, message: str, *, tick: int | None = None, **values: Any) -> None:
        """Note what happened, beside the rows; it is written with the next chunk.

        Parameters
        ----------
        kind : str
            `parameter` for a change of parameters, or a word of your own; `fault` and `lost` are noted by themselves.
        message : str
            What happened, in words.
        tick : int, optional
            When; the last row the recorder has seen, if not given. Its time is that of the row, if the loop still has
            it.
        **values
            Numbers and words that belong to it, the unit in the key.

        Raises
        ------
        ValueError
            When the recorder is closed.
        TypeError
            For a value that JSON has not.
        """
        values = {name: _plain(name, value) for name, value in values.items()}
        at, t, _ = self._new.last
        if tick is not None:
            at, t = tick, self._new.time_of(tick)
        with self._lock:
            if self._ends.is_set():
                raise ValueError(f"{self.path}: the recorder is closed; note events while it runs")
            self._waiting.append(Event(kind=kind, message=message, tick=at, t=t, values=values))

    def close(self) -> None:
        """Write what is left and the summary, and close the file.

        Warns
        -----
        UserWarning
            When rows were lost.

        Raises
        ------
        OSError
            When the file could not be written to its end; what was written before can be read.
        """
        if self._closed:
            return
        with self._lock:  # what was noted before is written, what comes later is refused
            self._ends.set()
        for thread in self._threads:
            thread.join()
        self._take_all()
        self._closed = True  # from here on: an interrupt before lets the next call do all of it
        atexit.unregister(self._at_exit)
        if self.error is None:
            try:
                self._writer.close(rows=self.written, lost=self.lost)
            except OSError as error:
                self.error = error
        if self.error is not None:
            self._writer.abandon()
            number = getattr(self.error, "errno", None) or errno.EIO
            why = getattr(self.error, "strerror", None) or self.error
            raise OSError(
                number,
                f"recording stopped after {self.written} rows: {why}; "
                "what was written can be read, and repaired by `ebac log repair`",
                str(self.path),
            ) from self.error
        if self.lost:
            warn(
                f"{self.path}: {plural(self.lost, 'row')} {'was' if self.lost == 1 else 'were'} lost, the recorder "
                "came too late; the log contains where. Give the loop a longer ring"
            )

    def _run(self) -> None:
        while self.error is None and not self._ends.wait(self._interval):
            self._take_all()

    def _sync(self, seconds: float) -> None:
        while self.error is None and not self._ends.wait(seconds):
            try:
                self._writer.sync()
            except OSError as error:
                self.error = error

    def _take_all(self) -> None:
        """Write all there is; an error ends the recording and is kept for `close`."""
        try:
            while self.error is None and self._take():
                pass
        except Exception as error:  # whatever it is: the loop must not end by it, nor it be silent
            self.error = error

    def _take(self) -> bool:
        """Write one chunk; return whether there was more than it holds.

        What came while it was written waits for the next interval: a fast loop always has a row or two more.
        """
        with self._lock:
            happened, self._waiting = self._waiting, []
        happened += self._watch()
        chunk = self._new.next()
        if not (len(chunk) or chunk.lost or happened):
            return False
        self.lost += chunk.lost
        self._writer.write(chunk.data, happened + chunk.events)
        self._new.done(chunk)
        self.written += len(chunk)
        return chunk.more

    def _at_exit(self) -> None:
        with contextlib.suppress(OSError):  # the interpreter ends: nobody is left to read it
            self.close()

    def __enter__(self) -> Self:
        """Return the recorder, which runs."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the log, whatever was raised."""
        self.close()

    def __repr__(self) -> str:
        """Return file, rows written and lost."""
        state = "closed" if self._ends.is_set() else "recording"
        return (
            f"<Recorder of {self.path}: {state}, {plural(self.written, 'row')}, {self.lost} lost>"
        )


def _plain(name: str, value: Any) -> Any:
    """Return a value as JSON has it, those of NumPy as Python's."""
    plain = value.tolist() if isinstance(value, (np.generic, np.ndarray)) else value
    try:
        json.dumps(plain)
    except (TypeError, ValueError) as error:
        kind = type(value).__name__
        raise TypeError(
            f"event: {name} = {value!r} ({kind}): a log takes what JSON has ({error})"
        ) from None
    return plain


def _nothing() -> Sequence[Event]:
    return ()


def _check(name: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise ValueError(f"Recorder.{name} = {value:g} s: must lie in [{low:g}, {high:g}] s")
