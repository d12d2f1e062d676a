"""What a contact with a wall comes to, from a trace alone."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Linear, MinimumJerk, Step, Wall, _measure_contact, _stored_energy
from ebac.scenario import Scenario
from ebac.trace import Trace

#: The end of a run over which rest and swing are taken.
TAIL_SHARE = 0.3
#: A contact swinging by less than this, peak to peak, is quiet [m].
QUIET_SWING = 0.25e-3
#: Rest within this many encoder counts of the ideal is exact.
EXACT_COUNTS = 2
#: Fewer rows have no tail to measure.
FEWEST_ROWS = 10
#: The numbers of a contact, and what the core calls them.
COLUMNS = {
    "rest_m": "rest",
    "swing_m": "swing",
    "force_swing_N": "force_swing",
    "settled_s": "settled",
    "peak_m": "peak",
    "limit_cycle_Hz": "limit_cycle",
    "least_energy_J": "least_energy",
    "most_drawn_J": "most_drawn",
    "clamped_share": "clamped_share",
}


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
        Frequency of the swing; None when it is quiet or drifts without swinging back.
    least_energy_J : float or None
        Lowest physical port energy, integral of (f v + b v^2 + friction); None without a simulation.
    most_drawn_J : float or None
        Most energy taken out of the port in any window beyond what an ideal wall stores at the window's start, max
        over t1 < t2 of W(t1) - W(t2) - K depth(t1)^2 / 2; 0 for an ideal wall, None without a simulation.
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
    most_drawn_J: float | None = None

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
        del values["count_m"], values["most_drawn_J"]
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
    if len(trace) < FEWEST_ROWS:
        raise ValueError(f"the trace has {len(trace)} rows: a contact needs at least {FEWEST_ROWS}")
    true = "true.x" in trace
    energy = _columns(trace, "true.energy").sum(axis=1) if "true.energy" in trace else None
    stored = None
    if trace.scenario is not None and true:
        stored = _stored_energy(trace.scenario.environment, _columns(trace, "true.x"))
    clamped = trace.axis("law.clamped", axis) if "law.clamped" in trace else None
    numbers: Any = _measure_contact(
        t=trace["t"],
        x=trace.axis("true.x" if true else "x", axis),
        force=trace.axis("f_applied", axis),
        energy=energy,
        stored=stored,
        clamped=clamped,
    )
    known: dict[str, Any] = {
        name: None if isnan(value) else value for name, value in numbers.items()
    }
    scenario = trace.scenario
    return Contact(
        law=trace.law,
        ideal_m=ideal_rest(scenario) if scenario and axis == 0 else None,
        count_m=scenario.device.count if scenario else None,
        **{column: known[name] for column, name in COLUMNS.items()},
    )


def _columns(trace: Trace, name: str) -> NDArray[np.float64]:
    """Return a column in the shape (rows, axes)."""
    return trace[name].reshape(len(trace), -1)


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
