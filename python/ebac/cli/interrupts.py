"""Ctrl-C and SIGTERM on the command line: none is lost, and each says what is kept and how to go on."""

from __future__ import annotations

import _thread
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

import typer

from ebac._util.program import started
from ebac.cli.output import console

#: The signal that stopped the command.
_by: list[int] = [signal.SIGINT]
#: What Ctrl-C says of the command that runs now: what is kept, and how to go on.
_kept: list[Callable[[], str]] = []
_NOTHING = "nothing was written; the same command starts from the beginning"


def keeping(text: str | Callable[[], str]) -> None:
    """Set what Ctrl-C says from now on, or a function that returns it then: what is kept, and how to go on."""
    _kept[:] = [text if callable(text) else lambda: text]


def exit_code() -> int:
    """Return the exit code of a command that was stopped, as shells have it: 130 by Ctrl-C, 143 by SIGTERM."""
    return 128 + _by[0]


@contextmanager
def interruptible() -> Iterator[None]:
    """Turn Ctrl-C and SIGTERM into the end of the command: a sentence and exit code 130 or 143, no traceback."""
    _kept.clear()
    _by[:] = [signal.SIGINT]
    started()
    try:
        with _none_lost(), _as_ctrl_c():
            yield
    except KeyboardInterrupt as stopped:
        name = "Ctrl-C" if _by[0] == signal.SIGINT else signal.Signals(_by[0]).name
        happened = f"Stopped by {name}: {stopped}" if str(stopped) else f"Stopped by {name}"
        kept = _kept[0]() if _kept else _NOTHING
        console(stderr=True).print(f"{happened}; {kept}.", markup=False, soft_wrap=True)
        raise typer.Exit(exit_code()) from None


@contextmanager
def _none_lost() -> Iterator[None]:
    """Send Ctrl-C again that Python drops: it may come in a callback of a reference, of which each import has one."""
    before = sys.unraisablehook

    def hook(lost: sys.UnraisableHookArgs) -> None:
        if issubclass(lost.exc_type, KeyboardInterrupt):
            _thread.start_new_thread(_send_again, ())
        else:
            before(lost)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = before


def _send_again() -> None:
    time.sleep(0.01)  # the callback has ended
    os.kill(os.getpid(), _by[0])


@contextmanager
def _as_ctrl_c() -> Iterator[None]:
    """Take SIGTERM as Ctrl-C where nobody else takes it; a worker that inherits that ends at once."""
    here = os.getpid()

    def stop(number: int, frame: FrameType | None) -> None:
        if os.getpid() != here:
            os._exit(128 + number)
        _by[:] = [number]
        raise KeyboardInterrupt

    free = signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    if not free or threading.current_thread() is not threading.main_thread():
        yield
        return
    signal.signal(signal.SIGTERM, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


@contextmanager
def resumable(folder: Path | None) -> Iterator[None]:
    """Say on Ctrl-C how a command that keeps its finished runs in a folder goes on."""

    def again() -> str:
        if folder is None:
            return "give --out next time to keep finished runs"
        if not any(folder.glob("sweep*/sweep.json")):
            return _NOTHING
        kept = sum(1 for _ in folder.glob("sweep*/bundle-*.npz"))
        runs = (
            "finished runs are kept" if kept else "no run is kept yet, they are written in bundles"
        )
        return f"{runs}; continue with the same command and --resume --out {folder}"

    keeping(again)
    yield
    if folder is not None:
        keeping(
            f"the runs are kept; draw and print them with the same command and --resume --out {folder}"
        )
