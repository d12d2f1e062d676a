"""A straight line through points, by the distances across it (total least squares)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ebac._util.arrays import Values
from ebac.tracking.deviation import Deviation, checked, digits, measure
from ebac.tracking.robust import counted


@dataclass(frozen=True, kw_only=True, eq=False)
class LineFit:
    """A fitted line.

    Attributes
    ----------
    point : array, shape (2,) or (3,)
        Its point nearest to the middle of the path [m].
    direction : array, shape (2,) or (3,)
        Unit vector along it, from the first counted point of the path to the last.
    residuals : array, shape (n,) or (n, 2)
        Distances across it [m]: in the plane with a sign, positive to the left; in space in two directions.
    along : array, shape (n,)
        Way along it from `point` [m].
    deviation : Deviation
        The distances in numbers, p = 2: in space each point gives two distances for 4 fitted numbers.
    direction_sd_rad, offset_sd_m : float
        Standard deviation of its direction [rad] and of `point` across it [m], from `deviation.independent` points.
    inliers : array of bool, shape (n,)
        What was counted; all without `robust`.
    """

    point: Values
    direction: Values
    residuals: Values
    along: Values
    deviation: Deviation
    direction_sd_rad: float
    offset_sd_m: float
    inliers: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    @property
    def length_m(self) -> float:
        """Way along it from end to end of what was counted [m]."""
        return float(np.ptp(self.along[self.inliers]))

    @property
    def angle_rad(self) -> float:
        """Direction in the plane of the first two axes, (-pi, pi] [rad]."""
        angle = float(np.arctan2(self.direction[1], self.direction[0]))
        return angle if angle > -np.pi else float(np.pi)  # a direction has -0.0, too

    def __repr__(self) -> str:
        """Return one line: length, direction, deviation, points counted."""
        return (
            f"<LineFit: length {1e3 * self.length_m:.4g} mm, angle {np.degrees(self.angle_rad):.4g} deg; "
            f"SD {digits(1e3 * self.deviation.sd_m, 3)} mm of {int(self.inliers.sum())} of {len(self.inliers)} points; "
            "distances in .residuals>"
        )


def fit_line(points: ArrayLike, *, robust: bool = False) -> LineFit:
    """Fit a line by least squares of the distances across it.

    Parameters
    ----------
    points : array-like, shape (n, 2) or (n, 3)
        The path [m], n >= 3, in the order of recording.
    robust : bool
        Whether to leave outliers out: least trimmed squares, and from there all points within 3.5 standard deviations
        (`ebac.tracking.robust`). Up to (n - 2) / 2 points may lie anywhere.

    Returns
    -------
    LineFit

    Raises
    ------
    ValueError
        For points that are too few, not finite, all the same, or without one direction of their own.
    """
    path = checked(points, 3, "a line")
    inliers = np.ones(len(path), bool)
    if robust:
        floor = 1e-12 * float(np.ptp(path, axis=0).max())
        inliers = counted(path, 2, _off, floor)
    kept = path[inliers]
    point, direction = _principal(kept)
    if direction @ (kept[-1] - kept[0]) < 0:
        direction = -direction
    centred = path - point
    along = centred @ direction
    point = point + direction * 0.5 * float(along[inliers].max() + along[inliers].min())
    along = (path - point) @ direction
    residuals = centred @ _normals(direction).T
    residuals = residuals[:, 0] if path.shape[1] == 2 else residuals
    deviation = measure(residuals, inliers, 2)
    each = deviation.sd_m / np.sqrt(path.shape[1] - 1) / np.sqrt(deviation.independent)
    spread = float(np.sqrt(np.average((along[inliers] - along[inliers].mean()) ** 2)))
    away = float(along[inliers].mean()) / spread
    return LineFit(
        point=point,
        direction=direction,
        residuals=residuals,
        along=along,
        deviation=deviation,
        direction_sd_rad=float(each / spread),
        offset_sd_m=float(each * np.hypot(1, away)),
        inliers=inliers,
    )


def _principal(path: Values) -> tuple[Values, Values]:
    point = path.mean(axis=0)
    _, sizes, axes = np.linalg.svd(path - point, full_matrices=False)
    if sizes[0] - sizes[1] <= 1e-9 * sizes[0]:
        raise ValueError(
            "the points spread alike in all directions: they have no line; fit a circle?"
        )
    return point, axes[0]


def _normals(direction: Values) -> Values:
    """Return unit vectors across a direction: in the plane to its left."""
    if len(direction) == 2:
        return np.array([[-direction[1], direction[0]]])
    least = np.eye(3)[int(np.abs(direction).argmin())]
    first = np.cross(direction, least)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(direction, first)])


def _size(path: Values, point: Values, direction: Values) -> Values:
    return np.asarray(np.linalg.norm((path - point) @ _normals(direction).T, axis=1))


def _off(fitted: Values, measured: Values) -> Values | None:
    """Return |distances| of measured points from the line through the fitted ones; None where these have none."""
    try:
        return _size(measured, *_principal(fitted))
    except ValueError:
        return None
