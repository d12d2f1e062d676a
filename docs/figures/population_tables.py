"""The tables of whole populations: `ebac study`."""

from __future__ import annotations

import json
from pathlib import Path

from printed import Printed, Row, code, count, fixed, joules, table

import ebac
from ebac.studies.tuning import TUNING_CONDITIONS

CELLS, FIVE = "study -c cells", "study -c five --population random --hands 500 --seed"
#: Left out of the wide tables: it rests too deep everywhere.
NARROW = "virtual-coupling"
SEEDS = (1, 2, 3)


def by_law(rows: list[Row], *, wide: bool = False) -> dict[str, list[Row]]:
    """Return the rows of every law, in the order of the laws."""
    laws = dict.fromkeys(row["law"] for row in rows)
    return {law: [r for r in rows if r["law"] == law] for law in laws if wide or law != NARROW}


def least(rows: list[Row]) -> float:
    """Return the least port energy [J]."""
    return float(min(row["least_energy_J"] for row in rows))


def drawn(rows: list[Row]) -> float:
    """Return the most energy drawn in any window [J]."""
    return float(max(row["most_drawn_J"] for row in rows))


def total(rows: list[Row], key: str) -> str:
    """Return the hands of all rows together."""
    return str(sum(row[key] for row in rows))


def grid(printed: Printed) -> str:
    """60 hands at the paper's wall, every law."""
    heads = [
        "law",
        "good",
        "in time",
        "least energy [mJ]",
        "most drawn [mJ]",
        "settled, median [s]",
    ]
    rows = [
        [code(r["law"]), str(r["good"]), str(r["settled_in_time"]), joules(r["least_energy_J"]),
         joules(r["most_drawn_J"]), fixed(r["median_settled_s"], 2)]
        for r in printed.rows("study --law all")
    ]  # fmt: skip
    return table(heads, rows)


def tuned(printed: Printed) -> str:
    """Every law as designed and tuned, on the test hands of `ebac tune`; `ebac` as designed."""
    heads = [
        "law", "parameters", "good of 360", "settled, median [s]", "least energy [mJ]", "most drawn [mJ]", "ripple [N]"
    ]  # fmt: skip
    found = json.loads((Path(ebac.__file__).parent / "tuned_rivals.json").read_text("utf-8"))[
        "rows"
    ]
    rows = []
    for law in dict.fromkeys(row["law"] for row in found):
        for what, key in (("designed", "default"), ("tuned", "test")):
            parts = [part for row in found if row["law"] == law for part in row[key]]
            rows.append([code(law), what, *_all_six(parts)])
    found = ebac.study(ebac.Operators.grid(), "ebac", TUNING_CONDITIONS, threads=printed.threads)
    swings = found.columns["force_swing_N"][found.columns["good"]]
    parts = [{**row.row(), "ripple_N": float(swings.max())} for row in found.rows]
    return table(heads, [*rows, [code("ebac"), "designed", *_all_six(parts)]])


def _all_six(parts: list[Row]) -> list[str]:
    def of(key: str) -> list[float]:
        return [part[key] for part in parts if part.get(key) is not None]

    def span(values: list[float]) -> str:
        return f"{min(values):.2f} to {max(values):.2f}" if values else "-"

    ripple = of("ripple_N")
    return [
        total(parts, "good"), span(of("median_settled_s")), joules(min(of("least_energy_J"))),
        joules(max(of("most_drawn_J"))), f"{max(ripple):.1f}" if ripple else "-",
    ]  # fmt: skip


def cells(printed: Printed) -> str:
    """36 cells, every law, and `ebac` from the surface."""
    every = by_law(printed.rows(f"{CELLS} --law all"))
    surface = printed.rows(f"{CELLS} --approach 0 --law ebac")
    named = {code(law): rows for law, rows in every.items()}
    named["`ebac`, from the surface (`--approach 0`)"] = surface
    hands = total(surface, "hands")
    rows = [
        [name, total(r, "good"), total(r, "settled_in_time"), joules(least(r)), joules(drawn(r))]
        for name, r in named.items()
    ]
    heads = ["law", f"good of {hands}", "in time", "least energy [mJ]", "most drawn [mJ]"]
    return (
        f"{table(heads, rows)}\n\nCells of `ebac` that are not 60 of 60: {_missing(every['ebac'])}.\n"
        f"From the surface: {_missing(surface)}."
    )


def _missing(rows: list[Row]) -> str:
    lost = [f"{code(r['condition'])} {r['good']}" for r in rows if r["good"] < r["hands"]]
    return ", ".join(lost) or "none"


def five(printed: Printed) -> str:
    """500 random hands, five conditions, three seeds."""
    seeds = [by_law(printed.rows(f"{FIVE} {seed} --law all")) for seed in SEEDS]
    named = list(dict.fromkeys(r["condition"] for r in seeds[0]["ebac"]))

    def line(law: str, key: str) -> list[str]:
        found = [{r["condition"]: r[key] for r in seed[law]} for seed in seeds]
        return [", ".join(str(of[name]) for of in found) for name in named]

    ours = [row for seed in seeds for row in seed["ebac"]]
    rows = [
        [code(law), *line(law, "good"), joules(min(least(s[law]) for s in seeds))]
        for law in seeds[0]
    ]
    rows += [["`ebac`, in time", *line("ebac", "settled_in_time"), ""]]
    rows += [["ideal wall", *line("ebac", "ideal_good"), ""]]
    return (
        f"{table(['law', *map(code, named), 'least energy [mJ]'], rows)}\n\nMost energy `ebac` drew in any window of "
        f"these {total(ours, 'hands')} runs: {joules(drawn(ours), ' mJ')}."
    )


def robustness_good(printed: Printed) -> str:
    """Good hands under every condition of the robustness list."""
    every = by_law(printed.rows("study -c robustness --law all"))
    ideal = [[code(r["condition"]), count(r["ideal_good"])] for r in every["ebac"]]
    columns = [[count(r["good"]) for r in rows] for rows in every.values()]
    rows = [[*first, *rest] for first, rest in zip(ideal, zip(*columns, strict=True), strict=True)]
    return table(["condition", "ideal wall", *map(code, every)], rows)


def robustness_energy(printed: Printed) -> str:
    """Least port energy under every condition of the robustness list."""
    every = by_law(printed.rows("study -c robustness --law all"))
    first = [code(r["condition"]) for r in every["ebac"]]
    columns = [[joules(r["least_energy_J"]) for r in rows] for rows in every.values()]
    return table(["condition", *map(code, every)], list(zip(first, *columns, strict=True)))


LAWS = "direct,tca,tca-damped,eba,ebac"


def models(printed: Printed) -> str:
    """Hands beyond eq. (4): good, and least port energy; the damper alone beside them."""
    every = by_law(printed.rows(f"study -c hands --law {LAWS}"))
    rows = [
        [code(first["condition"]), *(str(r[i]["good"]) for r in every.values()),
         *(joules(r[i]["least_energy_J"]) for r in every.values())]
        for i, first in enumerate(every["ebac"])
    ]  # fmt: skip
    good = [f"{code(law)}, good of {every[law][0]['hands']}" for law in every]
    return table(["condition", *good, *(f"{code(law)} [mJ]" for law in every)], rows)


def held(printed: Printed) -> str:
    """One light hand that holds for long."""
    found = printed.rows("study -c hold-10min,hold-1h --law direct,tca-damped,eba,ebac")
    rows = [
        [code(r["condition"]), code(r["law"]), joules(r["least_energy_J"]),
         f"{round(1e6 * r['least_rest_power_W'], 1) + 0.0:.1f}"]
        for r in found
    ]  # fmt: skip
    return table(["condition", "law", "least energy [mJ]", "power at rest [uW]"], rows)


def damped(printed: Printed) -> str:
    """Walls with damping: good hands over stiffness and damping."""
    every = by_law(printed.rows(f"study -c damped-walls --law {LAWS}"))
    stiff = list(dict.fromkeys(r["condition"].partition("K")[2] for r in every["ebac"]))
    n = len(stiff)
    rows = [
        [code(law), r[i]["condition"].partition("K")[0][1:], *(str(one["good"]) for one in r[i : i + n])]
        for law, r in every.items()
        for i in range(0, len(r), n)
    ]  # fmt: skip
    return table(["law", "B [N s/m]", *(f"{k} kN/m" for k in stiff)], rows)
