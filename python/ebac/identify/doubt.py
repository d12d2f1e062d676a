"""What a log leaves open of parameters that are held: when within a tick, which share, how a force bends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ebac.identify.parameters import kind

if TYPE_CHECKING:
    from ebac.identify.problem import Problem


@dataclass(frozen=True, kw_only=True, eq=False)
class Doubt:
    """Parameters that are held, but known only to a standard deviation: they move with the search, on a spring."""

    which: NDArray[np.intp]
    deviation: NDArray[np.float64]


#: Hardly determined by a log at one rate, fitted with a weak prior: when in a tick the target changed [ticks], and
#: which share of the motor's ripple the sensor sees.
WITHIN_TICK = {"onset": 0.15, "stair": 0.4}
#: Left as they are, and carried into the intervals; a fit would misuse them to smooth the noise of the force. How the
#: force bent between two rows, as a share of its second difference (0 for straight, 1/12 for a smooth curve).
BEND = 1 / 18
#: When within a tick the force was read [ticks], where the log has the motor's force, so that its ripple is known; and
#: where a device has none. Of a hand without it, see `unrecorded_motor`.
DELAY_DRIVEN, DELAY = 0.005, 0.04


def doubt_of(problem: Problem, deviations: Mapping[str, float]) -> Doubt:
    """Return which held parameters are in doubt, and by how much."""
    p = problem.parameters
    dt = max(r.dt for r in problem.recordings)
    moving = any(t.switches for t in problem.targets)
    driven = any(r.motor is not None for r in problem.recordings)
    found, sure = [], []
    for i, name in enumerate(p.names):
        what = kind(name)
        given = deviations.get(name, deviations.get(what))
        if given is None or np.isnan(p.fixed[i]):
            continue
        if (what == "onset" and not moving) or (what == "stair" and not driven):
            continue
        found.append(i)
        sure.append(given * (dt if what in ("delay", "onset") else 1.0))
    return Doubt(which=np.array(found, dtype=np.intp), deviation=np.array(sure))
