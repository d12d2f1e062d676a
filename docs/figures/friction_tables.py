"""What friction of the device changes for `ebac`: declared, compensated, not declared, declared as more than it is."""

from __future__ import annotations

from dataclasses import dataclass

from printed import NOISE, NOISY, Printed, table

from ebac.studies import scenario_changes as to
from ebac.studies.condition import Condition
from ebac.studies.conditions import conditions

#: Conditions of the second table: a hand that presses at once, two that sway, two that press slowly.
HARD = ("d2K35", "slow-waves", "slow-waves-K20", "slow-press-K20", "slow-press-d2K20")
#: Cells of the first table, by stiffness.
CELLS = {10: ("d0K10", "d1K10", "d2K10"), 20: ("d0K20", "d1K20", "d2K20"), 35: ("d1K35", "d2K35")}


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Coulomb friction of the device, what its motor compensates of it, and what the observer is told of it [N]."""

    coulomb: float = 0.0
    compensated: float = 0.0
    told: float | None = None
    observer: bool = True

    def study(self, known: Condition) -> Condition:
        """Return a condition with this friction."""
        friction = to.device("mechanics", coulomb=self.coulomb)
        if self.told is not None:
            declared = to.device("mechanics", coulomb=self.told)
            friction = to.untold(friction, declared=declared)
        change = to.together(known.change, friction)
        if self.compensated:
            change = to.together(change, to.device("compensation", friction=self.compensated))
        if not self.observer:
            change = to.together(change, to.scenario(observer=False))
        return Condition(name=known.name, summary=known.summary, change=change)


ROWS: tuple[tuple[str, tuple[Friction, ...]], ...] = (
    ("none", (Friction(),)),
    ("0.05, 0.1, 0.3 N, declared", tuple(Friction(coulomb=f) for f in (0.05, 0.1, 0.3))),
    ("0.1 N, declared, all of it compensated", (Friction(coulomb=0.1, compensated=0.1),)),
    (
        "0.3 N, declared, half or 80 % of it compensated",
        tuple(Friction(coulomb=0.3, compensated=c) for c in (0.15, 0.24)),
    ),
    ("0.3 N, declared, all of it compensated", (Friction(coulomb=0.3, compensated=0.3),)),
    ("0.5 N, declared", (Friction(coulomb=0.5),)),
    ("1 N, declared", (Friction(coulomb=1.0),)),
    ("0.05 N, not declared", (Friction(coulomb=0.05, told=0.0),)),
    ("0.1 N, not declared", (Friction(coulomb=0.1, told=0.0),)),
    ("0.3 N, not declared", (Friction(coulomb=0.3, told=0.0),)),
    ("0.1 N, declared as 0.15 N (observer 0.12 N)", (Friction(coulomb=0.1, told=0.15),)),
    ("0.3 N, declared as 0.45 N (observer 0.36 N)", (Friction(coulomb=0.3, told=0.45),)),
    ("0.1 N, on the encoder alone", (Friction(coulomb=0.1, observer=False),)),
)


def declared(printed: Printed) -> str:
    """Usable areas, and good hands of 60 that press at once, with friction that is declared."""
    rows = []
    for friction in (0.0, 0.05, 0.1, 0.3):
        options = f"{NOISE} --device-coulomb {friction:g}" if friction else NOISE
        found = printed.document(f"zwidth --law ebac --points 3 {options}")
        areas = ", ".join(f"{one['usable_area'] / 1e3:.0f}" for one in found["scores"])
        names = ",".join(",".join(cells) for cells in CELLS.values())
        good = {r["condition"]: r for r in printed.rows(f"study --law ebac {options} -c {names}")}
        counts = [", ".join(str(good[c]["good"]) for c in cells) for cells in CELLS.values()]
        rows.append([f"{friction:g} N" if friction else "0", areas, *counts])
    heads = [
        "friction, declared",
        "area, d = 0, 1, 2",
        "good, 10 kN/m, d = 0, 1, 2",
        "good, 20 kN/m, d = 0, 1, 2",
        "good, 35 kN/m, d = 1, 2",
    ]
    return table(heads, rows)


def kept_walls(printed: Printed) -> str:
    """Hands of 60 that are exact and still."""
    rows = []
    for label, frictions in ROWS:
        found = [
            printed.studied(_name(one), [one.study(known) for known in conditions(HARD)], NOISY)
            for one in frictions
        ]
        cells = [
            ", ".join(str(r["exact_and_still"]) for r in of) for of in zip(*found, strict=True)
        ]
        rows.append([label, *cells])
    heads = [
        "friction",
        "`d2K35`",
        "sway, 10 kN/m (`slow-waves`)",
        "sway, 20 kN/m (`slow-waves-K20`)",
        "slow press, 20 kN/m (`slow-press-K20`)",
        "the same, 2 samples (`slow-press-d2K20`)",
    ]
    return table(heads, rows)


def _name(one: Friction) -> str:
    told = "" if one.told is None else f"-told-{one.told:g}"
    return f"friction-{one.coulomb:g}-{one.compensated:g}{told}{'' if one.observer else '-alone'}"
