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
    """Return what waits on standard input; nothing at its end."""
    ready, _, _ = select.select([sys.stdin], [], [], 0)
    return os.read(sys.stdin.fileno(), 4096) if ready else b""
