"""Energy that a hand draws out of the port of a world that may move."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import require
from ebac.trace import Trace


def drawn(trace: Trace) -> float:
    """Return the energy that a hand drew beyond all it had put in and beyond what moving surfaces did [J].

    Minus the least energy of the port less the work of the surfaces, at least 0. The work is that of eq. (moving) in
    :doc:`/explanation/theory`: what was applied of the force that the world had asked for, over the motion that it
    reported for the time at which that force acted. Bodies that press the handle from opposite sides do work without
    a force that is left; that work is in the number, as if the hand had drawn it.

    Parameters
    ----------
    trace : Trace
        A simulated run of any number of axes.

    Raises
    ------
    ValueError
        For a trace without its scenario.
    KeyError
        For a recorded run, which has no column `true.energy`.
    """
    require(trace, Trace, "ebac.metrics.drawn", "a Trace")
    energy = trace["true.energy"].reshape(len(trace), -1).sum(axis=1)
    return max(0.0, -float((energy - work_of_surfaces(trace)).min()))


def work_of_surfaces(trace: Trace) -> NDArray[np.float64]:
    """Return the work of moving surfaces since the start [J] up to each row, as `drawn` takes it off.

    Parameters
    ----------
    trace : Trace
        A simulated run of any number of axes.

    Raises
    ------
    ValueError
        For a trace without its scenario.
    """
    require(trace, Trace, "ebac.metrics.work_of_surfaces", "a Trace")
    if trace.scenario is None:
        raise ValueError("the trace has no scenario, whose delay is needed; simulate it")
    rows, late = len(trace), trace.scenario.timing.delay + 1
    applied, force, speed = (
        trace[name].reshape(rows, -1) for name in ("f_applied", "f_env", "world_v")
    )
    asked, reported = (np.concatenate([0 * of[:late], of[:-late]]) for of in (force, speed))
    # On readings the world is met where it is now, with the observer where it will be when the force acts.
    ahead = trace["est.weight"].reshape(rows, -1)[:, :1] if "est.weight" in trace else 0.0
    now = (speed + np.concatenate([speed[:1], speed[:-1]])) / 2
    moved = now + ahead * (reported - now)
    size = np.linalg.norm(asked, axis=1)
    along = asked / np.where(size > 0, size, 1.0)[:, None]
    given = np.clip((applied * along).sum(axis=1), 0.0, size)
    motion = (along[1:] * moved[1:]).sum(axis=1)
    return np.concatenate([[0.0], np.cumsum(given[1:] * motion * np.diff(trace["t"]))])
