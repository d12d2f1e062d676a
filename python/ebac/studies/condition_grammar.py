"""Conditions that are written out: d2b1K15 is 2 samples of delay, 1 N s/m of device damping, a wall of 15 kN/m."""

from __future__ import annotations

import re

from ebac._core import Mechanics, Timing, Wall

#: How a condition is written out, for messages.
GRAMMAR = (
    "or write one out, as d2b1K15: 2 samples of delay, device damping 1 N s/m, wall 15 kN/m; without b1 the damping is "
    "2 N s/m"
)
#: Damping of the device where none is written [N s/m].
USUAL_DAMPING = 2.0
_NUMBER = r"(?:\d+(?:\.\d*)?|\.\d+)"
_WRITTEN = re.compile(rf"d(\d+)(?:b({_NUMBER}))?K({_NUMBER})", re.IGNORECASE)


def written_out(name: str) -> tuple[int, float, float] | None:
    """Return delay [samples], device damping [N s/m] and wall stiffness [kN/m] of a condition; None for another name.

    Raises
    ------
    ValueError
        For a number out of its range.
    """
    found = _WRITTEN.fullmatch(name)
    if found is None:
        return None
    delay, kilo = int(found[1]), float(found[3])
    damping = USUAL_DAMPING if found[2] is None else float(found[2])
    try:
        Timing(delay=min(delay, 2**31 - 1))
        Mechanics(damping=damping)
        Wall(stiffness=1e3 * kilo)
    except ValueError as error:
        raise ValueError(f"condition {name}: {error}") from None
    return delay, damping, kilo
