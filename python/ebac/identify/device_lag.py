"""A force of the hand that comes through a filter though none was declared: the lag with which a device fits better."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ebac.identify.device import fitted_device
from ebac.identify.device_problem import driven, first_guess
from ebac.identify.device_result import DeviceResult
from ebac.identify.late_force import HALVED, LAGS
from ebac.identify.validation import POOR

#: By so much -2 log of the likelihood falls where a lag is believed.
CLEARLY = 100.0


@dataclass(frozen=True, kw_only=True)
class SensorLag:
    """A lag of the force sensor that makes the log of a device clearly likelier [s]."""

    lag: float
    gain: float  # by which -2 log of the likelihood falls

    @property
    def sentence(self) -> str:
        """What seems late, and the options that take it into account."""
        return (
            f"The force of the hand seems to pass a filter with a lag of {1e3 * self.lag:.2g} ms, and none was "
            f"declared: --lag {self.lag:.2g}, in Python load(..., lag={self.lag:.2g}), fits better; take the lag of "
            "the sensor where you know it."
        )


def sensor_lag(result: DeviceResult) -> SensorLag | None:
    """Return the lag of the sensor that a log shows; None where one is declared, or none is clearly likelier.

    A lag is believed only with a device that explains the forces: where the model is wrong, any filter may fit better.
    """
    r, lever = result.recording, result.lever
    if r.force is None or r.lag or result.explained < POOR or result.impossible:
        return None
    handle = r.at_lever(lever) if r.rotary else r
    speed = None if result.stribeck_speed is None else result.stribeck_speed * lever
    known: dict[float, float] = {}

    def look(lag: float) -> float:
        if lag not in known:
            drive = driven(replace(handle, lag=lag), r.current_lag, lever if r.rotary else None)
            try:
                guess = first_guess(drive, speed)  # what a lag leaves may pass for a drift
                known[lag] = fitted_device(drive, speed, guess, drifts=False).found.likelihood
            except ValueError:  # the model runs away
                known[lag] = float("inf")
        return known[lag]

    best, step = min(LAGS, key=look), 2.0
    for _ in range(HALVED):
        step = step**0.5
        best = min((best / step, best, best * step), key=look)
    gain = look(0.0) - look(best)
    return None if gain < CLEARLY else SensorLag(lag=best, gain=gain)
