"""A folder of results: written whole or not at all."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory


@contextmanager
def filled(out: str | Path) -> Iterator[Path]:
    """Give a draft folder whose files move to `out` when all of them are written.

    Raises
    ------
    OSError
        When `out` is a file or cannot be written; before anything else is done.
    """
    target = Path(out)
    new = not target.exists()
    target.mkdir(parents=True, exist_ok=True)
    try:
        with TemporaryDirectory(prefix=".draft-", dir=target) as draft:
            yield Path(draft)
            for file in sorted(Path(draft).iterdir()):
                file.replace(target / file.name)
    except BaseException:
        if new:
            with suppress(OSError):  # not empty
                target.rmdir()
        raise
