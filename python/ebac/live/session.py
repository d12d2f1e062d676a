"""A loop at work that a page, or a program, may change while it runs: `ebac.live.Session`."""

from __future__ import annotations

import threading
import time
from math import ceil
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from ebac._util.wrong_calls import plain_constructor
from ebac.hardware import Configuration, OpenDevice, Run
from ebac.hardware.virtual_device import VirtualDevice, VirtualRun
from ebac.laws import LAWS, AnyLaw, law_name
from ebac.live.choices import CONFIGURED, RANGES, Choices, base_of
from ebac.live.device_limits import DeviceLimits
from ebac.live.intended_hand import IntendedHand
from ebac.live.session_changes import SessionChanges
from ebac.live.virtual_time import STEP, VirtualTime
from ebac.scenario import Scenario

#: How often the hand moves and somebody looks after the loop [s].
LOOK = 1 / 60
#: Longest silence of who holds the dead-man key [s].
DEAD_MAN = 0.3


@plain_constructor
class Session(SessionChanges):
    """A loop that can be changed while it runs, in real time or on a virtual clock. A context manager; any thread.

    Parameters
    ----------
    given : Scenario or Configuration, optional
        What to begin with; default: the paper's joystick on simulated drives, at a wall of 10 kN/m.
    device : OpenDevice, optional
        A device that is open, as hardware is; it stays open. Without it simulated drives, device and hand.
    dead_man : bool, optional
        Whether the loop has power only while `hold` is called again within 0.3 s; on hardware always.
    law : str, law class, Variant or law, optional
        The law to begin with. One that is not of `ebac.LAWS`, which must be compiled, can be chosen by its name beside
        them.
    observer : bool, optional
        Whether the loop begins with the state observer; default: as given, else with it. A device that was given
        decides by its configuration.
    virtual : bool, optional
        Whether the clock is virtual, as of `ebac run --virtual`: no tick is late, and what runs depends on orders and
        their ticks alone.
    paced : bool, optional
        Whether a virtual clock follows the one on the wall; without it `advance` alone moves it.
    max_stiffness, max_damping : float, optional
        Of a surface that may be chosen on a device that was given [N/m, N s/m]; default: those of its own world.
    folder : path
        Where logs and scenarios go.

    Attributes
    ----------
    choices : Choices
        What is chosen.
    hand : IntendedHand
        Where the simulated hand wants to be.
    run : Run or None
        The loop, once there is one.
    kept : list of Path
        Files written.
    trouble : str
        Why a drive could not be seen to be without power, a log not be written, or a run not be watched; empty if all
        is well.
    ranges : dict
        From where to where stiffness, damping and delay may be chosen.

    Raises
    ------
    ValueError
        For an unknown law, a limit that is none, a device on a virtual clock, an observer without a force sensor.
    """

    def __init__(
        self,
        given: Scenario | Configuration | None = None,
        *,
        device: OpenDevice | None = None,
        dead_man: bool = False,
        law: AnyLaw | None = None,
        observer: bool | None = None,
        virtual: bool = False,
        paced: bool = True,
        max_stiffness: float | None = None,
        max_damping: float | None = None,
        folder: str | Path = ".",
    ) -> None:
        self._given = device.configuration if device is not None else given
        if device is not None and virtual:
            raise ValueError("virtual=True: a device that is open has a clock of its own")
        if device is not None and observer is not None:
            raise ValueError(
                "observer: a device that is open keeps that of its configuration; change it there"
            )
        self._device: OpenDevice | VirtualDevice | None = device
        self._lent, self.virtual, self._paced = device is not None, virtual, paced
        virtual_time = self._time = VirtualTime()
        self.real = device is not None and device.backend.aim is None
        self.dead_man = dead_man or self.real
        self.base = base_of(self._given, CONFIGURED)
        world = self.base.environment
        limits = DeviceLimits.of(world, max_stiffness, max_damping)
        self._limits = limits if self._lent else None
        self.ranges = limits.ranges if self._lent else RANGES
        own: dict[str, Any] = {
            name: float(getattr(world, name, self.ranges[name][1]))
            for name in ("stiffness", "damping")
            if hasattr(world, name) or self._lent
        }
        if observer is None:
            observer = (given is None and device is None) or bool(self.base.observer)
        first = Choices(
            observer=observer,
            delay=self.base.timing.delay,
            **own,
        )
        wanted = law or self.base.law
        self.laws: dict[str, AnyLaw] = {name: name for name in LAWS}
        if not isinstance(wanted, str):
            self.laws[law_name(wanted)] = wanted
        self.choices = first.with_changes({"law": law_name(wanted)}, self.laws)
        self._chosen()
        self._clock = (lambda: virtual_time.now) if virtual else time.monotonic
        self.hand = IntendedHand(self.base, clock=self._clock)
        self.run: Run | None = None
        self.folder = Path(folder)
        self.kept = []
        self.starts = 0
        self.trouble = ""
        self._held = -1e9
        self._lock = threading.RLock()
        self._over = threading.Event()
        self._watch = threading.Thread(target=self._look_after, name="ebac-live", daemon=True)
        self._watch.start()

    # --- start and stop ---

    def start(self) -> None:
        """Begin a run under what is chosen; nothing if there is one.

        Raises
        ------
        PermissionError
            With a dead-man key that nobody holds; on hardware after a fault.
        RuntimeError
            When the session is closed.
        """
        with self._lock:
            if self._over.is_set():
                raise RuntimeError("this session is closed: make a new one")
            if self.running:
                return
            if self.dead_man and not self._is_held():
                raise PermissionError("nobody holds the dead-man key: hold it, then start")
            self._settle()
            if not self._lent:
                self._close_device()  # a handle without power was pulled on: all begins at zero
            self.run = self._begin_virtual() if self.virtual else self._begin()
            self.trouble = ""
            self.starts += 1
            if self.choices.delay != self._least_delay():
                try:
                    self.run.hold_back(self.choices.delay - self._least_delay())
                except BaseException:
                    self.pause(by="exception")
                    raise

    def pause(self, *, by: str = "stop") -> None:
        """End the run: the force fades, drives without power."""
        if self.run is not None:
            self.run.stop(by=by)  # without the lock: whoever holds it must not delay a stop
        with self._lock:
            self._settle()

    def reset(self) -> None:
        """Begin anew, everything at its zero."""
        with self._lock:
            self.pause()
            self._close_device()
            self.start()

    def hold(self) -> None:
        """Hold the dead-man key for the next 0.3 s."""
        self._held = time.monotonic()

    def let_go(self) -> None:
        """Let go of the dead-man key at once."""
        self._held = -1e9

    def close(self) -> None:
        """End the run, close the log, let go of the device."""
        self._over.set()
        self._watch.join()
        try:
            self.pause()
        finally:
            with self._lock:
                self._close_device()

    # --- its end ---

    def _is_held(self) -> bool:
        return time.monotonic() - self._held < DEAD_MAN

    def advance(self, seconds: float) -> None:
        """Let a virtual clock go on, in whole steps of 8 ms: in each the hand moves first, then the loop.

        Raises
        ------
        RuntimeError
            Where the clock is not virtual.
        """
        with self._lock:
            if not self.virtual:
                raise RuntimeError(
                    "advance: this session has a real clock; make it with virtual=True"
                )
            if isinstance(self.run, VirtualRun):
                self._time.advance(self.run, self.hand, ceil(seconds / STEP - 1e-6))

    def _look_after(self) -> None:
        while not self._over.wait(LOOK):
            run = self.run
            if run is None:
                continue
            try:
                self._look(run)
            except Exception as error:  # this thread watches the dead-man key: it goes on
                self.trouble = str(error) or repr(error)
                if self.dead_man:
                    run.stop(by="exception")

    def _look(self, run: Run) -> None:
        if self.dead_man and not run.done and not self._is_held():
            run.stop(by="dead-man key")
        if run.done and run.report is None and self._lock.acquire(blocking=False):
            try:
                self._settle()
            finally:
                self._lock.release()
        if self.virtual:
            steps = self._time.due() if self._paced else 0
            if steps:
                self.advance(steps * STEP)
        elif not run.done and run.ticks > 0:
            self.hand.go_on(run)

    def _settle(self) -> None:
        if self.run is not None:
            self.run.end()

    def _close_device(self) -> None:
        if self._device is not None and not self._lent:
            self._device.close()
            self._device = None

    def __enter__(self) -> Self:
        """Return the session."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Close it."""
        self.close()
