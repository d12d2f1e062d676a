"""The lever at which a knob or a joint is searched: as a handle, for which starts and bounds of a search are made."""

from __future__ import annotations

import numpy as np

from ebac.identify.device_problem import driven, first_guess
from ebac.identify.recording import Recording
from ebac.identify.signals import speed

#: A handle is moved about so fast [m/s], is at least and at most so heavy [kg], and is moved by less than this [N].
USUAL_SPEED, LIGHT, HEAVY, STRONG = 0.1, 0.05, 10.0, 50.0
#: Of an axis that does not turn [rad/s].
STILL = 1e-6


def usual_lever(r: Recording, current_lag: float) -> float:
    """Return the lever at which a rotary device moves, and is as heavy, as handles are [m].

    Raises
    ------
    ValueError
        As `driven` does.
    """
    parts = [speed(part.x, r.dt) for part in map(r.rows, r.stretches)]
    fast = float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))
    lever = USUAL_SPEED / max(fast, STILL)
    drive = driven(r.at_lever(lever), current_lag, lever)
    mass = max(abs(float(first_guess(drive).values[0])), 1e-12)
    force = float(np.sqrt(np.mean(drive.smooth_force[drive.slides] ** 2)))
    return lever * max(float(np.sqrt(mass / np.clip(mass, LIGHT, HEAVY))), force / STRONG)
