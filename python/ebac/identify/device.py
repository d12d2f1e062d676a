"""Identify the device: M_h, B_h of eq. (6), friction, weight; from them tau_static of eq. (2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Compensation
from ebac.identify.levels import lagged
from ebac.identify.recording import Recording
from ebac.identify.result import Z95, Estimate
from ebac.identify.smooth import WIDTH, kernels, smoothed

#: Standard gravity [m/s^2].
GRAVITY = 9.80665
#: Stribeck speeds that are tried [m/s].
SPEEDS = np.geomspace(2e-3, 0.1, 15)
#: Rows in which it must slide.
LEAST_SLIDING = 200
NAMES = ("M_h", "B_h", "coulomb", "weight", "stribeck")
UNITS = ("kg", "N s/m", "N", "N", "N")


@dataclass(frozen=True, kw_only=True, eq=False)
class DeviceResult:
    """The device as identified; `result.compensation` feeds a `Device`."""

    names: tuple[str, ...]
    values: NDArray[np.float64]
    covariance: NDArray[np.float64]
    stribeck_speed: float | None
    explained: float

    @cached_property
    def estimates(self) -> dict[str, Estimate]:
        """Every parameter by name: M_h, B_h, coulomb, weight (towards +x), stribeck (breakaway above Coulomb)."""
        half = Z95 * np.sqrt(np.diag(self.covariance))
        rows = zip(self.names, self.values.tolist(), half.tolist(), UNITS, strict=False)
        return {
            name: Estimate(
                name=name,
                value=value,
                unit=unit,
                low=value - h,
                high=value + h,
                fixed=False,
                determined=name in ("coulomb", "weight", "stribeck") or h <= 0.25 * abs(value),
            )
            for name, value, h, unit in rows
        }

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Names of what the log does not determine."""
        return tuple(name for name, e in self.estimates.items() if not e.determined)

    @property
    def compensation(self) -> Compensation:
        """Return tau_static of eq. (2), never more than is surely there.

        The lower bounds of friction and of the weight against +x. Inertia is left alone: given back it costs
        damping, see `Compensation`.
        """
        friction = max(0.0, self.estimates["coulomb"].low)
        weight = max(0.0, -self.estimates["weight"].high)
        return Compensation(friction=friction, gravity_mass=weight / GRAVITY)

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers in SI units, for JSON."""
        return {
            "rows": [vars(e) for e in self.estimates.values()],
            "stribeck_speed_m_per_s": self.stribeck_speed,
            "explained_share": self.explained,
            "undetermined": list(self.undetermined),
            "compensation": self.compensation.as_dict(),
        }

    def __repr__(self) -> str:
        """Return the estimates, one a line."""
        lines = ["Device:"] + [f"  {e}" for e in self.estimates.values()]
        return "\n".join([*lines, f"  explains {100 * self.explained:.2f} % of the force"])


def fit_device(recording: Recording, *, current_lag: float = 3e-4) -> DeviceResult:
    """Fit mass, damping, friction and weight to a log: M_h a + B_h v + friction sign(v) - weight = F_hand - F_motor.

    A hand may hold the device when a force sensor sits between them; without the column `force`, no hand must touch it.

    Parameters
    ----------
    recording : Recording
        With motion, and the motor's or the hand's force.
    current_lag : float
        Lag of the current loop [s].

    Raises
    ------
    ValueError
        When the recording has neither force, or does not move both ways.
    """
    if recording.motor is None and recording.force is None:
        raise ValueError(
            f"{recording.name}: has neither the motor's force nor the hand's; name one of these columns"
        )
    drive, moved = _signals(recording, current_lag)
    if not ((moved[1] > 0).any() and (moved[1] < 0).any()):
        raise ValueError(
            f"{recording.name}: moves one way only; friction shows when it moves both ways"
        )
    best = _regress(drive, moved, None)
    speed = None
    if recording.count > 0:
        for trial in SPEEDS:
            found = _regress(drive, moved, float(trial))
            stribeck = found[0][4]
            if found[2] < best[2] * 0.98 and stribeck > 3 * np.sqrt(found[1][4, 4]):
                best, speed = found, float(trial)
    values, covariance, left = best
    return DeviceResult(
        names=NAMES[: len(values)],
        values=values,
        covariance=covariance,
        stribeck_speed=speed,
        explained=1 - left / float(np.var(drive) * len(drive) + 1e-300),
    )


def _signals(r: Recording, current_lag: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return force, and acceleration, velocity, sign of velocity, smoothed alike and behind both lags."""
    h = kernels(r.dt)

    def behind(values: NDArray[np.float64], *lags: float) -> NDArray[np.float64]:
        for lag in lags:
            values = lagged(values, r.dt, lag)
        return values

    force = np.zeros(len(r.t))
    if r.force is not None:
        force = force + r.force
    if r.motor is not None:  # acted over the tick before the row, behind the current loop
        later = np.append(r.motor[1:], r.motor[-1])
        force = force - behind(0.5 * (r.motor + later), current_lag, r.lag)
    x = behind(r.x, r.lag)
    quick = kernels(r.dt, 0.25 * WIDTH)
    edge = quick.shape[1] // 2
    sign = smoothed(np.sign(smoothed(x, quick[1])), h[0])
    force, x = force[edge : len(force) - edge], x[edge : len(x) - edge]
    slides = (
        np.abs(sign) > 0.99
    )  # one way throughout the kernel; near a turn friction is what it has to be
    if slides.sum() < LEAST_SLIDING:
        raise ValueError(f"{r.name}: slides in {slides.sum()} rows only; needs {LEAST_SLIDING}")
    moved = np.array([smoothed(x, h[2]), smoothed(x, h[1]), np.sign(sign)])
    return smoothed(force, h[0])[slides], moved[:, slides]


def _regress(
    force: NDArray[np.float64], moved: NDArray[np.float64], speed: float | None
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    columns = [moved[0], moved[1], moved[2], -np.ones(len(force))]
    if speed is not None:
        columns.append(moved[2] * np.exp(-((moved[1] / speed) ** 2)))
    A = np.array(columns).T
    scale = np.sqrt((A**2).mean(axis=0)) + 1e-300
    inverse = np.linalg.pinv((A / scale).T @ (A / scale), rcond=1e-12)
    raw = inverse @ ((A / scale).T @ force)
    e = force - (A / scale) @ raw
    scores = (A / scale) * e[:, None]
    block = max(64, len(e) // 60)
    sums = np.add.reduceat(scores, np.arange(0, len(e), block), axis=0)
    covariance = inverse @ (sums.T @ sums) @ inverse
    return raw / scale, covariance / np.outer(scale, scale), float(e @ e)
