"""The log of a run, begun before there is power."""

from __future__ import annotations

import io
from pathlib import Path

from ebac.logs.writer import discard


def discard_log(file: io.FileIO | None, path: Path | None) -> None:
    """Take away a log that no run was recorded to."""
    if file is not None and path is not None:
        discard(file, path)


def free_log(path: Path) -> Path:
    """Return the path, for a log that is not there yet.

    Raises
    ------
    ValueError
        When it does not end in .mcap.
    FileExistsError
        When there is such a file.
    """
    if path.suffix != ".mcap":
        raise ValueError(
            f"log = {path}: must end in .mcap; `ebac log export` makes other formats of it"
        )
    if path.exists():
        raise FileExistsError(
            17, "There is such a file already; a log is never written over", str(path)
        )
    return path
