"""What each hand does against an ideal, continuous wall, and which runs settle in the time that it takes there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core
from ebac._util.cores import thread_count
from ebac.scenario import Scenario
from ebac.studies.sweeps.result import SweepResult

#: Settled in time: within this factor of what the ideal wall needs, plus this much [s].
SLOWER, LATER = 1.5, 0.2


def ideal_contacts(
    scenarios: Sequence[Scenario], threads: int | None = None
) -> dict[str, NDArray[Any]]:
    """Return what each hand would do against an ideal, continuous wall: `rest_m`, `swing_m`, `settled_s`, `quiet`.

    It settles at inf where it never does; NaN where there is no closed form, see `ideal_contact` in the core.
    """
    setups = [scenario.setup() for scenario in scenarios]
    found = _core._ideal_contacts(setups, thread_count(threads), _core.SweepProgress())
    settled, rest = found["settled"], found["rest"]
    return {
        "rest_m": rest,
        "swing_m": found["swing"],
        "quiet": found["quiet"] == 1,
        "settled_s": np.where(np.isnan(settled) & np.isfinite(rest), np.inf, settled),
    }


def settled_in_time(result: SweepResult, ideal_settled_s: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which runs are exact and still, and settle about as soon as at the ideal wall.

    Parameters
    ----------
    result : SweepResult
        The runs.
    ideal_settled_s : array, shape (runs,)
        When the same hands settle at the ideal wall [s], as `ideal_contacts` returns it.
    """
    in_time = result["settled_s"] <= SLOWER * ideal_settled_s + LATER
    return np.asarray(result.exact_and_still & in_time)
