"""What held the current of a run back: the limits of motor, drive and workspace."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ebac._core import Limited
from ebac._util.arguments import require
from ebac.trace import Trace
from ebac.trace.acting import without_waits

#: In words; a soft start or stop (RAMP) is meant to hold it back.
_BY = {
    Limited.PEAK: "the peak current",
    Limited.THERMAL: "the heat of the motor",
    Limited.SLEW: "the fastest change of a current",
    Limited.EDGE: "the soft wall at the edge of the workspace",
    Limited.NOT_FINITE: "a command that was no number",
}


@dataclass(frozen=True, kw_only=True)
class CurrentLimits:
    """What held the current of a run back.

    Attributes
    ----------
    shares : dict of str to float
        Share of the ticks, (0, 1], by reason: `Limited` in lower case, "peak", "thermal", "slew", "edge", "not_finite".
        Only reasons that occurred; the ramp of a soft start or stop is none.
    first_s : dict of str to float
        When each acted first [s].
    """

    shares: dict[str, float]
    first_s: dict[str, float]

    def __str__(self) -> str:
        """Return it in words: "the heat of the motor in 79.5 % of the ticks, from 5.12 s"."""
        return "; ".join(
            f"{_BY[Limited[name.upper()]]} in {100 * share:.3g} % of the ticks, from {self.first_s[name]:.3g} s"
            for name, share in self.shares.items()
        )


def current_limits(trace: Trace) -> CurrentLimits | None:
    """Return what held the current of a run back while its law acted; None where nothing did or was watched.

    Parameters
    ----------
    trace : Trace
        Of `ebac run`, or of a simulation with limits.

    Raises
    ------
    TypeError
        When it is no trace.
    """
    require(
        trace,
        Trace,
        "ebac.metrics.current_limits",
        "a trace, as ebac.simulate or ebac.load returns it",
    )
    trace = without_waits(trace)
    code = np.asarray(trace["limited"]) if "limited" in trace else np.zeros(0, dtype=int)
    acted = {one.name.lower(): (code & int(one)) != 0 for one in _BY if one.name}
    ticks = {name: at for name, at in acted.items() if at.any()}
    if not ticks:
        return None
    return CurrentLimits(
        shares={name: float(at.mean()) for name, at in ticks.items()},
        first_s={name: float(trace["t"][int(np.argmax(at))]) for name, at in ticks.items()},
    )
