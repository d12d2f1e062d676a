"""Results as text for a console: a title and a table with units, under 20 lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ebac._util import formatting

#: Rows of a table; longer ones are cut in the middle.
MOST_ROWS = 12
#: Characters of a line; columns beyond are left out, and named as such.
WIDTH = 110

#: Endings of a key and the SI unit they stand for, the longer ones first.
UNITS = {
    "_Ns_per_m": "N s/m",
    "_N_per_m": "N/m",
    "_samples": "samples",
    "_share": "share",
    "_kg": "kg",
    "_Hz": "Hz",
    "_m": "m",
    "_J": "J",
    "_N": "N",
    "_s": "s",
}


def report(title: str, rows: Sequence[Mapping[str, Any]], *notes: str) -> str:
    """Return a title, a table of rows, and notes, at most `MOST_ROWS` + 4 lines.

    Parameters
    ----------
    title : str
        One line.
    rows : sequence of mappings
        With the same keys, whose endings name the SI unit: `rest_m`, `least_energy_J`.
    *notes : str
        Lines below the table; empty ones are left out.
    """
    return "\n".join([title, *_table(rows), *filter(None, notes)])


def _table(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    if not rows:
        return []
    half = MOST_ROWS // 2
    shown = list(rows) if len(rows) <= MOST_ROWS else [*rows[:half], *rows[-half:]]
    lines = aligned([[heading(key), *(cell(key, row[key]) for row in shown)] for key in rows[0]])
    if len(shown) < len(rows):
        lines.insert(1 + half, f"  ... {len(rows) - len(shown)} more rows ...")
    return lines


def plural(count: int, noun: str) -> str:
    """Return "1 law" or "3 laws"."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def aligned(columns: Sequence[Sequence[str]]) -> list[str]:
    """Return columns of text, heading first, as lines: words to the left, numbers to the right."""
    if not columns:
        return []
    lines = [""] * len(columns[0])
    for place, column in enumerate(columns):
        wide = max(map(len, column))
        if len(lines[0]) + wide + 2 > WIDTH:
            return [
                *(line.rstrip() for line in lines),
                f"  {plural(len(columns) - place, 'more column')}",
            ]
        words = any(letter.isalpha() for one in column[1:] for letter in one if one != "nan")
        lines = [
            line + "  " + (one.ljust(wide) if words else one.rjust(wide))
            for line, one in zip(lines, column, strict=True)
        ]
    return [line.rstrip() for line in lines]


def _unit(key: str) -> tuple[str, str]:
    """Return the name in a key, and its SI unit."""
    for ending, unit in UNITS.items():
        if key.endswith(ending) and len(key) > len(ending):
            return key.removesuffix(ending), unit
    return key, "1"


def heading(key: str) -> str:
    """Return the heading of a key: "rest [mm]" for "rest_m"."""
    name, unit = _unit(key)
    words = name.replace("_", " ")
    shown = formatting.shown(unit)
    return f"{words} [{shown}]" if shown and unit != "1" else words


def cell(key: str, value: Any) -> str:
    """Return a value as people read it below the heading of its key."""
    if value is None:
        return "-"
    if isinstance(value, bool | str):
        return str(value)
    if isinstance(value, Mapping):
        return ", ".join(f"{name} = {one}" for name, one in value.items())
    if isinstance(value, Sequence):
        return ", ".join(map(str, value))
    _, unit = _unit(key)
    if unit in ("1", "samples") and float(value).is_integer():
        return f"{value:g}"
    return formatting.cell(float(value), unit)
