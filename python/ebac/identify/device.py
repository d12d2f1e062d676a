"""Identify the device: M_h and B_h of eq. (6), friction and weight; from them tau_static of eq. (2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Compensation
from ebac.identify.device_problem import (
    Drive,
    Guess,
    columns_of,
    device_problem,
    driven,
    first_guess,
)
from ebac.identify.estimate import Estimate
from ebac.identify.fit import Fitted, fitted
from ebac.identify.intervals import Z95
from ebac.identify.joint import usual_lever
from ebac.identify.parameters import BOUNDS
from ebac.identify.recording import Recording
from ebac.identify.recording_list import require_recordings
from ebac.identify.validation import POOR, flip_advice, seems_flipped

#: Standard gravity [m/s^2].
GRAVITY = 9.80665
#: Stribeck speeds that are tried [m/s], up to this share of the fastest motion: a longer fall looks like damping.
SPEEDS, PASSED = np.geomspace(2e-3, 0.1, 8), 0.5
#: A friction that falls with speed is believed when it is this many deviations from none and raises the likelihood.
BELIEVED, GAIN = 4.0, 20.0
#: A search starts from at least this mass [kg] and damping [N s/m]: from less the model runs away.
LEAST_START = (0.02, 0.1)
NAMES = ("M_h", "B_h", "coulomb", "weight", "stribeck")
UNITS = ("kg", "N s/m", "N", "N", "N")
ROTARY_UNITS = ("kg m^2", "N m s/rad", "N m", "N m", "N m")


@dataclass(frozen=True, kw_only=True, eq=False)
class DeviceResult:
    """The identified device; pass `result.compensation` to a `Device`.

    For a rotary recording all numbers refer to the joint: kg m^2, N m s/rad and N m.
    """

    recording: Recording
    drive: Drive
    names: tuple[str, ...]
    values: NDArray[np.float64]
    covariance: NDArray[np.float64]
    stribeck_speed: float | None
    explained: float
    converged: bool
    seconds: float
    #: Share explained with forces of the other sign, "force", "motor" or "force and motor", where this fit explains
    #: little or is impossible; only of devices that are possible.
    other_signs: Mapping[str, float] = field(default_factory=dict)
    #: Lever at which a rotary device was searched as a handle [m]; 1 for one in m.
    lever: float = 1.0

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each of `names`."""
        return ROTARY_UNITS if self.recording.rotary else UNITS

    @property
    def _effort(self) -> str:
        return "torque" if self.recording.rotary else "force"

    @cached_property
    def estimates(self) -> dict[str, Estimate]:
        """Every parameter by name: M_h, B_h, coulomb, weight (towards +x), stribeck (breakaway above Coulomb)."""
        half = Z95 * np.sqrt(np.diag(self.covariance))
        rows = zip(self.names, self.values.tolist(), half.tolist(), self.units, strict=False)
        return {
            name: Estimate(
                name=name,
                value=value,
                unit=unit,
                low=value - h,
                high=value + h,
                fixed=False,
                determined=self._determined(name, value, h),
            )
            for name, value, h, unit in rows
        }

    def _determined(self, name: str, value: float, half: float) -> bool:
        if self.impossible:
            return False
        if name in ("M_h", "B_h"):
            return half <= 0.25 * abs(value)
        reach = float(np.sqrt(np.mean(self.drive.force[self.drive.slides] ** 2)))
        return half <= 0.25 * max(abs(value), reach)

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Names of the parameters that the log does not determine."""
        return tuple(name for name, e in self.estimates.items() if not e.determined)

    @property
    def impossible(self) -> tuple[str, ...]:
        """Why no device can have these parameters, one sentence each; if not empty, the estimates are not a result."""
        deviations = np.sqrt(np.diag(self.covariance))
        rows = zip(self.names, self.values.tolist(), deviations, self.units, strict=False)
        out = []
        for name, value, deviation, unit in rows:
            low, high = (bound * _scale(name, self.lever) for bound in BOUNDS[name])
            if value <= low + Z95 * deviation and name == "M_h":
                out.append(
                    f"{name} = {value:.4g} {unit}: a device has {'inertia' if self.recording.rotary else 'a mass'}"
                )
            elif value + Z95 * deviation < 0 and name in ("B_h", "coulomb"):
                out.append(f"{name} = {value:.4g} {unit}: friction that drives is none")
            elif not low < value < high:
                out.append(f"{name} = {value:.4g} {unit}: at the bound of the search")
        if self.explained < 0:
            out.append(f"the device explains less of the {self._effort} than none would")
        return tuple(out)

    @property
    def misses(self) -> tuple[str, ...]:
        """What the model does not explain, one sentence each."""
        turned = max(self.other_signs, key=lambda key: self.other_signs[key], default="")
        wrong = [f"This is no device: {'; '.join(self.impossible)}."] if self.impossible else []
        share = 0.0 if wrong else self.explained
        if turned and seems_flipped(share, self.other_signs[turned]):
            sentence = f"The device explains {{}} of the {self._effort} where it slides"
            said = max(0.0, self.explained)
            wrong.insert(0, flip_advice(sentence, said, self.other_signs[turned], turned))
        return tuple(wrong)

    @property
    def compensation(self) -> Compensation:
        """Return tau_static of eq. (2), from the lower bounds of the estimates.

        These are the lower bounds of friction and of the weight against +x, and zero for an impossible device. Inertia
        is not compensated, because that costs damping; see `Compensation`.

        Raises
        ------
        ValueError
            For a rotary device, because a `Device` has a handle.
        """
        if self.recording.rotary:
            raise ValueError(
                f"{self.recording.name}: is of a rotary device, eq. (2) compensates a force at a handle; load the log "
                "with lever=0.05 or --lever 0.05, the radius of the handle [m]"
            )
        if self.impossible:
            return Compensation()
        friction = max(0.0, self.estimates["coulomb"].low)
        weight = max(0.0, -self.estimates["weight"].high)
        return Compensation(friction=friction, gravity_mass=weight / GRAVITY)

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers in SI units, for JSON."""
        return {
            "rows": [vars(e) for e in self.estimates.values()],
            f"stribeck_speed_{self.recording.units[0]}_per_s": self.stribeck_speed,
            "explained_share": self.explained,
            "undetermined": list(self.undetermined),
            "impossible": list(self.impossible),
            "misses": list(self.misses),
            "compensation": None if self.recording.rotary else self.compensation.as_dict(),
            "converged": self.converged,
            "seconds_s": self.seconds,
        }

    def _repr_html_(self) -> str:
        """Return the figure and the estimates, for a notebook."""
        from ebac._util import notebook
        from ebac.identify.figures import plot_device

        title = f"Device: explains {100 * self.explained:.2f} % of the {self._effort}"
        rows = [e.row() for e in self.estimates.values()]
        return notebook.result(title, rows, lambda: plot_device(self))

    def __repr__(self) -> str:
        """Return the estimates, one a line."""
        lines = ["Device:"] + [f"  {e}" for e in self.estimates.values()]
        lines.append(f"  explains {100 * self.explained:.2f} % of the {self._effort}")
        return "\n".join([*lines, *(f"  {text}" for text in self.misses)])


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
        result = _of_joint(_searched(handle, lag, lever), recording, lever)
    else:
        lever, handle = None, recording
        result = _searched(recording, lag)
    if result.explained < POOR or result.impossible:
        result = replace(result, other_signs=_other_signs(handle, lag, lever))
    return result


def _scale(name: str, lever: float) -> float:
    """Return a parameter of a joint over that of a handle at a lever [m]."""
    return lever**2 if name in ("M_h", "B_h") else lever


def _of_joint(result: DeviceResult, joint: Recording, lever: float) -> DeviceResult:
    """Return the device of a rotary recording that was seen at a lever [m], in rad and N m."""
    scale = np.array([_scale(name, lever) for name in result.names])
    speed = result.stribeck_speed
    return replace(
        result,
        recording=joint,
        drive=result.drive.of_joint(joint, lever),
        values=result.values * scale,
        covariance=result.covariance * np.outer(scale, scale),
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


def _searched(recording: Recording, current_lag: float, lever: float | None = None) -> DeviceResult:
    """Return the device with the forces as they are."""
    began = perf_counter()
    drive = driven(recording, current_lag, lever)
    start = first_guess(drive)
    best, speed = _fit(drive, None, start), None
    fastest = PASSED * float(np.abs(drive.velocity[drive.slides]).max())
    trials = [(float(s), first_guess(drive, float(s))) for s in SPEEDS if s <= fastest]
    tried, guess = min(trials, key=lambda trial: trial[1].cost, default=(0.0, start))
    if guess.cost < 0.995 * start.cost:
        other = _fit(drive, tried, guess)
        rise = other.values[-1] / np.sqrt(max(other.covariance[-1, -1], 1e-300))
        if other.found.likelihood < best.found.likelihood - GAIN and rise > BELIEVED:
            best, speed = other, tried
    left = drive.smooth_force[drive.slides] + columns_of(drive, speed) @ best.values
    return DeviceResult(
        recording=recording,
        drive=drive,
        names=NAMES[: len(best.values)],
        values=best.values,
        covariance=best.covariance,
        stribeck_speed=speed,
        explained=1 - float(np.var(left) / (np.var(drive.smooth_force[drive.slides]) + 1e-300)),
        converged=best.found.converged,
        seconds=perf_counter() - began,
    )


def _fit(drive: Drive, speed: float | None, guess: Guess) -> Fitted:
    """Return the fit, with the values of what is fitted alone."""
    problem, names = device_problem(drive, speed)
    p = problem.parameters
    start = np.where(np.isnan(p.fixed), 0.0, p.fixed)
    start[[p.names.index(n) for n in names]] = guess.values
    start[[p.names.index(n) for n in ("M_h", "B_h")]] = np.maximum(guess.values[:2], LEAST_START)
    sensed = drive.recording.force is not None  # what a sensor reads drifts, a command does not
    fit = fitted(problem, [p.clip(start)], starts=1, robust=None, seed=1, drifts=sensed)
    return replace(fit, values=fit.values[p.free])
