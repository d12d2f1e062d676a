"""Whether to warn of what is possible, but likely not what was meant."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

#: Its functions stand between a call and what was called.
_DECORATORS = "ebac._util.wrong_calls"
_silent: ContextVar[bool] = ContextVar("silent", default=False)


def wanted() -> bool:
    """Return whether a line outside the package called the function that asks: a study of many runs is no such line."""
    frame = sys._getframe(2)
    while (name := frame.f_globals.get("__name__", "")) == _DECORATORS and frame.f_back is not None:
        frame = frame.f_back
    return not (_silent.get() or name == "ebac" or name.startswith("ebac."))


@contextmanager
def silent() -> Iterator[None]:
    """Leave remarks out: a command prints notes in their place."""
    token = _silent.set(True)
    try:
        yield
    finally:
        _silent.reset(token)
