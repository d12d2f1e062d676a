"""Hands beyond eq. (4): presets with a delay, a pulp, a stiffening grip or gaps in the contact, and hands of your own.

A model stands in a `Hand` and makes the force from its mass, damping, stiffness and path::

    ebac.Scenario(hand=ebac.Hand(stiffness=500, model=ebac.hands.Reflex(delay=0.03)))

A hand of your own is an object with `force(t, x, v)`, see `OwnHand`.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from ebac._core import FingerPad, Hand, LetGo, NonlinearGrip, Reflex

if TYPE_CHECKING:
    from typing import TypeGuard

__all__ = [
    "FingerPad",
    "LetGo",
    "NonlinearGrip",
    "OwnHand",
    "Reflex",
]


def __dir__() -> list[str]:
    return __all__


#: Models of the core.
PRESETS = (Reflex, FingerPad, NonlinearGrip, LetGo)


class OwnHand:
    """Base of a hand of your own, for simulation. Any object with `force` will do; this one has the rest by default.

    Each axis and each run gets a deep copy, so the same scenario gives the same bits. The Python code runs some
    10 000 times a simulated second; other runs go on beside it.

    Attributes
    ----------
    mass : float
        What moves with the handle [kg], [0, 10]: its inertia must not be part of `force`.
    damping, stiffness : float
        The largest of the force [N s/m], [N/m], from which the steps of the integration are chosen: a hand that is
        stiffer than it says is integrated too coarsely.
    """

    mass: float = 0.0
    damping: float = 10.0
    stiffness: float = 1000.0

    @abstractmethod
    def force(self, t: float, x: float, v: float) -> float:
        """Return the force on the handle [N], along +x, at a time [s], position [m] and velocity [m/s].

        Within a step it is asked for several times, at instants that may lie before the last one: it must not change
        the object. What it raises ends the run: `simulate` raises a `LoopFault` that names it.
        """
        raise NotImplementedError("it has no method force(self, t, x, v) that returns a force [N]")

    def advance(self, t: float, x: float, v: float) -> None:
        """Change your own state: a step has ended; `t` only rises here."""

    def start(self, axis: int) -> None:
        """Prepare for a run on an axis, 0 to 2."""


class HandForce(Protocol):
    """What a hand of your own must have."""

    def force(self, t: float, x: float, v: float, /) -> float:
        """Return the force on the handle [N]."""
        ...


#: What a `Hand` may have as its model.
AnyModel: TypeAlias = Reflex | FingerPad | NonlinearGrip | LetGo | HandForce | None


def is_own(model: AnyModel) -> TypeGuard[OwnHand]:
    """Return whether a model is a hand of the user's own."""
    return model is not None and not isinstance(model, PRESETS)


def as_hand(given: Any) -> Any:
    """Return the `Hand` that a model alone stands for; what is neither is returned as it is."""
    if isinstance(given, PRESETS):
        return Hand(model=given)
    of_core = type(given).__module__ == Hand.__module__  # a world has a force as well
    if of_core or isinstance(given, type) or not hasattr(given, "force"):
        return given
    numbers = {
        name: getattr(given, name, getattr(OwnHand, name))
        for name in ("mass", "damping", "stiffness")
    }
    return Hand(model=given, **numbers)
