"""Whether the forces of hand and motor in a log can be those of one device: sign and unit of one beside the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ebac.identify.intervals import newey_west
from ebac.identify.recording import Recording
from ebac.identify.signals import every, kernels, smoothed

#: A gain outside of this range contradicts eq. (6), if it is so many deviations from 1 and the regression explains
#: this share of the force.
RANGE, DEVIATIONS, EXPLAINED = (0.5, 2.0), 8.0, 0.9
#: Forces of one unit in another [1], and so near a gain is that one.
FACTORS, NEAR = {"kgf": 9.80665, "lbf": 4.44822}, 0.15


def doubts(recordings: Sequence[Recording]) -> tuple[str, ...]:
    """Return a sentence for each recording whose forces of hand and motor cannot be those of one device."""
    return tuple(text for r in recordings if (text := _doubt(r)))


def _doubt(r: Recording) -> str:
    found = motor_gain(r)
    if found is None:
        return ""
    gain, deviation, explained = found
    if explained < EXPLAINED or abs(gain - 1) < DEVIATIONS * deviation:
        return ""
    low, high = RANGE
    if low <= -gain <= high:
        return (
            f"{r.name}: the motor pushes with the hand, not against it: the log seems to hold the force that the motor "
            "drives to +x with. --flip-motor turns it, in Python load(..., flip_motor=True)."
        )
    if low <= gain <= high:
        return ""
    says = f"{r.name}: 1 N of the motor is answered by {gain:.3g} N of the hand"
    for unit, by in FACTORS.items():
        for signal, factor in (("force", gain * by), ("motor", gain / by)):
            if abs(factor - 1) < NEAR:
                return (
                    f"{says}: as if {signal} were in {unit}. Name its unit, --unit {signal}={unit}, in Python "
                    f"units={{'{signal}': '{unit}'}}."
                )
    return (
        f"{says}. One of the two is in another unit than its heading says, or is no such force: name the unit, as in "
        "--unit force=kgf, or the column, as in --column motor=NAME."
    )


def motor_gain(r: Recording) -> tuple[float, float, float] | None:
    """Return the hand's force for 1 N of the motor's (1 by eq. (6)), its deviation, and the share that is explained.

    By regression of the smoothed force on motor, acceleration, velocity, friction and weight; None where the log lacks
    one of the forces, or has too few rows.
    """
    if r.force is None or r.motor is None or np.ptp(r.motor) == 0:
        return None
    h, step = kernels(r.dt), every(r.dt)
    columns, forces = [], []
    for rows in r.stretches:
        part = r.rows(rows)
        if len(part.t) <= 2 * h.shape[1] or part.force is None or part.motor is None:
            continue
        velocity = smoothed(part.x, h[1], step)
        moved = [smoothed(part.motor, h[0], step), smoothed(part.x, h[2], step), velocity]
        columns.append(np.array([*moved, np.sign(velocity), np.ones(len(velocity))]).T)
        forces.append(smoothed(part.force, h[0], step))
    if not columns:
        return None
    A, y = np.vstack(columns), np.concatenate(forces)
    if len(y) < 20 * A.shape[1]:
        return None
    scale = np.sqrt(np.mean(A**2, axis=0)) + 1e-300
    left = np.linalg.pinv(A / scale, rcond=1e-8)
    found = left @ y
    scores = (left * (y - A / scale @ found)).astype(float)
    covariance = newey_west(scores, reach=max(2, h.shape[1] // step))
    explained = 1 - float(np.var(y - A / scale @ found) / (np.var(y) + 1e-300))
    deviation = float(np.sqrt(max(covariance[0, 0], 0.0)))
    return float(found[0]) / float(scale[0]), deviation / float(scale[0]), explained
