"""Work in a thread of its own, while the caller shows the progress and receives Ctrl-C."""

from __future__ import annotations

import _thread
from collections.abc import Callable
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from ebac._core import SweepProgress

T = TypeVar("T")


class Background(Generic[T]):
    """Work in a thread of its own, which starts at once; one thread may wait for it.

    Neither a `Thread` nor a `Future`: these take locks in Python code. Ctrl-C in a wrong moment leaves such a lock
    taken, and then the work waits for ever to hand over its result.
    """

    def __init__(self, work: Callable[[], T]) -> None:
        self._result: list[T] = []
        self._raised: BaseException | None = None
        self._done = False
        self._over = _thread.allocate_lock()
        self._over.acquire()

        def run() -> None:
            try:
                self._result.append(work())
            except BaseException as error:  # raised in the thread that waits
                self._raised = error
            self._done = True
            self._over.release()

        _thread.start_new_thread(run, ())

    def wait(self, seconds: float = -1.0) -> bool:
        """Return whether it is done, after waiting for that: so long at most [s], or as long as it takes."""
        if not self._done:
            self._over.acquire(timeout=seconds)
        return self._done

    def result(self) -> T:
        """Wait for the work; return what it returned, or raise what it raised."""
        self.wait()
        if self._raised is not None:
            raise self._raised
        return self._result[0]


def cancellable(
    work: Callable[[SweepProgress], T], progress: Callable[[int], None] | None = None
) -> T:
    """Return what work of the core returns; Ctrl-C cancels it and waits until it has ended.

    Parameters
    ----------
    work : function
        Takes what it counts its runs in, and looks there whether it is cancelled.
    progress : function, optional
        Called with the runs done, some times a second and at the end.
    """
    from ebac._core import SweepProgress

    state = SweepProgress()
    running = None
    try:
        running = Background(lambda: work(state))
        while not running.wait(0.1):
            if progress is not None:
                progress(state.done)
    except BaseException:
        state.cancel()
        if running is not None:
            running.wait()
        raise
    if progress is not None:
        progress(state.done)
    return running.result()
