"""The columns of a population of operators: names, units, ranges, and how they are read."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from io import StringIO
from math import isnan, nan
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ebac._util.headings import FACTORS, split_heading
from ebac._util.text_file import check_end, delimited, read_text, with_rows

#: Free motion of a hand before contact with the wall, unless given [m].
APPROACH = 0.010


@dataclass(frozen=True)
class OperatorColumn:
    """One column of a population; `default` is NaN where it must be given."""

    name: str
    unit: str
    meaning: str
    low: float
    high: float
    default: float = nan

    @property
    def required(self) -> bool:
        """Whether it must be given."""
        return isnan(self.default)


#: Every column a population may have.
OPERATOR_COLUMNS = {
    column.name: column
    for column in (
        OperatorColumn("m_kg", "kg", "mass M0", 0, 10),
        OperatorColumn("b_Ns_per_m", "N s/m", "damping B0", 0, 1e3),
        OperatorColumn("k_N_per_m", "N/m", "stiffness K0", 0, 1e5),
        OperatorColumn("target_m", "m", "depth X0 it wants to reach, from the surface", -1, 1),
        OperatorColumn(
            "approach_m", "m", "way through free air before the surface", 0, 1, APPROACH
        ),
        OperatorColumn("tremor_m", "m", "amplitude of its tremor", 0, 0.1, 0),
        OperatorColumn("tremor_Hz", "Hz", "frequency of its tremor", 0, 500, 9),
    )
}


#: Other names of the columns with a unit of their own.
_STEMS = {
    "m": "m_kg", "m0": "m_kg", "mass": "m_kg", "b": "b_Ns_per_m", "b0": "b_Ns_per_m", "damping": "b_Ns_per_m",
    "k": "k_N_per_m", "k0": "k_N_per_m", "stiffness": "k_N_per_m", "target": "target_m", "approach": "approach_m",
    "tremor": "tremor_m",
}  # fmt: skip
_QUANTITY = {"kg": "mass", "N s/m": "damping", "N/m": "stiffness", "m": "length", "Hz": "frequency"}


def in_si(table: Mapping[str, ArrayLike]) -> dict[str, ArrayLike]:
    """Return columns by their own names and in SI units: `k [N/mm]` becomes `k_N_per_m`; what is not known stays."""
    found: dict[str, ArrayLike] = {}
    for heading, values in table.items():
        name, factor = _known(str(heading))
        if name in found:
            raise ValueError(f"column {name} stands there twice, as {heading} too")
        found[name] = values if factor == 1 else factor * numbers(name, values)
    return found


def _known(heading: str) -> tuple[str, float]:
    """Return the column that a heading means, and its unit in SI."""
    if heading in OPERATOR_COLUMNS:
        return heading, 1.0
    for column in OPERATOR_COLUMNS.values():
        units = FACTORS[_QUANTITY[column.unit]]
        stem, unit = split_heading(heading, units)
        own = "tremor_m" if column.name == "tremor_Hz" else column.name
        if unit in units and _STEMS.get(stem.lower()) == own:
            return column.name, units[unit]
    return heading, 1.0


def meant(heading: str) -> list[str]:
    """Return the column that a heading without a unit stands for, if one does."""
    name = _STEMS.get(heading.strip().lower())
    return [] if name is None else [name]


def read_csv(path: str | Path) -> dict[str, list[str]]:
    """Return the columns of a CSV file by the names in its heading, as text; lines that start with # are left out.

    Between columns are commas, semicolons or tabs; with the latter two a number may have a decimal comma.
    """
    try:
        text = [line for line in StringIO(read_text(path), newline="") if not line.startswith("#")]
        mark, text = delimited([line for line in text if line.strip()] or [""])
        lines = [row for row in csv.reader(text, delimiter=mark) if any(c.strip() for c in row)]
    except csv.Error as error:
        raise ValueError(str(error)) from None
    heading, *rows = with_rows(lines)
    check_end(path)
    names = [cell.strip() for cell in heading]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"column {twice} stands there twice")
    for i, row in enumerate(rows, 1):
        if len(row) != len(names):
            raise ValueError(f"row {i} has {len(row)} values, the heading {len(names)}")
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


def numbers(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Return a column as numbers; what is none, or masked, is named by row, counted from 1."""
    if np.ma.is_masked(values):
        row = 1 + int(np.flatnonzero(np.ma.getmaskarray(np.ma.asarray(values)))[0])
        raise ValueError(f"row {row}: {name} is masked: leave the row out, or give its value")
    try:
        return np.array(values, float)
    except (TypeError, ValueError, OverflowError):
        for i, value in enumerate(np.atleast_1d(np.array(values, object)).tolist(), 1):
            try:
                float(value)
            except (TypeError, ValueError, OverflowError):
                unit = OPERATOR_COLUMNS[name].unit
                raise ValueError(
                    f"row {i}: {name} = {value!r}: must be a number in {unit}"
                ) from None
        raise


def check(column: OperatorColumn, values: NDArray[np.float64]) -> None:
    """Refuse the first value out of range, named by row, counted from 1."""
    wrong = np.flatnonzero(~((values >= column.low) & (values <= column.high)))
    if len(wrong):
        i = int(wrong[0])
        raise ValueError(
            f"row {i + 1}: {column.name} = {values[i]:g} {column.unit}: must lie in "
            f"[{column.low:g}, {column.high:g}] {column.unit}"
        )
