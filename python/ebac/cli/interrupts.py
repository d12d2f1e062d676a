"""Ctrl-C on the command line: none is lost, and each says what is kept and how to go on."""

from __future__ import annotations

import _thread
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import typer

from ebac._util.program import started
from ebac.cli.output import console

#: Exit code of a keyboard interrupt, as shells have it.
INTERRUPTED = 130

#: What Ctrl-C says of the command that runs now: what is kept, and how to go on.
_kept: list[Callable[[], str]] = []
_NOTHING = "nothing was written; the same command starts from the beginning"


def keeping(text: str | Callable[[], str]) -> None:
    """Set what Ctrl-C says from now on, or a function that returns it then: what is kept, and how to go on."""
    _kept[:] = [text if callable(text) else lambda: text]


@contextmanager
def interruptible() -> Iterator[None]:
    """Turn Ctrl-C into the end of the command: a sentence and exit code 130, no traceback."""
    _kept.clear()
    started()
    try:
        with _none_lost():
            yield
    except KeyboardInterrupt as stopped:
        happened = f"Stopped by Ctrl-C: {stopped}" if str(stopped) else "Stopped by Ctrl-C"
        kept = _kept[0]() if _kept else _NOTHING
        console(stderr=True).print(f"{happened}; {kept}.", markup=False, soft_wrap=True)
        raise typer.Exit(INTERRUPTED) from None


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
    os.kill(os.getpid(), signal.SIGINT)


@contextmanager
def resumable(what: str, folder: Path | None) -> Iterator[None]:
    """Say on Ctrl-C how `what`, which keeps its finished runs in a folder, goes on."""

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
