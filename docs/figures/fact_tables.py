"""What the worst hands draw from `ebac` where a fact of the device is declared wrong."""

from __future__ import annotations

from printed import Printed, table

#: Conditions in which a fact is wrong, and what it is.
WRONG = (
    ("d1K10", "none"),
    ("told-mass-50", "mass: half of the true one"),
    ("told-mass+50", "mass: 1.5 times the true one"),
    ("told-damping+50", "damping: 1.5 times the true one"),
    ("told-lag-0.3-of-1", "current lag: 0.3 ms, 1 ms in truth"),
    ("told-delay-1-of-2", "delay: 1 sample, 2 in truth"),
    ("told-delay-1-of-3", "delay: 1 sample, 3 in truth"),
)
SEEDS = (1, 2)


def told(printed: Printed) -> str:
    """Energy that the worst hands draw in the runs of a search, and if they go on for five minutes."""
    rows = []
    for condition, label in WRONG:
        found = [
            printed.rows(
                f"worst --device-noise 0.03 -c {condition} --evaluations 500 --seed {seed}"
            )
            for seed in SEEDS
        ]
        cells = [
            ", ".join(_energy(max(float(row[key]) for row in hands)) for hands in found)
            for key in ("energy_drawn_J", "energy_drawn_300_s_J")
        ]
        rows.append([label, f"`{condition}`", *cells])
    return table(["wrong fact", "condition", "draws in 2 to 8 s", "in 5 min"], rows)


def _energy(joule: float) -> str:
    return f"{joule:.1f} J" if joule >= 1 else f"{1e3 * joule:.1f} mJ"
