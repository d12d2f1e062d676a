"""A world: bodies of some material, which may move and hold by friction."""

from __future__ import annotations

from dataclasses import dataclass, field

from ebac import _core
from ebac._core import Elastic, HuntCrossley, Layer, Swing
from ebac.worlds.solids import SOLIDS, Solid, made


@dataclass(frozen=True, init=False)
class Layered:
    """Tissue in layers, from the surface inwards; each gives way at its `puncture` force.

    Parameters
    ----------
    *layers : Layer
        One to six.
    """

    layers: tuple[Layer, ...]

    def __init__(self, *layers: Layer) -> None:
        if not 1 <= len(layers) <= 6:
            raise ValueError(f"Layered: {len(layers)} layers: must be 1 to 6")
        for layer in layers:
            if not isinstance(layer, Layer):
                raise TypeError(f"Layered: {layer!r}: must be a Layer")
        object.__setattr__(self, "layers", layers)


@dataclass(frozen=True, kw_only=True)
class Body:
    """One body.

    Parameters
    ----------
    solid : solid
        Its shape and place.
    material : Elastic, HuntCrossley or Layered
        What it answers to being pressed in.
    friction : float
        Coulomb's coefficient, [0, 2].
    motion : Swing
        How it moves.
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
            "friction": (int, float),
            "motion": (Swing,),
        }
        for name, kinds in parts.items():
            value = getattr(self, name)
            if not isinstance(value, kinds):
                names = " or ".join(kind.__name__ for kind in kinds)
                raise TypeError(f"Body.{name} = {value!r}: must be {names}")
        if not 0 <= self.friction <= 2:
            raise ValueError(f"Body.friction = {self.friction}: must lie in [0, 2]")


@dataclass(frozen=True, init=False)
class World:
    """Bodies in space, which the handle meets as a point.

    Parameters
    ----------
    *bodies : Body or solid
        A solid stands for a body of it, elastic with 10 kN/m.
    """

    bodies: tuple[Body, ...]

    def __init__(self, *bodies: Body | Solid) -> None:
        if not bodies:
            raise ValueError("World: 0 bodies: must be one at least; ebac.Free() is empty space")
        all_of_them = tuple(b if isinstance(b, Body) else Body(solid=b) for b in bodies)
        object.__setattr__(self, "bodies", all_of_them)

    def made(self) -> _core._World:
        """Return the world as the core has it, without memory."""
        return _core._scene([_made(body) for body in self.bodies])


def _made(body: Body) -> tuple[object, object, float, Swing]:
    material = body.material
    own = _core._Layered(list(material.layers)) if isinstance(material, Layered) else material
    return made(body.solid), own, float(body.friction), body.motion


