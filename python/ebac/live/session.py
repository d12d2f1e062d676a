"""A loop at work that a page, or a program, may change while it runs: `ebac.live.Session`."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from ebac._core import Fault
from ebac._util.wrong_calls import plain_constructor
from ebac.hardware import Configuration, OpenDevice, Run
from ebac.hardware.law import designed
from ebac.live.choices import CONFIGURED, Choices, base_of, world_of
from ebac.live.intended_hand import IntendedHand
from ebac.live.session_files import SessionFiles
from ebac.scenario import Scenario

#: How often the hand moves and somebody looks after the loop [s].
LOOK = 1 / 60
#: Longest silence of who holds the dead-man key [s].
DEAD_MAN = 0.3
#: A simulated device moves for so many ticks at most from one tick to the next: on a machine that is late its time
#: stands still.
LONGEST_STEP = 2
#: Ticks without an answer that are a fault of simulated drives.
PATIENCE = 200
#: Longest run [s].
LONGEST = 1e5
#: Changes of these act in the running loop; all others restart it.
WHILE_IT_RUNS = ("law", "world", "stiffness", "damping", "delay")


@plain_constructor
class Session(SessionFiles):
    """A loop in real time that can be changed while it runs. A context manager; from any thread.

    Parameters
    ----------
    given : Scenario or Configuration, optional
        What to begin with; default: the paper's joystick on simulated drives, at a wall of 10 kN/m.
    device : OpenDevice, optional
        A device that is open, as hardware is; it stays open. Without it simulated drives, device and hand.
    dead_man : bool, optional
        Whether the loop has power only while `hold` is called again within 0.3 s; on hardware always.
    law : str, optional
        The law to begin with.
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

    Raises
    ------
    ValueError
        For an unknown law.
    """

    def __init__(
        self,
        given: Scenario | Configuration | None = None,
        *,
        device: OpenDevice | None = None,
        dead_man: bool = False,
        law: str | None = None,
        folder: str | Path = ".",
    ) -> None:
        self._given = device.configuration if device is not None else given
        self._device, self._lent = device, device is not None
        self.real = device is not None and device.backend.aim is None
        self.dead_man = dead_man or self.real
        self.base = base_of(self._given, CONFIGURED)
        world = self.base.environment
        own: dict[str, Any] = {
            name: float(getattr(world, name))
            for name in ("stiffness", "damping")
            if hasattr(world, name)
        }
        first = Choices(
            observer=(given is None and device is None) or bool(self.base.observer),
            delay=self.base.timing.delay,
            **own,
        )
        self.choices = first.with_changes({"law": law or self.base.law})
        self.hand = IntendedHand(self.base)
        self.run: Run | None = None
        self.folder = Path(folder)
        self.kept = []
        self.starts = 0
        self._held = -1e9
        self._lock = threading.RLock()
        self._over = threading.Event()
        self._watch = threading.Thread(target=self._look_after, name="ebac-live", daemon=True)
        self._watch.start()

    # --- start and stop ---

    @property
    def running(self) -> bool:
        """Whether the loop acts."""
        return self.run is not None and not self.run.done

    def start(self) -> None:
        """Begin a run under what is chosen; nothing if there is one.

        Raises
        ------
        PermissionError
            With a dead-man key that nobody holds; on hardware after a fault.
        """
        with self._lock:
            if self.running:
                return
            if self.dead_man and not self._is_held():
                raise PermissionError("nobody holds the dead-man key: hold it, then start")
            self._settle()
            if not self._lent:
                self._close_device()  # a handle without power was pulled on: all begins at zero
            if self._device is None:
                known = self._chosen()
                self._device = OpenDevice(
                    known, simulate=True, longest_step=LONGEST_STEP * known.timing.dt
                )
            if self._device.report is not None and self._device.report.ended_by == "fault":
                if self.real:
                    raise PermissionError(
                        "the last run ended by a fault: look at the device, end `ebac live`, start it again; it asks "
                        "for the zero anew"
                    )
                self._device.reset()
            base = self._device.configuration
            if not self._lent:
                self.hand = IntendedHand(base, goal=self.hand.goal, mode=self.hand.mode)
                aim = self._device.backend.aim
                self.hand.post = None if aim is None else aim.post
            run = self._device.start(self._law(), self._world(), seconds=LONGEST)
            if self.choices.delay != self._least_delay():
                run.hold_back(self.choices.delay - self._least_delay())
            self.run = run
            self.starts += 1

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
        self.pause()
        with self._lock:
            self._close_device()

    # --- changes ---

    def change(self, **changes: Any) -> bool:
        """Change what is chosen, in the running loop where that is possible; else it begins anew.

        Parameters
        ----------
        **changes
            Of `Choices`: `law="tca"`, `stiffness=2e4` [N/m], `damping` [N s/m], `delay` [samples], `world`, `observer`,
            `hand`, `device`.

        Returns
        -------
        bool
            Whether the loop was restarted.

        Raises
        ------
        KeyError
            For an unknown name.
        ValueError
            For what cannot be, and for what only a restart could change on hardware.
        """
        with self._lock:
            after = self.choices.with_changes(changes)
            before, self.choices = self.choices, after
            try:
                return self._apply(
                    before, [n for n, v in after.row().items() if v != before.row()[n]]
                )
            except BaseException:
                self.choices = before
                raise

    def _apply(self, before: Choices, names: list[str]) -> bool:
        observed = self.choices.observer or before.observer
        live = all(name in WHILE_IT_RUNS for name in names)
        if "delay" in names and observed:  # it is designed for its delay
            live = False
        if self._lent and (not live or "delay" in names):
            raise ValueError(
                f"{', '.join(names)}: cannot change on this device while it is open; change the file and start again"
            )
        law, world = self._law(), self._world()
        self._chosen().scenario()._check_axes()
        if live:
            run = self.run
            if run is None or run.done:
                return False
            if "law" in names or "delay" in names:
                run.replace_law(law)
            if "delay" in names:
                run.hold_back(self.choices.delay - self._least_delay())
            if set(names) & {"world", "stiffness", "damping"}:
                run.change(world)
            return False
        again = self.running
        self.pause()
        self._close_device()
        if again:
            self.start()
        return True

    def _least_delay(self) -> int:
        """Return the delay of the bus [samples]: the rest is held back."""
        return base_of(self._given, self.choices.device).timing.delay

    def _chosen(self) -> Configuration:
        """Return the configuration of what is chosen."""
        from ebac import presets

        known = base_of(self._given, self.choices.device)
        if self.choices.hand != CONFIGURED:
            held = presets.HANDS[self.choices.hand].hand
            known = known.replace(hand=held.replace(path=list(known.hand.path)))
        observer: Any = self.choices.observer
        if self.choices.delay < known.timing.delay:
            raise ValueError(
                f"delay = {self.choices.delay} samples: drives and bus take {known.timing.delay}"
            )
        return known.replace(
            timing=known.timing.replace(delay=self.choices.delay),
            silent=known.silent if self._lent else PATIENCE,
            limits=known.limits
            if self._lent
            else known.limits.replace(
                watch_motion=False, overruns=PATIENCE, pause=0.5, force_age=0.2
            ),
            observer=known.observer if bool(known.observer) == observer else observer,
            law=self.choices.law,
            changes=known.changes if self.choices.law == known.law else {},
        )

    def _law(self) -> Any:
        known = self._chosen()
        return designed(
            known.law,
            known.changes,
            known.device,
            known.timing,
            sensor=known.sensor is not None,
        )

    def _world(self) -> Any:
        return world_of(self.choices, base_of(self._given, self.choices.device).environment)

    @property
    def scenario(self) -> Scenario:
        """What runs, as a scenario: device, hand with its target, world, timing."""
        known = self._chosen()
        return known.scenario(seconds=6).replace(
            environment=self._world(),
            hand=self.hand.as_hand(known.hand),
        )

    # --- its end ---

    @property
    def fault(self) -> Fault:
        """What ended the run, `Fault.NONE` while it runs."""
        last = None if self.run is None else self.run.tail(1)
        return Fault(int(last["fault"][-1])) if last is not None and len(last) else Fault.NONE

    def _is_held(self) -> bool:
        return time.monotonic() - self._held < DEAD_MAN

    def _look_after(self) -> None:
        while not self._over.wait(LOOK):
            run = self.run
            if self.hand.fades and run is not None and len(last := run.tail(1)):
                self.hand.handle = [float(one) for one in last["x"].reshape(-1)]
            if run is None:
                continue
            if not run.done and run.ticks > 0:
                self.hand.move()
            if self.dead_man and not run.done and not self._is_held():
                run.stop(by="dead-man key")
            if run.done and run.report is None and self._lock.acquire(blocking=False):
                try:
                    self._settle()
                finally:
                    self._lock.release()

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
