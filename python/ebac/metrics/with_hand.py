"""Whether a swing is that of the hand, or a limit cycle of the law: by the hand's target, or by what was measured."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ebac._core import STILL_SWING, TAIL_SHARE
from ebac.trace import Trace

#: So many times as often as its target may a handle turn round that follows its hand, and so many times more.
OFTEN, MORE = 2, 2
#: Share of its swing by which a handle goes back where it turns round: a hand that taps bounces by less.
BACK = 0.1
#: Share of the swing that a motion which comes to its end keeps in the second half of the tail, at most.
ENDING = 0.6
#: So many times as often as the hand's target swings a handle that it moves, at most.
FASTER = 1.25
#: A hand whose target is not known may swing so often of its own will [Hz]; the limit cycles of stiff walls are faster.
AT_WILL = 3.0
#: Share of the tail in which the virtual world does not act where such a hand taps, or moves in free air.
APART = 0.2


def moves_with_hand(trace: Trace, axis: int = 0) -> bool:
    """Return whether the handle follows the target of the scenario's hand in the tail, tremor apart.

    A limit cycle goes to and fro farther than a hand that still moves, or more often; a hand that lands may bounce by
    less than a tenth of the swing.
    """
    found = _targets(trace)
    if found is None:
        return False
    _, targets = found
    x = _tail_of(trace, axis)
    back = max(STILL_SWING, BACK * float(np.ptp(x)))
    return _way(x) <= _way(targets) and turns(x, back) <= OFTEN * turns(targets[:, axis]) + MORE


def on_its_way(x: NDArray[np.float64]) -> bool:
    """Return whether a motion that is not still goes one way, or is about to end: its second half is the smaller.

    Parameters
    ----------
    x : ndarray
        Positions of the tail [m]; shape (rows,). A limit cycle swings as far in its second half.
    """
    return turns(x) == 0 or float(np.ptp(x[len(x) // 2 :])) < ENDING * float(np.ptp(x))


def at_hands_pace(
    trace: Trace, frequency: float | None, axes: Sequence[int], *, target: bool
) -> bool:
    """Return whether a swing may be that of the hand, so that its frequency is that of no limit cycle.

    Parameters
    ----------
    trace : Trace
        Rows under the law.
    frequency : float or None
        Of the swing in the tail [Hz].
    axes : sequence of int
        Those that are judged, of which the one that swings most on the virtual world has this frequency.
    target : bool
        Whether the target of the hand is known, which is that of the scenario: then the swing is the hand's up to 1.25
        times the frequency of the target in the tail. In a recording it is not known: there it may be the hand's up to
        3 Hz, where the virtual world does not act in a fifth of the tail or more. A law that shakes on a stiff wall
        does so at 5 Hz or faster; one that throws out a soft hand as slowly as a hand taps looks the same.
    """
    if frequency is None:
        return False
    axis = _widest(trace, axes)
    if not target:
        return frequency <= AT_WILL and _apart(trace, axis) >= APART
    found = _targets(trace)
    if found is None:
        return False
    t, targets = found
    wanted = targets[:, axis]
    if len(t) < 2 or np.ptp(wanted) < STILL_SWING:
        return False
    return frequency <= FASTER * _frequency(t, wanted)


def _targets(trace: Trace) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return times and targets of the scenario's hand in the tail, tremor apart; None where nobody holds the handle."""
    if trace.scenario is None:
        return None
    t, hand = trace["t"], trace.scenario.hand.replace(tremor_amplitude=0.0)
    held = t[_tail(t) & (t < hand.release_at)]
    if len(held) == 0:
        return None
    return held, np.array([[hand.target(now, i) for i in range(trace.axes)] for now in held])


def _widest(trace: Trace, axes: Sequence[int]) -> int:
    """Return the axis that swings most: the first, or another one on which the virtual world acts."""
    met = [i for i in axes[1:] if _apart(trace, i) < 1 and "f_env" in trace]
    return max([axes[0], *met], key=lambda i: float(np.ptp(_tail_of(trace, i))))


def _apart(trace: Trace, axis: int) -> float:
    """Return the share of the tail in which the virtual world does not act; 0 where that is not known."""
    if "f_env" not in trace:
        return 0.0
    return float(np.mean(trace.axis("f_env", axis)[_tail(trace["t"])] == 0))


def _tail_of(trace: Trace, axis: int) -> NDArray[np.float64]:
    return trace.axis("true.x" if "true.x" in trace else "x", axis)[_tail(trace["t"])]


def _tail(t: NDArray[np.float64]) -> NDArray[np.bool_]:
    return np.asarray(t >= t[-1] - TAIL_SHARE * (t[-1] - t[0]))


def _way(x: NDArray[np.float64]) -> float:
    return float(np.abs(np.diff(x, axis=0)).sum())


def turns(x: NDArray[np.float64], back: float = STILL_SWING) -> int:
    """Return how often a motion turns round and goes back by more than `back` [m]."""
    return len(_turning_points(x, back))


def _frequency(t: NDArray[np.float64], x: NDArray[np.float64]) -> float:
    """Return how often a motion goes to and fro [Hz]; at most so often, where it turns round less than twice."""
    rows = _turning_points(x)
    if len(rows) < 2:
        return (len(rows) + 1) / (2 * float(t[-1] - t[0]))
    return (len(rows) - 1) / (2 * float(t[rows[-1]] - t[rows[0]]))


def _turning_points(x: NDArray[np.float64], back: float = STILL_SWING) -> list[int]:
    """Return the rows in which a motion turns round and then goes back by more than `back` [m]."""
    found: list[int] = []
    forward, farthest, row = None, float(x[0]), 0
    for i, place in enumerate(x.tolist()):
        if forward is not None and (place > farthest) == forward:
            farthest, row = place, i
        elif abs(place - farthest) > back:
            if forward is not None:
                found.append(row)
            forward, farthest, row = place > farthest, place, i
    return found
