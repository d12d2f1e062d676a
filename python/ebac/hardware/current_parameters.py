"""Current parameters of a running loop: its law, its virtual world, the target of a simulated hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan
from typing import TYPE_CHECKING, Any, get_args

from ebac._core import Recorded, Step, _World
from ebac._util.arguments import require, whole
from ebac._util.foreign_worlds import refuse_python
from ebac._util.plural import plural
from ebac.hardware.parameter_updates import Note, ParameterUpdates
from ebac.hardware.world_place import check_stays_outside
from ebac.scenario import Environment

if TYPE_CHECKING:
    from ebac import _core
    from ebac._core import Hand
    from ebac.laws import CoreLaw
    from ebac.scenario import Scenario

#: What a mailbox has room for.
_MOST_AXES = 3
#: Samples, as cpp/ebac/loop/held_back_commands.hpp has it.
MOST_HELD_BACK = 7


class CurrentParameters:
    """Law, world and target of a loop, each checked before it is sent, and noted for the log. One thread at a time."""

    def __init__(
        self,
        running: _core.Running,
        *,
        law: CoreLaw,
        scenario: Scenario,
        hand: bool,
    ) -> None:
        self.law = law
        self.world: Environment = scenario.environment
        self.target: tuple[float | None, ...] = (None,) * scenario.device.axes
        self.updates = ParameterUpdates(running, scenario.timing.dt)
        self._running = running
        self._dt = scenario.timing.dt
        self._hand = scenario.hand if hand else None

    def retune(self, **changes: Any) -> CoreLaw:
        """Send the law with other gains."""
        before, after = self.law, self.law.replace(**changes)
        parts = [
            f"{name} {getattr(before, name)!r} -> {value!r}" for name, value in changes.items()
        ]
        note = Note(
            message=f"law {after.name}: {', '.join(parts)}",
            values={f"law.{name}": value for name, value in changes.items()},
        )
        self.updates.send("law", lambda: self._running.retune(after), note)
        self.law = after
        return after

    def replace_law(self, law: CoreLaw) -> CoreLaw:
        """Send another law."""
        if not hasattr(law, "_start"):
            raise TypeError(f"{law!r}: must be one of the library's laws compiled in C++")
        if law.timing.dt != self._dt:
            raise ValueError(
                f"law.timing.dt = {law.timing.dt:g} s: the loop has a tick every {self._dt:g} s; design the law with "
                "the timing of the run"
            )
        note = Note(message=f"law {self.law.name} -> {law!r}", values={"law": law.name})
        self.updates.send("law", lambda: self._running.replace_law(law), note)
        self.law = law
        return law

    def hold_back(self, ticks: int) -> int:
        """Send how many ticks every command is held back."""
        if self._hand is None:
            raise ValueError(
                "hold_back: the drives are real, and a command to rest must not come late; open them with "
                "simulate=True (ebac run --simulated)"
            )
        ticks = whole("hold_back", ticks)
        if isinstance(ticks, bool) or not 0 <= ticks <= MOST_HELD_BACK:
            raise ValueError(
                f"hold_back = {plural(ticks, 'sample')}: must lie in [0, {MOST_HELD_BACK}] samples"
            )
        note = Note(
            message=f"commands held back by {plural(ticks, 'sample')}",
            values={"delay_ticks": ticks},
        )
        self.updates.send("delay", lambda: self._running.hold_back(ticks), note)
        return ticks

    def change(
        self, environment: Environment | None, at: Sequence[float] | None, **changes: Any
    ) -> Environment:
        """Send another world, or the present one with other numbers, but none deep inside which the handle stands."""
        world = self.world if environment is None else environment
        require(
            world, get_args(Environment), "change", "a world, as ebac.Wall or one of ebac.worlds"
        )
        refuse_python(world)
        if changes:
            world = changed(world, **changes)
        if at is not None:
            check_stays_outside(self.world, world, at)
        shown = repr(world)
        if environment is None and changes:
            shown = ", ".join(
                f"{name} {getattr(self.world, name):g} -> {value:g}"
                for name, value in changes.items()
            )
        note = Note(
            message=f"environment: {shown}",
            values={f"environment.{name}": value for name, value in changes.items()},
        )
        self.updates.send("environment", lambda: self._running.change_world(world), note)
        self.world = world
        return world

    def set_target(self, *target: float | None) -> tuple[float | None, ...]:
        """Send another target of the hand; None leaves an axis as it is."""
        wanted = targets_after(self._hand, self.target, *target)
        places = [nan if one is None else one for one in wanted]
        places += [nan] * (_MOST_AXES - len(places))
        names = [f"hand.target_{axis}" for axis in range(len(target))]
        values = {name: one for name, one in zip(names, target, strict=True) if one is not None}
        alone = len(wanted) == 1
        shown = [
            f"{one:g} m" if alone else f"axis {axis}: {one:g} m"
            for axis, one in enumerate(target)
            if one is not None
        ]
        note = Note(message=f"hand target, {', '.join(shown)}", values=values)
        self.updates.send("target", lambda: self._running.aim(places), note)
        self.target = wanted
        return wanted


def changed(world: Environment, **changes: float) -> Environment:
    """Return a world with other numbers.

    Raises
    ------
    ValueError
        For a world of bodies, or a number out of range.
    """
    if isinstance(world, _World):
        raise ValueError(
            f"environment.{', '.join(changes)}: a world of bodies is changed as a whole; give environment=..."
        )
    for name, value in changes.items():
        if isinstance(value, bool):
            raise TypeError(f"environment.{name} = {value}: must be a number in SI units")
    return world.replace(**changes)


def targets_after(
    hand: Hand | None, before: tuple[float | None, ...], *target: float | None
) -> tuple[float | None, ...]:
    """Return the targets of a hand [m], by axis, with these on top of those set before.

    Raises
    ------
    ValueError
        When there is no simulated hand, for too many axes, for a number out of range, for a recorded path.
    """
    axes = len(before)
    if hand is None:
        raise ValueError(
            "the target of the hand: no simulated hand holds this device, so there is no target to set; "
            "open it with simulate=True (ebac run --simulated)"
        )
    if not 1 <= len(target) <= axes:
        raise ValueError(
            f"the target of the hand: {plural(len(target), 'number')} for {plural(axes, 'axis', 'axes')}: "
            f"give {'1' if axes == 1 else f'1 to {axes}'}, None for one that stays"
        )
    for axis, one in enumerate(target):
        if one is None:
            continue
        Step(target=one)
        if isinstance(hand.path[axis], Recorded):
            raise ValueError(
                f"the target of the hand on axis {axis}: follows a recorded path, which cannot be left while it "
                "runs; give it a Step, MinimumJerk, Sine or Tapping"
            )
    padded = (*target, *(None for _ in range(axes - len(target))))
    return tuple(
        old if new is None else float(new) for new, old in zip(padded, before, strict=True)
    )
