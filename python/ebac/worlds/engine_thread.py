"""An engine in a separate thread, for runs in real time."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Self

from ebac import _core
from ebac._core import BridgeParams
from ebac.worlds.engines import Engine, named
from ebac.worlds.posted_world import PostedWorld
from ebac.worlds.serving import answer_poses, checked_engine, checked_rate


class EngineError(RuntimeError):
    """An engine in its thread raised an error, its `__cause__`, or answered with no model."""

    def __init__(self, engine: Engine, error: Exception) -> None:
        super().__init__(engine, error)
        self.engine, self.error = engine, error

    def __str__(self) -> str:
        """Return engine and error in one sentence."""
        return (
            f"the engine {named(self.engine)} raised {type(self.error).__name__}: {self.error}; its thread ended "
            "there, and its force faded to zero"
        )


class EngineThread:
    """Calls an engine at a given rate, in a separate thread, for a loop in real time.

    The loop never waits for it: poses go to the thread and models come back through mailboxes that hold the newest
    value. An engine that raises ends the thread; its force fades within `stale + fade`, and leaving the `with` block
    raises an `EngineError` that names it. For an engine in another process, see `EngineProcess`.

    ::

        with EngineThread(engine, rate=60) as thread:
            device.run("ebac", thread.world, seconds=10)

    Parameters
    ----------
    engine : callable
        `engine(position, velocity)`, [m] and [m/s], returns a `LocalModel`, or None where no surface is near.
    rate : float
        Calls per second [Hz], [1, 1000]. A call that takes longer delays the next one.
    rendering : BridgeParams
        How models take over from each other and fade.
    """

    def __init__(
        self, engine: Engine, *, rate: float = 60.0, rendering: BridgeParams | None = None
    ) -> None:
        self._engine = checked_engine("EngineThread", engine)
        self._rate = checked_rate("EngineThread", rate)
        self._end = _core._EngineEnd()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self.error: BaseException | None = None
        chosen = BridgeParams() if rendering is None else rendering
        self.world = PostedWorld(self._end, chosen, "the engine's thread")

    def __enter__(self) -> Self:
        """Start the thread."""
        if self._thread is not None:
            raise RuntimeError("EngineThread: was started before; make a new one")
        self._thread = threading.Thread(target=self._serve, name="ebac-engine", daemon=True)
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop the thread; raise what the engine raised, unless something else was raised already."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join()
        if self.error is None or error is not None:
            return
        if not isinstance(self.error, Exception):  # an interrupt is raised as it is
            raise self.error
        raise EngineError(self._engine, self.error) from self.error

    def _serve(self) -> None:
        try:
            answer_poses(self._end, self._engine, self._rate, self._stop.wait)
        except BaseException as failed:
            self.error = failed
