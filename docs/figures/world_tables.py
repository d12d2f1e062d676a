"""Tables of the worlds: laws at eight shapes on three devices, and before an engine that answers late."""

from __future__ import annotations

from collections.abc import Sequence

from population_tables import DAMPER, LAG
from printed import Printed, Row, code, joules, table

#: Columns of the table of engines: rate of the engine [Hz] and what is rendered.
RENDERED = {
    "every tick": (None, "every tick"),
    "60 Hz, held": (60.0, "force held"),
    "60 Hz, model": (60.0, "local model"),
    "500 Hz, held": (500.0, "force held"),
    "500 Hz, model": (500.0, "local model"),
}
#: An offset from the ideal rest that is written out [m].
DEEP = 1e-4


def engines(printed: Printed) -> str:
    """Return swing and least energy of each law before an engine, and how far off it rests where it is still."""
    rows = printed.rows("engines")
    laws = dict.fromkeys(row["law"] for row in rows)
    lines = [[code(law), *(_swing(rows, law, *how) for how in RENDERED.values())] for law in laws]
    return table(["law", *RENDERED], lines)


def _swing(rows: Sequence[Row], law: str, rate: float | None, rendered: str) -> str:
    (row,) = (r for r in rows if (r["law"], r["rate_Hz"], r["rendered"]) == (law, rate, rendered))
    off = row["deviation_m"]
    deep = f", **{1e3 * off:.2g} mm too deep**" if row["still"] and off > DEEP else ""
    return f"{1e3 * row['swing_m']:.3g} mm, {joules(row['least_energy_J'], ' mJ')}{deep}"


def soft_shapes(printed: Printed) -> str:
    """Return in how many runs at 2 kN/m each law is quiet, exact and passive."""
    return table(["law", *JUDGED], [_judged(law, runs) for law, runs in _runs(printed, 2e3)])


def stiff_shapes(printed: Printed) -> str:
    """Return the same at 10 kN/m, with the swing."""
    lines = [
        [*_judged(law, runs), _between([1e3 * run["swing_m"] for run in runs])]
        for law, runs in _runs(printed, 10e3)
    ]
    return table(["law", *JUDGED, "swing [mm]"], lines)


#: How a run is judged, in the order of the columns.
JUDGED = ("quiet", "exact", "passive", "all three")


def _judged(law: str, runs: Sequence[Row]) -> list[str]:
    alone = [sum(bool(run[what]) for run in runs) for what in JUDGED[:3]]
    together = sum(all(run[what] for what in JUDGED[:3]) for run in runs)
    return [code(law), *map(str, alone), str(together)]


def _runs(printed: Printed, stiffness: float) -> list[tuple[str, list[Row]]]:
    observed = printed.rows(f"shapes --law {LAG},{DAMPER}")
    found = [*printed.rows("shapes"), *observed]
    rows = [row for row in found if row["stiffness_N_per_m"] == stiffness]
    laws = dict.fromkeys(row["law"] for row in rows)
    return [(law, [row for row in rows if row["law"] == law]) for law in laws]


def _between(values: Sequence[float]) -> str:
    high = f"{max(values):.2g}"
    return f"up to {high}" if min(values) < 0.1 * max(values) else f"{min(values):.2g} to {high}"
