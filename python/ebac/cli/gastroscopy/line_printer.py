"""Lines for a terminal that may be stopped, while somebody watches drives."""

from __future__ import annotations

import threading
from queue import SimpleQueue
from types import TracebackType
from typing import IO, Self

import typer


class LinePrinter:
    """Prints lines in a thread of its own: a stopped terminal (Ctrl-S) or a full pipe holds up nobody.

    A context manager.

    Parameters
    ----------
    file : text file, optional
        Where to; default: standard output.
    err : bool
        To standard error instead.
    """

    #: How long its end waits for what is still to be printed [s].
    LONGEST = 1.0

    def __init__(self, file: IO[str] | None = None, *, err: bool = False) -> None:
        self._lines: SimpleQueue[str | None] = SimpleQueue()
        self._thread = threading.Thread(
            target=self._work, args=(file, err), name="ebac-line-printer", daemon=True
        )
        self._thread.start()

    def say(self, text: str) -> None:
        """Print a line, soon."""
        self._lines.put(text)

    def close(self) -> None:
        """Wait until all is printed, but no longer than a second."""
        self._lines.put(None)
        self._thread.join(self.LONGEST)

    def _work(self, file: IO[str] | None, err: bool) -> None:
        while (text := self._lines.get()) is not None:
            try:
                typer.echo(text, file=file, err=err)
            except OSError:  # nobody listens any more
                return

    def __enter__(self) -> Self:
        """Return it."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it."""
        self.close()
