"""Patience with a machine that is late: limits of time that it keeps without being made for real time."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac.hardware.configuration import Configuration

#: A simulated device moves for this many ticks at most from one tick to the next: on a machine that is late its time
#: stands still.
LONGEST_STEP = 2
#: Ticks in a row without an answer, or too late, that are a fault.
PATIENCE = 200


def patient(known: Configuration, *, pause: float) -> Configuration:
    """Return the configuration with patient limits of time; `pause` [s] of lost time is a fault."""
    limits = known.limits.replace(watch_motion=False, overruns=PATIENCE, pause=pause, force_age=0.2)
    return known.replace(silent=PATIENCE, limits=limits)
