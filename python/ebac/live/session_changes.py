"""Changes of a session: in the running loop where that is possible, else by a new run."""

from __future__ import annotations

from typing import Any

from ebac.live.choices import Choices
from ebac.live.session_files import SessionFiles
from ebac.scenario_checks import check_axes

#: Changes of these act in the running loop; all others restart it.
WHILE_IT_RUNS = ("law", "world", "stiffness", "damping", "delay")


class SessionChanges(SessionFiles):
    """What may be changed, and how."""

    def start(self) -> None:
        """Begin a run."""
        raise NotImplementedError

    def pause(self, *, by: str = "stop") -> None:
        """End the run."""
        raise NotImplementedError

    def _close_device(self) -> None:
        raise NotImplementedError

    @property
    def running(self) -> bool:
        """Whether the loop acts."""
        return self.run is not None and not self.run.done

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
            after = self.choices.with_changes(changes, self.laws)
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
        changed = bool(set(names) & {"world", "stiffness", "damping"})
        if changed:
            self._check_world(world, another="world" in names)
        check_axes(self._chosen().scenario())
        if live:
            run = self.run
            if run is None or run.done:
                return False
            if "law" in names or "delay" in names:
                run.replace_law(law)
            if "delay" in names:
                run.hold_back(self.choices.delay - self._least_delay())
            if changed:
                run.change(world, into_hand=not self.real)  # what is simulated may be thrown out
            return False
        again = self.running
        self.pause()
        self._close_device()
        if again:
            self.start()
        return True
