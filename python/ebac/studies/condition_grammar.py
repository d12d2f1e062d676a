"""Conditions that are written out: d2b1K15 is 2 samples of delay, 1 N s/m of device damping, a wall of 15 kN/m.

K15 is a wall of 15 kN/m alone.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from ebac._core import Mechanics, Timing, Wall

#: How a condition is written out, for messages.
GRAMMAR = (
    "or write one out, as d2b1K15: 2 samples of delay, device damping 1 N s/m, wall 15 kN/m; without b1 the device "
    "keeps its damping; K15 changes the stiffness of the wall only"
)
_NUMBER = r"(?:\d+(?:\.\d*)?|\.\d+)"
_WRITTEN = re.compile(rf"(?:d(\d+)(?:b({_NUMBER}))?)?K({_NUMBER})", re.IGNORECASE)


@dataclass(frozen=True, kw_only=True)
class WrittenOut:
    """The numbers of a condition that is written out.

    Attributes
    ----------
    delay : int or None
        Delay [samples]; None as in the scenario.
    damping : float or None
        Device damping [N s/m]; None as in the scenario.
    kilo : float
        Wall stiffness [kN/m].
    """

    delay: int | None
    damping: float | None
    kilo: float

    @property
    def name(self) -> str:
        """The name with every number in its place."""
        delay = "" if self.delay is None else f"d{self.delay}"
        damping = "" if self.damping is None else f"b{self.damping:g}"
        return f"{delay}{damping}K{self.kilo:g}"


def written_out(name: str) -> WrittenOut | None:
    """Return the numbers of a condition; None for another name.

    Raises
    ------
    ValueError
        For a number out of its range.
    """
    found = _WRITTEN.fullmatch(name)
    if found is None:
        return None
    kilo = float(found[3])
    delay = None if found[1] is None else int(found[1])
    damping = None if found[2] is None else float(found[2])
    try:
        Timing(delay=min(delay or 0, 2**31 - 1))
        Mechanics(damping=damping or 0.0)
    except ValueError as error:
        raise ValueError(f"condition {name}: {error}") from None
    try:
        Wall(stiffness=1e3 * kilo)
    except ValueError as error:
        raise ValueError(
            f"condition {name}: {error}; the number after K is in kN/m: {kilo:g} N/m is "
            f"{name[: found.start(3)]}{kilo / 1e3:g}"
        ) from None
    return WrittenOut(delay=delay, damping=damping, kilo=kilo)
