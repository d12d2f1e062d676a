"""Force over depth of a material, pressed in and let out again at one speed, beside its closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ebac._core import Elastic, HuntCrossley, Plane
from ebac._util.arguments import number
from ebac._util.arrays import Values
from ebac.worlds.closed_forms import ClosedForm, PowerLaw, Puncture, Spring, Springs
from ebac.worlds.world import Body, Layered, World

Material = Elastic | HuntCrossley | Layered

#: Steps each way.
ROWS = 6000
#: Speeds [m/s]: below the first `cutting` of a layer fades. Depths [m].
SPEEDS, DEPTHS = (2e-3, 1.0), (1e-4, 0.1)


@dataclass(frozen=True, kw_only=True)
class ForceDepth:
    """A material that is pressed in and let out again; what ends in `_exact` is by its closed form.

    Attributes
    ----------
    material : Elastic, HuntCrossley or Layered
        What is pressed.
    speed : float
        Of the handle, either way [m/s].
    depth, force, force_exact : array, shape (2 n,)
        The way in, then the way out; the deepest place is in both [m], [N].
    error : float
        Largest difference of the forces [N], without the row of each puncture.
    punctures, punctures_exact : tuple of Puncture
        Where a layer gave way, from the surface inwards.
    taken, taken_exact : float
        Energy of the way in [J].
    back, back_exact : float
        Energy given back on the way out [J].
    """

    material: Material
    speed: float
    depth: Values
    force: Values
    force_exact: Values
    error: float
    punctures: tuple[Puncture, ...]
    punctures_exact: tuple[Puncture, ...]
    taken: float
    taken_exact: float
    back: float
    back_exact: float

    def row(self) -> dict[str, Any]:
        """Return the numbers by name, units in the keys."""
        return {
            "depth_m": float(self.depth.max()),
            "speed_m_s": self.speed,
            "force_error_N": self.error,
            "taken_J": self.taken,
            "taken_exact_J": self.taken_exact,
            "back_J": self.back,
            "back_exact_J": self.back_exact,
            "punctures": [one.row() for one in self.punctures],
            "punctures_exact": [one.row() for one in self.punctures_exact],
        }


def force_depth(material: Material, *, depth: float = 12e-3, speed: float = 0.02) -> ForceDepth:
    """Press a plane of some material at a constant speed, and let it out again.

    Parameters
    ----------
    material : Elastic, HuntCrossley or Layered
        What is pressed.
    depth : float
        Deepest place [m], [1e-4, 0.1].
    speed : float
        Of the handle, either way [m/s], [2e-3, 1].

    Returns
    -------
    ForceDepth
        Of 6001 rows each way.

    Raises
    ------
    ValueError
        For a depth or a speed out of its range.
    TypeError
        For something that is no material, or no number.
    """
    for name, value, unit, (low, high) in (("depth", depth, "m", DEPTHS), ("speed", speed, "m/s", SPEEDS)):  # fmt: skip
        if not low <= number(name, value) <= high:
            raise ValueError(f"{name} = {value:g} {unit}: must lie in [{low:g}, {high:g}] {unit}")
    x = np.linspace(0.0, depth, ROWS + 1)
    depths = np.concatenate([x, x[::-1]])
    inwards = np.arange(len(depths)) <= ROWS
    handle = np.zeros((len(depths) + 1, 3))
    handle[:, 0] = np.concatenate([[-1e-3], depths])  # it comes from outside
    speeds = np.zeros_like(handle)
    speeds[:, 0] = np.concatenate([[speed], np.where(inwards, speed, -speed)])
    touches = World(Body(solid=Plane(), material=material)).walk(handle, speeds)[1:]
    force = np.array([touch.force[0] for touch in touches])
    exact = closed_form(material)
    known = np.where(inwards, exact.inwards(depths, speed), exact.outwards(depths, speed, depth))
    punctures, expected = _punctures(x, force[: ROWS + 1]), exact.punctures(speed, depth)
    off = np.abs(force - known)
    off[[0, -1]] = 0.0  # on the surface itself a damper may push or not
    for one in expected:
        off[np.abs(depths - one.depth) < 2 * x[1]] = 0.0
    taken, back = exact.energies(speed, depth)
    return ForceDepth(
        material=material,
        speed=speed,
        depth=depths,
        force=force,
        force_exact=known,
        error=float(off.max()),
        punctures=punctures,
        punctures_exact=expected,
        taken=float(np.trapezoid(force[: ROWS + 1], x)),
        taken_exact=taken,
        back=float(-np.trapezoid(force[ROWS + 1 :], depths[ROWS + 1 :])),
        back_exact=back,
    )


def closed_form(material: Material) -> ClosedForm:
    """Return the closed form of a material.

    Raises
    ------
    TypeError
        For something that is no material.
    """
    if isinstance(material, HuntCrossley):
        return PowerLaw(material.stiffness, material.exponent, material.dissipation)
    if isinstance(material, Elastic):
        return Springs((Spring(stiffness=material.stiffness, damping=material.damping),))
    if not isinstance(material, Layered):
        raise TypeError(f"{material!r}: must be Elastic, HuntCrossley or Layered")
    tops = np.cumsum([0.0, *(layer.thickness for layer in material.layers)])
    springs = [
        Spring(float(top), layer.stiffness, layer.damping, layer.puncture, layer.cutting)
        for top, layer in zip(tops, material.layers, strict=False)
    ]
    return Springs(tuple(springs))


def _punctures(depth: Values, force: Values) -> tuple[Puncture, ...]:
    """Return where the force falls on the way in."""
    return tuple(
        Puncture(float(depth[k + 1]), float(force[k]), float(force[k + 1]))
        for k in np.flatnonzero(np.diff(force) < -1e-9)
    )
