"""The tables of one law: its pieces, its worst hand, its Z-width, its speed."""

from __future__ import annotations

import re
from collections.abc import Callable

from printed import NOISE, Printed, Row, code, fixed, millijoules, table

import ebac
from ebac.studies.conditions import conditions
from ebac.studies.families import find_family

NOISY = ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)))
Show = Callable[[float | None], str]
#: Measures of `ebac ablation` by question: the key, the heading, how its number is written.
MEASURES: dict[str, tuple[tuple[str, str, Show], ...]] = {
    "**How many hands are good?** Of 60, at 10 kN/m, and good in four harder conditions.": (
        ("good", "good", lambda n: fixed(n, 0)),
        ("exact_and_still", "exact, still", lambda n: fixed(n, 0)),
        ("settled_in_time", "in time", lambda n: fixed(n, 0)),
        ("good_K20", "20 kN/m", lambda n: fixed(n, 0)),
        ("good_d2_K20", "20 kN/m, delay 2", lambda n: fixed(n, 0)),
        ("good_slow_press_d2_K20", "the same, slow press", lambda n: fixed(n, 0)),
        ("good_tremor", "tremor", lambda n: fixed(n, 0)),
    ),
    "**How fast, and how quiet?**": (
        ("median_settled_s", "settled, median [s]", lambda s: fixed(s, 3)),
        ("force_swing_N", "force swing [N]", lambda f: fixed(f, 2)),
        ("force_swing_noise_N", "the same, 0.2 N noise [N]", lambda f: fixed(f, 2)),
        ("force_step_N", "step inside [N]", lambda f: fixed(f, 1)),
        ("friction_m", "off, friction 1 N [mm]", lambda x: fixed(x, 3, 1e3)),
    ),
    "**How much energy?** Least energy [mJ].": (
        ("least_energy_impact_J", "impact", millijoules),
        ("least_energy_let_go_J", "let go", millijoules),
        ("least_energy_pumping_J", "pumping", millijoules),
    ),
}
PURPOSE = {
    "observer": "quiet in force, fast, and seen below a count",
    "continuity": "smaller steps of the force inside of the wall",
    "recovery": "rests where the wall is",
    "injection": "takes out what recovery puts in",
    "fast_stiffness": "noise does not ring with a heavy hand on a stiff wall",
    "guard": "limits the energy that a hand draws",
    "kp": "less friction felt",
}


def ablation(printed: Printed) -> str:
    """The law without each of its pieces; bold what gets worse, italics what gets better."""
    found = printed.rows(f"ablation {NOISE}")
    purposes = [[_name(r), PURPOSE[next(iter(r["changes"]))]] for r in found if r["piece"]]
    return f"{table(['change', 'what the piece is for'], purposes)}\n\n{_pieces(found)}"


def ablation_encoder(printed: Printed) -> str:
    """The same on the encoder alone."""
    rows = printed.rows(f"ablation {NOISE} --no-observer")
    return _pieces([r for r in rows if "observer" not in (r["changes"] or {})])


def _pieces(found: list[Row]) -> str:
    """A table for each question, a row for each piece."""
    return "\n\n".join(
        f"{question}\n\n{table(['', *(head for _, head, _ in asked)], [_piece(r, asked) for r in found])}"
        for question, asked in MEASURES.items()
    )


def _piece(row: Row, asked: tuple[tuple[str, str, Show], ...]) -> list[str]:
    marks = (
        {**dict.fromkeys(row["worse"], "**"), **dict.fromkeys(row["better"], "*")}
        if row["piece"]
        else {}
    )
    return [
        _name(row),
        *(f"{marks.get(k, '')}{show(row[k])}{marks.get(k, '')}" for k, _, show in asked),
    ]


def _name(row: Row) -> str:
    """What is off, or the law."""
    changes = (row["changes"] or {}).items()
    parts = [f"{k} off" if v is False else f"{k} = {v:g}" for k, v in changes]
    return ", ".join(parts) if row["piece"] else code(row["law"])


def worst(printed: Printed) -> str:
    """The worst hand of every family; the same hand behind other parts, and for longer."""
    found = printed.document(f"worst {NOISE}")
    free, alone = (
        {r["family"]: r["energy_drawn_J"] for r in printed.rows(f"worst {NOISE} {change}")}
        for change in ("--change guard=off", "--no-observer")
    )
    drawn, others = [], []
    for r in found["rows"]:
        family = find_family(r["family"], found["allowed_pull_N"])
        (where,) = conditions([r["condition"]])
        values = {p["name"]: p["value"] for p in r["parameters"]}
        hand = family.make(where.change(NOISY), values)
        name, most = code(family.name), millijoules(r["energy_drawn_J"])
        again = (millijoules(found[family.name]) for found in (free, alone))
        drawn.append([name, most, *again, fixed(r["most_pull_N"], 1)])
        parts = [(True, 1), (False, 64), (True, 64)]
        longer = millijoules(r["energy_drawn_300_s_J"])
        others.append([name, most, *(millijoules(_behind(hand, *part)) for part in parts), longer])
    searched = table(
        ["family", "`ebac`", "guard off", "`--no-observer`", "hardest pull of the first [N]"], drawn
    )
    behind = table(["family", "as found", "no current lag", "64 times the counts", "both", "in 5 min"],
                   others)  # fmt: skip
    return (
        f"**Energy drawn by the worst hand of each family** [mJ].\n\n{searched}\n\n"
        "**The same hands of the first column** with another current loop, another encoder, or in a run of 5 min "
        f"[mJ].\n\n{behind}"
    )


def _behind(hand: ebac.Scenario, no_lag: bool, finer: int) -> float:
    """Energy [J] the same hand draws from `ebac`, designed anew for the other parts of the device."""
    device = hand.device
    lag = 0.0 if no_lag else device.drive.current_lag
    other = device.replace(
        drive=device.drive.replace(current_lag=lag),
        encoder=device.encoder.replace(counts_per_turn=finer * device.encoder.counts_per_turn),
    )
    trace = ebac.simulate(hand.replace(device=other), "ebac")
    return max(0.0, -(ebac.contact(trace).least_energy_J or 0.0))


def speed(printed: Printed) -> str:
    """Times beside other programs; only where nothing else runs."""
    rows = [
        [r["subject"], r["program"], _quantity(r["value"], r["unit"]),
         "" if r["program"] == "ebac" else fixed(r["times_ebac"], 1), _aim(r)]
        for r in printed.rows("bench --peers")
        if r["unit"] != "m"  # what is computed, not how fast
    ]  # fmt: skip
    return table(["what", "program", "", "times ebac", "aim"], rows)


def _aim(row: Row) -> str:
    """What was aimed at, and whether it was missed: the number is the first after "at least" or "at most"."""
    aim: str = row["target"]
    found = re.match(r"at (least|most) ([\d.]+)", aim)
    if not found:
        return aim
    reached = row["value"] if row["program"] == "ebac" else row["times_ebac"]
    missed = reached < float(found[2]) if found[1] == "least" else reached > float(found[2])
    return f"{aim}: **missed**" if missed else aim


def _quantity(value: float, unit: str) -> str:
    if unit == "s":
        return f"{value:.1f} s" if value > 0.1 else f"{1e9 * value:,.0f} ns"
    if unit == "B":
        return f"{value / 1e6:.0f} MB" if value > 1e6 else f"{value:g} bytes"
    return f"{value:.2f}"
