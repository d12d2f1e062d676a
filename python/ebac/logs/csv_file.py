"""Reads the CSV that `Trace.to_csv` writes."""

from __future__ import annotations

import csv
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.headings import FACTORS, signal_heading, split_heading
from ebac._util.text_file import check_end, read_text, says_simulated
from ebac.trace import Trace
from ebac.trace.columns import ColumnInfo

_WHOLE = re.compile(r"^[+-]?\d+$")


def read_csv(path: Path) -> Trace:
    """Read a trace from CSV: names and units in the headings, `x_0`, `x_1` for two axes, below lines that start with #.

    A column in another unit is returned in SI units. Numbers are float64, or int64 where a column has whole ones
    without a point. Meanings, scenario and law are not in it.

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    ValueError
        When it is no such table; the message names the line. When it is a file of ours that was cut.

    Warns
    -----
    UserWarning
        When the last line of another program's file has no end: it may have been cut inside its last number.
    """
    try:
        with path.open(encoding="utf-8-sig") as file:
            line = 1  # of the headings
            while (heading := file.readline()).startswith("#"):
                line += 1
            first = next((text for text in file if text.strip()), "").rstrip("\n")
    except UnicodeDecodeError:
        raise ValueError(f"{path}: {_first_wrong(path, [], 0, ',')}") from None
    if not heading.strip():
        raise ValueError(f"{path}: the file is empty: needs headings, `t [s],x [m],...`, and rows")
    mark = max(",;\t", key=re.sub(r'"[^"]*"', "", heading).count)
    cells = next(csv.reader([heading.rstrip("\n")], delimiter=mark, skipinitialspace=True))
    split = [signal_heading(cell.strip()) for cell in cells]
    names = [name for name, _, _ in split]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(f"{path}: line {line} has column {twice[0]!r} more than once; rename one")
    if not all(names) or "t" not in names:
        raise ValueError(f"{path}: line {line} {_not_a_log(names, path)}")
    units = {name: unit for name, unit, _ in split}
    flat = _numbers(path, names, first, line, mark)
    try:
        check_end(path)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    flat |= {name: factor * flat[name] for name, _, factor in split if factor != 1}
    axes = _axes(names)
    data, parts = gathered(flat, names, axes)
    columns = {
        name: ColumnInfo(name=name, unit=units[part], meaning="") for name, part in parts.items()
    }
    for values in data.values():
        values.setflags(write=False)
    origin = "simulated" if says_simulated(path) else ""
    return Trace(data=data, columns=columns, axes=axes, origin=origin)


def _not_a_log(names: list[str], path: Path) -> str:
    """Return why headings are not those of a log, and what reads the file."""
    stems = {split_heading(name, FACTORS["mass"])[0] for name in names}
    if {"m", "mass"} & stems:
        return f"has the headings of hands, not of a log: `ebac study --population {path.name}` reads them"
    if {"x", "y"} <= set(names):
        return f"has the headings of a path, without time: `ebac track {path.name}` reads it"
    return (
        "has no column of time, `t [s]`: name one in the headings, `t [s],x [m],...`; "
        "`ebac identify arm --rate` reads a log without time"
    )


def gathered(
    flat: dict[str, NDArray[Any]], names: list[str], axes: int
) -> tuple[dict[str, NDArray[Any]], dict[str, str]]:
    """Return the columns with those of several axes together, and the flat name each begins with."""
    data, first = {}, {}
    for name in _together(names, axes):
        parts = [f"{name}_{axis}" for axis in range(axes)] if name not in flat else [name]
        data[name] = flat[name] if name in flat else np.column_stack([flat[p] for p in parts])
        first[name] = parts[0]
    return data, first


def _numbers(
    path: Path, names: list[str], first: str, skip: int, mark: str
) -> dict[str, NDArray[Any]]:
    if first == "":
        return {name: np.empty(0) for name in names}
    cells = first.split(mark)
    if len(cells) != len(names):
        raise ValueError(
            f"{path}: line {skip + 1} has {len(cells)} numbers for {len(names)} headings"
        )
    kinds = ["i8" if _WHOLE.match(text.strip()) else "f8" for text in cells]
    try:
        table = _table(path, kinds, skip, mark)
    except (ValueError, OverflowError, Warning):
        try:
            table = _table(path, ["f8"] * len(names), skip, mark)
        except (ValueError, Warning) as error:
            wrong = _first_wrong(path, names, skip, mark) or f"not a table of numbers: {error}"
            raise ValueError(f"{path}: {wrong}") from None
    return {name: np.ascontiguousarray(table[f"f{i}"]) for i, name in enumerate(names)}


def _first_wrong(path: Path, names: list[str], skip: int, mark: str) -> str | None:
    """Return the first line that is no row of numbers, in words."""
    try:
        lines = read_text(path).splitlines()
    except ValueError as error:
        return str(error)
    for number, line in enumerate(lines, 1):
        cells = line.split(mark)
        if number <= skip or not line.strip():
            continue
        if len(cells) != len(names):
            return f"line {number} has {len(cells)} cells for {len(names)} headings"
        for name, cell in zip(names, cells, strict=True):
            try:
                float(cell)
            except ValueError:
                return f"line {number}, column {name!r}: {cell.strip()!r} is no number"
    return None


def _table(path: Path, kinds: list[str], skip: int, mark: str) -> NDArray[Any]:
    record = np.dtype([(f"f{i}", kind) for i, kind in enumerate(kinds)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return np.atleast_1d(
            np.loadtxt(path, record, delimiter=mark, skiprows=skip, encoding="utf-8-sig")
        )


def _axes(names: list[str]) -> int:
    """Return the number of axes in the headings: those of x, else of q."""
    for stem in ("x", "q"):
        count = 0
        while f"{stem}_{count}" in names:
            count += 1
        if count > 0:
            return count
    return 1


def _together(names: list[str], axes: int) -> list[str]:
    """Return the names of the columns, those of several axes once."""
    together = []
    for name in names:
        stem, _, axis = name.rpartition("_")
        several = axes > 1 and all(f"{stem}_{i}" in names for i in range(axes))
        if not several:
            together.append(name)
        elif axis == "0":
            together.append(stem)
    return together
