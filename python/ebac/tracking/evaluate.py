"""A recorded path: what it follows, and how well."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees
from typing import Any

import numpy as np

from ebac._util.arguments import require, unknown
from ebac.tracking.circle import CircleFit, fit_circle
from ebac.tracking.line import LineFit, fit_line
from ebac.tracking.read import RecordedPath

SHAPES = ("auto", "line", "circle")
#: A circle is taken for what covers at least this much of one [rad] ...
LEAST_ARC = np.pi / 2
#: ... and lies this much nearer to it than to a line.
NEARER = 0.5
#: Beyond so many standard deviations out of the plane of a circle a remark follows: equal errors in space give one.
OUT_OF_PLANE = 2.0


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Tracking:
    """A path and the line or circle through it."""

    path: RecordedPath
    fit: LineFit | CircleFit

    @property
    def shape(self) -> str:
        """What was fitted: "line" or "circle"."""
        return "line" if isinstance(self.fit, LineFit) else "circle"

    @property
    def remark(self) -> str:
        """What the numbers leave out: a path that leaves the plane of its circle; empty if nothing."""
        fit = self.fit
        if isinstance(fit, LineFit):
            return ""
        rms, largest = fit.out_of_plane_rms_m, fit.out_of_plane_largest_m
        if rms <= OUT_OF_PLANE * fit.deviation.sd_m + 1e-9:  # 1 nm: rounding
            return ""
        return (
            f"{self.path.name} leaves the plane of its circle by {1e3 * rms:.3g} mm rms, {1e3 * largest:.3g} mm at "
            "most; SD, path error and largest are radial and do not count that"
        )

    def __repr__(self) -> str:
        """Return the fit and how far the path lies from it."""
        mm, d = 1e3, self.fit.deviation
        if isinstance(self.fit, LineFit):
            size = f"length {mm * self.fit.length_m:.2f} mm"
        else:
            size = f"radius {mm * self.fit.radius:.3f} mm"
        return (
            f"<Tracking of {self.path.name}: {self.shape}, {size}; {d.n} points, {d.outliers} outliers, "
            f"SD {mm * d.sd_m:.3f} mm, error {mm * d.error_m:.3f} mm, largest {mm * d.largest_m:.3f} mm>"
        )

    def row(self) -> dict[str, Any]:
        """Return the documented row of `ebac track --json`."""
        fit, d = self.fit, self.fit.deviation
        row: dict[str, Any] = {
            "file": self.path.name,
            "read": self.path.remark,
            "shape": self.shape,
            "points": d.n,
            "outliers": d.outliers,
            "independent_points": d.independent,
            "sd_m": d.sd_m,
            "error_m": d.error_m,
            "rms_m": d.rms_m,
            "largest_m": d.largest_m,
        }
        if isinstance(fit, LineFit):
            more = {
                "length_m": fit.length_m,
                "angle_deg": degrees(fit.angle_rad),
                "angle_sd_deg": degrees(fit.direction_sd_rad),
                "point_m": [float(v) for v in fit.point],
                "point_sd_m": fit.offset_sd_m,
            }
        else:
            more = {
                "radius_m": fit.radius,
                "radius_sd_m": fit.radius_sd_m,
                "arc_deg": degrees(fit.arc_rad),
                "centre_m": [float(v) for v in fit.centre],
                "centre_sd_m": fit.centre_sd_m,
                "out_of_plane_rms_m": fit.out_of_plane_rms_m,
                "out_of_plane_largest_m": fit.out_of_plane_largest_m,
            }
        return row | more


def evaluate(path: RecordedPath, *, shape: str = "auto", robust: bool = False) -> Tracking:
    """Fit a line or a circle to a recorded path.

    Parameters
    ----------
    path : RecordedPath
        See `read_path`.
    shape : str
        "line", "circle", or "auto": a circle where the path covers at least 90 degrees of one and lies at most half as
        far from it as from a line.
    robust : bool
        See `fit_line` and `fit_circle`.

    Returns
    -------
    Tracking

    Raises
    ------
    ValueError
        When the path cannot be fitted; with the name of its file.
    """
    require(path, RecordedPath, "ebac.tracking.evaluate", "a RecordedPath")
    if shape not in SHAPES:
        raise ValueError(unknown(f"shape = {shape!r}", shape, SHAPES))
    try:
        fit = _fit(path, shape, robust)
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None
    return Tracking(path=path, fit=fit)


def _fit(path: RecordedPath, shape: str, robust: bool) -> LineFit | CircleFit:
    if shape == "line":
        return fit_line(path.points, robust=robust)
    if shape == "circle":
        return fit_circle(path.points, robust=robust)
    try:
        circle = fit_circle(path.points, robust=robust)
    except ValueError:
        return fit_line(path.points, robust=robust)
    try:
        line = fit_line(path.points, robust=robust)
    except ValueError:
        return circle
    away = np.hypot(circle.deviation.sd_m, circle.out_of_plane_rms_m)
    near = away <= NEARER * line.deviation.sd_m
    return circle if near and circle.arc_rad >= LEAST_ARC else line
