"""What code of a user's own raised, and where."""

from __future__ import annotations

import sysconfig
import traceback
from pathlib import Path

#: Files that are nobody's law, hand or world: this package, the standard library and installed packages.
_OTHERS = (
    Path(__file__).resolve().parents[1],
    *(Path(sysconfig.get_path(name)) for name in ("stdlib", "platlib", "purelib")),
)


def raised(error: BaseException) -> str:
    """Return an error in words: its type, its text, and the file and line of the user's own that raised it.

    The innermost such line counts: an error of NumPy stands where NumPy was called. Where no line of the user's is in
    the traceback, as for a law that returned a text, there is none in the words.
    """
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        file = Path(frame.filename)
        if not file.is_file() or any(file.resolve().is_relative_to(one) for one in _OTHERS):
            continue
        return f"{type(error).__name__}: {error} ({file.name}, line {frame.lineno})"
    return f"{type(error).__name__}: {error}"
