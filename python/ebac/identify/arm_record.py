"""A recording of an arm and its target as the core takes them."""

from __future__ import annotations

import numpy as np

from ebac._core import ArmRecord
from ebac.identify.missing import force_of_hand
from ebac.identify.recording import Recording
from ebac.identify.signals import readings, ripple, unknown_force
from ebac.identify.target import Target


def arm_record(recording: Recording, target: Target) -> ArmRecord:
    """Hand a recording to the core.

    Raises
    ------
    ValueError
        When it has no force of the hand.
    """
    force = force_of_hand(recording)
    _check_switches(recording, target)
    t0 = float(recording.t[0])
    read = readings(recording)
    return ArmRecord(
        x=read.x,
        force=force,
        variance=read.variance,
        early=read.early,
        known=np.zeros(len(recording.t)) if target.path is None else target.path,
        doubt=unknown_force(recording),
        inputs=[ripple(recording)],
        switches=[s - t0 for s in target.switches],
        segments=list(target.segments),
        dt=recording.dt,
        lag=recording.lag,
    )


def _check_switches(recording: Recording, target: Target) -> None:
    """Refuse a target that changes outside the log, or faster than its rows."""
    start, end = float(recording.t[0]), float(recording.t[-1])
    for at in target.switches:
        if not start < at < end:
            raise ValueError(
                f"{recording.name}: the target changes at {at:g} s: "
                f"must lie in ({start:g}, {end:g}) s, the time of the log"
            )
    shortest = min(np.diff(target.switches), default=np.inf)
    if shortest < 10 * recording.dt:
        raise ValueError(
            f"{recording.name}: the target changes again within {shortest:.3g} s: "
            f"must hold for 10 rows, {10 * recording.dt:g} s"
        )
