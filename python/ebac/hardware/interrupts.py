"""What may end a run from outside: signals, and the death of the parent."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, Self

from ebac._util.parent import parent_gone

#: Signals that end a run; what the system sends when somebody types Ctrl-C, ends a process, or closes a terminal.
SIGNALS = (signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else []))
#: Those that would end or freeze the process in the middle of a run, and end the run where nobody else takes them.
OTHERS = tuple(
    getattr(signal, name)
    for name in ("SIGQUIT", "SIGTSTP", "SIGUSR1", "SIGUSR2", "SIGALRM")
    if hasattr(signal, name)
)
#: How often somebody looks whether the parent is still there [s].
PARENT = 0.1


class Terminated(SystemExit):
    """The process received a signal to end (SIGTERM, ...). Everything that moved was stopped before this is raised.

    Attributes
    ----------
    signal : signal.Signals
        The signal received.
    """

    def __init__(self, number: int) -> None:
        super().__init__(128 + number)
        self.signal = signal.Signals(number)


class Interrupts:
    """Signals as exceptions in the main thread, but never in the middle of a stop. A context manager.

    The first one while something moves is raised where the main thread stands: KeyboardInterrupt for SIGINT,
    `Terminated` for the others. From then on, or from `ending`, they are kept until `settled`: a second Ctrl-C does not
    keep a motor on, but calls `hurry`. Elsewhere than in the main thread Python takes no signals, and nothing changes.
    Several may be open, and be closed in any order.
    """

    def __init__(self) -> None:
        self._moving = False
        self._ending = False
        self._kept: int | None = None
        self.first: int | None = None  #: number of the signal that ended what moved last
        self.hurry: Callable[[], None] = lambda: None  #: leaves out what is gentle in the stop

    def __enter__(self) -> Self:
        _HANDLERS.add(self)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        _HANDLERS.remove(self)

    def moving(self) -> None:
        """Take the next signal as the end of what moves from here on."""
        self._moving, self._ending, self._kept, self.first = True, False, None, None

    def ending(self) -> None:
        """Keep every signal from here on: what moves is being stopped, and nothing may come in between."""
        self._ending = True

    def forget(self) -> int | None:
        """Nothing moves any more; return the signal that came while it was stopped, if any did."""
        kept, self._kept = self._kept, None
        self._moving = self._ending = False
        return kept

    def settled(self) -> None:
        """Nothing moves any more. A signal that came while it was stopped, and was not the reason, is raised now."""
        kept = self.forget()
        here = threading.current_thread() is threading.main_thread()
        if kept is not None and self.first is None and here:
            _raise(kept)

    @property
    def stops(self) -> bool:
        """Whether what moved is being stopped, so that no exception may come in between."""
        return self._ending

    def end(self, number: int) -> None:
        """End what moves by a signal that is raised now."""
        if self._moving:
            self._ending, self.first = True, number

    def keep(self, number: int) -> None:
        """Keep a signal that cannot be raised now; what moves or is being stopped ends at once."""
        if self._moving or self._ending:
            self._kept = number
            self.hurry()


class _Handlers:
    """The handlers of this process while any `Interrupts` is open: what was there before comes back with the last."""

    def __init__(self) -> None:
        self._open: list[Interrupts] = []
        self._before: dict[int, Any] = {}

    def add(self, one: Interrupts) -> None:
        if threading.current_thread() is not threading.main_thread():
            return
        self._open.append(one)
        free = [other for other in OTHERS if signal.getsignal(other) == signal.SIG_DFL]
        for number in (*SIGNALS, *free):
            if signal.getsignal(number) != self._take:  # a program may have set its own in between
                self._before[number] = signal.signal(number, self._take)

    def remove(self, one: Interrupts) -> None:
        if one in self._open:
            self._open.remove(one)
        if not self._open and threading.current_thread() is threading.main_thread():
            self._restore()

    def _restore(self) -> None:
        for number, handler in self._before.items():
            if signal.getsignal(number) == self._take:
                signal.signal(number, handler)
        self._before = {}

    def _take(self, number: int, frame: FrameType | None) -> None:
        if not self._open:  # the last was closed in another thread, where no handler can be set
            self._restore()
            signal.raise_signal(number)
            return
        if any(one.stops for one in self._open):
            for one in self._open:
                one.keep(number)
            return
        for one in self._open:
            one.end(number)
        _raise(number)


_HANDLERS = _Handlers()


def _raise(number: int) -> None:
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    raise Terminated(number)


class OfParent(threading.Thread):
    """Looks whether the parent has died, until `over` is set; then nobody is left who could end what runs."""

    def __init__(self, gone: Callable[[], None]) -> None:
        super().__init__(name="ebac-parent", daemon=True)
        self.over = threading.Event()
        self._gone = gone
        self.start()

    def run(self) -> None:
        """Look until it is over."""
        while not self.over.wait(PARENT):
            if parent_gone():
                self._gone()
                return
