"""Reads the CSV that `Trace.to_csv` writes."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac._util.headings import split_heading
from ebac.trace import Trace
from ebac.trace.columns import ColumnInfo

_WHOLE = re.compile(r"^[+-]?\d+$")


def read_csv(path: Path) -> Trace:
    """Read a trace from CSV: names and units in the headings, `x_0`, `x_1` for two axes, below lines that start with #.

    Numbers are float64, or int64 where the first row has whole ones without a point. Meanings, scenario and law are
    not in it.

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    ValueError
        When it is no such table; the message names the line.
    """
    with path.open(encoding="utf-8") as file:
        line = 1  # of the headings
        while (heading := file.readline()).startswith("#"):
            line += 1
        headings = heading.rstrip("\n").split(",")
        first = file.readline().rstrip("\n").split(",")
    split = [split_heading(heading, ()) for heading in headings]
    names = [name for name, _ in split]
    if "t" not in names or not all(names) or len(set(names)) < len(names):
        raise ValueError(
            f"{path}: line {line} has no headings of a trace, `t [s],x [m],...`, each once"
        )
    units = {name: unit or "1" for name, unit in split}
    flat = _numbers(path, names, first, line)
    axes = _axes(names)
    data, parts = gathered(flat, names, axes)
    columns = {
        name: ColumnInfo(name=name, unit=units[part], meaning="") for name, part in parts.items()
    }
    for values in data.values():
        values.setflags(write=False)
    return Trace(data=data, columns=columns, axes=axes)


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


def _numbers(path: Path, names: list[str], first: list[str], skip: int) -> dict[str, NDArray[Any]]:
    if first == [""]:
        return {name: np.empty(0) for name in names}
    if len(first) != len(names):
        raise ValueError(
            f"{path}: line {skip + 1} has {len(first)} numbers for {len(names)} headings"
        )
    kinds = ["i8" if _WHOLE.match(text) else "f8" for text in first]
    record = np.dtype([(f"f{i}", kind) for i, kind in enumerate(kinds)])
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = np.atleast_1d(
                np.loadtxt(path, record, delimiter=",", skiprows=skip, encoding="utf-8")
            )
    except (ValueError, Warning) as error:
        raise ValueError(f"{path}: not a table of numbers: {error}") from None
    return {name: np.ascontiguousarray(table[f"f{i}"]) for i, name in enumerate(names)}


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
