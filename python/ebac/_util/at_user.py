"""Warnings at the line of the user, however deep in the package they arise."""

from __future__ import annotations

import sys
import warnings

#: Packages whose lines are not the user's: this one, and the blocks and decorators that lie between its functions.
_WITHIN = ("ebac", "contextlib")


def warn(text: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the nearest line outside this package that led here."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and _is_within(frame.f_globals.get("__name__", "")):
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)


def _is_within(module: str) -> bool:
    return module.partition(".")[0] in _WITHIN
