"""Numbers with their units, as people read them."""

from __future__ import annotations

from collections.abc import Iterable
from math import floor, isfinite, log10
from typing import Any

#: SI unit: factor, unit shown, decimals.
SHOWN: dict[str, tuple[float, str, int]] = {
    "m": (1e3, "mm", 3),
    "J": (1e3, "mJ", 2),
    "W": (1e3, "mW", 2),
    "N": (1, "N", 2),
    "s": (1, "s", 3),
    "Hz": (1, "Hz", 1),
    "A": (1, "A", 4),
    "share": (100, "%", 0),
}
#: A smaller vibration is printed as 0 [detection thresholds].
LEAST_VIBRATION = 1e-3
#: What a contact does not have where the virtual world never acted.
OF_CONTACT = {"rest_m", "ideal_m", "deviation_m", "allowed_m", "depth_m", "deepest_m"}

#: What has a unit, where that is plain.
QUANTITY_OF = {"m": "position", "m/s": "velocity", "N": "force", "N/m": "stiffness", "J": "energy", "W": "power",
               "A": "current"}  # fmt: skip


def quantity(value: float | None, unit: str, *, signed: bool = False, none: str = "-") -> str:
    """Return a number with its unit as people read it: 0.00123 m is "1.230 mm", 58.3 J is "58.30 J", not in mJ.

    Parameters
    ----------
    value : float or None
        In SI units; None gives `none`.
    unit : str
        SI unit; "1" for a pure number, "share" for one shown in per cent, "threshold" for a vibration in
        detection thresholds.
    signed : bool
        Whether to show a plus sign.
    none : str
        What to write where there is no number.
    """
    if value is None or not isfinite(value):
        return none
    if unit == "threshold":
        value, unit = vibration_shown(value), "1"
    if unit == "J" and abs(value) >= 1:
        return f"{_number(value, 2, 0, signed, exact=False)} J"
    return f"{_converted(value, unit, signed)} {'' if unit == '1' else shown(unit)}".rstrip()


def _converted(value: float, unit: str, signed: bool = False) -> str:
    """Return a number in the unit of `shown`, without it."""
    factor, _, decimals = SHOWN.get(unit, (1, "", 3))
    more = 1 if unit in ("m", "J") else 3
    return _number(value * factor, decimals, more, signed, exact=unit not in SHOWN)


def shown(unit: str) -> str:
    """Return the unit in which people read a quantity of an SI unit: "mm" for "m"."""
    return SHOWN[unit][1] if unit in SHOWN else unit


def cell(value: float | None, unit: str, *, none: str = "-") -> str:
    """Return a number in the unit of `shown`, without it: what stands below a heading that has the unit."""
    if value is None or not isfinite(value):
        return none
    return _converted(vibration_shown(value) if unit == "threshold" else value, unit)


def or_more(value: float | None, unit: str, *, ended: bool) -> str:
    """Return a number as `cell`; with "or more" where a search ended there."""
    return f"{cell(value, unit)}{' or more' if ended else ''}"


def listed(title: str, result: Any, lines: Iterable[tuple[str, str, str, str]]) -> str:
    """Return a title and the numbers of a result, one a line: label, attribute, SI unit, what to print for none."""
    shown = [f"  {label:<20}{quantity(of_contact(result, name), unit, none=none)}"
             for label, name, unit, none in lines]  # fmt: skip
    return "\n".join([title, *shown])


def vibration_shown(vibration: float) -> float:
    """Return a vibration [detection thresholds]; 0 where it is next to none."""
    return vibration if vibration >= LEAST_VIBRATION else 0.0


def of_contact(result: Any, name: str) -> Any:
    """Return a number of a result; None for what a contact without contact does not have."""
    untouched = getattr(result, "touched", None) is False
    return None if untouched and name in OF_CONTACT else getattr(result, name)


def _number(value: float, decimals: int, more: int, signed: bool, exact: bool) -> str:
    sign = "+" if signed and value != 0 else ""
    if exact or value == 0:
        long = 9999.5 <= abs(value) < 1e7  # from where four digits round to five
        return "0" if value == 0 else f"{value:{sign}.{'0f' if long else '4g'}}"
    if abs(value) >= 1000:
        return f"{value:{sign}.0f}"
    wanted = 2 - floor(log10(abs(value))) if decimals > 0 else 0
    text = f"{value:{sign}.{min(max(decimals, wanted), decimals + more)}f}"
    if float(text) == 0:
        return "0"
    whole, _, part = text.partition(".")
    part = part[:decimals] + part[decimals:].rstrip("0")
    return f"{whole}.{part}" if part else whole
