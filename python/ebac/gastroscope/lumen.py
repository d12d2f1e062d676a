"""The lumen from the teeth to behind the pylorus: generated from measures, or a solid of the user's own."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ebac._core import Patient, _Lumen
from ebac._util.arguments import require
from ebac._util.wrong_calls import plain_constructor
from ebac.worlds.solids import Solid, check_solid, made


class Wall(NamedTuple):
    """The wall near a ball.

    Attributes
    ----------
    place : float
        Along the lumen from the teeth [m].
    depth : float
        Of the ball in the wall [m]; negative: free.
    way : ndarray
        Gradient of the depth, shape (3,): where the wall yields to.
    """

    place: float
    depth: float
    way: NDArray[np.float64]


@plain_constructor
class Lumen:
    """The lumen of a patient.

    Parameters
    ----------
    patient : Patient, optional
        Measures, wall and motion; default: those of `Patient()`.
    points : array_like, optional
        Centre line of your own, shape (n, 3) [m], 5 mm or more from point to point, from the teeth on.
    radii : sequence of float, optional
        A radius for each point [m], [0.001, 1].
    wall : solid of `ebac.worlds`, optional
        The tissue as a solid, for instance `worlds.Cavity(worlds.Mesh("stomach.stl"))`; needs `points` and `radii` for
        the way through it. Peristalsis does not move it, breathing does.

    Raises
    ------
    ValueError
        For fewer than two points, another number of radii, a radius out of its range, points too close, or a wall or
        radii without points.
    TypeError
        For a patient or a wall of another type.
    """

    def __init__(
        self,
        patient: Patient | None = None,
        *,
        points: ArrayLike | None = None,
        radii: Sequence[float] | None = None,
        wall: Solid | None = None,
    ) -> None:
        self.patient = Patient() if patient is None else patient
        require(self.patient, Patient, "Lumen.patient", "a Patient")
        if wall is not None:
            check_solid("Lumen.wall", wall)
        line = np.zeros((0, 3)) if points is None else np.array(points, dtype=float)
        if line.ndim != 2 or line.shape[1] != 3 or not np.isfinite(line).all():
            raise ValueError(f"Lumen.points: has the shape {line.shape}: must be (n, 3), finite")
        self._own: dict[str, Any] = {
            "points": None if points is None else line,
            "radii": None if radii is None else [float(r) for r in radii],
            "wall": wall,
        }
        self.core = _Lumen(
            self.patient,
            [(float(x), float(y), float(z)) for x, y, z in line],
            self._own["radii"] or [],
            None if wall is None else made(wall),
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what a copy is made from."""
        return partial(type(self), **self._own), (self.patient,)

    def landmarks(self) -> dict[str, float]:
        """Return where its parts end, by name [m] along the lumen."""
        return {str(name): float(value) for name, value in self.core.landmarks().items()}

    def line(
        self, s: ArrayLike, t: float = 0.0
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return centre line, axes and radius at places along it.

        Returns
        -------
        points : ndarray
            Shape (n, 3) [m]: towards the patient's front, left and head.
        axes : ndarray
            Shape (n, 3, 3): right, down and ahead of a camera there, as rows.
        radius : ndarray
            Shape (n,) [m].

        Raises
        ------
        ValueError
            For a place that is not finite.
        """
        places = np.atleast_1d(np.asarray(s, dtype=float))
        if not np.isfinite(places).all():
            raise ValueError(f"Lumen.line: s = {s!r} m: must be finite")
        rows = [self.core.at(float(one), t) for one in places]
        return (
            np.array([row[0] for row in rows]),
            np.array([row[1:4] for row in rows]),
            np.array([row[4] for row in rows]),
        )

    def near(self, x: Sequence[float], radius: float, t: float = 0.0, place: float = 0.0) -> Wall:
        """Return the wall near a ball.

        Parameters
        ----------
        x : sequence of 3 floats
            Its centre [m].
        radius : float
            Its radius [m].
        t : float
            Time [s].
        place : float
            About where along the lumen it is [m]; where the lumen comes back to itself, that decides.
        """
        a, b, c = (float(one) for one in x)
        s, depth, way = self.core.near((a, b, c), radius, t, int(place / 5e-3))
        return Wall(s, depth, np.array(way))

    def target(self, place: float, angle: float, t: float = 0.0) -> NDArray[np.float64]:
        """Return a point of the wall [m], shape (3,): `angle` [rad] from right to down at `place` [m]."""
        points, axes, radius = self.line([place], t)
        out = np.cos(angle) * axes[0, 0] + np.sin(angle) * axes[0, 1]
        point: NDArray[np.float64] = points[0] + radius[0] * out
        return point
