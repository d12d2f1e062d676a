"""The tables of whole populations: `ebac study`."""

from __future__ import annotations

from printed import NOISE, Printed, Row, code, fixed, joules, millijoules, of_two, table

#: The two simple laws that come closest, on the same state observer.
DAMPER, LAG = "tca-damped-tuned-observer", "lag-compensator-tuned-observer"
EVERY = f"--law all,{LAG},{DAMPER}"
CELLS = f"study -c cells {NOISE}"
FIVE = f"study -c five --population random --hands 500 {NOISE} {EVERY} --seed"
#: `ebac` on the encoder alone, in a table of its own command.
ALONE, ALONE_NAME = "--law ebac --no-observer", "`ebac`, `--no-observer`"
#: Left out of the wide tables: it rests too deep everywhere.
NARROW = "virtual-coupling"
SEEDS = (1, 2, 3)
#: The laws of the wide tables, in groups that fit a page: what a group is called, and its laws.
GROUPS = {
    "`ebac`, and the laws that come closest": (
        "`ebac`", code(LAG), code(DAMPER), ALONE_NAME, "`tca-damped`", "`lag-compensator`", "`sfa`",
    ),
    "Laws that render the whole stiffness": ("`direct`", "`tca`", "`passivity-control`", "`iss`"),
    "Energy-bounding laws of the literature": (
        "`force-bounding`", "`eba`", "`eba-account`", "`ebac-printed`",
    ),
}  # fmt: skip


def by_law(rows: list[Row], *, wide: bool = False) -> dict[str, list[Row]]:
    """Return the rows of every law, in the order of the laws."""
    laws = dict.fromkeys(row["law"] for row in rows)
    return {law: [r for r in rows if r["law"] == law] for law in laws if wide or law != NARROW}


def least(rows: list[Row]) -> float:
    """Return the least energy [J]."""
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
        "exact, still",
        "quiet force",
        "in time",
        "least energy [mJ]",
        "drawn in any window [mJ]",
        "settled, median [s]",
    ]
    rows = [
        [name, str(r["good"]), str(r["exact_and_still"]), str(r["force_quiet"]), str(r["settled_in_time"]),
         millijoules(r["least_energy_J"]), millijoules(r["most_drawn_J"]), fixed(r["median_settled_s"], 2)]
        for name, r in (
            *((code(r["law"]), r) for r in printed.rows(f"study {NOISE} {EVERY}")),
            (ALONE_NAME, printed.rows(f"study {NOISE} {ALONE}")[0]),
        )
    ]  # fmt: skip
    return table(heads, rows)


def cells(printed: Printed) -> str:
    """36 cells, every law, and `ebac` from the surface."""
    every = by_law(printed.rows(f"{CELLS} {EVERY}"))
    started = by_law(printed.rows(f"{CELLS} --approach 0 --law ebac,{LAG},{DAMPER}"))
    surface = started["ebac"]
    named = {code(law): rows for law, rows in every.items()}
    named[ALONE_NAME] = printed.rows(f"{CELLS} {ALONE}")
    named |= {f"{code(law)}, from the surface (`--approach 0`)": r for law, r in started.items()}
    hands = total(surface, "hands")
    rows = [
        [name, total(r, "good"), total(r, "exact_and_still"), total(r, "settled_in_time"),
         millijoules(least(r)), millijoules(drawn(r))]
        for name, r in named.items()
    ]  # fmt: skip
    heads = [
        "law",
        f"good of {hands}",
        "exact, still",
        "in time",
        "least energy [mJ]",
        "drawn in any window [mJ]",
    ]
    return (
        f"{table(heads, rows)}\n\nCells in which not all 60 hands are good under `ebac`: "
        f"{_missing(every['ebac'], 'good')}.\nNot exact and still: {_missing(every['ebac'], 'exact_and_still')}. "
        f"From the surface: {_missing(surface, 'exact_and_still')}."
    )


def _missing(rows: list[Row], key: str) -> str:
    lost = [f"{code(r['condition'])} {r[key]}" for r in rows if r[key] < r["hands"]]
    return ", ".join(lost) or "none"


def five(printed: Printed) -> str:
    """500 random hands, five conditions, the worst of three seeds."""
    seeds = [by_law(printed.rows(f"{FIVE} {seed}")) for seed in SEEDS]
    named = list(dict.fromkeys(r["condition"] for r in seeds[0]["ebac"]))

    def fewest(law: str, key: str) -> list[int]:
        found = [{r["condition"]: r[key] for r in seed[law]} for seed in seeds]
        return [min(of[name] for of in found) for name in named]

    def both(law: str) -> list[str]:
        pairs = zip(fewest(law, "good"), fewest(law, "exact_and_still"), strict=True)
        return [of_two(good, still) for good, still in pairs]

    ours = [row for seed in seeds for row in seed["ebac"]]
    rows = [
        [code(law), *both(law), millijoules(min(least(s[law]) for s in seeds))] for law in seeds[0]
    ]
    rows += [["`ebac`, in time", *map(str, fewest("ebac", "settled_in_time")), ""]]
    rows += [["ideal wall", *map(str, fewest("ebac", "ideal_good")), ""]]
    return (
        f"{table(['law', *map(code, named), 'least energy [mJ]'], rows)}\n\nMost energy `ebac` drew in any window of "
        f"these {total(ours, 'hands')} runs: {joules(drawn(ours), ' mJ')}."
    )


def robustness_good(printed: Printed) -> str:
    """Good hands under every condition of the robustness list in which a hand comes to rest."""
    every = _robustness(printed)
    rests = [r for r in every["`ebac`"] if r["ideal_good"] is not None]
    ideal = {r["condition"]: str(r["ideal_good"]) for r in rests}
    found = {
        law: {r["condition"]: _pair(r, "good", "exact_and_still") for r in rows}
        for law, rows in every.items()
    }
    return _grouped({"ideal wall": ideal} | found, list(ideal), first=("ideal wall",))


def _grouped(
    found: dict[str, dict[str, str]], named: list[str], *, first: tuple[str, ...] = ()
) -> str:
    """A table for each group of laws, a row for each condition; where all cells are 0, a sentence instead."""
    parts = []
    for title, laws in GROUPS.items():
        columns = [*(first if not parts else ()), *laws]
        cells = {name: [found[law][name] for law in columns] for name in named}
        zero = [name for name, row in cells.items() if set(row) == {"0"}]
        rows = [[code(name), *row] for name, row in cells.items() if name not in zero]
        parts.append(f"**{title}.**\n\n{table(['condition', *columns], rows)}")
        if zero:
            parts.append(f"All are 0 in: {', '.join(map(code, zero))}.")
    return "\n\n".join(parts)


def _robustness(printed: Printed) -> dict[str, list[Row]]:
    robustness = f"study -c robustness {NOISE}"
    every = {code(law): rows for law, rows in by_law(printed.rows(f"{robustness} {EVERY}")).items()}
    return every | {ALONE_NAME: printed.rows(f"{robustness} {ALONE}")}


def _pair(row: Row, *keys: str) -> str:
    """Return counts of hands, once where they are the same; a dash where there is no point of rest."""
    counts = [row[key] for key in keys]
    return "-" if None in counts else of_two(*counts)


def robustness_energy(printed: Printed) -> str:
    """Least energy under every condition of the robustness list."""
    every = _robustness(printed)
    found = {
        law: {r["condition"]: millijoules(r["least_energy_J"]) for r in rows}
        for law, rows in every.items()
    }
    return _grouped(found, list(found["`ebac`"]))


LAWS = f"direct,tca,tca-damped,{DAMPER},{LAG},eba,ebac"


def models(printed: Printed) -> str:
    """Hands beyond eq. (4): good, then least energy."""
    every = by_law(printed.rows(f"study -c hands {NOISE} --law {LAWS}"))
    first = [code(r["condition"]) for r in every["ebac"]]
    heads = ["condition", *map(code, every)]
    good = [[_pair(r, "good", "exact_and_still") for r in rows] for rows in every.values()]
    least_ = [[millijoules(r["least_energy_J"]) for r in rows] for rows in every.values()]
    tables = (table(heads, list(zip(first, *columns, strict=True))) for columns in (good, least_))
    hands = every["ebac"][0]["hands"]
    return "\n\n".join(
        f"{title}\n\n{text}"
        for title, text in zip(
            (f"**Of {hands}, good / exact and still.**", "**Least energy [mJ].**"),
            tables,
            strict=True,
        )
    )


def held(printed: Printed) -> str:
    """One light hand that holds for long."""
    long = f"study -c hold-10min,hold-1h {NOISE}"
    found = [
        *(
            (code(r["law"]), r)
            for r in printed.rows(f"{long} --law direct,tca-damped,{DAMPER},{LAG},eba,ebac")
        ),
        *((ALONE_NAME, r) for r in printed.rows(f"{long} {ALONE}")),
    ]
    rows = [
        [code(r["condition"]), name, millijoules(r["least_energy_J"]),
         f"{round(1e6 * r['least_rest_power_W'], 1) + 0.0:.1f}"]
        for name, r in sorted(found, key=lambda one: one[1]["condition"] == "hold-1h")
    ]  # fmt: skip
    return table(["condition", "law", "least energy [mJ]", "power at rest [µW]"], rows)


def damped(printed: Printed) -> str:
    """Walls with damping: good hands over stiffness and damping."""
    every = by_law(printed.rows(f"study -c damped-walls {NOISE} --law {LAWS}"))
    stiff = list(dict.fromkeys(r["condition"].partition("K")[2] for r in every["ebac"]))
    n = len(stiff)
    rows = [
        [code(law), r[i]["condition"].partition("K")[0][1:],
         *(_pair(one, "good", "exact_and_still") for one in r[i : i + n])]
        for law, r in every.items()
        for i in range(0, len(r), n)
    ]  # fmt: skip
    return table(["law", "B [N s/m]", *(f"{k} kN/m" for k in stiff)], rows)
