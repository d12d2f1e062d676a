"""What an open device must let go of, whoever forgets it."""

from __future__ import annotations

import atexit
import os
from contextlib import ExitStack
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.hardware.run import Run


class Held:
    """What a device must let go of, whoever forgets it: its run first."""

    def __init__(self, stack: ExitStack) -> None:
        self.run: Run | None = None
        self._stack = stack
        self._process = os.getpid()

    def last_to_register(self) -> None:
        """Be the first to be called at the exit of the interpreter: before the recorder, and simulated drives."""
        atexit.unregister(self.close)
        atexit.register(self.close)

    def close(self) -> None:
        """End its run, and let go of all; in a forked process nothing, which has neither threads nor drives."""
        atexit.unregister(self.close)
        if os.getpid() != self._process:
            return
        try:
            if self.run is not None:
                self.run.end()
        finally:
            self._stack.close()
