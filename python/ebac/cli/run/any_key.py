"""Any key ends a run: its force is zero in the next tick, without the ramp."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.hardware import Run


@contextmanager
def any_key() -> Iterator[Callable[[Run], None]]:
    """Give what a run calls while it runs; it stops the run once a key was pressed in this program's terminal.

    Keys are taken one by one and not shown until the end of the block. Without a terminal, or in the background of one,
    nothing is read. Ctrl-C stays what it is.
    """
    try:
        terminal = sys.stdin.fileno()
        here = os.isatty(terminal) and os.tcgetpgrp(terminal) == os.getpgrp()
    except (AttributeError, OSError, ValueError):  # no standard input, or none of a process
        here = False
    if not here:
        yield lambda run: None
        return
    import termios
    import tty

    before = termios.tcgetattr(terminal)

    def look(run: Run) -> None:
        if select.select([terminal], [], [], 0)[0]:
            os.read(terminal, 1024)
            run.stop(at_once=True, by="key")

    try:
        tty.setcbreak(terminal, termios.TCSADRAIN)
        termios.tcflush(terminal, termios.TCIFLUSH)
        yield look
    finally:
        termios.tcsetattr(terminal, termios.TCSAFLUSH, before)
