"""Measure a contact with a wall, from a trace alone."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._core import FEWEST_ROWS as FEWEST_ROWS  # fewer have no tail to measure
from ebac._core import (
    STILL_SWING as STILL_SWING,
)  # m, peak to peak: a contact that swings by less is still
from ebac._core import (
    TAIL_SHARE as TAIL_SHARE,
)  # of a run, its end, over which rest and swing are taken
from ebac._core import Linear, _measure_contact, _stored_energy
from ebac._util.arguments import require
from ebac._util.foreign_worlds import foreign
from ebac.hands import is_own
from ebac.metrics.contact_result import Contact
from ebac.metrics.energy_drawn import drawn
from ebac.metrics.ideal import allowed_deviation, ideal_rest, without_engine
from ebac.metrics.with_hand import at_hands_pace, moves_with_hand
from ebac.scenario import Environment
from ebac.trace import Trace
from ebac.trace.acting import without_waits

#: A handle that met nothing for so long at the end of a run has left the surface [s]; a law that shakes meets the wall
#: several times within it.
LEFT_AFTER = 0.5
#: A handle that swings has left it if it met nothing for so many of its swings, where that is longer.
SWINGS = 1.25
#: A handle at rest under less than this share of the force at the ideal rest grazes a surface, and is held by none: its
#: target lies on the far side of a body that it slid around.
GRAZE_SHARE = 0.05
#: A surface moves at rest if it goes farther than this share of what the handle may swing.
MOVES = 0.1
#: The numbers of a contact, and what the core calls them.
COLUMNS = {
    "rest_m": "rest",
    "swing_m": "swing",
    "force_swing_N": "force_swing",
    "settled_s": "settled",
    "peak_m": "peak",
    "impact_share": "impact_share",
    "limit_cycle_Hz": "limit_cycle",
    "least_energy_J": "least_energy",
    "most_drawn_J": "most_drawn",
    "clamped_share": "clamped_share",
    "force_step_N": "force_step",
    "most_pull_N": "most_pull",
    "rest_power_W": "rest_power",
    "force_rest_N": "force_rest",
    "force_settled_s": "force_settled",
    "ripple_N": "ripple",
    "ripple_rms_N": "ripple_rms",
    "ripple_high_N": "ripple_high",
    "jumps": "jumps",
    "perceived": "perceived",
}
#: What a contact is, as the core judges it.
FLAGS = ("still", "force_quiet", "quiet")


def contact(trace: Trace, *, axis: int | None = None, truth: bool = True) -> Contact:
    """Measure a wall contact.

    Parameters
    ----------
    trace : Trace
        At least 10 rows.
    axis : int, optional
        Which axis to measure, [0, trace.axes). Default: the first, and of what should be small (swings, steps, pulls,
        settling times, ripples, jumps, vibration) the worst of all axes on which the virtual world acts in the last
        30 %, so that a contact is still and quiet only where all of them are.
    truth : bool
        Whether to take what a simulation knows, where the trace has it; False measures it by its readings, as a
        recorded run is measured; whether the handle moves with its hand is judged by the truth all the same.

    Of a run over drives only the rows in which the law acted are measured. A trace that was `changed` during its run
    has no ideal rest: it is measured, and not judged exact.

    Returns
    -------
    Contact

    Raises
    ------
    ValueError
        When the trace is too short, has no such axis, or a time, position or force that is no number.
    TypeError
        When it is no trace.
    """
    require(trace, Trace, "ebac.contact", "a trace, as ebac.simulate or ebac.load returns it")
    trace = without_waits(trace)
    if len(trace) < FEWEST_ROWS:
        raise ValueError(f"the trace has {len(trace)} rows: a contact needs at least {FEWEST_ROWS}")
    judged = range(trace.axes) if axis is None else [axis]
    axis = judged[0]
    for name in ("t", "x", "f_applied"):
        for each in judged:
            _refuse_gaps(trace, name, each)
    true, with_energy = (truth and name in trace for name in ("true.x", "true.energy"))
    energy = _columns(trace, "true.energy").sum(axis=1) if with_energy else None
    stored = None
    scenario = trace.scenario
    if scenario is not None and true and not trace.changed and _known(scenario.environment):
        world = without_engine(scenario).environment
        kinematics = scenario.device.kinematics
        stored = _stored_energy(world, kinematics, _columns(trace, "true.x"), trace["t"])
    clamped = trace.axis("law.clamped", axis) if "law.clamped" in trace else None
    place = "true.x" if true else "x"
    others = [
        (
            trace.axis(place, i),
            trace.axis("f_applied", i),
            trace.axis("f_env", i),
            _pull(trace, i, truth),
        )
        for i in judged[1:]
        if "f_env" in trace
    ]
    numbers: Any = _measure_contact(
        t=trace["t"],
        x=trace.axis(place, axis),
        force=trace.axis("f_applied", axis),
        energy=energy,
        stored=stored,
        clamped=clamped,
        pull=_pull(trace, axis, truth),
        wall=trace.axis("f_env", axis) if "f_env" in trace else None,
        others=others,
    )
    known: dict[str, Any] = {
        name: None if isnan(value) else value for name, value in numbers.items()
    }
    known["jumps"] = int(known["jumps"])
    simulated = scenario is not None and "true.x" in trace
    ideal = ideal_rest(scenario) if scenario and axis == 0 and not trace.changed else None
    touched = _touched(trace, judged, known["limit_cycle"])
    if known["still"] and _grazes(trace, judged, ideal):
        touched["touched_at_rest"] = False
    return Contact(
        law=trace.law,
        ideal_m=ideal,
        count_m=scenario.device.count if scenario else None,
        allowed_m=allowed_deviation(scenario) if scenario else None,
        seconds=float(trace["t"][-1] - trace["t"][0]),
        drawn_J=drawn(trace) if with_energy and scenario and _moves(trace) else None,
        with_hand=simulated
        and not known["still"]
        and all(moves_with_hand(trace, i) for i in judged),
        at_hands_pace=at_hands_pace(trace, known["limit_cycle"], judged, target=simulated),
        surface_moves=_surface_moves(trace),
        saturated_share=_saturated(trace, axis),
        **touched,
        **{column: known[name] for column, name in COLUMNS.items()},
        **{name: known[name] for name in FLAGS},
    )


def _refuse_gaps(trace: Trace, name: str, axis: int) -> None:
    values = trace.axis(name, axis)
    if (wrong := np.flatnonzero(~np.isfinite(values))).size:
        raise ValueError(
            f"{name} is no number in {wrong.size} of {len(trace)} rows, first in row {wrong[0]} (counted from 0): a "
            "contact cannot be judged; take the part before it, or repair the log"
        )


def _pull(trace: Trace, axis: int, truth: bool) -> NDArray[np.float64] | None:
    """Return the pull of a simulated hand where the virtual world acts [N]; None where it is not known."""
    scenario = trace.scenario
    if scenario is None or not truth or "true.x" not in trace or is_own(scenario.hand.model):
        return None
    acts = [trace.axis(name, axis) != 0 for name in ("f_env", "f_cmd", "f_applied")]
    pull = scenario.hand.pull(trace["t"], trace.axis("true.x", axis), axis)
    return np.where(np.any(acts, axis=0), pull, 0.0)


def _known(environment: Environment) -> bool:
    """Return whether it is known what a world stores: not of a function, or of an engine that stands for no bodies."""
    world = foreign(environment)
    return world is None or world.ideal() is not None


def _moves(trace: Trace) -> bool:
    """Return whether a surface of the virtual world moved while it was touched."""
    return "world_v" in trace and bool(trace["world_v"].any())


def _surface_moves(trace: Trace) -> bool:
    """Return whether a surface of which only an engine knows how it moves did so at rest."""
    scenario = trace.scenario
    if scenario is not None and foreign(scenario.environment) is None:
        return False
    if "world_v" not in trace:
        return False
    steps = _columns(trace, "world_v") * np.gradient(trace["t"])[:, np.newaxis]
    ways = np.ptp(steps.cumsum(axis=0)[_at_rest(trace)], axis=0)
    return bool(ways.max() > MOVES * STILL_SWING)


def _at_rest(trace: Trace) -> NDArray[np.bool_]:
    """Return which rows are the end of a run, over which rest and swing are taken."""
    t = trace["t"]
    return np.asarray(t >= t[-1] - TAIL_SHARE * (t[-1] - t[0]))


def _saturated(trace: Trace, axis: int) -> float | None:
    """Return the share of ticks whose command is more than the motor can give."""
    scenario = trace.scenario
    if scenario is None or "f_cmd" not in trace:
        return None
    if not isinstance(scenario.device.kinematics, Linear):
        return None
    return float(np.mean(np.abs(trace.axis("f_cmd", axis)) > scenario.device.peak_force))


def _touched(trace: Trace, judged: Sequence[int], frequency: float | None) -> dict[str, bool]:
    """Return whether the virtual world ever acted on one of these axes, and whether it still did at the end."""
    if "f_env" not in trace:
        return {}
    acted = np.any([trace.axis("f_env", i) != 0 for i in judged], axis=0)
    t = trace["t"]
    apart = max(LEFT_AFTER, SWINGS / frequency) if frequency else LEFT_AFTER
    end = min(apart, TAIL_SHARE * float(t[-1] - t[0]))
    return {
        "touched": bool(acted.any()),
        "touched_at_rest": bool(acted[t >= t[-1] - end].any()),
    }


def _grazes(trace: Trace, judged: Sequence[int], ideal: float | None) -> bool:
    """Return whether neither world nor law presses at rest, though the ideal rest [m] is inside the world."""
    scenario = trace.scenario
    if scenario is None or ideal is None or "f_env" not in trace:
        return False
    most = GRAZE_SHARE * abs(scenario.hand.steady(ideal))
    tail = _at_rest(trace)
    means = [
        np.hypot.reduce([trace.axis(name, i)[tail].mean() for i in judged])
        for name in ("f_env", "f_applied")
    ]
    return bool(max(means) < most)


def _columns(trace: Trace, name: str) -> NDArray[np.float64]:
    """Return a column in the shape (rows, axes)."""
    return trace[name].reshape(len(trace), -1)
