"""Warnings of what is possible, but likely not what was meant."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_silent: ContextVar[bool] = ContextVar("silent", default=False)


def remark(text: str) -> None:
    """Warn once of what a call was given, at the line that called the package; nothing without a text."""
    if text and not _silent.get():
        warnings.warn(text, UserWarning, stacklevel=_outside())


@contextmanager
def silent() -> Iterator[None]:
    """Leave remarks out: a command prints notes in their place."""
    token = _silent.set(True)
    try:
        yield
    finally:
        _silent.reset(token)


def _outside() -> int:
    """Return how many calls above the caller of this function the first one outside the package is, from 1."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None:
        name = frame.f_globals.get("__name__", "")
        if name != "ebac" and not name.startswith("ebac."):
            break
        frame, level = frame.f_back, level + 1
    return level
