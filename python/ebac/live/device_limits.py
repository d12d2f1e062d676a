"""What the page of `ebac live` may ask of a device: never more than its file, or who started it, allows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any, Self

import numpy as np

from ebac._core import Corner, Elastic, Free, HuntCrossley, _World
from ebac._util.arguments import nearest_float
from ebac._util.surfaces import GRAZE
from ebac.live.choices import RANGES
from ebac.live.surface import distance_of
from ebac.scenario import Environment


def surface_of(world: Environment) -> tuple[float, float]:
    """Return the largest stiffness [N/m] and damping [N s/m] of a world's surfaces; inf where it has no such number."""
    if isinstance(world, Free):
        return 0.0, 0.0
    if isinstance(world, Corner):
        walls: Sequence[Any] = (world.first, world.second)
    elif isinstance(world, _World):
        bodies: Any = getattr(world, "bodies", None)
        if bodies is None:
            return inf, inf  # an engine's
        walls = [one for body in bodies for one in _layers(body.material)]
    else:
        walls = (world,)
    soft = [(one.stiffness, one.damping) for one in walls if not isinstance(one, HuntCrossley)]
    if len(soft) < len(walls):
        return inf, inf
    return max(float(k) for k, _ in soft), max(float(b) for _, b in soft)


def _layers(material: Any) -> Sequence[Any]:
    return material.layers if not isinstance(material, (Elastic, HuntCrossley)) else (material,)


@dataclass(frozen=True, kw_only=True)
class DeviceLimits:
    """The stiffest and most damped surface that a page may ask for.

    Attributes
    ----------
    stiffness, damping : float
        At most [N/m, N s/m].
    configured : Environment
        The world of the file, which may always be had.
    """

    stiffness: float
    damping: float
    configured: Environment

    @classmethod
    def of(cls, world: Environment, stiffness: float | None, damping: float | None) -> Self:
        """Return those of a file's world, or the ones that were declared in their place.

        A world without such a number allows no other one unless they are declared.
        """
        own = [0.0 if one == inf else one for one in surface_of(world)]
        for name, value in (("max_stiffness", stiffness), ("max_damping", damping)):
            if value is not None and not 0 <= nearest_float(value) < inf:
                unit = "N/m" if name == "max_stiffness" else "N s/m"
                raise ValueError(
                    f"{name} = {nearest_float(value)} {unit}: must be a number of at least 0 {unit}"
                )
        return cls(
            stiffness=own[0] if stiffness is None else float(stiffness),
            damping=own[1] if damping is None else float(damping),
            configured=world,
        )

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """What the sliders reach."""
        most = {"stiffness": self.stiffness, "damping": self.damping}
        return {
            name: (min(low, most[name]), min(high, most[name])) if name in most else (low, high)
            for name, (low, high) in RANGES.items()
        }

    def check(self, world: Environment) -> None:
        """Refuse a world that is stiffer, or more damped.

        Raises
        ------
        ValueError
            With both numbers, and what to do.
        """
        if world == self.configured:
            return
        for name, value, most, unit in zip(
            ("stiffness", "damping"), surface_of(world), (self.stiffness, self.damping),
            ("N/m", "N s/m"), strict=True,
        ):  # fmt: skip
            if value == inf:
                raise ValueError(
                    f"this world has a material whose {name} is no number of {unit}, so that the limit of this device "
                    f"({most:g} {unit}) cannot be held: put it into the file, then start `ebac live` again"
                )
            if value > most:
                raise ValueError(
                    f"{name} = {value:g} {unit}: this device allows {most:g} {unit}, and no page can raise that; "
                    f"end `ebac live`, and start it with another file or --max-{name}"
                )

    def check_place(self, world: Environment, at: Sequence[float]) -> None:
        """Refuse a world inside which the handle stands.

        Raises
        ------
        ValueError
            With its depth.
        """
        distance = distance_of(world)
        if distance is None:
            return
        place = np.array([[*at, 0.0, 0.0][:3]], float)
        depth = -float(distance(place)[0])
        if depth > GRAZE:
            raise ValueError(
                f"the handle stands {1e3 * depth:.3g} mm inside that world: move it out, then choose again"
            )
