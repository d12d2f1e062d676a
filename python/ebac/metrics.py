"""What a contact with a wall comes to, from a trace alone."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._core import Linear, MinimumJerk, Step, Wall
from ebac.scenario import Scenario
from ebac.trace import Trace

#: The end of a run over which rest and swing are taken.
TAIL_SHARE = 0.3
#: A contact swinging by less than this, peak to peak, is quiet [m].
QUIET_SWING = 0.25e-3
#: Rest within this many encoder counts of the ideal is exact.
EXACT_COUNTS = 2


@dataclass(frozen=True, kw_only=True)
class Contact:
    """A wall contact in numbers, SI units, the unit in the name; None where a thing does not exist.

    Attributes
    ----------
    law : str
        Name of the law.
    rest_m : float
        Mean position over the last 30 % of the run.
    ideal_m : float or None
        Where an ideal wall would rest; None where the scenario has no such point.
    swing_m, force_swing_N : float
        Position and applied force, peak to peak, over the last 30 %.
    settled_s : float or None
        From when on the position stays within 0.125 mm of its rest; None when it never does.
    peak_m : float
        Deepest position of the whole run.
    limit_cycle_Hz : float or None
        Frequency of the swing; None when it is quiet.
    least_energy_J : float or None
        Lowest physical port energy, integral of (f v + b v^2 + friction); None without a simulation.
    clamped_share : float or None
        Share of ticks in which the law held its force back; None for a law that never does.
    count_m : float or None
        One encoder count, the yardstick of `exact`.
    """

    law: str
    rest_m: float
    ideal_m: float | None
    swing_m: float
    force_swing_N: float
    settled_s: float | None
    peak_m: float
    limit_cycle_Hz: float | None
    least_energy_J: float | None
    clamped_share: float | None
    count_m: float | None = None

    @property
    def deviation_m(self) -> float | None:
        """Rest minus ideal [m]; positive is too deep."""
        return None if self.ideal_m is None else self.rest_m - self.ideal_m

    @property
    def quiet(self) -> bool:
        """Whether it swings by less than 0.25 mm."""
        return self.swing_m < QUIET_SWING

    @property
    def exact(self) -> bool | None:
        """Whether it rests within two counts of the ideal."""
        if self.deviation_m is None or self.count_m is None:
            return None
        return abs(self.deviation_m) <= EXACT_COUNTS * self.count_m

    def row(self) -> dict[str, str | float | None]:
        """Return the documented row of `ebac wall --json`."""
        values = asdict(self)
        del values["count_m"]
        return values


def contact(trace: Trace, *, axis: int = 0) -> Contact:
    """Measure a wall contact.

    Parameters
    ----------
    trace : Trace
        At least 10 rows.
    axis : int
        Which axis to measure, [0, trace.axes).

    Returns
    -------
    Contact

    Raises
    ------
    ValueError
        When the trace is too short or has no such axis.
    """
    if len(trace) < 10:
        raise ValueError(f"the trace has {len(trace)} rows: a contact needs at least 10")
    x = trace.axis("true.x" if "true.x" in trace else "x", axis)
    force = trace.axis("f_applied", axis)
    t = trace["t"]
    tail = slice(-max(2, round(TAIL_SHARE * len(trace))), None)
    rest = float(x[tail].mean())
    swing = float(np.ptp(x[tail]))
    energy = (
        trace["true.energy"].reshape(len(trace), -1).sum(axis=1) if "true.energy" in trace else None
    )
    return Contact(
        law=trace.law,
        rest_m=rest,
        ideal_m=ideal_rest(trace.scenario) if trace.scenario and axis == 0 else None,
        swing_m=swing,
        force_swing_N=float(np.ptp(force[tail])),
        settled_s=_settled(t, x, rest) if swing < QUIET_SWING else None,
        peak_m=float(x.max()),
        limit_cycle_Hz=None if swing < QUIET_SWING else _frequency(t[tail], x[tail]),
        least_energy_J=None if energy is None else float(energy.min()),
        clamped_share=float(trace.axis("law.clamped", axis).mean())
        if "law.clamped" in trace
        else None,
        count_m=trace.scenario.device.count if trace.scenario else None,
    )


def ideal_rest(scenario: Scenario) -> float | None:
    """Return where hand and ideal wall balance, x* = (K0 X0 + K p + weight) / (K0 + K) [m].

    None where there is no such point: no straight wall across the first axis, or a hand that never rests.
    """
    wall, hand = scenario.environment, scenario.hand
    path = hand.path[0]
    if not isinstance(wall, Wall) or wall.angle != 0 or np.isfinite(hand.release_at):
        return None
    if not isinstance(path, (Step, MinimumJerk)) or not isinstance(
        scenario.device.kinematics, Linear
    ):
        return None
    mechanics, given = scenario.device.mechanics, scenario.device.compensation
    weight = (mechanics.handle_mass - given.gravity_mass) * mechanics.gravity
    pull = hand.stiffness * path.target + weight
    if hand.stiffness == 0 or pull <= hand.stiffness * wall.position:
        return pull / hand.stiffness if hand.stiffness > 0 else None
    return (pull + wall.stiffness * wall.position) / (hand.stiffness + wall.stiffness)


def _settled(t: NDArray[np.float64], x: NDArray[np.float64], rest: float) -> float:
    outside = np.flatnonzero(np.abs(x - rest) > QUIET_SWING / 2)
    return float(t[min(outside[-1] + 1, len(t) - 1)]) if len(outside) else float(t[0])


def _frequency(t: NDArray[np.float64], x: NDArray[np.float64]) -> float:
    """Strongest frequency of an even recording, refined by a parabola through its neighbours."""
    spectrum = np.abs(np.fft.rfft((x - x.mean()) * np.hanning(len(x))))
    peak = int(spectrum[1:].argmax()) + 1
    shift = 0.0
    if peak + 1 < len(spectrum):
        left, top, right = np.log(spectrum[peak - 1 : peak + 2] + 1e-300)
        bend = left - 2 * top + right
        shift = 0.5 * (left - right) / bend if bend != 0 else 0.0
    return float((peak + shift) * (len(t) - 1) / len(t) / (t[-1] - t[0]))
