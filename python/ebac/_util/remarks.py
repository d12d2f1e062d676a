"""Whether to warn of what is possible, but likely not what was meant."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_silent: ContextVar[bool] = ContextVar("silent", default=False)


def wanted(*, wrapped: bool = False) -> bool:
    """Return whether a line outside the package called the function that asks: a study of many runs is no such line.

    `wrapped` is whether that function stands behind a decorator.
    """
    name = sys._getframe(3 if wrapped else 2).f_globals.get("__name__", "")
    return not (_silent.get() or name == "ebac" or name.startswith("ebac."))


@contextmanager
def silent() -> Iterator[None]:
    """Leave remarks out: a command prints notes in their place."""
    token = _silent.set(True)
    try:
        yield
    finally:
        _silent.reset(token)
