"""What the noise of an input does to an estimate, and how it is taken off again."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac._core import ArmGains
from ebac.identify.noise import rough
from ebac.identify.problem import Problem

Values = NDArray[np.float64]

#: Logs of noise that are averaged over.
DRAWS = 4
#: Largest correction, as a share of what is left of a parameter's information.
LARGEST_SHARE = 0.5
#: Least information, as a share of the best direction's, by which anything is corrected.
LEAST_SHARE = 1e-9


def without_noise(
    problem: Problem, values: Values, force_noise: Values, gains: list[ArmGains]
) -> tuple[Values, Values]:
    """Return the values without the bias of a noisy input, and the Jacobian of the noise.

    The force reading drives the model, noise and all: noise is taken for force that moved nothing, so the hand comes
    out too heavy (errors in variables, attenuation). The score that noise alone gives is known, it is that of a log
    of noise; taken off, the score has mean zero at the truth (Nakamura 1990). One Newton step from the optimum does it.

    Only what the sensor itself shows counts, not what else disturbs a hand.
    """
    noise = []
    for r, found in zip(problem.recordings, force_noise.tolist(), strict=True):
        assert r.force is not None
        noise.append(min(found, rough(r.force)))
    moved = problem.moved
    score = np.zeros(len(moved))
    information = np.zeros((len(moved), len(moved)))
    pretended = np.zeros((len(moved), 0))
    for seed in range(DRAWS):
        J, e = problem.of_noise(values, gains, np.array(noise), moved, seed)
        score += np.einsum("ik,k->i", J, e) / DRAWS
        information += np.einsum("ik,jk->ij", J, J) / DRAWS
        pretended = J
    S = problem.slope(values, gains)
    H = np.einsum("ik,jk->ij", S, S)
    scale = np.sqrt(np.diag(H))
    scale[scale == 0] = 1.0
    known = (H - information) / np.outer(scale, scale)
    least = np.linalg.eigvalsh(H / np.outer(scale, scale))[0]
    if np.linalg.eigvalsh(known)[0] < max(LARGEST_SHARE * least, LEAST_SHARE):
        return values, pretended  # noise is most of what there is: nothing to correct by
    out = values.copy()
    out[moved] += np.linalg.solve(known, score / scale) / scale
    return problem.parameters_within(out), pretended
