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


#: Names of signals without unit, by quantity.
_SIGNALS = {
    "time": re.compile(r"t|time"),
    "length": re.compile(r"(true\.)?[xyz](_\d)?|pos|position|target"),
    "force": re.compile(r"(true\.)?f(_[a-z]+)*(_\d)?|force(_[a-z\d]+)?|motor|desired"),
}


def split_heading(heading: str, units: Collection[str]) -> tuple[str, str | None]:
    """Return name and unit of a heading; the unit is None where there is none.

    Parameters
    ----------
    heading : str
        `x [mm]`, `x (mm)`, `x_mm`, `x mm`, `x.mm` or `x/mm`.
    units : collection of str
        What may be a unit without brackets, in capital or small letters; anything in brackets is one.
    """
    text = heading.strip().replace(
        "\u03bc", "\u00b5"
    )  # the Greek letter and the micro sign look alike
    match = re.fullmatch(r"(.*?)\s*(?:\[\s*([^\]]*?)\s*\]|\(\s*([^)]*?)\s*\))", text)
    if match and match[1]:
        return match[1], _plain(_standard(match[2] or match[3], units)) or None
    for unit in sorted(units, key=len, reverse=True):
        stem, end = text[: -len(unit)], text[-len(unit) :]
        name = stem.rstrip("_/. ")
        if name and name != stem and _standard(end, [unit]) == unit:
            return name, _plain(unit)
    return text, None


def signal_heading(heading: str) -> tuple[str, str, float]:
    """Return name, SI unit and factor to it of the heading of a log.

    A unit without brackets is one where it fits the name: `x_mm` is x in mm, `law.f_d` stays whole. Time, position
    and force without unit are in SI units.
    """
    every = [unit for units in FACTORS.values() for unit in units]
    name, unit = split_heading(heading, ())
    unit = unit and _plain(_standard(unit, every))
    for quantity, known in _SIGNALS.items():
        stem, own = (name, unit) if unit else split_heading(heading, FACTORS[quantity])
        if known.fullmatch(stem.lower()):
            name = "t" if stem.lower() == "time" else stem.lower()
            unit = own or next(iter(FACTORS[quantity]))
    for units in FACTORS.values():
        if unit in units:
            return name, next(iter(units)), units[unit]
    return name, unit or "1", 1.0


def _standard(unit: str | None, units: Collection[str]) -> str:
    """Return a unit in its standard letters: mm for MM. MN stays: it is no mN."""
    if not unit or unit in units:
        return unit or ""
    same = (known for known in units if known.lower() == unit.lower())
    return next((known for known in same if unit[0] != "M" or known != "mN"), unit)


def _plain(unit: str | None) -> str:
    return (unit or "").replace("\u00b5", "u")
