"""Columns of files from other programs: CSV, .mat, NPZ."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from ebac._util.plural import plural
from ebac._util.text_file import check_end, delimited, read_text, with_rows

Columns: TypeAlias = dict[str, NDArray[np.float64]]


@dataclass(frozen=True, kw_only=True)
class Table:
    """The columns of a file: those of numbers, and why the others are none."""

    columns: Columns
    text: Mapping[str, str] = field(default_factory=dict)  # nothing but text
    mixed: Mapping[str, str] = field(default_factory=dict)  # numbers and text


def read_columns(path: Path) -> Table:
    """Return the columns of a file by their headings; the extension gives the format.

    Raises
    ------
    ValueError
        When it cannot be read, or holds none.
    """
    readers = {".csv": _csv, ".txt": _csv, ".tsv": _csv, ".mat": _mat, ".npz": _npz}
    if path.suffix.lower() not in readers:
        turn = ""
        if path.suffix.lower() in (".h5", ".parquet"):
            turn = f"; ebac log export {path.name} {path.stem}.csv makes one that is read"
        raise ValueError(
            f"{path.name}: unknown ending {path.suffix!r}; known are .mcap, {', '.join(readers)}{turn}"
        )
    found = readers[path.suffix.lower()](path)
    if not (found.columns or found.mixed):
        raise ValueError(f"{path.name}: holds no columns of numbers")
    return found


def _csv(path: Path) -> Table:
    try:
        lines = read_text(path).splitlines()
        check_end(path)
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None
    lines = [line for line in lines if line.strip() and not line.startswith(("#", "%"))]
    try:
        mark, lines = delimited(with_rows(lines))
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None
    names = [name.strip() for name in next(csv.reader(lines[:1], delimiter=mark))]
    if all(_is_number(name) for name in names):
        raise ValueError(
            f"{path.name}: has no heading; put the names of the columns into its first line"
        )
    for number, name in enumerate(names, 1):
        if name and (first := names.index(name) + 1) < number:
            raise ValueError(
                f"{path.name}: columns {first} and {number} are both headed {name!r}; rename one of them"
            )
    try:  # as most files are; the rest looks for what is wrong, and for text
        numbers = np.loadtxt(lines[1:], delimiter=mark, ndmin=2).T
        return Table(columns=dict(zip(names, numbers, strict=True)))
    except ValueError:
        return _with_text(path.name, names, list(csv.reader(lines[1:], delimiter=mark)))


def _with_text(file: str, names: list[str], rows: list[list[str]]) -> Table:
    """Return the columns of a table that has text, or cells that are empty."""
    for number, cells in enumerate(rows, 1):
        if len(cells) != len(names):
            raise ValueError(
                f"{file}: row {number} below the heading has {plural(len(cells), 'cell')}, the heading {len(names)}; "
                "complete that line, or delete it"
            )
    columns: Columns = {}
    text: dict[str, str] = {}
    mixed: dict[str, str] = {}
    for name, column in zip(names, zip(*rows, strict=True), strict=True):
        numbers = any(_is_number(cell.strip().replace(",", ".")) for cell in column)
        try:
            values = [_number(cell, file, row, name) for row, cell in enumerate(column, 1)]
        except ValueError as error:
            (mixed if numbers else text)[name] = str(error)
            continue
        if numbers:
            columns[name] = np.array(values)
    return Table(columns=columns, text=text, mixed=mixed)


def _is_number(text: str) -> bool:
    try:
        _float(text)
    except ValueError:
        return False
    return True


def _float(text: str) -> float:
    """Return a number as files have it; Python's own 1_0 for 10 is none."""
    if "_" in text:
        raise ValueError(text)
    return float(text)


def _number(cell: str, file: str, row: int, column: str) -> float:
    text = cell.strip()
    if text in ("", "-"):
        return float("nan")
    try:
        return _float(text)
    except ValueError:
        point = text.replace(",", ".")
        remedy = f"; write {point}" if _is_number(point) else ""
        raise ValueError(
            f"{file}: {text!r} in row {row}, column {column!r}, is no number{remedy}"
        ) from None


@contextmanager
def archive_of(path: Path) -> Iterator[Any]:
    """Open an .npz file.

    Raises
    ------
    ValueError
        When it is none.
    """
    with path.open("rb") as file:  # NumPy leaves a file open that is none of its own
        try:
            archive = np.load(file, allow_pickle=False)
            names = archive.files
        except (AttributeError, BadZipFile, EOFError, ValueError):
            raise ValueError(f"{path.name}: is no NumPy archive; write it by numpy.savez") from None
        with archive:
            if not names:
                raise ValueError(f"{path.name}: holds no arrays")
            yield archive


def _npz(path: Path) -> Table:
    with archive_of(path) as archive:
        return Table(columns=_series({name: _array(path, archive, name) for name in archive.files}))


def _array(path: Path, archive: Any, name: str) -> Any:
    try:
        return archive[name]
    except (BadZipFile, EOFError, ValueError) as error:
        reason = "is cut or damaged"
        if "pickle" in str(error):
            reason = "holds objects of Python, which are not read; store an array of numbers"
        raise ValueError(f"{path.name}: {name} {reason}") from None


def _mat(path: Path) -> Table:
    try:
        from scipy.io import loadmat
        from scipy.io.matlab import MatReadError
    except ImportError:
        raise ValueError(f"{path.name}: reading .mat needs SciPy: pip install scipy") from None
    try:
        content = loadmat(path, squeeze_me=True)
    except (MatReadError, NotImplementedError, TypeError, ValueError) as error:
        raise ValueError(f"{path.name}: cannot be read ({error}); save it with -v7") from None
    arrays = {name: v for name, v in content.items() if not name.startswith("__")}
    return Table(columns=_series(arrays))


def _series(arrays: Mapping[str, Any], within: str = "") -> Columns:
    """Return every series of numbers; what is in a struct in a struct by both names, `force_x`."""
    out: Columns = {}
    for name, values in arrays.items():
        array = np.asarray(values)
        if array.dtype.names:  # a struct array of MATLAB: one value a row, or all rows in one
            fields = {field: array[field] for field in array.dtype.names}
            whole = array.ndim == 0 or array.size == 1
            out |= _series(
                {
                    field: np.squeeze(each).item() if whole else each.astype(float)
                    for field, each in fields.items()
                    if whole or _of_numbers(each)
                },
                f"{within}{name}_" if within else "_",
            )
            if not whole:
                out |= _series_of_each(array.ravel(), f"{within or '_'}{name}")
            continue
        if array.dtype.kind not in "fiub":
            continue
        array = np.squeeze(array.astype(float))
        name = f"{within.removeprefix('_')}{name}"
        if array.ndim == 1 and array.size > 1:
            out[name] = array
        elif array.ndim == 2:  # time runs along the longer side
            series = array if array.shape[0] < array.shape[1] else array.T
            out |= {f"{name}_{i}": column for i, column in enumerate(series)}
    return out


def _series_of_each(structs: Any, within: str) -> Columns:
    """Return the series of structs that hold whole series: `trials_1_x`, signals of Simulink by their labels."""
    out: Columns = {}
    for number, one in enumerate(structs, 1):
        fields = {field: np.asarray(one[field]) for field in structs.dtype.names}
        series = {field: each for field, each in fields.items() if each.size > 1}
        label = str(fields["label"]) if "label" in fields else ""
        if label and "values" in series:
            out |= _series({label: series["values"]}, "_")
        else:
            out |= _series(series, f"{within}_{number}_")
    return out


def _of_numbers(cells: Any) -> bool:
    """Return whether cells of an array of objects hold one number each."""
    try:
        cells.astype(float)
    except (TypeError, ValueError):
        return False
    return True
