"""The device as a problem: eq. (6) with friction and weight, driven by the forces on its handle."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import ArmRecord
from ebac._util.arrays import Values
from ebac.identify.missing import left_for
from ebac.identify.parameters import BOUNDS, Parameters
from ebac.identify.problem import Problem
from ebac.identify.recording import Recording
from ebac.identify.signals import (
    WIDTH,
    by_place,
    kernels,
    readings,
    rough,
    smoothed,
    stair,
    unknown_force,
)
from ebac.identify.target import Target

#: Rows in which it must slide.
LEAST_SLIDING = 200
#: Slides one way when it does so for this long before and after [s].
AROUND = 0.012
#: Slowest sliding [m/s], and in counts over the width of the kernel.
SLOWEST, COUNTS = 1e-3, 0.5
#: A shorter stop than the kernel shows where an encoder is so fine: slowest sliding passes as many counts within WIDTH.
FINE = 4.0
#: Where it does not slide, friction is whatever it has to be: this many times the largest force.
WHATEVER = 100.0
#: A force jumps where it bends by this many deviations of its noise; a tick may miss this share of it, for this many
#: rows before and after.
NOISY, JUMP, FELT = 5.0, 0.5, 4
#: What is fitted, in this order; `stribeck` not always.
FITTED = ("M_h", "B_h", "coulomb", "weight", "stribeck")


@dataclass(frozen=True, kw_only=True, eq=False)
class Drive:
    """What drives a device, and when it slides; one value a row."""

    recording: Recording  # with the lag that all of it stands behind
    force: Values  # N, motor less hand: what resists +x
    beyond: Values  # N, ripple of the motor
    slides: NDArray[np.bool_]
    sign: Values  # of the velocity, 0 where it does not slide
    velocity: Values  # m/s
    acceleration: Values  # m/s^2
    smooth_force: Values  # N, behind the same kernel as the motion

    def of_joint(self, joint: Recording, lever: float) -> Drive:
        """Return it in rad and N m, of a recording that was seen at a lever [m]."""
        return replace(
            self,
            recording=joint,
            force=self.force * lever,
            beyond=self.beyond * lever,
            velocity=self.velocity / lever,
            acceleration=self.acceleration / lever,
            smooth_force=self.smooth_force * lever,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Guess:
    """Values in the order of `FITTED`, and the sum of squares they leave [N^2]."""

    values: Values
    cost: float
    columns: Values


def driven(
    r: Recording,
    current_lag: float,
    lever: float | None = None,
    *,
    without: NDArray[np.bool_] | None = None,
) -> Drive:
    """Return what drives the device; one seen at a `lever` [m] is rotary in what is refused.

    Rows `without` are left out, and those beside them.

    Raises
    ------
    ValueError
        Without any force, or when it does not slide both ways for long enough.
    """
    if r.motor is None and r.force is None:
        raise ValueError(
            f"{r.name}: has neither the motor's force nor the hand's{left_for('motor', r)}"
        )
    if r.force is None:
        r = replace(r, lag=0.0)
    edge = kernels(r.dt).shape[1] // 2
    slow = max(SLOWEST, COUNTS * r.count / (0.5 * edge * r.dt))
    parts = [_stretch(r.rows(rows), current_lag, edge, slow) for rows in r.stretches]
    found = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    if without is not None:
        found["slides"] &= ~(np.convolve(without, np.ones(5), mode="same") > 0)
        found["sign"] = np.where(found["slides"], found["sign"], 0.0)
    slides, sign = found["slides"], found["sign"]
    if slides.sum() < LEAST_SLIDING:
        fast = f"{slow / lever:.2g} rad/s" if lever else f"{1e3 * slow:.2g} mm/s"
        raise ValueError(
            f"{r.name}: slides in {slides.sum()} rows only, faster than {fast}; needs {LEAST_SLIDING}"
        )
    if not ((sign > 0).any() and (sign < 0).any()):
        raise ValueError(f"{r.name}: moves one way only; friction shows when it moves both ways")
    return Drive(recording=r, **found)


def _stretch(r: Recording, current_lag: float, edge: int, slow: float) -> dict[str, Any]:
    """Return the columns of a `Drive` between two pauses: at their ends friction is whatever it has to be."""
    force, beyond = np.zeros(len(r.t)), np.zeros(len(r.t))
    if r.motor is not None:
        force, beyond = stair(r.motor, r.dt, current_lag, r.lag)
    if r.force is not None:
        force = force - r.force
    h = kernels(r.dt)

    def whole(values: Values, kernel: Values) -> Values:
        if len(values) < len(kernel):
            return np.zeros(len(values))
        return np.pad(smoothed(values, kernel), edge, mode="edge")

    velocity = whole(r.x, h[1])
    sign = np.where(np.abs(velocity) > slow, np.sign(velocity), 0.0)
    width = 2 * max(1, round(AROUND / r.dt)) + 1
    steady = np.convolve(sign, np.ones(width), mode="same")[: len(r.t)]
    slides = (np.abs(steady) > width - 0.5) & ~_stands(r, slow)
    slides[:edge] = slides[-edge:] = False
    return {
        "force": force,
        "beyond": beyond,
        "slides": slides,
        "sign": np.where(slides, np.sign(sign), 0.0),
        "velocity": velocity,
        "acceleration": whole(r.x, h[2]),
        "smooth_force": whole(force, h[0]),
    }


def _stands(r: Recording, slow: float) -> NDArray[np.bool_]:
    """Return the rows around which the readings themselves move slower than sliding [m/s], as far as they show it."""
    around = max(1, int(np.ceil(FINE * max(r.count, rough(r.x)) / (slow * r.dt))))
    out = np.zeros(len(r.t), dtype=bool)
    if around * r.dt <= WIDTH and len(r.t) > 2 * around:
        way = np.abs(r.x[2 * around :] - r.x[: -2 * around])
        out[around:-around] = way < slow * 2 * around * r.dt
    return out


def columns_of(drive: Drive, speed: float | None) -> Values:
    """Return what each of `FITTED` multiplies in the force that moves the device, where it slides."""
    on = drive.slides
    v, s = drive.velocity[on], drive.sign[on]
    columns = [drive.acceleration[on], v, s, -np.ones(int(on.sum()))]
    if speed is not None:
        columns.append(s * np.exp(-((v / speed) ** 2)))
    return np.array(columns).T


def first_guess(drive: Drive, speed: float | None = None) -> Guess:
    """Return where a search starts, by linear regression on smoothed signals."""
    A = columns_of(drive, speed)
    y = -drive.smooth_force[drive.slides]
    scale = np.sqrt((A**2).mean(axis=0)) + 1e-300
    raw, *_ = np.linalg.lstsq(A / scale, y, rcond=1e-10)
    e = y - (A / scale) @ raw
    return Guess(values=np.asarray(raw / scale), cost=float(e @ e), columns=A)


def device_problem(drive: Drive, speed: float | None) -> tuple[Problem, tuple[str, ...]]:
    """Return the problem of a device, and the names of what is fitted."""
    inner = ("M_h", "B_h", "spring", "delay", "onset", "bend", "stair")
    extra = ("coulomb", "weight") + (() if speed is None else ("stribeck",))
    names = (*inner, *extra, "X0")
    both = drive.recording.force is not None
    held = {
        "spring": 0.0,
        "delay": 0.0,
        "onset": 0.0,
        "bend": 0.0,
        "stair": 0.5 if both else 1.0,
        "X0": 0.0,
    }
    parameters = Parameters(
        names=names,
        low=np.array([BOUNDS[n][0] for n in names]),
        high=np.array([BOUNDS[n][1] for n in names]),
        fixed=np.array([held.get(n, np.nan) for n in names]),
        places=(np.arange(len(names)),),
        before_levels=len(names) - 1,
    )

    def make(r: Recording, _: Target) -> ArmRecord:
        return _record(drive, speed, r)

    r = drive.recording
    as_force = replace(r, force=drive.force)
    problem = Problem(
        recordings=(as_force,),
        targets=(Target.held(),),
        parameters=parameters,
        make=make,
        folds=(by_place(r, drive.velocity),),
    )
    return problem, tuple(n for n in FITTED if n in names)


def jumps(r: Recording) -> Values:
    """Return what a tick may miss of a force that jumps within it [N]: the hand changed its mind.

    Where the reading bends by more than its noise does, a share of that, for the rows around it.
    """
    if r.force is None:
        return np.zeros(len(r.t))
    bends = np.abs(np.diff(r.force, 2, prepend=r.force[0], append=r.force[-1]))
    size = JUMP * np.where(bends > NOISY * np.sqrt(6.0) * rough(r.force), bends, 0.0)
    out = size.copy()
    for k in range(1, FELT + 1):
        out[k:] = np.maximum(out[k:], size[:-k])
        out[:-k] = np.maximum(out[:-k], size[k:])
    return out


def _record(drive: Drive, speed: float | None, r: Recording) -> ArmRecord:
    assert r.force is not None
    n = len(r.t)
    read = readings(r)
    ahead = np.append(drive.sign[1:], 0.0)
    falls = np.exp(-((drive.velocity / (speed or 1.0)) ** 2))
    inputs = [drive.beyond, ahead, -np.ones(n)]
    if speed is not None:
        inputs.append(ahead * falls)
    largest = float(np.abs(r.force).max()) + 1e-9
    missed = np.maximum(jumps(drive.recording), unknown_force(r))
    return ArmRecord(
        x=read.x,
        force=r.force,
        variance=np.where(drive.slides, read.variance, np.inf),
        early=read.early,
        known=np.zeros(n),
        doubt=np.where(drive.slides, missed, WHATEVER * largest),
        inputs=inputs,
        switches=[],
        segments=[0],
        dt=r.dt,
        lag=r.lag,
    )
