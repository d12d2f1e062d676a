"""Commands of `ebac` in processes of their own, for a run of several."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from tempfile import TemporaryFile
from typing import IO, NamedTuple

from ebac._core import Link
from ebac._util.arguments import shown


class Child(NamedTuple):
    """A process, and the files of what it prints."""

    process: subprocess.Popen[bytes]
    out: IO[bytes]
    err: IO[bytes]


@contextmanager
def started(words: Sequence[str]) -> Iterator[Child]:
    """Start `ebac` with these words; it ends with the block at the latest."""
    command = [sys.executable, "-m", "ebac.cli", *words]
    with TemporaryFile() as out, TemporaryFile() as err:
        process = subprocess.Popen(command, stdout=out, stderr=err)
        try:
            yield Child(process, out, err)
        finally:
            end(process)


def text(file: IO[bytes]) -> str:
    """Return what a process has printed so far."""
    file.seek(0)
    return file.read().decode()


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
