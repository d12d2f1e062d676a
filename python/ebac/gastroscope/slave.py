"""The gastroscope by itself: kinematics of the bending section, and the slave in the patient tick by tick."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ebac._core import Scope, _camera, _Slave
from ebac._util.arguments import number, require
from ebac.gastroscope.lumen import Lumen


class Camera(NamedTuple):
    """The camera in the frame of the bending section's base.

    Attributes
    ----------
    at : ndarray
        Place [m], shape (3,): right, down, ahead.
    axes : ndarray
        Right, down and ahead of the picture, as rows, shape (3, 3).
    jacobian : ndarray
        How `at` changes with insertion [m/m], rotation, bending to the right and bending down [m/rad], shape (3, 4).
    """

    at: NDArray[np.float64]
    axes: NDArray[np.float64]
    jacobian: NDArray[np.float64]


def camera(bend_x: float, bend_y: float, scope: Scope | None = None) -> Camera:
    """Return where the camera is for a bend to the right and down [rad]: an arc of constant curvature.

    Parameters
    ----------
    bend_x, bend_y : float
        Bend to the right and down [rad].
    scope : Scope, optional
        Its bending section and tip; default: `Scope()`.

    Returns
    -------
    Camera
        Its place [m], its axes, and how the place changes.

    Raises
    ------
    ValueError
        For a bend that is not finite.
    TypeError
        For a bend that is no number, or a scope of another type.

    References
    ----------
    R. J. Webster and B. A. Jones, Int. J. Robotics Research 29 (2010) 1661-1683.
    """
    known = Scope() if scope is None else scope
    require(known, Scope, "ebac.gastroscope.camera", "a Scope")
    for name, bend in (("bend_x", bend_x), ("bend_y", bend_y)):
        if not isfinite(number(f"camera: {name}", bend)):
            raise ValueError(f"camera: {name} = {bend} rad: must be finite")
    at, right, down, ahead, columns = _camera(bend_x, bend_y, known.section, known.tip)
    return Camera(np.array(at), np.array([right, down, ahead]), np.array(columns).T)


@dataclass(frozen=True, kw_only=True)
class SlaveState:
    """The gastroscope in the patient at an instant.

    Attributes
    ----------
    at, ahead, right : ndarray
        Camera [m], its direction of view and its right, shape (3,).
    place, inserted : float
        Of the camera along the lumen, and length of the scope behind the teeth [m].
    bend : tuple of 2 floats
        To the right and down [rad].
    tip_force, section_force, tube_force : float
        Of the wall on the camera, largest on the bending section, largest on the tube [N].
    stored : float
        Energy in the wall that the bending section presses [J].
    tube : ndarray
        The insertion tube, 20 mm from point to point, shape (n, 3) [m].
    bag : ndarray
        Displacement of the stomach as a whole [m], shape (3,).
    """

    at: NDArray[np.float64]
    ahead: NDArray[np.float64]
    right: NDArray[np.float64]
    place: float
    inserted: float
    bend: tuple[float, float]
    tip_force: float
    section_force: float
    tube_force: float
    stored: float
    tube: NDArray[np.float64]
    bag: NDArray[np.float64]


class Slave:
    """The gastroscope in the patient, tick by tick.

    Parameters
    ----------
    scope : Scope, optional
        The gastroscope.
    lumen : Lumen, optional
        The patient.
    start : float
        Place of the camera at the start [m], [0, 1], where it lies at rest, with straight tendons.

    Raises
    ------
    ValueError
        For a start out of its range.
    """

    def __init__(
        self, scope: Scope | None = None, lumen: Lumen | None = None, start: float = 0.09
    ) -> None:
        if not 0 <= start <= 1:
            raise ValueError(f"Slave.start = {start} m: must lie in [0, 1] m")
        self.lumen = Lumen() if lumen is None else lumen
        self._core = _Slave(Scope() if scope is None else scope, self.lumen.core, start)

    def step(
        self,
        insertion: float,
        bend_x: float = 0.0,
        bend_y: float = 0.0,
        rotation: float = 0.0,
        *,
        dt: float = 1e-3,
    ) -> tuple[float, float, float]:
        """Command the four axes for a tick.

        Parameters
        ----------
        insertion : float
            Of the bending section's base [m], [-10, 10].
        bend_x, bend_y, rotation : float
            To the right, down, and about the tube [rad], [-100, 100].
        dt : float
            Length of the tick [s], [1e-5, 0.1].

        Returns
        -------
        push, torque_x, torque_y : float
            Resistance against insertion [N] and bends [N m].

        Raises
        ------
        ValueError
            For a number that is not finite or out of its range; nothing has moved then.
        """
        _check("insertion", insertion, "m", -10, 10)
        for name, angle in (("bend_x", bend_x), ("bend_y", bend_y), ("rotation", rotation)):
            _check(name, angle, "rad", -100, 100)
        _check("dt", dt, "s", 1e-5, 0.1)
        push, torque_x, torque_y = self._core.step((insertion, bend_x, bend_y), rotation, dt)
        return push, torque_x, torque_y

    @property
    def state(self) -> SlaveState:
        """The slave as it is now."""
        given = self._core.state()
        arrays = ("at", "ahead", "right", "tube", "bag")
        values: dict[str, Any] = {
            str(name): np.array(value) if name in arrays else value for name, value in given.items()
        }
        return SlaveState(**values)


def _check(name: str, value: float, unit: str, least: float, most: float) -> None:
    if not least <= number(f"Slave.step: {name}", value) <= most:
        raise ValueError(
            f"Slave.step: {name} = {value:g} {unit}: must lie in [{least:g}, {most:g}] {unit}"
        )
