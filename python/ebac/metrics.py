"""Measure a contact with a wall, from a trace alone."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import Hand, Linear, MinimumJerk, Step, Wall, _measure_contact, _stored_energy
from ebac._util import formatting
from ebac._util.arguments import require
from ebac.hands import is_own
from ebac.scenario import Scenario
from ebac.trace import Trace

__all__ = [
    "EXACT_COUNTS",
    "FEWEST_ROWS",
    "QUIET_SWING",
    "TAIL_SHARE",
    "Contact",
    "allowed_deviation",
    "contact",
    "ideal_rest",
]


def __dir__() -> list[str]:
    return __all__


#: The end of a run over which rest and swing are taken.
TAIL_SHARE = 0.3
#: A contact swinging by less than this, peak to peak, is quiet [m].
QUIET_SWING = 0.25e-3
#: Rest within this many encoder counts of the ideal, and the band that friction holds, is exact.
EXACT_COUNTS = 2
#: Fewer rows have no tail to measure.
FEWEST_ROWS = 10
#: A hand with a model balances within so far from zero, or has no rest [m].
LARGEST_REST = 10.0
#: Half of the way over which the slope of a steady force is taken [m].
SMALL = 1e-6
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
    "force_step_N": "force_step",
    "most_pull_N": "most_pull",
    "rest_power_W": "rest_power",
}
#: Numbers of a contact that are no keys of `ebac wall --json`.
MORE = (
    "count_m", "allowed_m", "most_drawn_J", "force_step_N", "most_pull_N", "rest_power_W", "seconds", "touched",
)  # fmt: skip
#: What a printed contact shows: label, attribute, unit, what to print where there is none.
LINES = (
    ("rest", "rest_m", "m", "-"),
    ("ideal rest", "ideal_m", "m", "-"),
    ("deviation", "deviation_m", "m", "-"),
    ("allowed deviation", "allowed_m", "m", "-"),
    ("swing, peak to peak", "swing_m", "m", "-"),
    ("force swing", "force_swing_N", "N", "-"),
    ("settled", "settled_s", "s", "never"),
    ("deepest", "peak_m", "m", "-"),
    ("limit cycle", "limit_cycle_Hz", "Hz", "none"),
    ("least port energy", "least_energy_J", "J", "-"),
    ("most energy drawn", "most_drawn_J", "J", "-"),
    ("force limited", "clamped_share", "share", "-"),
)


@dataclass(frozen=True, kw_only=True, repr=False)
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
    force_step_N : float
        Largest change of the applied force from one tick to the next.
    most_pull_N : float or None
        Hardest pull of the hand, |K0 (X0 - x)|, while the virtual world acts; None without a simulation and for a hand
        of your own.
    rest_power_W : float or None
        Mean rate of the port energy over the last 30 %, dW/dt at rest; negative where the port gives out energy for
        as long as it is held. None without a simulation.
    count_m : float or None
        One encoder count.
    allowed_m : float or None
        How far from the ideal a rest still is `exact`, see `allowed_deviation`.
    seconds : float or None
        Length of the run [s].
    touched : bool or None
        Whether the virtual world ever acted; None where that is not known.
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
    force_step_N: float | None = None
    most_pull_N: float | None = None
    rest_power_W: float | None = None
    allowed_m: float | None = None
    seconds: float | None = None
    touched: bool | None = None

    @property
    def verdict(self) -> str:
        """What the contact came to in words: "exact and quiet", "swings", "no contact", "too short to judge"."""
        return formatting.verdict(self)

    def __repr__(self) -> str:
        """Return the verdict and the main numbers in one line."""
        settled = formatting.quantity(self.settled_s, "s", none="never")
        return (
            f"<Contact of {self.law or 'a run'}: {self.verdict}; rest {formatting.quantity(self.rest_m, 'm')}, "
            f"swing {formatting.quantity(self.swing_m, 'm')}, settled {settled}>"
        )

    def __str__(self) -> str:
        """Return the verdict and every number with its unit, one a line."""
        signed = {"deviation_m"}
        lines = [f"Contact of {self.law or 'a run'}: {self.verdict}"]
        for label, name, unit, none in LINES:
            value = getattr(self, name)
            shown = formatting.quantity(value, unit, signed=name in signed, none=none)
            lines.append(f"  {label:<20}{shown}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Return a table for a notebook."""
        from dataclasses import asdict

        from ebac._util.notebook import table

        return table([asdict(self)])

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
        """Whether it rests within two counts of the ideal, and what friction holds."""
        if self.deviation_m is None or self.allowed_m is None:
            return None
        return abs(self.deviation_m) <= self.allowed_m

    def row(self) -> dict[str, str | float | None]:
        """Return the documented row of `ebac wall --json`."""
        return {name: value for name, value in asdict(self).items() if name not in MORE}


def contact(trace: Trace, *, axis: int = 0, truth: bool = True) -> Contact:
    """Measure a wall contact.

    Parameters
    ----------
    trace : Trace
        At least 10 rows.
    axis : int
        Which axis to measure, [0, trace.axes).
    truth : bool
        Whether to take what a simulation knows, where the trace has it; False measures it by its readings, as a
        recorded run is measured.

    Returns
    -------
    Contact

    Raises
    ------
    ValueError
        When the trace is too short or has no such axis.
    TypeError
        When it is no trace.
    """
    require(trace, Trace, "ebac.contact", "a trace, as ebac.simulate or ebac.load returns it")
    if len(trace) < FEWEST_ROWS:
        raise ValueError(f"the trace has {len(trace)} rows: a contact needs at least {FEWEST_ROWS}")
    true, with_energy = (truth and name in trace for name in ("true.x", "true.energy"))
    energy = _columns(trace, "true.energy").sum(axis=1) if with_energy else None
    stored = None
    if trace.scenario is not None and true:
        stored = _stored_energy(trace.scenario.environment, _columns(trace, "true.x"))
    clamped = trace.axis("law.clamped", axis) if "law.clamped" in trace else None
    pull = None
    if trace.scenario is not None and true:
        acts = [trace.axis(name, axis) != 0 for name in ("f_env", "f_cmd", "f_applied")]
        hand, x = trace.scenario.hand, trace.axis("true.x", axis)
        if not is_own(hand.model):
            pull = np.where(np.any(acts, axis=0), hand.pull(trace["t"], x, axis), 0.0)
    numbers: Any = _measure_contact(
        t=trace["t"],
        x=trace.axis("true.x" if true else "x", axis),
        force=trace.axis("f_applied", axis),
        energy=energy,
        stored=stored,
        clamped=clamped,
        pull=pull,
    )
    known: dict[str, Any] = {
        name: None if isnan(value) else value for name, value in numbers.items()
    }
    scenario = trace.scenario
    return Contact(
        law=trace.law,
        ideal_m=ideal_rest(scenario) if scenario and axis == 0 else None,
        count_m=scenario.device.count if scenario else None,
        allowed_m=allowed_deviation(scenario) if scenario else None,
        seconds=float(trace["t"][-1] - trace["t"][0]),
        touched=bool(trace.axis("f_env", axis).any()) if "f_env" in trace else None,
        **{column: known[name] for column, name in COLUMNS.items()},
    )


def _columns(trace: Trace, name: str) -> NDArray[np.float64]:
    """Return a column in the shape (rows, axes)."""
    return trace[name].reshape(len(trace), -1)


def allowed_deviation(scenario: Scenario) -> float:
    """Return how far from the ideal a rest still is exact: 2 counts + f_c / (K0 + K) [m].

    Friction of up to f_c holds a hand and an *ideal* wall anywhere within f_c / (K0 + K) of their balance, so a rest
    within that band is no fault of a law. f_c is the friction at standstill; K counts only where the ideal rest
    lies inside the wall.
    """
    mechanics, wall = scenario.device.mechanics, scenario.environment
    counts = EXACT_COUNTS * scenario.device.count
    friction = max(mechanics.coulomb, mechanics.breakaway)
    ideal = ideal_rest(scenario)
    if friction == 0 or ideal is None:
        return counts
    hand = scenario.hand
    stiffness = hand.stiffness
    if hand.model is not None:
        stiffness = (hand.steady(ideal - SMALL) - hand.steady(ideal + SMALL)) / (2 * SMALL)
    if isinstance(wall, Wall) and ideal > wall.position:
        stiffness += wall.stiffness
    return counts + friction / stiffness


def ideal_rest(scenario: Scenario) -> float | None:
    """Return where hand and ideal wall balance, x* = (K0 X0 + K p + weight) / (K0 + K) [m].

    None where there is no such point: no straight wall across the first axis, or a hand that never rests. With a
    model of `ebac.hands` it is where the steady force of the model and the wall balance; None for a hand of your own.
    """
    require(scenario, Scenario, "ebac.ideal_rest", "a Scenario")
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
    if hand.model is not None:
        return _balance(hand, wall, weight)
    pull = hand.stiffness * path.target + weight
    if hand.stiffness == 0 or pull <= hand.stiffness * wall.position:
        return pull / hand.stiffness if hand.stiffness > 0 else None
    return (pull + wall.stiffness * wall.position) / (hand.stiffness + wall.stiffness)


def _balance(hand: Hand, wall: Wall, weight: float) -> float | None:
    """Return where a hand with a model, a wall and a weight balance, by bisection of a falling force."""

    def left(x: float) -> float:
        depth = max(x - wall.position, 0.0)
        return hand.steady(x) + weight - wall.stiffness * depth

    low, high = -LARGEST_REST, LARGEST_REST
    if not left(low) > 0 > left(high):  # NaN too: a hand that never rests, or is not known
        return None
    while True:
        middle = (low + high) / 2
        if middle in (low, high):
            return middle
        low, high = (middle, high) if left(middle) > 0 else (low, middle)
