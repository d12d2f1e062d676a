"""Default gains and chosen ones side by side, on hands that were held out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ebac._util.arrays import Values
from ebac.identify.gains.check import MEASURES, GainsCase, Refused
from ebac.identify.gains.press_trials import Presses

#: Finer differences are not counted: one tick [s], a micrometre, a millinewton.
FINEST = {"settled": 1e-3, "swing": 1e-6, "noise": 1e-3}
#: Over which logs: all, those whose held-out presses keep all constraints under the default gains, and the others; at
#: last those whose default had to be turned down for the presses it was chosen on, and that in place of the default.
OVER = ("all", "default keeps", "default breaks", "default turned down")
HOW = ("better", "equal", "worse")
#: What a table shows: its words, the name in a row, what is compared press by press, scale and digits.
NUMBERS = (
    ("settling, median [ms]", "settled_median_s", "settled", 1e3, 1),
    ("swing, median [um]", "swing_median_m", "swing", 1e6, 2),
    ("noise, median [mN]", "noise_median_N", "noise", 1e3, 1),
    ("swing, worst [um]", "swing_worst_m", "", 1e6, 1),
    ("settled presses [1]", "settled", "", 1, 0),
    ("least energy [mJ]", "least_energy_J", "", 1e3, 1),
    ("logs that break [1]", "logs_with_broken_constraint", "", 1, 0),
    ("Kp, median [1]", "kp_median", "", 1, 4),
    ("Kd, median [ms]", "kd_median_s", "", 1e3, 3),
)


def gains_rows(cases: Sequence[GainsCase | Refused]) -> list[dict[str, Any]]:
    """Return a row for each law, group of logs and kind of gains, over all presses that were held out.

    A law of which every log was refused has no row, nor has a group without a log.
    """
    rows = []
    for law in dict.fromkeys(c.law for c in cases):
        mine = [c for c in cases if isinstance(c, GainsCase) and c.law == law]
        refused = sum(isinstance(c, Refused) and c.law == law for c in cases)
        for over in OVER:
            base = "turned_down" if over == OVER[-1] else "default"
            group = [c for c in mine if over in ("all", *_sides(c))]
            for kind in (base, "chosen") if group else ():
                name = "chosen" if kind == "chosen" else "default"
                row = {"law": law, "over": over, "gains": name, **_numbers(group, kind)}
                if kind == "chosen":
                    row |= _against(group, base)
                rows.append(row | {"logs_refused": refused})
    return rows


def side_by_side(rows: Sequence[Mapping[str, Any]]) -> list[list[str]]:
    """Return heading and cells of `gains_rows`: a line for each number, its unit beside its name.

    A number that is None, as JSON has it, is one that is not finite.
    """
    heading = [
        "law",
        "logs, presses [1]",
        "number",
        "default",
        "chosen",
        "better / equal / worse [1]",
    ]
    pairs: dict[tuple[str, str], dict[str, Mapping[str, Any]]] = {}
    for row in rows:
        pairs.setdefault((row["law"], row["over"]), {})[row["gains"]] = row
    lines = [heading]
    for (law, over), pair in pairs.items():
        default, chosen = pair["default"], pair["chosen"]
        if over in OVER[1:3] and default["logs"] == pairs[law, "all"]["default"]["logs"]:
            continue  # the same once more
        first = [law, f"{over}: {default['logs']}, {default['presses']}"]
        for text, name, measure, scale, digits in NUMBERS if over == "all" else NUMBERS[:3]:
            values = [written(row[name], scale, digits) for row in (default, chosen)]
            counts = " / ".join(str(chosen[f"{measure}_{how}"]) for how in HOW) if measure else ""
            lines.append([*first, text, *values, counts])
            first = ["", ""]
    return lines


def written(value: float | None, scale: float, digits: int) -> str:
    """Return a number as a table has it; "never" for a time without end."""
    return f"{scale * value:.{digits}f}" if value is not None and np.isfinite(value) else "never"


def compare(chosen: Values, default: Values, scatter: Values, finest: float) -> dict[str, int]:
    """Return on how many presses the choice is better, equal, worse.

    Equal: apart by no more than another seed of the noise changes, one standard deviation, and than `finest`. What
    never settles is infinite: equal to what never does either, worse than all else.
    """
    with np.errstate(invalid="ignore"):  # inf - inf: neither better nor worse
        apart = chosen - default
    within = np.maximum(np.nan_to_num(scatter, nan=0.0, posinf=0.0), finest) * (1 + 1e-9)
    better, worse = int((apart < -within).sum()), int((apart > within).sum())
    return dict(zip(HOW, (better, len(apart) - better - worse, worse), strict=True))


def _sides(case: GainsCase) -> tuple[str, ...]:
    side = "default breaks" if case.broken("default") else "default keeps"
    return (side,) if case.turned_down is None else (side, "default turned down")


def _column(presses: Sequence[Presses], name: str) -> Values:
    return np.concatenate([p.settled if name == "settled" else p.columns[name] for p in presses])


def _against(cases: Sequence[GainsCase], base: str) -> dict[str, int]:
    out: dict[str, int] = {}
    for name in MEASURES:
        chosen, default = (
            _column([getattr(c, kind) for c in cases], name) for kind in ("chosen", base)
        )
        scatter = np.concatenate([c.scatter[name] for c in cases])
        found = compare(chosen, default, scatter, FINEST[name])
        out |= {f"{name}_{how}": many for how, many in found.items()}
    return out


def _numbers(cases: Sequence[GainsCase], kind: str) -> dict[str, Any]:
    presses: list[Presses] = [getattr(c, kind) for c in cases]
    gains = [getattr(c.result, kind) for c in cases]
    breaks = [c.broken(kind) for c in cases]
    settled, swing = _column(presses, "settled"), _column(presses, "swing")
    return {
        "kp_median": float(np.median([g.kp for g in gains])),
        "kd_median_s": float(np.median([g.kd for g in gains])),
        "presses": len(settled),
        "settled": int(np.isfinite(settled).sum()),
        "settled_median_s": float(np.median(settled)),
        "swing_median_m": float(np.median(swing)),
        "swing_worst_m": float(np.max(swing)),
        "noise_median_N": float(np.median(_column(presses, "noise"))),
        "least_energy_J": float(np.min(_column(presses, "least_energy"))),
        "logs": len(cases),
        "logs_with_broken_constraint": sum(map(bool, breaks)),
        "broken": sorted({name for names in breaks for name in names}),
    }
