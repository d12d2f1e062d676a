"""Names of the files of a run: none is ever used twice."""

from __future__ import annotations

import time
from contextlib import suppress
from itertools import count
from pathlib import Path

from ebac.cli import output


def free_stem(folder: Path | None) -> Path | None:
    """Return the name of all files of this run, without extension; a hidden file keeps other runs from it."""
    if folder is None:
        return None
    now = time.strftime("run-%Y%m%d-%H%M%S", time.gmtime())
    with output.writing(f"--out {folder}", "folder"):
        folder.mkdir(parents=True, exist_ok=True)
        for number in count(1):
            stem = folder / (now if number == 1 else f"{now}-{number}")
            if not stem.with_suffix(".mcap").exists() and _claimed(stem):
                break
    return stem


def leave(stem: Path) -> None:
    """Give up the claim on a name, and remove the folder where nothing was written."""
    with suppress(OSError):  # the folder is not empty: it has what the run gave
        _claim(stem).unlink()
        stem.parent.rmdir()


def _claim(stem: Path) -> Path:
    return stem.with_name(f".{stem.name}.claim")


def _claimed(stem: Path) -> bool:
    try:
        _claim(stem).touch(exist_ok=False)
    except FileExistsError:  # another run has this name
        return False
    return True
