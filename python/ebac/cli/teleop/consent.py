"""Enter as the consent of a hand: only what is typed after the question counts."""

from __future__ import annotations

import os
import select
import sys

#: Reads at most that forget what was typed: a program that types without end must not hold up the command.
_MOST = 100


class Consent:
    """Asks for Enter once the link is back. Reads nothing before, and never waits."""

    def __init__(self) -> None:
        self._asked = False

    @property
    def question(self) -> str:
        """What to show when the link is back; without a standard input, that nobody can agree."""
        if _keys() is not None:
            return "press Enter to go on"
        return "nobody can consent, as standard input is closed: end this, and start it again with a standard input"

    def ask(self) -> None:
        """Forget what was typed before, and wait for Enter from now on."""
        for _ in range(_MOST):
            if not _typed():
                break
        self._asked = True

    def withdraw(self) -> None:
        """Take the question back: the link has gone again, or somebody has agreed."""
        self._asked = False

    def given(self) -> bool:
        """Whether Enter was pressed since it was asked."""
        return self._asked and b"\n" in _typed()


def _typed() -> bytes:
    """Return what waits on standard input; nothing at its end, nor where there is none."""
    keys = _keys()
    if keys is None:
        return b""
    ready, _, _ = select.select([keys], [], [], 0)
    return os.read(keys, 4096) if ready else b""


def _keys() -> int | None:
    """Return the file of standard input; None where the program was started without one, or it was closed."""
    try:
        return sys.stdin.fileno()
    except (AttributeError, OSError, ValueError):
        return None
