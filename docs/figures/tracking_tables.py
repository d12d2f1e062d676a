"""How many outliers a robust fit of a path bears."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from printed import Printed, table

from ebac.tracking import fit_circle, fit_line

FITS = {"line": fit_line, "circle": fit_circle}
#: Points of a path, paths of each kind, the errors of the points [m], and how wrong their spread may be found.
POINTS, PATHS, SD, WITHIN = 120, 100, 1e-4, 0.4
SHARES = (0.0, 0.05, 0.15, 0.25, 0.35, 0.45, 0.55)


def outliers(_: Printed) -> str:
    """Return the share of fits that find the spread, for far and near outliers."""
    rows = []
    for share in SHARES:
        fits = [_found(shape, share, near) for near in (False, True) for shape in FITS]
        rows.append([f"{100 * share:.0f} %", *(f"{100 * part:.0f} %" for part in fits)])
    heads = ["outliers", "line, far", "circle, far", "line, near", "circle, near"]
    return table(heads, rows)


def _found(shape: str, share: float, near: bool) -> float:
    sds = []
    for seed in range(PATHS):
        random = np.random.default_rng(seed)
        points = _spoiled(shape, random, share, near)
        sds.append(FITS[shape](points, robust=True).deviation.sd_m)
    return float(np.mean(np.abs(np.array(sds) / SD - 1) < WITHIN))


def _spoiled(
    shape: str, random: np.random.Generator, share: float, near: bool
) -> NDArray[np.float64]:
    """Draw a line of 80 mm or an arc of 286 degrees with a radius of 40 mm, and move a share of its points."""
    turn = np.linspace(0, 5, POINTS)
    out = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    if shape == "circle":
        path = 0.04 * out
    else:
        path = np.stack([np.linspace(-0.04, 0.04, POINTS), np.zeros(POINTS)], axis=1)
        out = np.tile([0.0, 1.0], (POINTS, 1))
    path = path + SD * random.standard_normal((POINTS, 2))
    bad = random.permutation(POINTS)[: round(share * POINTS)]
    if near:
        by = random.choice([-1, 1], POINTS) * random.uniform(5 * SD, 10 * SD, POINTS)
        path[bad] += (by[:, None] * out)[bad]
    else:
        path[bad] += (0.02, 0.03) + 0.005 * random.standard_normal((len(bad), 2))
    return np.asarray(path)
