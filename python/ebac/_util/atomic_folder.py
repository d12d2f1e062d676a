"""A folder of results: written whole or not at all."""

from __future__ import annotations

import os
import platform
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory

#: Where there are no locks: a disk, or a system, that has none.
NO_LOCKS = (OSError, ImportError)


def is_abandoned(path: Path) -> bool:
    """Return whether a path is the draft of a process of this machine that was killed: its lock ended with it."""
    if not path.name.startswith(_prefix()):
        return False
    try:
        with locked(path, wait=False):
            return True
    except NO_LOCKS:  # or it is at work
        return False


def has_files(folder: Path) -> bool:
    """Return whether a folder has files, or another process is about to write some."""
    return folder.is_dir() and not all(map(is_abandoned, folder.iterdir()))


@contextmanager
def claimed(folder: Path) -> Iterator[bool]:
    """Give whether a folder had no files, and keep it from others; it is made, and removed where it stays empty.

    Raises
    ------
    OSError
        When it is a file or cannot be made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with ExitStack() as claim:
        claim.callback(_remove_empty, folder)
        with ExitStack() as looking:
            with suppress(*NO_LOCKS):
                looking.enter_context(locked(folder))
            free = not has_files(folder)
            if free:
                _in_use(folder, claim)
        yield free


def _remove_empty(folder: Path) -> None:
    with suppress(OSError):  # not empty
        folder.rmdir()


@contextmanager
def filled(out: str | Path) -> Iterator[Path]:
    """Give a draft folder whose files move to `out` when all of them are written; remove those of killed processes.

    Raises
    ------
    OSError
        When `out` is a file or cannot be written; before anything else is done.
    """
    target = Path(out)
    new = not target.exists()
    target.mkdir(parents=True, exist_ok=True)
    try:
        with _draft(target) as draft:
            yield draft
            for file in sorted(draft.iterdir()):
                file.replace(target / file.name)
    except BaseException:
        if new:
            _remove_empty(target)
        raise


@contextmanager
def _draft(target: Path) -> Iterator[Path]:
    """Give a new folder in `target` that is locked while it is there, so that others know it is in use."""
    with ExitStack() as stack:
        with ExitStack() as making:
            with suppress(*NO_LOCKS):  # nothing is removed
                making.enter_context(locked(target))
                for old in filter(is_abandoned, target.iterdir()):
                    shutil.rmtree(old, ignore_errors=True)
            draft = _in_use(target, stack)
        yield draft


def _in_use(folder: Path, stack: ExitStack) -> Path:
    """Return a hidden folder in another one, locked until the stack is closed: who looks there knows it is in use."""
    draft = Path(stack.enter_context(TemporaryDirectory(prefix=_prefix(), dir=folder)))
    with suppress(*NO_LOCKS):
        stack.enter_context(locked(draft))
    return draft


@contextmanager
def locked(folder: Path, *, wait: bool = True) -> Iterator[None]:
    """Lock a folder against other processes.

    Raises
    ------
    BlockingIOError
        When it is locked, and this shall not wait.
    OSError, ImportError
        Of `NO_LOCKS`.
    """
    import fcntl  # not on Windows

    number = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(number, fcntl.LOCK_EX if wait else fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    finally:
        os.close(number)


def _prefix() -> str:
    return f".draft-{platform.node()}-"
