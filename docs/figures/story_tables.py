"""The tables of the story alone: one hand, 60 hands, the law put together again."""

from __future__ import annotations

from printed import NOISE, Printed, Row, code, fixed, joules, table

#: One hand under four laws, and what they are called.
ONE_HAND = {
    "tca": "`tca`",
    "eba": "`eba`",
    "ebac-printed": "`ebac-printed`, eq. (8) to (10) and (2) to the letter",
    "ebac": "`ebac`, completed",
}
#: What the story shows, in this order.
TOLD = ("tca", "eba", "ebac-printed", "tca-damped", "ebac")
#: The law put together again: what is off, and what it then has.
BUILT = {
    "observer=off,recovery=off,injection=off,guard=off,kp=0": "eq. (8) to (10), sorted, the bound last",
    "observer=off,injection=off,guard=off,kp=0": "... and recovery at rest",
    "observer=off,guard=off,kp=0": "... and damping",
    "observer=off": "... and the guard, K_p = 0.1",
    "": "... and the observer: `ebac`",
}


def walls(printed: Printed) -> str:
    """One hand against the paper's wall under four laws."""
    rows = []
    for r in printed.rows(" ".join(["wall", NOISE, *(f"--law {law}" for law in ONE_HAND)])):
        ideal = fixed(r["ideal_m"], 3, 1e3)
        least_ = joules(r["least_energy_J"], " mJ")
        rows.append(
            [
                ONE_HAND[r["law"]],
                *(f"{fixed(r[k], 3, 1e3)} mm" for k in ("rest_m", "swing_m")),
                least_,
            ]
        )
    return table(["law", f"rest (ideal {ideal} mm)", "swing", "least energy"], rows)


def hands(printed: Printed) -> str:
    """60 hands at the paper's wall, as the story tells it."""
    rows = {code(r["law"]): r for r in printed.rows(f"study {NOISE} --law all")}
    alone = {"`ebac`, `--no-observer`": printed.rows(f"study {NOISE} --law ebac --no-observer")[0]}
    told = [(code(law), rows[code(law)]) for law in TOLD]
    keys = ("good", "exact_and_still", "force_quiet", "settled_in_time")
    return table(
        ["law", "good", "exact, still", "quiet force", "in time", "least energy"],
        [
            [name, *(str(r[key]) for key in keys), joules(r["least_energy_J"], " mJ")]
            for name, r in (*told[:-1], *alone.items(), told[-1])
        ],
    )


def pieces(printed: Printed) -> str:
    """The law put together again, piece by piece."""
    asked = " ".join(f"--change {off}" for off in BUILT if off)
    made = {
        _typed(r["changes"]): r
        for r in printed.rows(f"ablation {NOISE} {asked}")
        if r["law"] == "ebac"
    }
    keys = ("least_energy_impact_J", "least_energy_let_go_J", "least_energy_pumping_J")
    rows = [
        [name, *(str(made[off][k]) for k in ("good", "exact_and_still", "good_K20")),
         *(joules(made[off][k], " mJ") for k in keys)]
        for off, name in BUILT.items()
    ]  # fmt: skip
    heads = ["the law has", "good", "exact, still", "good, 20 kN/m", "least energy, impact", "slow press, then let go",
             "pumping for 20 s"]  # fmt: skip
    return table(heads, rows)


def _typed(changes: Row) -> str:
    """Changes of parameters as `--change` takes them."""
    return ",".join(f"{k}=off" if v is False else f"{k}={v:g}" for k, v in changes.items())
