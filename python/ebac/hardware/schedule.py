"""Parameter updates at times that are known before a run."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ebac._core import LoopState
from ebac._util.arguments import unknown
from ebac.hardware.current_parameters import changed, targets_after
from ebac.hardware.world_place import check_reached

if TYPE_CHECKING:
    from ebac.hardware.configuration import Configuration
    from ebac.hardware.run import Run

#: Rows that are looked at for the first one under the law.
_BACK = 100_000
_ONE = re.compile(r"(?P<part>law|environment|hand)\.(?P<name>\w+)=(?P<value>\S+)")
_TARGET = re.compile(r"target(?:_(?P<axis>\d))?")


@dataclass(frozen=True, kw_only=True)
class Order:
    """Changes at one time.

    Attributes
    ----------
    at : float
        When, from the first tick under the law on [s].
    law, environment : mapping
        Parameters and their new numbers, SI units.
    target : tuple
        Targets of a simulated hand by axis [m], None for one that stays; empty for none.
    """

    at: float
    law: dict[str, Any] = field(default_factory=dict)
    environment: dict[str, Any] = field(default_factory=dict)
    target: tuple[float | None, ...] = ()

    @classmethod
    def parse(cls, text: str) -> Self:
        """Read `3 environment.stiffness=2e4 law.kp=0`: the time in s, then what changes.

        Raises
        ------
        ValueError
            When it is not that.
        """
        time, *words = text.split() or [""]
        parts: dict[str, dict[str, Any]] = {"law": {}, "environment": {}, "hand": {}}
        for word in words:
            match = _ONE.fullmatch(word)
            if match is None:
                raise ValueError(
                    f"--at {word!r}: must be law.NAME=NUMBER, environment.NAME=NUMBER or hand.target=NUMBER"
                )
            parts[match["part"]][match["name"]] = _number(match["value"], word)
        at = _number(time, text) if words else -1.0
        if not 0 <= at < inf:
            raise ValueError(
                f"--at {text!r}: must be a time of 0 s or more, then what changes, like '3 environment.stiffness=2e4'"
            )
        return cls(
            at=float(at),
            law=parts["law"],
            environment=parts["environment"],
            target=_target(parts["hand"]),
        )

    @contextmanager
    def naming(self, part: str) -> Iterator[None]:
        """Name in an error the order, and the number as it was given: environment.stiffness for Wall.stiffness."""
        try:
            yield
        except (TypeError, ValueError) as error:
            said = re.sub(r"^[A-Za-z]\w*\.(\w+)(?= = )", rf"{part}.\1", str(error))
            raise type(error)(f"--at {self.at:g} s: {said}") from None

    def apply(self, run: Run) -> None:
        """Tell a loop."""
        if self.law:
            run.retune(**self.law)
        if self.environment:
            with self.naming("environment"):
                run.change(**self.environment)
        if self.target:
            run.set_target(*self.target)


def _number(text: str, whole: str) -> float | int:
    try:
        value = float(text)  # infinite for a whole number beyond all floats
        return int(text) if value.is_integer() and text.lstrip("+-").isdigit() else value
    except ValueError:
        raise ValueError(f"--at {whole!r}: {text!r} is no number") from None


def _target(found: dict[str, Any]) -> tuple[float | None, ...]:
    """Return the targets by axis from `target`, `target_0`, `target_1`."""
    by_axis: dict[int, float] = {}
    for name, value in found.items():
        match = _TARGET.fullmatch(name)
        if match is None:
            raise ValueError(unknown(f"--at hand.{name}", name, ["target", "target_0", "target_1"]))
        by_axis[int(match["axis"] or 0)] = value
    return tuple(by_axis.get(axis) for axis in range(1 + max(by_axis, default=-1)))


class Schedule:
    """Orders in the order of their times; `look` gives each to a run once its time has come.

    A look comes about 50 times a second, so an order acts up to 0.02 s late on a machine that keeps up; the log has the
    tick from which it acts.

    Parameters
    ----------
    orders : sequence of Order
        In any order.
    """

    def __init__(self, orders: Sequence[Order]) -> None:
        self.orders = sorted(orders, key=lambda order: order.at)
        self._left = list(self.orders)
        self._begun: float | None = None

    @classmethod
    def parse(cls, texts: Sequence[str]) -> Self:
        """Read one order from each text. Raises as `Order.parse`."""
        return cls([Order.parse(text) for text in texts])

    def check(self, known: Configuration, *, simulated: bool) -> None:
        """Try every order on a configuration, before anything moves.

        Raises
        ------
        ValueError, TypeError
            For a number out of range, a name it does not have, a time after the end of the run.
        """
        law: Any = known.design()
        world: Any = known.environment
        target: tuple[float | None, ...] = (None,) * known.device.axes
        for order in self.orders:
            if order.at >= known.seconds:
                raise ValueError(
                    f"--at {order.at:g} s: the run ends after {known.seconds:g} s; let it last longer"
                )
            with order.naming("law"):
                if order.law:
                    after = law.replace(**order.law)
                    law._check_retune(after)
                    law = after
            with order.naming("environment"):
                if order.environment:
                    world = changed(world, **order.environment)
                    check_reached(known.device, known.limits, world)
            with order.naming("hand"):
                if order.target:
                    target = targets_after(known.hand if simulated else None, target, *order.target)

    def look(self, run: Run) -> None:
        """Give the run what is due."""
        if not self._left or run.done:
            return
        if self._begun is None:
            self._begun = _first_under_the_law(run)
        if self._begun is None:
            return
        now = run.tail(1)["t"][-1] - self._begun
        while self._left and now >= self._left[0].at:
            order = self._left.pop(0)
            try:
                order.apply(run)
            except RuntimeError:  # it ended meanwhile, and reports the reason itself
                if not run.done:
                    raise


def _first_under_the_law(run: Run) -> float | None:
    """Return the time of the first tick under the law [s]; None where there was none yet."""
    tail = run.tail(_BACK)
    rows = np.flatnonzero(tail["state"] == LoopState.RUN)
    return float(tail["t"][rows[0]]) if len(rows) else None
