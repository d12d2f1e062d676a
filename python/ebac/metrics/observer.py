"""How far a run relied on its observer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ebac._core import Fallback
from ebac._util.arguments import require
from ebac.trace import Trace


@dataclass(frozen=True, kw_only=True)
class ObserverUse:
    """How far a run relied on its observer.

    Attributes
    ----------
    trusted : float
        Share of the ticks in which the law acted on the estimate alone, [0, 1]; in the others it faded to the
        encoder alone, or back.
    fallback : dict of str to float
        Share of the ticks in which there was a reason to fall back to the encoder alone, by reason: `Fallback` in
        lower case, "force_stale", "force_status", "model", "account", or "off" for a law that does not use the
        estimate. Only reasons that occurred.
    """

    trusted: float
    fallback: dict[str, float]

    def __str__(self) -> str:
        """Return it as a sentence: "trusted in 97.1 % of the ticks; encoder alone: force stale in 2.2 %"."""
        if self.fallback.get("off") == 1:
            return "not used, this law acts on the encoder alone"
        reasons = ", ".join(
            f"{name.replace('_', ' ')} in {100 * share:.3g} %"
            for name, share in self.fallback.items()
        )
        why = f"; encoder alone: {reasons}" if reasons else ""
        return f"trusted in {100 * self.trusted:.3g} % of the ticks{why}"


def observer_use(trace: Trace) -> ObserverUse | None:
    """Return how far a run relied on its observer; None for a run without one.

    Parameters
    ----------
    trace : Trace
        At least one row.

    Raises
    ------
    TypeError
        When it is no trace.
    """
    require(trace, Trace, "ebac.observer_use", "a trace, as ebac.simulate or ebac.load returns it")
    if "est.bound" not in trace or not trace["est.bound"].any():
        return None
    weight, code = trace.axis("est.weight"), trace.axis("est.fallback")
    shares = {one.name.lower(): float(np.mean(code == int(one))) for one in Fallback}
    return ObserverUse(
        trusted=float(np.mean(weight == 1)),
        fallback={name: share for name, share in shares.items() if name != "none" and share > 0},
    )
