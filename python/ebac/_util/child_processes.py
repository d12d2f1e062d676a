"""Commands of `ebac` in processes of their own, for a run of several."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from tempfile import TemporaryFile
from typing import IO, Any, NamedTuple

from ebac._core import Link
from ebac._util.arguments import shown


class Child(NamedTuple):
    """A process, and the files of what it prints."""

    process: subprocess.Popen[bytes]
    out: IO[bytes]
    err: IO[bytes]


@contextmanager
def started(words: Sequence[str], **more: Any) -> Iterator[Child]:
    """Start `ebac` with these words, and `more` for Popen; it ends with the block at the latest."""
    command = [sys.executable, "-m", "ebac", *words]
    with TemporaryFile() as out, TemporaryFile() as err:
        process = subprocess.Popen(command, stdout=out, stderr=err, **more)
        try:
            yield Child(process, out, err)
        finally:
            end(process)


def text(file: IO[bytes]) -> str:
    """Return what a process has printed so far."""
    # Not by seek and read: the process writes where this file stands.
    data = os.pread(file.fileno(), os.fstat(file.fileno()).st_size, 0)
    return data.decode(errors="replace")  # the last character may not yet be whole


def last_report(printed: str) -> dict[str, Any]:
    """Return the last line that is a report, as a command prints with --json; an empty one without it."""
    for line in reversed(printed.splitlines()):
        try:
            found = json.loads(line)
        except ValueError:
            continue
        if isinstance(found, dict) and "command" in found:
            return found
    return {}


def first_lines(child: Child, count: int, seconds: float) -> list[str]:
    """Return the first lines that a process prints; fewer where it ends, or the time [s] does."""
    latest = time.monotonic() + seconds
    while text(child.out).count("\n") < count and child.process.poll() is None:
        if time.monotonic() > latest:
            break
        time.sleep(0.01)
    return text(child.out).split("\n")[:-1][:count]


def end(process: subprocess.Popen[bytes], patience: float = 20.0) -> None:
    """End a process, by force where it does not within `patience` [s]."""
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(timeout=patience)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def link_options(link: Link) -> list[str]:
    """Return a link as options of `ebac teleop network`.

    Raises
    ------
    TypeError
        For something else.
    """
    if not isinstance(link, Link):
        raise TypeError(f"link = {shown(link)}: must be a Link")
    return [
        word
        for name, value in link.as_dict().items()
        for word in ("--" + name.replace("_", "-"), str(value))
    ]
