"""A file: written whole or not at all; until then the one of that name stays as it is."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from secrets import token_hex
from stat import S_IMODE, S_ISREG


@contextmanager
def draft(path: str | Path) -> Iterator[Path]:
    """Give the name of a file to write; it takes the place of `path` once it is whole, and is removed otherwise.

    A file that is replaced keeps its permissions and, where that is allowed, its owner; where `path` is a link, the
    file that it leads to is replaced. A pipe, a device or /dev/stdout cannot be, and is given itself.

    Raises
    ------
    OSError
        When the file cannot be written, or is write-protected; the error names `path`, not the draft.
    """
    file = _behind(Path(path))
    if file is None:
        yield Path(path)
        return
    name = file.with_name(f".{file.name[:40]}.{token_hex(8)}.draft")
    try:
        old = file.stat() if file.exists() else None
        if old is not None:  # a draft would get past its write protection
            os.close(os.open(file, os.O_WRONLY))
        yield name
        with name.open("rb") as written:
            os.fsync(written.fileno())  # or a crash may leave the name, and nothing in the file
        if old is not None:
            with suppress(PermissionError):  # only root gives files away
                os.chown(name, old.st_uid, old.st_gid)
            name.chmod(S_IMODE(old.st_mode))
        name.replace(file)
    except OSError as error:
        number, why = error.errno or errno.EIO, error.strerror or str(error)
        raise OSError(number, why, str(path)) from None
    finally:
        with suppress(OSError):  # a folder that is none has no draft either
            name.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write a text file in UTF-8 as `draft` does.

    Raises
    ------
    OSError
        As `draft`.
    """
    with draft(path) as name:
        name.write_text(text, encoding="utf-8", newline="")


def _behind(path: Path) -> Path | None:
    """Return the file that a path leads to, there or not; None for one that is open, as /dev/stdout, or no file."""
    with suppress(FileNotFoundError):
        if not S_ISREG(path.stat().st_mode):
            return None
    while path.is_symlink():
        if path.parent.resolve().is_relative_to("/proc"):  # others write to it, too
            return None
        path = path.parent / path.readlink()
    return path
