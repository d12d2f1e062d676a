"""What an open device must let go of, whoever forgets it."""

from __future__ import annotations

import atexit
from contextlib import ExitStack
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.hardware.run import Run


class Held:
    """What a device must let go of, whoever forgets it: its run first."""

    def __init__(self, stack: ExitStack) -> None:
        self.run: Run | None = None
        self._stack = stack

    def last_to_register(self) -> None:
        """Be the first to be called at the exit of the interpreter: before the recorder, and simulated drives."""
        atexit.unregister(self.close)
        atexit.register(self.close)

    def close(self) -> None:
        """End its run, and let go of all."""
        atexit.unregister(self.close)
        try:
            if self.run is not None:
                self.run.end()
        finally:
            self._stack.close()
