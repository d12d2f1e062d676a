"""What encoder and friction of the device change: usable areas of simple laws on the encoder alone, beside `ebac`."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from printed import Printed, millijoules, table
from rival_tables import DELAYS, WALLS

import ebac

#: Counts per turn of the motor's encoder, and Coulomb friction of the device [N]. The reference device is the first.
DEVICES = (
    (1024, 0.0),
    (1024, 0.05),
    (1024, 0.3),
    (4096, 0.0),
    (4096, 0.05),
    (4096, 0.3),
    (8192, 0.0),
    (8192, 0.05),
    (8192, 0.3),
)
#: Random parameter sets of a lag compensator: ranges of stiffness [N/m], damping [N s/m] and recovery time [s].
SETS, STIFFNESS, DAMPING, TIME = 60, (500.0, 10e3), (1.0, 100.0), (0.1, 1.0)
#: Dampings of `tca-damped` without its force loop [N s/m].
DAMPED = (10.0, 20.0, 40.0)
#: Runs per family of the search for the worst hand.
SEARCH = 150


def simple_laws(seed: int = 1) -> dict[str, ebac.Variant | str]:
    """Return the laws of which the best counts."""
    random = np.random.default_rng(seed)

    def evenly(low: float, high: float) -> float:
        return math.exp(random.uniform(math.log(low), math.log(high)))

    lags = [
        ebac.Variant(
            "lag-compensator",
            {
                "stiffness": evenly(*STIFFNESS),
                "virtual_damping": evenly(*DAMPING),
                "recovery_time": random.uniform(*TIME),
            },
        )
        for _ in range(SETS)
    ]
    damped = [ebac.Variant("tca-damped", {"virtual_damping": b, "kp": 0.0}) for b in DAMPED]
    laws = ["direct", "lag-compensator", *damped, *lags]
    return {str(i): law for i, law in enumerate(laws)}


def encoder_and_friction(printed: Printed) -> str:
    """Usable areas at each delay, and what the worst hand draws at 10 kN/m and one sample of delay."""

    def areas(base: ebac.Scenario, laws: dict[str, ebac.Variant | str]) -> list[tuple[float, str]]:
        """Return the largest area of some laws at each delay, and whose it is."""
        found = ebac.zwidth(laws, base=base, threads=printed.threads, **WALLS)
        return [max((found.area("usable", law, d), law) for law in laws) for d in DELAYS]

    def drawn(base: ebac.Scenario, law: ebac.Variant | str) -> str:
        hands = ebac.worst(law, base=base, evaluations=SEARCH, threads=printed.threads).hands
        return millijoules(max(hand.energy_J for hand in hands))

    rows, simple = [], simple_laws()
    for counts, friction in DEVICES:
        device = ebac.Device(
            encoder=ebac.Encoder(counts_per_turn=counts),
            mechanics=ebac.Mechanics(coulomb=friction),
            sensor=ebac.ForceSensor(noise=0.03),
        )
        observed = ebac.Scenario(device=device, seconds=3.0)
        alone = observed.replace(observer=False)
        best, ours = areas(alone, simple), areas(observed, {"ebac": "ebac"})
        rows.append(
            [
                f"{1e6 * device.count:.1f}",
                f"{friction:g}",
                _listed(best),
                drawn(alone, simple[best[1][1]]),
                _listed(ours),
                drawn(observed, "ebac"),
            ]
        )
    heads = [
        "count [µm]",
        "friction [N]",
        "simple law, area at d = 0, 1, 2",
        "its worst hand draws [mJ]",
        "`ebac`, area at d = 0, 1, 2",
        "its worst hand draws [mJ]",
    ]
    return table(heads, rows)


def _listed(areas: Sequence[tuple[float, str]]) -> str:
    return ", ".join(f"{area / 1e3:.0f}" for area, _ in areas)
