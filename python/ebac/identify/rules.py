"""Gains by rule: what a step response alone suggests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._core import Device, Timing

#: The rules by name.
RULES = ("step-response",)


@dataclass(frozen=True, kw_only=True)
class StepResponse:
    """The reading of the force sensor after a step of the command, the handle held: dead time, rise, gain."""

    dead_time: float  # s
    rise_time: float  # s
    gain: float  # 1


def blocked_step(device: Device, timing: Timing) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return times [s] and the reading [1] after a unit step of the command at t = 0, the handle held in place.

    Transport delay, then the current loop's lag and the sensor's; a command counts from the tick it is computed in.
    """
    dead = timing.delay * timing.dt
    first, second = device.drive.current_lag, device.sensor.lag
    span = dead + 12 * (first + second) + 10 * timing.dt
    t = np.linspace(0, span, 4001)
    s = np.maximum(t - dead, 0)
    if first == second:
        second *= 1.001
    if first == 0 and second == 0:
        return t, (t >= dead).astype(float)

    def rest(lag: float) -> NDArray[np.float64]:
        return lag * np.exp(-s / lag) if lag > 0 else np.zeros_like(s)

    return t, 1 - (rest(first) - rest(second)) / (first - second)


def by_tangent(t: NDArray[np.float64], y: NDArray[np.float64]) -> StepResponse:
    """Read dead time and rise time off a step response, by the tangent at its steepest point (Ziegler, Nichols 1942).

    Raises
    ------
    ValueError
        When the response does not rise.
    """
    slope = np.gradient(y, t)
    steepest = int(np.argmax(slope))
    final = float(y[-1] - y[0])
    if not (final > 0 and slope[steepest] > 0):
        raise ValueError("the step response does not rise: turn its sign, or record a step upwards")
    crossing = float(t[steepest] - (y[steepest] - y[0]) / slope[steepest])
    return StepResponse(
        dead_time=max(crossing, 0.0), rise_time=final / float(slope[steepest]), gain=final
    )


def by_rule(name: str, device: Device, timing: Timing) -> tuple[float, float]:
    """Return K_p [1] and K_d [s] by a named rule.

    `step-response`: the paper takes its "quasi-optimal" set from the step response by its reference [12], whose formula
    it does not print. Taken here: Chien, Hrones and Reswick (1952), no overshoot after a step of the command, for the
    reaction curve of the force with the handle held. K_p = 0.3 T/(k L) as for a proportional controller, since the
    feed-forward of eq. (2) stands in for the integral; the derivative acts over half the dead time, K_d = K_p L/2.

    Raises
    ------
    ValueError
        For a rule that does not exist.
    """
    if name not in RULES:
        raise ValueError(f"rule {name!r}: must be one of {', '.join(RULES)}")
    read = by_tangent(*blocked_step(device, timing))
    dead = max(read.dead_time, 0.5 * timing.dt)  # a sampled loop is never quicker
    kp = 0.3 * read.rise_time / (read.gain * dead)
    return kp, 0.5 * dead * kp
