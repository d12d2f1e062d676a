"""What the steps of a motor that a log lacks do to a fit of a hand that follows a path: the path seems late, too.

The part of F that samples miss, see `unrecorded_motor`, has (1 - k) K0 v0 dt of a target that moves at v0: as if the
target came (1 - k) g ticks late. Nothing in the log shows k, so the intervals hold every k from 0 to 1.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np

from ebac._core import ArmGains
from ebac._util.arrays import Values
from ebac.identify.problem import Problem
from ebac.identify.unrecorded_motor import SQUARE, found_late, parts


def of_late_paths(
    problem: Problem, values: Values, gains: list[ArmGains], errors: Values
) -> Values:
    """Return by how much late paths would change the errors at some values, by one deviation, shape (0 or 1, rows)."""
    dt = max(r.dt for r in problem.recordings)
    late = {  # s
        part.delay: part.share * found_late(problem, values, part.delay)
        if part.delay in problem.doubt.which
        else part.motor * dt
        for part in parts(problem.recordings, problem.parameters)
    }
    if not any(late.values()) or all(target.path is None for target in problem.targets):
        return np.zeros((0, len(errors)))
    targets = tuple(
        target
        if target.path is None
        else replace(target, path=np.interp(r.t + late[int(place[3])], r.t, target.path))
        for r, target, place in zip(
            problem.recordings, problem.targets, problem.parameters.places, strict=True
        )
    )
    change = replace(problem, targets=targets).errors(values, gains) - errors
    return sqrt(SQUARE) * change[None]
