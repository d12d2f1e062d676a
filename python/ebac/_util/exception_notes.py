"""What to do when leaving fails, and something else has failed already."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def noted_on(error: BaseException | None, words: str) -> Iterator[None]:
    """Raise what the block raises; where an error is under way already, note it on that one.

    Parameters
    ----------
    error : BaseException or None
        What is under way; it stays the one that people see.
    words : str
        What the block was about: "and the drive could not be disabled".
    """
    try:
        yield
    except Exception as failure:
        if error is None:
            raise
        error.add_note(f"{words}: {failure}")
