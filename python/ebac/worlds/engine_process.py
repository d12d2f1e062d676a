"""An engine in a separate process, for runs in real time."""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import subprocess
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Self

from ebac import _core
from ebac._core import BridgeParams
from ebac._util.arguments import number
from ebac.worlds.posted_world import PostedWorld

#: The variable of the environment that names the channel.
VARIABLE = "EBAC_ENGINE_CHANNEL"

#: How often a start is looked after [s], and how long an end may take before it is asked for more firmly [s].
_LOOK, _END = 0.01, 2.0


class EngineProcess:
    """An engine in another process, beside a loop in real time.

    The loop never waits for it: poses and models pass through memory that both share, which holds the newest value. The
    program calls `serve_engine`, or in C++ has an `ebac::world::EngineClient`; it finds the loop by the environment
    variable EBAC_ENGINE_CHANNEL. Where it dies or stops posting, its force fades within `stale + fade`, and the run
    says so. It is ended with the `with` block.

    ::

        with EngineProcess([sys.executable, "engine.py"]) as process:
            device.run("ebac", process.world, seconds=10)

    Parameters
    ----------
    command : sequence of str, or str, optional
        Program and arguments. None for one that is started by hand, with `name` as its channel.
    rendering : BridgeParams
        How models take over from each other and fade.
    name : str, optional
        Of the channel, of letters, digits and `._-`; one of its own, if not given.
    patience : float
        How long the program may take to open the channel [s].

    Attributes
    ----------
    world
        What the program posts, for a run.

    Raises
    ------
    TypeError
        For a command that is neither a string nor a sequence.
    ValueError
        For no program, or a name that is none or is taken.
    OSError
        Where memory cannot be shared.
    """

    def __init__(
        self,
        command: str | Sequence[str] | None = None,
        *,
        rendering: BridgeParams | None = None,
        name: str | None = None,
        patience: float = 10.0,
    ) -> None:
        self.command = _words(command)
        if self.command is None and name is None:
            raise ValueError(
                "EngineProcess: give a command that starts the engine, or the name of a channel for one that is "
                "started by hand"
            )
        self.rendering = BridgeParams() if rendering is None else rendering
        if not number("EngineProcess.patience", patience) > 0:
            raise ValueError(f"EngineProcess.patience = {patience} s: must be above 0 s")
        self._patience = patience
        self._channel = _core._SharedEngineChannel("" if name is None else name)
        self._program: subprocess.Popen[bytes] | None = None
        self._ended = False
        self.world = PostedWorld(
            self._channel, self.rendering, "the engine's process", lambda: self.trouble
        )

    @property
    def name(self) -> str:
        """Name of the channel."""
        return self._channel.name

    @property
    def posted(self) -> int:
        """Models that the engine has posted."""
        return int(self._channel.posted)

    @property
    def alive(self) -> bool:
        """Whether the engine has opened its end, has not closed it, and its process is at work."""
        return bool(self._channel.engine_lives)

    @property
    def trouble(self) -> str:
        """What has happened to it, empty if nothing: it never came, or it has ended before its loop."""
        if self._ended or self.alive:
            return ""
        if self._program is not None and (code := self._program.poll()) is not None:
            return f"the engine {self._said} {_how(code)}"
        if not self._channel.engine:
            return f"no engine has opened the channel {self.name}"
        return f"the engine {self._said} (process {self._channel.engine}) has left its channel"

    @property
    def _said(self) -> str:
        return f"on {self.name}" if self.command is None else f"`{shlex.join(self.command)}`"

    def __enter__(self) -> Self:
        """Start the program, and wait until it has opened its end.

        Raises
        ------
        RuntimeError
            When it does not, or was started before.
        """
        if self._program is not None or self._ended:
            raise RuntimeError("EngineProcess: was started before; make a new one")
        try:
            if self.command is not None:
                self._program = self._started(self.command)
            self._wait()
        except BaseException:
            self.close()
            raise
        return self

    def _started(self, command: Sequence[str]) -> subprocess.Popen[bytes]:
        try:
            return subprocess.Popen(
                command,
                env=os.environ | {VARIABLE: self.name},
                stdin=subprocess.DEVNULL,
                stdout=2,  # what it says is no result of this program
                start_new_session=True,  # Ctrl-C is for the loop: its world must be there until it has stopped
            )
        except OSError as error:
            raise RuntimeError(
                f"the engine {self._said} cannot be started: {error.strerror}"
            ) from None

    def _wait(self) -> None:
        until = time.monotonic() + self._patience
        while not self._channel.engine:
            if self._program is not None and self._program.poll() is not None:
                raise RuntimeError(
                    f"{self.trouble} before it opened its channel; what it said is above"
                )
            if time.monotonic() > until:
                raise RuntimeError(
                    f"the engine {self._said} has not opened the channel {self.name} within {self._patience:g} s: a "
                    "Python program calls ebac.worlds.serve_engine, one in C++ has an ebac::world::EngineClient"
                )
            time.sleep(_LOOK)

    def close(self) -> None:
        """Tell the engine that the loop has ended, and end its program; nothing the second time."""
        self._ended = True
        self._channel.end()
        program = self._program
        if program is None:
            return
        if not _ends(program):
            program.terminate()
            if not _ends(program):
                program.kill()
                program.wait()
        _end_group(program.pid)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End it."""
        self.close()


def _ends(program: subprocess.Popen[bytes]) -> bool:
    """Return whether a program ends within a while."""
    try:
        program.wait(_END)
    except subprocess.TimeoutExpired:
        return False
    return True


def _end_group(leader: int) -> None:
    """End what a program that has ended has started itself, as a shell does."""
    # One that is stopped ends when it goes on.
    for how in (signal.SIGTERM, signal.SIGCONT, signal.SIGKILL):
        until = time.monotonic() + (0 if how is signal.SIGTERM else _END)
        try:
            os.killpg(leader, how)
            while time.monotonic() < until:
                os.killpg(leader, 0)
                time.sleep(_LOOK)
        except (ProcessLookupError, PermissionError):
            return


def _words(command: str | Sequence[str] | None) -> list[str] | None:
    if command is None:
        return None
    given: object = command
    if isinstance(given, bytes) or not isinstance(given, Sequence):
        raise TypeError(
            f"EngineProcess.command = {command!r}: must be a string, or a sequence of strings"
        )
    try:
        words = shlex.split(command) if isinstance(command, str) else [str(one) for one in command]
    except ValueError as error:
        raise ValueError(f"EngineProcess.command = {command!r}: {error}") from None
    if not words:
        raise ValueError("EngineProcess.command: is empty; give a program and its arguments")
    if shutil.which(words[0]) is None:
        raise ValueError(
            f"EngineProcess.command: there is no program {words[0]!r} that could be run; give its path, or an "
            "interpreter and the file"
        )
    return words


def _how(code: int) -> str:
    """Return how a process ended."""
    if code >= 0:
        return f"has ended with exit code {code}"
    try:
        return f"was killed by {signal.Signals(-code).name}"
    except ValueError:
        return f"was killed by signal {-code}"
