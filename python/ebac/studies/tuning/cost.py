"""What a search makes small: the cost of runs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac._core import QUIET_PERCEIVED
from ebac.studies.sweeps.result import SweepResult

# The cost of a run begins at 0 for one that is good, at 1 for one whose force is not quiet, at 1.5 for one that is not
# exact and still.
_LATE = 0.25  # of a run that is not in time
_SOFT = 0.25  # of one that meets nothing on impact
_WEIGHT = 0.1  # of settling, of energy and of the force swing, each
_HALF_SETTLING = 0.5  # s, at which half of the weight is charged
_HALF_ENERGY = 10e-3  # J
_HALF_SWING = 1.0  # N
_FAR = 1e-3  # m, error and swing of a run that is not good


def cost_of(result: SweepResult) -> float:
    """Return the mean cost of some runs [1]; less is better.

    A good run is exact, and quiet in position and force; it costs 0.1 s/(s + 0.5 s), where position and force have
    settled at s. One that is exact and still, but whose force vibrates by p detection thresholds, costs
    1 + p/(2 (p + 3)); any other 1.5 + e/(2 (e + 1 mm)), e its error and its swing together. To all comes 0.25 for a run
    that is not in time, 0.25 times the share of the wall's stiffness that is missing on impact,
    0.1 E/(E + 10 mJ), E the most energy drawn in any window, and 0.1 R/(R + 1 N), R the force swing at rest.

    Parameters
    ----------
    result : SweepResult
        Runs of a study, `Study.result()`: they have `settled_in_time`, which those of a sweep do not.

    Raises
    ------
    KeyError
        For runs without one of these columns.
    """
    rough = 1 + 0.5 * _share(result["perceived"], QUIET_PERCEIVED)
    away = 1.5 + 0.5 * _share(np.abs(result.deviation_m) + result["swing_m"], _FAR)
    bad = np.where(result.exact_and_still, rough, away)
    settled = np.maximum(result["settled_s"], result["force_settled_s"])
    settling = _WEIGHT * _share(settled, _HALF_SETTLING)
    met = np.clip(np.nan_to_num(result["impact_share"], nan=0.0), 0, 1)
    late = np.where(result["settled_in_time"], 0, _LATE)
    energy = _WEIGHT * _share(result["most_drawn_J"], _HALF_ENERGY)
    swing = _WEIGHT * _share(result["force_swing_N"], _HALF_SWING)
    kept = np.where(result.good, settling, bad)
    return float(np.mean(kept + late + _SOFT * (1 - met) + energy + swing))


def _share(values: NDArray[np.float64], half: float) -> NDArray[np.float64]:
    """Return x/(x + half); 1 where there is no number."""
    return np.asarray(1 - half / (np.nan_to_num(values, nan=np.inf, posinf=np.inf) + half))
