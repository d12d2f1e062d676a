"""An error budget by Monte Carlo: what each source makes of a true line and a true circle. A simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np

from ebac._core import Device
from ebac._util.arguments import number, require, whole
from ebac._util.arrays import Values
from ebac.tracking.circle import fit_circle
from ebac.tracking.error_sources import GROUPS, ErrorSources, Joystick
from ebac.tracking.line import fit_line
from ebac.tracking.table import mean

#: The circle of section IV.B: "a rope with a length of 80 mm" taken as a diameter. As a radius it would not fit into
#: the 100 mm chord of +-30 degrees on a 100 mm lever; the paper's 200 mm is the diameter of the sphere.
RADIUS = 0.040
#: Half the line; the chord ends at 50 mm.
HALF_LINE = 0.040
#: Points of one run along the line and back, or once around and a bit.
POINTS = 400
#: Longest search for the slack that explains the table.
BISECTIONS = 12


@dataclass(frozen=True, kw_only=True)
class BudgetRow:
    """One source on one path, over all runs.

    Attributes
    ----------
    shape : str
        "line" or "circle".
    source : str
        A group of `ErrorSources`, or "all".
    sd_m, sd_low_m, sd_high_m : float
        Median standard deviation about the fit, and its 5 % and 95 % over the runs [m].
    error_m : float
        Median path error, mean |d| [m].
    ratio : float
        Median of error over sd; Table I has 0.64 to 0.88.
    radius_m : float or None
        Median of |fitted radius - true radius| [m]; None for a line.
    """

    shape: str
    source: str
    sd_m: float
    sd_low_m: float
    sd_high_m: float
    error_m: float
    ratio: float
    radius_m: float | None


@dataclass(frozen=True, kw_only=True, repr=False)
class Budget:
    """An error budget beside the paper's table.

    Attributes
    ----------
    rows : tuple of BudgetRow
        Each source, then all together, for the line and the circle.
    sources : ErrorSources
        The sizes that were drawn from.
    runs, seed : int
        How many joysticks were drawn for each row, and from which seed.
    slack_m : dict of str to (float or None)
        By shape: the slack at the handle, end to end, with which all sources together would have the table's mean SD
        [m]; None where even 20 mm have not, or where the others exceed it without any.
    examples : dict of str to array
        By shape: one path with all errors, shape (n, 2) [m].
    """

    rows: tuple[BudgetRow, ...]
    sources: ErrorSources
    runs: int
    seed: int
    slack_m: dict[str, float | None]
    examples: dict[str, Values]

    def __repr__(self) -> str:
        """Return a row per shape and source."""
        from ebac._util.report import report

        shown = ("shape", "source", "sd_m", "sd_low_m", "sd_high_m", "error_m")
        rows = [{key: getattr(row, key) for key in shown} for row in self.rows]
        return report(f"Error budget of {self.runs} simulated joysticks, seed {self.seed}", rows)

    def row(self, shape: str, source: str) -> BudgetRow:
        """Return one row."""
        return next(r for r in self.rows if (r.shape, r.source) == (shape, source))

    def unexplained_m(self, shape: str) -> float:
        """Return what is left of the table's mean SD, sqrt(SD^2 - sd^2) [m]: hand, ruler, rope; 0 for none."""
        return sqrt(max(mean(shape).sd_m ** 2 - self.row(shape, "all").sd_m ** 2, 0.0))


def error_budget(
    *,
    sources: ErrorSources | None = None,
    runs: int = 100,
    seed: int = 1,
    radius: float = RADIUS,
    device: Device | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Budget:
    """Draw joysticks with errors, lead their handles along a true ruler and a true rope, and fit what they show.

    The handle follows the path without error and slowly, so that friction keeps each motor where its slack cable
    leaves it: what comes out is the device's share. How well a hand keeps to a ruler is not in it.

    Parameters
    ----------
    sources : ErrorSources, optional
        Sizes of the errors; the defaults are assumptions.
    runs : int
        Joysticks for each row, [2, 100000].
    seed : int
        Seed of the draws, at least 0.
    radius : float
        Of the circle [m], (0, 0.049].
    device : Device, optional
        A device with a Gimbal; default: the paper's joystick.
    progress : function, optional
        Called with (done, total).

    Returns
    -------
    Budget

    Raises
    ------
    ValueError
        For a number out of range or a device that is no gimbal.
    """
    from ebac import presets

    if not 2 <= whole("runs", runs) <= 100_000:
        raise ValueError(f"runs = {runs}: must lie in [2, 100000]")
    if not 0 < number("radius", radius) <= 0.049:
        raise ValueError(
            f"radius = {radius} m: must lie in (0, 0.049] m, the reach of +-30 deg on 100 mm"
        )
    if whole("seed", seed) < 0:
        raise ValueError(f"seed = {seed}: must be at least 0")
    sizes = ErrorSources() if sources is None else sources
    stick = presets.device("joystick") if device is None else device
    require(sizes, ErrorSources, "ebac.tracking.error_budget", "ErrorSources as its sources")
    require(stick, Device, "ebac.tracking.error_budget", "a Device")
    parts = {**{name: sizes.only(name) for name in GROUPS}, "all": sizes}
    rows: list[BudgetRow] = []
    examples: dict[str, Values] = {}
    slack: dict[str, float | None] = {}
    total = 2 * (len(parts) + 1)
    for shape in ("line", "circle"):
        for name, part in parts.items():
            found = [_one(stick, part, shape, radius, seed, run) for run in range(runs)]
            rows.append(_row(shape, name, found))
            if progress is not None:
                progress(len(rows) + len(slack), total)
        examples[shape] = _path(stick, sizes, shape, radius, seed, 0)
        slack[shape] = _needed_slack(stick, sizes, shape, radius, seed, min(runs, 40))
        if progress is not None:
            progress(len(rows) + len(slack), total)
    return Budget(
        rows=tuple(rows), sources=sizes, runs=runs, seed=seed, slack_m=slack, examples=examples
    )


def _row(shape: str, source: str, found: list[tuple[float, float, float]]) -> BudgetRow:
    sd, error, off = np.array(found).T
    ratio = np.divide(error, sd, out=np.zeros_like(sd), where=sd > 0)
    return BudgetRow(
        shape=shape,
        source=source,
        sd_m=float(np.median(sd)),
        sd_low_m=float(np.quantile(sd, 0.05)),
        sd_high_m=float(np.quantile(sd, 0.95)),
        error_m=float(np.median(error)),
        ratio=float(np.median(ratio)),
        radius_m=float(np.median(off)) if shape == "circle" else None,
    )


def _path(
    device: Device, sources: ErrorSources, shape: str, radius: float, seed: int, run: int
) -> Values:
    """Return what the `run`-th joystick shows. All rows use the same draws, so that sources add up run by run."""
    random = np.random.default_rng([seed, run, shape == "circle"])
    joystick = Joystick.draw(device, sources, random)
    turn = float(random.uniform(0, 2 * np.pi))
    if shape == "line":  # there and back, at any angle, through the middle
        way = HALF_LINE * np.cos(np.linspace(0, 2 * np.pi, POINTS, endpoint=False))
        return joystick.shown(np.outer(way, [np.cos(turn), np.sin(turn)]))
    angle = turn + np.linspace(-np.pi / 4, 2 * np.pi, POINTS, endpoint=False)
    around = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return joystick.shown(around)[POINTS // 9 :]  # the play is used up by then


def _one(
    device: Device, sources: ErrorSources, shape: str, radius: float, seed: int, run: int
) -> tuple[float, float, float]:
    path = _path(device, sources, shape, radius, seed, run)
    if shape == "line":
        deviation = fit_line(path).deviation
        return deviation.sd_m, deviation.error_m, 0.0
    circle = fit_circle(path)
    return circle.deviation.sd_m, circle.deviation.error_m, abs(circle.radius - radius)


def _needed_slack(
    device: Device, sources: ErrorSources, shape: str, radius: float, seed: int, runs: int
) -> float | None:
    """Find by bisection the slack that gives the table's mean SD."""
    wanted = mean(shape).sd_m

    def typical(slack: float) -> float:
        part: Any = sources.replace(slack=slack)
        return float(
            np.median([_one(device, part, shape, radius, seed, r)[0] for r in range(runs)])
        )

    low, high = 0.0, 0.02
    if typical(low) > wanted or typical(high) < wanted:
        return None
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        low, high = (middle, high) if typical(middle) < wanted else (low, middle)
    return (low + high) / 2
