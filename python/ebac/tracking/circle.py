"""A circle through points, by their radial distances (geometric fit)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ebac._util.arrays import Values
from ebac.tracking.deviation import Deviation, checked, digits, measure
from ebac.tracking.robust import counted

#: A radius beyond this many times the size of the path is a line.
FLATTEST = 1e3


@dataclass(frozen=True, kw_only=True, eq=False)
class CircleFit:
    """A fitted circle.

    Attributes
    ----------
    centre : array, shape (2,) or (3,)
        Its centre [m].
    radius : float
        Its radius [m].
    normal : array, shape (3,)
        Unit vector across its plane; z in the plane.
    residuals : array, shape (n,)
        Radial distances [m], positive outside; in space of the points moved into the plane.
    out_of_plane : array, shape (n,)
        Distances from the plane [m]; 0 in the plane.
    angle : array, shape (n,)
        Where each point lies on the circle [rad].
    deviation : Deviation
        The radial distances in numbers, p = 3.
    radius_sd_m, centre_sd_m : float
        Standard deviations of the radius and of the centre in its worst direction [m], from `deviation.independent`
        points. A short arc has large ones.
    arc_rad : float
        How much of the circle the points cover, 2 pi minus the largest gap [rad].
    inliers : array of bool, shape (n,)
        What was counted; all without `robust`.
    """

    centre: Values
    radius: float
    normal: Values
    residuals: Values
    out_of_plane: Values
    angle: Values
    deviation: Deviation
    radius_sd_m: float
    centre_sd_m: float
    arc_rad: float
    inliers: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]

    @property
    def out_of_plane_rms_m(self) -> float:
        """Root mean square of the counted distances from the plane [m]; `deviation` does not hold them."""
        return float(np.sqrt((self.out_of_plane[self.inliers] ** 2).mean()))

    @property
    def out_of_plane_largest_m(self) -> float:
        """Largest of the counted distances from the plane [m]."""
        return float(np.abs(self.out_of_plane[self.inliers]).max())

    def __repr__(self) -> str:
        """Return one line: radius, centre, arc, deviation, points counted."""
        centre = ", ".join(f"{round(1e3 * value, 4) + 0.0:.4f}" for value in self.centre.tolist())
        plane = f", out of its plane {digits(1e3 * self.out_of_plane_rms_m, 3)} mm rms"
        return (
            f"<CircleFit: radius {1e3 * self.radius:.4g} mm, centre ({centre}) mm, "
            f"arc {np.degrees(self.arc_rad):.4g} deg; SD {digits(1e3 * self.deviation.sd_m, 3)} mm"
            f"{plane if len(self.centre) == 3 else ''} of "
            f"{int(self.inliers.sum())} of {len(self.inliers)} points; distances in .residuals>"
        )


def fit_circle(points: ArrayLike, *, robust: bool = False) -> CircleFit:
    """Fit a circle by least squares of the radial distances.

    Parameters
    ----------
    points : array-like, shape (n, 2) or (n, 3)
        The path [m], n >= 4, in the order of recording. In space the plane is fitted first, by the distances from it.
    robust : bool
        Whether to leave outliers out: least trimmed squares, and from there all points within 3.5 standard deviations
        (`ebac.tracking.robust`). Up to (n - 3) / 2 points may lie anywhere.

    Returns
    -------
    CircleFit

    Raises
    ------
    ValueError
        For points that are too few, not finite, all the same, or on a line.
    """
    path = checked(points, 4, "a circle")
    middle, size = path.mean(axis=0), float(np.ptp(path, axis=0).max())
    unit = (path - middle) / size
    inliers = np.ones(len(unit), bool)
    if robust:
        inliers = counted(unit, 3, _off, 1e-12)
    origin, axes, normal = _plane(unit[inliers])
    flat, height = (unit - origin) @ axes.T, _height(unit, origin, normal)
    circle = _geometric(flat[inliers])
    if circle[2] > FLATTEST:
        raise ValueError("the points lie on a line: their circle has no radius; fit a line")
    residuals = size * _radial(flat, circle)
    deviation = measure(residuals, inliers, 3)
    away = flat - circle[:2]
    angle = np.arctan2(away[:, 1], away[:, 0])
    sd = _uncertainty(angle[inliers], deviation)
    return CircleFit(
        centre=middle + size * (origin + circle[:2] @ axes),
        radius=size * float(circle[2]),
        normal=normal,
        residuals=residuals,
        out_of_plane=size * height,
        angle=angle,
        deviation=deviation,
        radius_sd_m=sd[0],
        centre_sd_m=sd[1],
        arc_rad=_arc(angle[inliers]),
        inliers=inliers,
    )


def _plane(points: Values) -> tuple[Values, Values, Values]:
    """Return the origin of the plane of points, its two axes and its normal."""
    if points.shape[1] == 2:
        return np.zeros(2), np.eye(2), np.array([0.0, 0.0, 1.0])
    origin = points.mean(axis=0)
    _, _, axes = np.linalg.svd(points - origin, full_matrices=False)
    return origin, axes[:2], np.cross(axes[0], axes[1])


def _height(points: Values, origin: Values, normal: Values) -> Values:
    flat = points.shape[1] == 2
    return np.zeros(len(points)) if flat else np.asarray((points - origin) @ normal)


def _radial(points: Values, circle: Values) -> Values:
    return np.asarray(np.hypot(points[:, 0] - circle[0], points[:, 1] - circle[1]) - circle[2])


def _algebraic(points: Values) -> Values | None:
    """Solve x^2 + y^2 = 2 a x + 2 b y + c, a good start; None where the points lie on a line."""
    left = np.column_stack([2 * points, np.ones(len(points))])
    answer, _, rank, sizes = np.linalg.lstsq(left, (points**2).sum(axis=1), rcond=None)
    if rank < 3 or sizes[-1] < 1e-9 * sizes[0]:
        return None
    return np.array([*answer[:2], np.sqrt(max(answer[2] + answer[:2] @ answer[:2], 0.0))])


def _geometric(points: Values) -> Values:
    """Minimise the squares of the radial distances by Levenberg and Marquardt's steps; unit size."""
    circle = _algebraic(points)
    if circle is None:
        raise ValueError("the points lie on a line: their circle has no radius; fit a line")
    damping, cost = 1e-3, float((_radial(points, circle) ** 2).sum())
    for _ in range(200):
        away = points - circle[:2]
        distance = np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-300)
        slope = np.column_stack([-away / distance[:, None], -np.ones(len(points))])
        normal = slope.T @ slope
        gradient = slope.T @ (distance - circle[2])
        step = np.linalg.lstsq(normal + damping * np.diag(np.diag(normal)), -gradient, rcond=None)[
            0
        ]
        tried = float((_radial(points, circle + step) ** 2).sum())
        if tried <= cost:
            circle, damping = circle + step, damping / 10
            if float(np.abs(step).max()) < 1e-14 * (1 + abs(circle[2])):
                break
            cost = tried
        elif damping > 1e12 or float(np.abs(step).max()) < 1e-15:
            break
        else:
            damping *= 10
    return circle


def _uncertainty(angle: Values, deviation: Deviation) -> tuple[float, float]:
    slope = np.column_stack([np.cos(angle), np.sin(angle), np.ones(len(angle))])
    spread = np.linalg.pinv(slope.T @ slope, hermitian=True) * deviation.n / deviation.independent
    variance = deviation.sd_m**2 * spread
    worst = float(np.linalg.eigvalsh(variance[:2, :2])[-1])
    return float(np.sqrt(variance[2, 2])), float(np.sqrt(max(worst, 0.0)))


def _arc(angle: Values) -> float:
    turn = np.sort(angle)
    gaps = np.diff(np.append(turn, turn[0] + 2 * np.pi))
    return float(2 * np.pi - gaps.max())


def _off(fitted: Values, measured: Values) -> Values | None:
    """Return |distances| of measured points from the circle through the fitted ones; None where these lie on a line."""
    origin, axes, normal = _plane(fitted)
    flat = (fitted - origin) @ axes.T
    circle = _algebraic(flat)
    if circle is not None and len(fitted) > 3:
        circle = _geometric(flat)
    if circle is None or circle[2] > FLATTEST:
        return None
    radial = _radial((measured - origin) @ axes.T, circle)
    return np.asarray(np.hypot(radial, _height(measured, origin, normal)))
