"""A world: bodies of some material, which may move and hold by friction."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sin
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ebac import _core
from ebac._core import Elastic, HuntCrossley, Layer, Swing
from ebac._util.arguments import number, shown
from ebac._util.wrong_calls import plain_constructor
from ebac.worlds.part import Part, array, points
from ebac.worlds.solids import SOLIDS, Solid, made

#: Layers of a tissue, as the core has them.
MOST_LAYERS = 6
#: A scene costs a distance or more of each body in every tick.
MOST_BODIES = 64


@plain_constructor
@dataclass(frozen=True, init=False)
class Layered(Part):
    """Tissue in layers, from the surface inwards; each gives way at its `puncture` force.

    The uppermost layer that is whole carries the force, from its own surface on. A punctured layer resists by `cutting`
    alone, and is whole again once the handle has left.

    Parameters
    ----------
    *layers : Layer
        One to six.
    """

    layers: tuple[Layer, ...]

    def __init__(self, *layers: Layer) -> None:
        if not 1 <= len(layers) <= MOST_LAYERS:
            raise ValueError(f"Layered: {len(layers)} layers: must lie in [1, {MOST_LAYERS}]")
        for layer in layers:
            if not isinstance(layer, Layer):
                raise TypeError(f"Layered: {layer!r}: must be a Layer")
        object.__setattr__(self, "layers", layers)

    @classmethod
    def from_table(cls, layers: tuple[Layer, ...]) -> Self:
        """Return it from its parts by name."""
        return cls(*layers)


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Body(Part):
    """One body.

    Parameters
    ----------
    solid : solid
        Its shape and place.
    material : Elastic, HuntCrossley or Layered
        What it answers to being pressed in; default: elastic, 10 kN/m.
    friction : float
        Coulomb's coefficient, [0, 2].
    motion : Swing
        How it moves; default: not at all.
    """

    solid: Solid
    material: Elastic | HuntCrossley | Layered = field(default_factory=Elastic)
    friction: float = 0.0
    motion: Swing = field(default_factory=Swing)

    def __post_init__(self) -> None:
        """Check types and ranges."""
        parts = {
            "solid": SOLIDS,
            "material": (Elastic, HuntCrossley, Layered),
            "motion": (Swing,),
        }
        for name, kinds in parts.items():
            value = getattr(self, name)
            if not isinstance(value, kinds):
                names = " or ".join(kind.__name__ for kind in kinds)
                raise TypeError(f"Body.{name} = {value!r}: must be {names}")
        friction = number("Body.friction", self.friction)
        if not 0 <= friction <= 2:
            raise ValueError(f"Body.friction = {self.friction}: must lie in [0, 2]")
        object.__setattr__(self, "friction", friction)


def begin_of(body: Body) -> NDArray[np.float64]:
    """Return where the origin of a body is at the time 0, when it is not turned yet, shape (3,) [m]."""
    swing = body.motion
    ends = (swing.amplitude_x, swing.amplitude_y, swing.amplitude_z)
    return np.array([sin(swing.phase) * end for end in ends])


class Touch(NamedTuple):
    """What a world does to the handle.

    Attributes
    ----------
    force : array, shape (3,)
        With which the handle presses [N].
    normal : array, shape (3,)
        Unit vector into the body; without contact that of the last one.
    depth : float
        From the surface where the handle came in [m].
    stiffness : float
        At this depth, along the normal [N/m].
    stored : float
        Elastic energy [J].
    """

    force: NDArray[np.float64]
    normal: NDArray[np.float64]
    depth: float
    stiffness: float
    stored: float


@plain_constructor
class World(_core._World):
    """Bodies in space, which the handle meets as a point.

    The handle keeps a point on the surface where it came in (a god-object, Zilles and Salisbury 1995), so that nothing
    of 1 mm or more gives way however hard it is pressed. A device with one axis moves along x, one with two in the
    plane z = 0 or, with a gimbal, on its sphere; it feels the share of a force that does work there. The handle at rest
    in the middle is the origin.

    Parameters
    ----------
    *bodies : Body or solid
        1 to 64. A solid stands for a body of it, elastic with 10 kN/m. Their forces add up.

    Raises
    ------
    ValueError
        Without a body, or with too many.
    TypeError
        For something that is no body.
    """

    def __init__(self, *bodies: Body | Solid) -> None:
        if not 1 <= len(bodies) <= MOST_BODIES:
            raise ValueError(
                f"World: {len(bodies)} bodies: must lie in [1, {MOST_BODIES}]; ebac.Free() is empty space"
            )
        all_of_them = []
        for body in bodies:
            if not isinstance(body, (Body, *SOLIDS)):
                raise TypeError(f"World: {shown(body)}: must be a Body or a solid of ebac.worlds")
            all_of_them.append(body if isinstance(body, Body) else Body(solid=body))
        super().__init__([_parts(body) for body in all_of_them])
        self._bodies = tuple(all_of_them)

    @classmethod
    def from_table(cls, bodies: tuple[Body, ...]) -> Self:
        """Return it from its parts by name."""
        return cls(*bodies)

    @property
    def bodies(self) -> tuple[Body, ...]:
        """What it is made of."""
        return self._bodies

    def as_dict(self) -> dict[str, Any]:
        """Return the bodies by name."""
        return {"bodies": self._bodies}

    def walk(
        self, x: ArrayLike, v: ArrayLike | None = None, t: ArrayLike | None = None
    ) -> list[Touch]:
        """Follow a handle along a path, from a world that was not touched before.

        Parameters
        ----------
        x : array_like, shape (n, 3)
            Places, one after the other [m].
        v : array_like, shape (n, 3), optional
            Velocities [m/s]; default 0.
        t : array_like, shape (n,), optional
            Times [s]; default 0.

        Returns
        -------
        list of Touch
            One for each place.

        Raises
        ------
        TypeError, ValueError
            For what is no array of numbers, or one of another shape.
        """
        places = points("World.walk: x", x)
        speeds = np.zeros_like(places) if v is None else points("World.walk: v", v)
        times = np.zeros(len(places)) if t is None else array("World.walk: t", t, "numbers")
        if times.ndim != 1:
            raise ValueError(f"World.walk: t: shape {times.shape}: must be (n,)")
        if not len(places) == len(speeds) == len(times):
            raise ValueError(
                f"World.walk: {len(places)} places, {len(speeds)} velocities, {len(times)} times: must be as many"
            )
        self.reset()
        return [Touch(*self.contact(*one)) for one in zip(places, speeds, times, strict=True)]

    def __repr__(self) -> str:
        """Return the bodies."""
        return f"World({', '.join(map(repr, self._bodies))})"

    def __eq__(self, other: object) -> bool:
        """Return whether both have the same bodies."""
        return isinstance(other, World) and self._bodies == other._bodies

    def __hash__(self) -> int:
        """Return a number of the bodies."""
        return hash(self._bodies)

    def __reduce__(self) -> tuple[type[World], tuple[Body, ...]]:
        """Return what a copy is made from."""
        return type(self), self._bodies


def _parts(body: Body) -> tuple[_core._Solid, Any, float, Swing]:
    material = body.material
    own = _core._Layered(list(material.layers)) if isinstance(material, Layered) else material
    return made(body.solid), own, body.friction, body.motion
