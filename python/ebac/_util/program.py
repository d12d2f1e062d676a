"""The program `ebac` around its commands: Ctrl-C while it still imports, and a standard output that takes no more."""

from __future__ import annotations

import os
import signal
import sys
from io import TextIOWrapper
from types import FrameType
from typing import Any, NoReturn, TextIO, cast


def begin() -> None:
    """Prepare the process, before anything that takes time is imported."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _leave)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="replace")  # a bullet in a terminal of Latin-1
    if sys.stdout is not None:
        sys.stdout = cast("TextIO", _Output(sys.stdout))


def started() -> None:
    """Let Ctrl-C raise KeyboardInterrupt, as a command is there that says what it keeps."""
    if signal.getsignal(signal.SIGINT) is _leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _leave(number: int, frame: FrameType | None) -> NoReturn:
    os._exit(130)  # an exception could be lost in what is imported


class _Output:
    """Standard output; where it takes no more the program ends: well when its reader has gone, else with a sentence."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        try:
            return self._stream.write(text)
        except OSError as error:
            self._end(error)

    def flush(self) -> None:
        try:
            self._stream.flush()
        except OSError as error:
            self._end(error)

    def _end(self, error: OSError) -> NoReturn:
        # What is left in the buffer goes nowhere, or Python would report it at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), self._stream.fileno())
        if isinstance(error, BrokenPipeError):
            raise SystemExit(0)
        sys.exit(f"Error: standard output: cannot be written ({error.strerror})")
