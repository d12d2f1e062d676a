"""The parameters of each scheme, chosen on contacts, delays and hands that the study does not use."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from ebac._core import STILL_SWING, Link
from ebac.teleop.schemes import Scheme, scheme
from ebac.teleop.study import NETWORKS, shaking, simulated

if TYPE_CHECKING:
    from ebac.scenario import Scenario

#: A slave that ends within it [m] of the stick follows in free motion.
FOLLOWS = 5e-3
#: The training set, which the study does not use: contacts [N/m], delays [s], hands [N/m].
TRAINING = ((0.0, 300.0, 1000.0, 5000.0), (0.005, 0.03, 0.12), (200.0, 500.0))
#: What is tried on it for each scheme.
GRIDS: Mapping[str, Mapping[str, Sequence[Any]]] = {
    "position-force": {"measured": (False, True), "buffer": (0.0, 0.015)},
    "master-passivity": {"measured": (False, True), "buffer": (0.0, 0.015)},
    "two-port-passivity": {
        "injection": (5, 10, 20, 40, 80),
        "catch_up": (0.005, 0.02, 0.1, 0.3),
        "buffer": (0.0, 0.015),
        "stiffness": (60, 125, 250, 500, 1000, 4000),
        "reserve": (1e-3, 5e-3),
    },
    "waves": {"impedance": (10, 20, 30, 40, 60, 80), "buffer": (0.0, 0.015)},
    "ebac": {"measured": (False, True), "buffer": (0.0, 0.015)},
    "two-port-ebac": {
        "catch_up": (0.005, 0.02, 0.1, 0.3),
        "buffer": (0.0, 0.015),
        "stiffness": (1000, 2000, 4000, 8000, 16000),
    },
}


def tuned(
    name: str,
    *,
    scenario: Scenario | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Scheme:
    """Return a scheme with the parameters that are best on the training set, over a rough network.

    Best: highest mean transparency, where a run counts 0 that is not still or not passive at the master, and one in
    free motion 1 if the slave ends within 5 mm of the stick.

    Parameters
    ----------
    name : str
        Of `SCHEMES`.
    scenario : Scenario, optional
        As in `study`.
    progress : callable, optional
        Called with sets of parameters done and all.
    """
    base, grid = scheme(name), GRIDS[name]
    tries = [dict(zip(grid, values, strict=True)) for values in product(*grid.values())]
    best, best_score = base, -1.0
    for number, values in enumerate(tries, 1):
        one = base.changed(**values)
        score = _score(one, scenario)
        if score > best_score:
            best, best_score = one, score
        if progress is not None:
            progress(number, len(tries))
    return best


def _score(one: Scheme, scenario: Scenario | None) -> float:
    found = []
    for seed, (contact, delay, hand) in enumerate(product(*TRAINING), 100):
        link = Link(delay=delay, **NETWORKS["rough"])
        run = simulated(one, contact, link, hand=hand, seed=seed, scenario=scenario)
        fine = shaking(run) < STILL_SWING and run.passive
        value = run.transparency if contact > 0 else float(abs(run.drift_m) < FOLLOWS)
        found.append(value if fine and np.isfinite(value) else 0.0)
    return float(np.mean(found))
