"""What a Python function says of a world, and how its errors come back out of a run."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass
from math import inf, isfinite
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ebac._util.arguments import number
from ebac._util.arrays import Values
from ebac._util.wrong_calls import plain_constructor
from ebac.worlds.part import three
from ebac.worlds.world import Touch

Vector = tuple[float, float, float]

#: Largest stiffness [N/m] and damping [N s/m], as of a wall.
STIFFEST, MOST_DAMPING = 1e7, 1e4


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class LocalModel:
    """What an engine says of the world near the handle: a plane or a sphere. The loop renders it at its own rate.

    Parameters
    ----------
    at : (x, y, z)
        A point of the surface, each in [-10, 10] m.
    normal : (x, y, z)
        Into the body, of any length but 0.
    stiffness : float
        Along the normal [N/m], [0, 1e7].
    damping : float
        Along the normal [N s/m], [0, 1e4].
    radius : float
        Of the sphere [m]; infinite for a plane, negative for a hollow.
    velocity : (x, y, z)
        Of the surface, each in [-10, 10] m/s.

    Raises
    ------
    ValueError
        For a number out of its range.
    TypeError
        For something that is no number.
    """

    at: Vector
    normal: Vector
    stiffness: float
    damping: float = 0.0
    radius: float = inf
    velocity: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        """Check ranges, and make the normal a unit vector."""
        object.__setattr__(self, "at", three("LocalModel.at", self.at, "m", 10.0))
        object.__setattr__(
            self, "velocity", three("LocalModel.velocity", self.velocity, "m/s", 10.0)
        )
        normal = np.array(three("LocalModel.normal", self.normal, "1", 1e9))
        length = float(np.linalg.norm(normal))
        if length == 0:
            raise ValueError("LocalModel.normal = (0, 0, 0): must have a length")
        x, y, z = map(float, normal / length)
        object.__setattr__(self, "normal", (x, y, z))
        ranges = {"stiffness": ("N/m", STIFFEST), "damping": ("N s/m", MOST_DAMPING)}
        for name, (unit, most) in ranges.items():
            value = number(f"LocalModel.{name}", getattr(self, name))
            if not 0 <= value <= most:
                raise ValueError(
                    f"LocalModel.{name} = {value:g} {unit}: must lie in [0, {most:g}] {unit}"
                )
            object.__setattr__(self, name, value)
        radius = number("LocalModel.radius", self.radius)
        object.__setattr__(self, "radius", radius)
        if not abs(radius) >= 1e-4:
            raise ValueError(
                f"LocalModel.radius = {self.radius} m: must be 1e-4 m at least in size; infinite for a plane"
            )

    @classmethod
    def of_force(cls, x: ArrayLike, force: ArrayLike, stiffness: float, **more: Any) -> Self | None:
        """Return the plane that answers with a force at a place; None for no force.

        Parameters
        ----------
        x : array_like, shape (3,)
            Where the handle was [m].
        force : array_like, shape (3,)
            With which the handle pressed [N].
        stiffness : float
            How the force grows with depth [N/m], (0, 1e7].
        **more
            `damping`, `radius`, `velocity`.
        """
        pressed = np.array(three("LocalModel.of_force: force", force, "N", 1e9))
        size = float(np.linalg.norm(pressed))
        if size == 0:
            return None
        if not 0 < number("LocalModel.of_force: stiffness", stiffness) <= STIFFEST:
            raise ValueError(
                f"LocalModel.of_force: stiffness = {stiffness} N/m: must lie in (0, {STIFFEST:g}] N/m"
            )
        place = np.array(three("LocalModel.of_force: x", x, "m", 10.0))
        a, b, c = place - pressed / stiffness
        return cls(at=(a, b, c), normal=pressed / size, stiffness=stiffness, **more)  # type: ignore[arg-type]


def model_numbers(answer: Any) -> tuple[Any, ...] | None:
    """Return the numbers of an engine's answer, as the core takes them."""
    if answer is None:
        return None
    if not isinstance(answer, LocalModel):
        raise TypeError(f"the engine returned {answer!r}: must return a LocalModel, or None")
    return (
        np.array(answer.at),
        np.array(answer.normal),
        1 / answer.radius,
        float(answer.stiffness),
        float(answer.damping),
        np.array(answer.velocity),
    )


def contact_numbers(answer: Any) -> tuple[Any, ...] | None:
    """Return the numbers of a world's answer, as the core takes them."""
    if answer is None:
        return None
    touch = answer if isinstance(answer, Touch) else None
    force = np.asarray(answer if touch is None else touch.force, float)
    if force.shape != (3,) or not np.isfinite(force).all():
        raise TypeError(
            f"the world returned {answer!r}: must return the force with which the handle presses, three finite "
            "numbers [N], a Touch, or None"
        )
    size = float(np.linalg.norm(force))
    if size == 0:
        return None
    if touch is None:
        return force, force / size, 0.0, 0.0, np.zeros(3)
    normal = np.array(three("Touch.normal", touch.normal, "1", 1e9))
    numbers = (float(touch.depth), float(touch.stiffness))
    if not np.linalg.norm(normal) > 0 or not all(map(isfinite, numbers)):
        raise ValueError(f"the world returned {touch!r}: normal, depth or stiffness is no number")
    return force, normal / np.linalg.norm(normal), *numbers, np.zeros(3)


class Kept:
    """A function as the core calls it: its answer in numbers, its first error kept for the end of the run.

    Parameters
    ----------
    function : callable
        Called with position [m] and velocity [m/s], each of shape (3,).
    numbers : callable
        Makes numbers of its answer.
    errors : list
        Where the first error goes; copies share it.
    """

    def __init__(
        self,
        function: Callable[[Values, Values], Any],
        numbers: Callable[[Any], tuple[Any, ...] | None],
        errors: list[BaseException],
    ) -> None:
        self._function, self._numbers, self._errors = function, numbers, errors

    def __call__(self, x: Values, v: Values) -> tuple[Any, ...] | None:
        """Return the numbers; an error comes again at every later call."""
        if self._errors:
            raise RuntimeError("failed before")
        try:
            return self._numbers(self._function(x, v))
        except BaseException as error:
            self._errors.append(error)
            raise

    def __deepcopy__(self, memo: dict[int, Any]) -> Kept:
        """Return one with a copy of the function's object."""
        return Kept(copy.deepcopy(self._function, memo), self._numbers, self._errors)
