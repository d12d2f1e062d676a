"""A circle through points, by their radial distances (geometric fit)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ebac.tracking.deviation import Deviation, Numbers, checked, measure
from ebac.tracking.robust import STEPS, start, weights

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

    centre: Numbers
    radius: float
    normal: Numbers
    residuals: Numbers
    out_of_plane: Numbers
    angle: Numbers
    deviation: Deviation
    radius_sd_m: float
    centre_sd_m: float
    arc_rad: float
    inliers: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


def fit_circle(points: ArrayLike, *, robust: bool = False) -> CircleFit:
    """Fit a circle by least squares of the radial distances.

    Parameters
    ----------
    points : array-like, shape (n, 2) or (n, 3)
        The path [m], n >= 4, in the order of recording. In space the plane is fitted first, by the distances from it.
    robust : bool
        Whether to fit by Tukey's biweight from a least median of squares, so that nearly half of the points may lie
        anywhere (in space: anywhere near the plane).

    Returns
    -------
    CircleFit

    Raises
    ------
    ValueError
        For points that are too few, not finite, all the same, or on a line.
    """
    path = checked(points, 4, "a circle")
    flat, origin, axes, normal, height = _plane(path)
    middle, size = flat.mean(axis=0), float(np.ptp(flat, axis=0).max())
    unit = (flat - middle) / size
    weight = np.ones(len(unit))
    if robust:
        weight = start(unit, 3, lambda three: _off(unit, three)).astype(float)
        for _ in range(STEPS):
            circle = _geometric(unit, weight)
            before, weight = weight, weights(np.abs(_radial(unit, circle)), 1e-12)
            if np.abs(weight - before).max() < 1e-9:
                break
    circle = _geometric(unit, weight)
    if circle[2] > FLATTEST:
        raise ValueError("the points lie on a line: their circle has no radius; fit a line")
    inliers = weight > 0
    centre, radius = middle + size * circle[:2], size * float(circle[2])
    residuals = size * _radial(unit, circle)
    deviation = measure(residuals, inliers, 3)
    away = flat - centre
    angle = np.arctan2(away[:, 1], away[:, 0])
    sd = _uncertainty(angle[inliers], deviation)
    return CircleFit(
        centre=origin + centre @ axes,
        radius=radius,
        normal=normal,
        residuals=residuals,
        out_of_plane=height,
        angle=angle,
        deviation=deviation,
        radius_sd_m=sd[0],
        centre_sd_m=sd[1],
        arc_rad=_arc(angle[inliers]),
        inliers=inliers,
    )


def _plane(path: Numbers) -> tuple[Numbers, Numbers, Numbers, Numbers, Numbers]:
    """Return points in the plane, its origin, its two axes, its normal and the heights above it."""
    if path.shape[1] == 2:
        return path, np.zeros(2), np.eye(2), np.array([0.0, 0.0, 1.0]), np.zeros(len(path))
    origin = path.mean(axis=0)
    _, _, axes = np.linalg.svd(path - origin, full_matrices=False)
    normal = np.cross(axes[0], axes[1])
    return (path - origin) @ axes[:2].T, origin, axes[:2], normal, (path - origin) @ normal


def _radial(points: Numbers, circle: Numbers) -> Numbers:
    return np.asarray(np.hypot(points[:, 0] - circle[0], points[:, 1] - circle[1]) - circle[2])


def _algebraic(points: Numbers, weight: Numbers) -> Numbers | None:
    """Solve x^2 + y^2 = 2 a x + 2 b y + c, a good start; None where the points lie on a line."""
    root = np.sqrt(weight)
    left = root[:, None] * np.column_stack([2 * points, np.ones(len(points))])
    answer, _, rank, sizes = np.linalg.lstsq(left, root * (points**2).sum(axis=1), rcond=None)
    if rank < 3 or sizes[-1] < 1e-9 * sizes[0]:
        return None
    return np.array([*answer[:2], np.sqrt(max(answer[2] + answer[:2] @ answer[:2], 0.0))])


def _geometric(points: Numbers, weight: Numbers) -> Numbers:
    """Minimise the weighted squares of the radial distances by Levenberg and Marquardt's steps; unit size."""
    circle = _algebraic(points, weight)
    if circle is None:
        raise ValueError("the points lie on a line: their circle has no radius; fit a line")
    damping, cost = 1e-3, float(weight @ _radial(points, circle) ** 2)
    for _ in range(200):
        away = points - circle[:2]
        distance = np.maximum(np.hypot(away[:, 0], away[:, 1]), 1e-300)
        slope = np.column_stack([-away / distance[:, None], -np.ones(len(points))])
        normal = slope.T @ (weight[:, None] * slope)
        gradient = slope.T @ (weight * (distance - circle[2]))
        step = np.linalg.lstsq(normal + damping * np.diag(np.diag(normal)), -gradient, rcond=None)[
            0
        ]
        tried = float(weight @ _radial(points, circle + step) ** 2)
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


def _uncertainty(angle: Numbers, deviation: Deviation) -> tuple[float, float]:
    slope = np.column_stack([np.cos(angle), np.sin(angle), np.ones(len(angle))])
    spread = np.linalg.pinv(slope.T @ slope, hermitian=True) * deviation.n / deviation.independent
    variance = deviation.sd_m**2 * spread
    worst = float(np.linalg.eigvalsh(variance[:2, :2])[-1])
    return float(np.sqrt(variance[2, 2])), float(np.sqrt(max(worst, 0.0)))


def _arc(angle: Numbers) -> float:
    turn = np.sort(angle)
    gaps = np.diff(np.append(turn, turn[0] + 2 * np.pi))
    return float(2 * np.pi - gaps.max())


def _off(points: Numbers, three: Numbers) -> Numbers | None:
    circle = _algebraic(three, np.ones(3))
    return None if circle is None or circle[2] > FLATTEST else np.abs(_radial(points, circle))
