"""The sampled linear loop of one axis: exact eigenvalues, no simulation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac._core import LinearLoop
from ebac.scenario import Scenario


def eigenvalues(
    scenario: Scenario, stiffness: float, damping: float = 0.0
) -> NDArray[np.complex128]:
    """Return the eigenvalues of the loop from tick to tick, largest modulus first.

    The loop is hand, handle, current lag, delay, velocity estimate and hold, as simulated, deep in a wall and without
    a law; without friction, encoder counts, the wall's edge and the drive's peak.

    Parameters
    ----------
    scenario : Scenario
        Device, hand and timing count; give a hand of no mass, damping and stiffness for a device let go.
    stiffness : float
        Of the wall [N/m].
    damping : float
        Of the wall, on the estimated velocity [N s/m].

    Raises
    ------
    ValueError
        For a device that is not linear even so: a gimbal, a compliant cable, an adaptive window.
    """
    values = np.asarray(LinearLoop(scenario.setup()).eigenvalues(stiffness, damping))
    return values[np.argsort(-np.abs(values))]


def spectral_radius(scenario: Scenario, stiffness: float, damping: float = 0.0) -> float:
    """Return the largest modulus of an eigenvalue; below one, everything decays. Parameters as `eigenvalues`."""
    return LinearLoop(scenario.setup()).spectral_radius(stiffness, damping)


def stiffness_limit(scenario: Scenario, damping: float = 0.0) -> float:
    """Return the largest wall stiffness [N/m] up to which everything decays, by bisection.

    0 where the wall's damping alone is too much; 1e7, the largest stiffness of a wall, where nothing is.

    Parameters
    ----------
    scenario, damping
        As `eigenvalues`.
    """
    return LinearLoop(scenario.setup()).stiffness_limit(damping)
