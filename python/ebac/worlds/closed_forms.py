"""Force and energy of a soft material that is pressed at a constant speed, in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ebac._util.arrays import Values


class Puncture(NamedTuple):
    """A layer that gives way.

    Attributes
    ----------
    depth : float
        Where [m].
    before, after : float
        Force of the tissue [N].
    """

    depth: float
    before: float
    after: float

    def row(self) -> dict[str, float]:
        """Return the numbers by name, units in the keys."""
        return {"depth_m": self.depth, "before_N": self.before, "after_N": self.after}


class ClosedForm(Protocol):
    """What a material does at a constant speed v [m/s], down to a deepest place and out again."""

    def inwards(self, depth: Values, v: float) -> Values:
        """Return the force on the way in [N]."""

    def outwards(self, depth: Values, v: float, deepest: float) -> Values:
        """Return the force on the way out [N]."""

    def punctures(self, v: float, deepest: float) -> tuple[Puncture, ...]:
        """Return the layers that give way."""

    def energies(self, v: float, deepest: float) -> tuple[float, float]:
        """Return the energy of the way in, and what is given back on the way out [J]."""


@dataclass(frozen=True)
class PowerLaw:
    """k x^n (1 + 3/2 a v), Hunt and Crossley (1975)."""

    k: float
    n: float
    a: float

    def inwards(self, depth: Values, v: float) -> Values:
        """Return the force on the way in [N]."""
        return self.k * depth**self.n * (1 + 1.5 * self.a * v)

    def outwards(self, depth: Values, v: float, deepest: float) -> Values:
        """Return the force on the way out [N]."""
        return self.k * depth**self.n * max(0.0, 1 - 1.5 * self.a * v)

    def punctures(self, v: float, deepest: float) -> tuple[Puncture, ...]:
        """Return the layers that give way."""
        return ()

    def energies(self, v: float, deepest: float) -> tuple[float, float]:
        """Return the energy of the way in, and what is given back on the way out [J]."""
        still = self.k * deepest ** (self.n + 1) / (self.n + 1)
        lost = 1.5 * self.a * v
        return still * (1 + lost), still * max(0.0, 1 - lost)


@dataclass(frozen=True)
class Spring:
    """K (x - top) + B v below `top`, until it carries `strength`; then `cutting` against the motion."""

    top: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0
    strength: float = 0.0  # 0: never gives way
    cutting: float = 0.0

    def given_way(self, v: float) -> float:
        """Return the depth at which it gives way."""
        beyond = self.strength - self.damping * v
        if self.strength == 0 or (self.stiffness == 0 and beyond >= 0):
            return np.inf
        return self.top + max(0.0, beyond / self.stiffness if beyond > 0 else 0.0)


@dataclass(frozen=True)
class Springs:
    """Springs one behind the other, of which the uppermost that is whole carries the force."""

    springs: tuple[Spring, ...]

    def _ends(self, v: float) -> Values:
        """Return where each gives way: none before those above it."""
        return np.maximum.accumulate([one.given_way(v) for one in self.springs])

    def _of(self, carrying: int, depth: Values, v: float) -> Values:
        """Return the force where the one of this number carries; v < 0 outwards."""
        force = np.full_like(
            depth, np.sign(v) * sum(one.cutting for one in self.springs[:carrying])
        )
        if carrying < len(self.springs):
            own = self.springs[carrying]
            below = depth - own.top
            force += np.where(below > 0, np.maximum(own.stiffness * below + own.damping * v, 0), 0)
        return np.maximum(force, 0.0)

    def inwards(self, depth: Values, v: float) -> Values:
        """Return the force on the way in [N]."""
        carrying = np.searchsorted(self._ends(v), depth)
        all_of_them = np.stack([self._of(k, depth, v) for k in range(len(self.springs) + 1)])
        return np.asarray(np.take_along_axis(all_of_them, carrying[None], axis=0)[0])

    def outwards(self, depth: Values, v: float, deepest: float) -> Values:
        """Return the force on the way out [N]."""
        return self._of(int(np.searchsorted(self._ends(v), deepest)), depth, -v)

    def punctures(self, v: float, deepest: float) -> tuple[Puncture, ...]:
        """Return the layers that give way."""
        ends = self._ends(v)
        found = []
        for end in np.unique(ends[ends < deepest]):
            first, last = np.searchsorted(ends, [end, np.nextafter(end, np.inf)])
            before, after = (float(self._of(int(k), np.array([end]), v)[0]) for k in (first, last))
            if after < before:
                found.append(Puncture(float(end), before, after))
        return tuple(found)

    def energies(self, v: float, deepest: float) -> tuple[float, float]:
        """Return the energy of the way in, and what is given back on the way out [J]."""
        taken = start = 0.0
        cutting = 0.0
        ends = self._ends(v)
        for own, end in zip(self.springs, np.minimum(ends, deepest), strict=True):
            a, b = max(start, own.top) - own.top, max(end, own.top) - own.top
            taken += cutting * (end - start)
            taken += own.stiffness * (b * b - a * a) / 2 + own.damping * v * (b - a)
            start, cutting = end, cutting + own.cutting
        taken += cutting * (deepest - start)
        whole = int(np.searchsorted(ends, deepest))
        if whole == len(self.springs):
            return taken, 0.0
        own = self.springs[whole]
        lost = own.damping * v + sum(one.cutting for one in self.springs[:whole])
        if own.stiffness == 0:
            return taken, 0.0
        left = max(0.0, deepest - own.top - lost / own.stiffness)
        return taken, own.stiffness * left * left / 2
