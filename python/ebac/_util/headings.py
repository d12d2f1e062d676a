"""Names and units in the headings of columns, as every reader of this package understands them."""

from __future__ import annotations

import re
from collections.abc import Collection

#: What one of a unit is in SI, by quantity.
FACTORS: dict[str, dict[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9, "min": 60.0},
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "µm": 1e-6, "in": 0.0254},
    "force": {
        "N": 1.0,
        "mN": 1e-3,
        "kN": 1e3,
        "gf": 9.80665e-3,
        "kgf": 9.80665,
        "lbf": 4.4482216152605,
    },
    "mass": {"kg": 1.0, "g": 1e-3},
    "damping": {"N s/m": 1.0, "Ns/m": 1.0, "N*s/m": 1.0, "Ns_per_m": 1.0, "N s/mm": 1e3},
    "stiffness": {"N/m": 1.0, "N_per_m": 1.0, "N/mm": 1e3, "kN/m": 1e3},
    "frequency": {"Hz": 1.0},
}


def split_heading(heading: str, units: Collection[str]) -> tuple[str, str | None]:
    """Return name and unit of a heading; the unit is None where there is none.

    Parameters
    ----------
    heading : str
        `x [mm]`, `x (mm)`, `x_mm`, `x mm` or `x/mm`.
    units : collection of str
        What may be a unit without brackets; anything in brackets is one.
    """
    text = heading.strip().replace(
        "\u03bc", "\u00b5"
    )  # the Greek letter and the micro sign look alike
    match = re.fullmatch(r"(.*?)\s*(?:\[\s*([^\]]*?)\s*\]|\(\s*([^)]*?)\s*\))", text)
    if match and match[1]:
        return match[1], _plain(match[2] or match[3]) or None
    for unit in sorted(units, key=len, reverse=True):
        stem = text.removesuffix(unit)
        name = stem.rstrip("_/ ")
        if stem != text and name and name != stem:
            return name, _plain(unit)
    return text, None


def _plain(unit: str | None) -> str:
    return (unit or "").replace("\u00b5", "u")
