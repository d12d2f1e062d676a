"""What the 60 hands find with and without the observer while its inputs or its model fail."""

from __future__ import annotations

from collections import Counter
from functools import partial

import numpy as np
from printed import NOISY, Printed, Row, code, table

import ebac

#: The case without a failure comes first, then the group of `ebac conditions`.
CASES = ("d1K10", "failures")
#: Of so many runs one is asked for the reasons of the fallback.
EVERY = 6


def failures(printed: Printed) -> str:
    """Hands, energies and the swing of the force without and with the observer; how far it is trusted."""
    alone, with_observer = (
        printed.kept(f"failures-{'on' if on else 'off'}", partial(_studied, printed, on))
        for on in (False, True)
    )
    rows = [
        [
            code(off["condition"]),
            f"{off['still']}, {on['still']}",
            f"{off['quiet']}, {on['quiet']}",
            f"{1e3 * off['drawn_J']:.2f}, {1e3 * on['drawn_J']:.2f}",
            *(f"{one['median_N']:.2f}, {one['worst_N']:.2f}" for one in (off, on)),
            " ".join([f"{100 * on['trusted']:.0f} %", ", ".join(on["reasons"])]).strip(),
        ]
        for off, on in zip(alone, with_observer, strict=True)
    ]
    heads = [
        "condition",
        "exact and still",
        "force quiet",
        "drawn in any window [mJ]",
        "force swing without [N]",
        "force swing with [N]",
        "trusted; fell back for",
    ]
    return table(heads, rows)


def _studied(printed: Printed, observer: bool) -> list[Row]:
    base = NOISY.replace(observer=observer)
    study = ebac.study(
        ebac.Operators.grid(), ["ebac"], CASES, base=base, seed=1, threads=printed.threads
    )
    return [_case(study, row, observer) for row in study.rows]


def _case(study: ebac.Study, row: ebac.StudyRow, observer: bool) -> Row:
    runs = study.runs("ebac", row.condition)
    swing = study.columns["force_swing_N"][runs]
    found: Row = {
        "condition": row.condition,
        "still": row.exact_and_still,
        "quiet": row.force_quiet,
        "drawn_J": row.most_drawn_J or 0.0,
        "median_N": float(np.median(swing)),
        "worst_N": float(swing.max()),
    }
    if observer:
        uses = [ebac.observer_use(study.trace(run)) for run in runs[::EVERY].tolist()]
        reasons = Counter(name for use in uses if use is not None for name in use.fallback)
        found["trusted"] = float(np.mean([use.trusted for use in uses if use is not None]))
        found["reasons"] = sorted(reasons)
    return found
