"""Identify the device: M_h and B_h of eq. (6), friction and weight; from them tau_static of eq. (2)."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from ebac._util.wrong_calls import plain_function
from ebac.identify.device_problem import (
    FITTED,
    Drive,
    Guess,
    columns_of,
    device_problem,
    driven,
    first_guess,
)
from ebac.identify.device_result import DeviceResult, scale
from ebac.identify.fit import Fitted, fitted
from ebac.identify.joint import usual_lever
from ebac.identify.limits import at_limits
from ebac.identify.recording import Recording
from ebac.identify.recording_list import require_recordings
from ebac.identify.validation import POOR

#: Stribeck speeds that are tried [m/s], up to this share of the fastest motion: a longer fall looks like damping.
SPEEDS, PASSED = np.geomspace(2e-3, 0.1, 8), 0.5
#: A friction that falls with speed is believed when it is this many deviations from none and raises the likelihood.
BELIEVED, GAIN = 4.0, 20.0
#: A search starts from at least this mass [kg] and damping [N s/m]: from less the model runs away.
LEAST_START = (0.02, 0.1)
#: So many of `FITTED` every device has.
FEWEST = 4
#: Rows that leave this share of the unexplained force to the others contradict them.
LESS = 1 / 3


@plain_function
def fit_device(recording: Recording, *, current_lag: float | None = None) -> DeviceResult:
    """Identify the device of one axis from motion and forces.

    The model is driven by the forces on the handle: the force of the motor, and that of the hand if the log has it. Its
    position is predicted one tick ahead and compared, as for the arm. While the device slides, only the magnitude of
    the friction is unknown. Near a reversal or at rest, friction can have any value up to its limit, so these rows
    contain no information.

    Parameters
    ----------
    recording : Recording
        Recording with motion in both directions, and with the force of the motor or of the hand.
    current_lag : float, optional
        Lag of the current loop [s]; default: that of the recording.

    Raises
    ------
    ValueError
        When the recording has neither force, or does not slide long enough in both directions; for a lag out of range.
    """
    require_recordings(recording, "fit_device", rotary=True)
    if current_lag is not None:
        recording = replace(recording, current_lag=current_lag)
    lag = recording.current_lag
    if recording.rotary:
        lever = usual_lever(recording, lag)
        handle = recording.at_lever(lever)
        result = _of_joint(_believed(handle, lag, lever), recording, lever)
    else:
        lever, handle = None, recording
        result = _believed(recording, lag)
    if result.explained < POOR or result.impossible:
        result = replace(result, other_signs=_other_signs(handle, lag, lever))
    return result


def _of_joint(result: DeviceResult, joint: Recording, lever: float) -> DeviceResult:
    """Return the device of a rotary recording that was seen at a lever [m], in rad and N m."""
    scales = np.array([scale(name, lever) for name in result.names])
    speed = result.stribeck_speed
    return replace(
        result,
        recording=joint,
        drive=result.drive.of_joint(joint, lever),
        values=result.values * scales,
        covariance=result.covariance * np.outer(scales, scales),
        stribeck_speed=None if speed is None else speed / lever,
        lever=lever,
    )


def _other_signs(recording: Recording, lag: float, lever: float | None) -> dict[str, float]:
    """Return the share that a regression explains with forces of the other sign, where that is a device."""
    has = [name for name in ("force", "motor") if getattr(recording, name) is not None]
    out = {}
    for names in [(name,) for name in has] + ([tuple(has)] if len(has) > 1 else []):
        drive = driven(recording.flipped(*names), lag, lever)
        guess = first_guess(drive)
        if guess.values[0] > 0 and guess.values[2] >= 0:
            force = drive.smooth_force[drive.slides]
            share = 1 - guess.cost / len(force) / (float(np.var(force)) + 1e-300)
            out[" and ".join(names)] = share
    return out


def _believed(recording: Recording, current_lag: float, lever: float | None = None) -> DeviceResult:
    """Return the device; without the rows in which the motor stands at a limit, where they contradict the others.

    A motor at its limit is recorded well where the record shows what it gave, and too small where it was cut.
    """
    result = _searched(recording, current_lag, lever)
    cut = np.zeros(0, dtype=bool) if recording.motor is None else at_limits(recording.motor)
    if not cut.any():
        return result
    try:
        other = _searched(recording, current_lag, lever, without=cut)
    except ValueError:  # nothing is left
        return result
    apart = any(
        abs(one.value - two.value) > 0.5 * np.hypot(one.high - one.low, two.high - two.low)
        for one, two in ((result.estimates[n], other.estimates[n]) for n in FITTED[:FEWEST])
    )
    if apart or 1 - other.explained < LESS * (1 - result.explained):
        return replace(other, cut_rows=int(cut.sum()))
    return result


def _searched(
    recording: Recording,
    current_lag: float,
    lever: float | None = None,
    *,
    without: NDArray[np.bool_] | None = None,
) -> DeviceResult:
    """Return the device with the forces as they are."""
    began = perf_counter()
    drive = driven(recording, current_lag, lever, without=without)
    start = first_guess(drive)
    best, speed = fitted_device(drive, None, start), None
    fastest = PASSED * float(np.abs(drive.velocity[drive.slides]).max())
    trials = [(float(s), first_guess(drive, float(s))) for s in SPEEDS if s <= fastest]
    tried, guess = min(trials, key=lambda trial: trial[1].cost, default=(0.0, start))
    if guess.cost < 0.995 * start.cost:
        other = fitted_device(drive, tried, guess)
        rise = other.values[-1] / np.sqrt(max(other.covariance[-1, -1], 1e-300))
        if other.found.likelihood < best.found.likelihood - GAIN and rise > BELIEVED:
            best, speed = other, tried
    left = drive.smooth_force[drive.slides] + columns_of(drive, speed) @ best.values
    return DeviceResult(
        recording=recording,
        drive=drive,
        names=FITTED[: len(best.values)],
        values=best.values,
        covariance=best.covariance,
        stribeck_speed=speed,
        explained=1 - float(np.var(left) / (np.var(drive.smooth_force[drive.slides]) + 1e-300)),
        converged=best.found.converged,
        seconds=perf_counter() - began,
    )


def fitted_device(
    drive: Drive, speed: float | None, guess: Guess, *, drifts: bool = True
) -> Fitted:
    """Return the fit, with the values of what is fitted alone; `drifts` where the force of a sensor may drift."""
    problem, names = device_problem(drive, speed)
    p = problem.parameters
    start = np.where(np.isnan(p.fixed), 0.0, p.fixed)
    start[[p.names.index(n) for n in names]] = guess.values
    start[[p.names.index(n) for n in ("M_h", "B_h")]] = np.maximum(guess.values[:2], LEAST_START)
    sensed = drive.recording.force is not None  # what a sensor reads drifts, a command does not
    fit = fitted(problem, [p.clip(start)], starts=1, robust=None, seed=1, drifts=drifts and sensed)
    return replace(fit, values=fit.values[p.free])
