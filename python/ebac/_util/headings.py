"""Names and units in the headings of columns, as every reader of this package understands them."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from math import pi
from typing import Any

#: What one of a unit is in SI, by quantity.
FACTORS: dict[str, dict[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9, "min": 60.0},
    "length": {
        "m": 1.0,
        "mm": 1e-3,
        "cm": 1e-2,
        "um": 1e-6,
        "µm": 1e-6,
        "in": 0.0254,
        "inch": 0.0254,
    },
    "force": {
        "N": 1.0,
        "mN": 1e-3,
        "kN": 1e3,
        "gf": 9.80665e-3,
        "kgf": 9.80665,
        "lbf": 4.4482216152605,
    },
    "angle": {
        "rad": 1.0,
        "mrad": 1e-3,
        "deg": pi / 180,
        "°": pi / 180,
        "degree": pi / 180,
        "degrees": pi / 180,
        "turn": 2 * pi,
        "turns": 2 * pi,
        "rev": 2 * pi,
    },
    "torque": {
        "N m": 1.0,
        "mN m": 1e-3,
        "uN m": 1e-6,
        "kN m": 1e3,
        "N cm": 1e-2,
        "mN cm": 1e-5,
        "N mm": 1e-3,
    },
    "count": {"counts": 1.0, "count": 1.0, "cts": 1.0, "inc": 1.0, "ticks": 1.0},
    "current": {"A": 1.0, "mA": 1e-3},
    "voltage": {"V": 1.0, "mV": 1e-3},
    "mass": {"kg": 1.0, "g": 1e-3},
    "damping": {"N s/m": 1.0, "Ns/m": 1.0, "N*s/m": 1.0, "Ns_per_m": 1.0, "N s/mm": 1e3},
    "stiffness": {"N/m": 1.0, "N_per_m": 1.0, "N/mm": 1e3, "kN/m": 1e3},
    "frequency": {"Hz": 1.0},
}

#: A torque as N m, Nm, N*m, N.m, N_m, N-m, N\u00b7m, with prefixes; `nm` without a mark between.
_TORQUE = r"(?:[muk\u00b5]?N[ *._\u00b7\u22c5\u2219\u00d7-]*|[muk\u00b5]?n)(?:[cm]?m|M)"

#: Names of signals without unit, by quantity; the first that fits gives the unit of a heading without one.
_SIGNALS = {
    "time": re.compile(r"t|time|timestamp|zeit"),
    "length": re.compile(r"(true\.)?[xyz](_\d)?|pos|position|target"),
    "force": re.compile(r"(true\.)?f(_[a-z]+)*(_\d)?|force(_[a-z\d]+)?|motor|desired"),
    "angle": re.compile(r"(theta|phi|angle|q|x|pos|position|target)(_\d)?"),
    "torque": re.compile(r"(tau|torque|f|force|motor|desired)(_[a-z]+)*(_\d)?"),
}


def split_heading(heading: str, units: Collection[str]) -> tuple[str, str | None]:
    """Return name and unit of a heading; the unit is None where there is none.

    Parameters
    ----------
    heading : str
        `x [mm]`, `x (mm)`, `x_mm`, `x mm`, `x.mm` or `x/mm`; a torque in any spelling.
    units : collection of str
        What may be a unit without brackets, in capital or small letters; anything in brackets is one.
    """
    text = heading.strip().replace(
        "\u03bc", "\u00b5"
    )  # the Greek letter and the micro sign look alike
    match = re.fullmatch(r"(.*?)\s*(?:\[\s*([^\]]*?)\s*\]|\(\s*([^)]*?)\s*\))", text)
    if match and match[1]:
        return match[1], _plain(standard_unit(match[2] or match[3], units)) or None
    torque = re.fullmatch(rf"(.+?)[_/. ]+({_TORQUE})", text)
    if torque and (unit := standard_unit(torque[2], units)) in units:
        return torque[1], unit
    for unit in sorted(units, key=len, reverse=True):
        stem, end = text[: -len(unit)], text[-len(unit) :]
        name = stem.rstrip("_/. ")
        if name and name != stem and standard_unit(end, [unit]) == unit:
            return name, _plain(unit)
    return text, None


def signal_heading(heading: str) -> tuple[str, str, float]:
    """Return name, SI unit and factor to it of the heading of a log.

    A unit without brackets is one where it fits the name: `x_mm` is x in mm, `law.f_d` stays whole. Time, position,
    force, angle and torque without unit are in SI units.
    """
    every = [unit for units in FACTORS.values() for unit in units]
    name, unit = split_heading(heading, ())
    unit = unit and _plain(standard_unit(unit, every))
    for quantity, known in _SIGNALS.items():
        stem, own = (name, unit) if unit else split_heading(heading, FACTORS[quantity])
        if known.fullmatch(stem.lower()):
            name = "t" if quantity == "time" else stem.lower()
            unit = own or next(iter(FACTORS[quantity]))
    for units in FACTORS.values():
        if unit in units:
            return name, next(iter(units)), units[unit]
    return name, unit or "1", 1.0


def with_units(values: Mapping[str, Any], units: Mapping[str, str]) -> dict[str, Any]:
    """Return values with their units in the keys, as JSON has them: `impulse_N_s`; a pure number keeps its name."""
    return {
        f"{name}_{units[name].replace(' ', '_')}" if name in units else name: value
        for name, value in values.items()
    }


def standard_unit(unit: str | None, units: Collection[str]) -> str:
    """Return a unit in its standard letters: mm for MM, N m for Nm. MN stays: it is no mN; nm among lengths is none."""
    if not unit or unit in units:
        return unit or ""
    if re.fullmatch(_TORQUE, unit) and not (unit == "nm" and "mm" in units):
        first, last = re.split(r"[^mukc\u00b5M]+", unit)
        torque = f"{_plain(first)}N {last.lower()}"
        return torque if torque in units else unit
    same = (known for known in units if known.lower() == unit.lower())
    return next((known for known in same if unit[0] != "M" or known != "mN"), unit)


def _plain(unit: str | None) -> str:
    return (unit or "").replace("\u00b5", "u")
