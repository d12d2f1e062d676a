"""Results as text for a console: a title and a table with units, about 20 lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ebac._util import formatting
from ebac._util.plural import plural

#: Rows of a table; longer ones are cut in the middle. With several tables each has fewer, but not below the fewest.
MOST_ROWS, FEWEST_ROWS = 12, 4
#: Names of columns that do not fit.
MOST_NAMES = 6
#: Characters of a line; columns beyond are left out, and named below, or stand there.
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
    "_W": "W",
    "_s": "s",
}


def report(
    title: str,
    rows: Sequence[Mapping[str, Any]],
    *notes: str,
    keys: Sequence[str] = (),
    more: str = "",
) -> str:
    """Return a title, a table of rows, and notes.

    Parameters
    ----------
    title : str
        One line.
    rows : sequence of mappings
        With the same keys, whose endings name the SI unit: `rest_m`, `least_energy_J`.
    *notes : str
        Lines below the table; empty ones are left out.
    keys : sequence of str
        Of the columns that say which row it is: columns that do not fit then stand below, behind these once more.
    more : str
        Where columns are that do not fit, "in .rows".
    """
    return "\n".join([title, *_tables(rows, keys, more), *filter(None, notes)])


def _tables(rows: Sequence[Mapping[str, Any]], keys: Sequence[str], more: str) -> list[str]:
    """Return the lines of one table, or with `keys` of as many as it takes to show all columns."""
    if not rows or not keys:
        return _table(rows, MOST_ROWS, more)
    blocks = _blocks(rows, keys)
    most = max(FEWEST_ROWS, MOST_ROWS // len(blocks))
    tables = [_table([{key: row[key] for key in block} for row in rows], most) for block in blocks]
    return [line for table in tables for line in ("", *table)][1:]


def _blocks(rows: Sequence[Mapping[str, Any]], keys: Sequence[str]) -> list[list[str]]:
    """Return the columns of each table: the keys, and as many others as fit a line."""
    wide = {
        key: 2 + max(len(heading(key)), *(len(cell(key, row[key])) for row in rows))
        for key in rows[0]
    }
    blocks = [list(keys)]
    for key in rows[0]:
        if key in keys:
            continue
        if sum(wide[one] for one in (*blocks[-1], key)) > WIDTH and len(blocks[-1]) > len(keys):
            blocks.append(list(keys))
        blocks[-1].append(key)
    return blocks


def _table(rows: Sequence[Mapping[str, Any]], most: int, more: str = "") -> list[str]:
    if not rows:
        return []
    half = most // 2
    shown = list(rows) if len(rows) <= most else [*rows[:half], *rows[-half:]]
    columns = [[heading(key), *(cell(key, row[key]) for row in shown)] for key in rows[0]]
    lines = aligned(columns, more)
    if len(shown) < len(rows):
        lines.insert(1 + half, f"  ... {len(rows) - len(shown)} more rows ...")
    return lines


def aligned(columns: Sequence[Sequence[str]], more: str = "") -> list[str]:
    """Return columns of text, heading first, as lines: words to the left, numbers to the right.

    Columns that do not fit are named below, with `more`: where they are.
    """
    if not columns:
        return []
    lines = [""] * len(columns[0])
    for place, column in enumerate(columns):
        wide = max(map(len, column))
        if len(lines[0]) + wide + 2 > WIDTH:
            left_out = f"  {plural(len(columns) - place, 'more column')} {more}".rstrip()
            names = [column[0] for column in columns[place:]]
            named = ", ".join(names[:MOST_NAMES] + ["..."] * (len(names) > MOST_NAMES))
            return [*(line.rstrip() for line in lines), f"{left_out}: {named}"]
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
    value = value.item() if isinstance(value, np.generic) else value
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
