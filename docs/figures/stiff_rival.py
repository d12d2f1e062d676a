"""Search a lag compensator on the observer that is quiet, in time and stiff: `python docs/figures/stiff_rival.py`.

`ebac tune` asks for quiet hands and energy, and softens the wall on impact to that end. Here 200 random points are
judged by what the table of the README shows, on 60 random hands that it does not have, at 10 and 20 kN/m and 0, 1 and
2 samples of delay, in about three minutes.
"""

from __future__ import annotations

import numpy as np

import ebac
from ebac.studies.result import StudyRow

POINTS, SHOWN = 200, 5
NOISE_N = 0.03
#: A wall that renders less than this share of its stiffness on impact counts as soft.
STIFF = 0.9
CONDITIONS = [f"d{delay}K{stiffness}" for delay in (0, 1, 2) for stiffness in (10, 20)]


def drawn(random: np.random.Generator) -> dict[str, float]:
    """Return a random point: stiffness at once [N/m], damping [N s/m], time constant of the rest [s]."""
    low, high = np.array([3.3, 30, -1.3]), np.array([4.5, 130, 0.5])
    stiffness, damping, time = random.uniform(low, high)
    values = {
        "stiffness": 10**stiffness,
        "virtual_damping": damping,
        "recovery_time": 10**time,
    }
    return {name: float(f"{value:.3g}") for name, value in values.items()}


def score(row: StudyRow) -> float:
    """Return shares of hands that are good and in time, plus the stiffness on impact, less energy given out."""
    impact = min(1.0, (row.median_impact_share or 0.0) / STIFF)
    return (
        (row.good + row.settled_in_time) / row.hands
        + impact
        - 0.2 * min(1.0, -row.least_energy_J / 1e-3)
    )


def main() -> None:
    """Print the best points, and what each of them does."""
    random = np.random.default_rng(1)
    points = [drawn(random) for _ in range(POINTS)]
    base = ebac.Scenario(
        device=ebac.Device(sensor=ebac.ForceSensor(noise=NOISE_N)), observer="every-law"
    )
    laws = {str(i): ebac.Variant("lag-compensator", point) for i, point in enumerate(points)}
    rows = ebac.study(ebac.Operators.sample(60, 11), laws, CONDITIONS, base=base).rows
    by_law = {name: [row for row in rows if row.law == name] for name in laws}
    for name in sorted(by_law, key=lambda one: -sum(map(score, by_law[one])))[:SHOWN]:
        print(f"{sum(map(score, by_law[name])):.3f} of {3 * len(CONDITIONS)}: {points[int(name)]}")
        for row in by_law[name]:
            print(
                f"  {row.condition}: {row.good} good, {row.settled_in_time} in time, "
                f"{100 * (row.median_impact_share or 0):.0f} % on impact"
            )


if __name__ == "__main__":
    main()
