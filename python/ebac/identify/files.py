"""Columns of files from other programs (CSV, .mat, NPZ): their quantities and units, given or guessed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from ebac._util.headings import FACTORS, split_heading
from ebac._util.text_file import read_text

Columns: TypeAlias = dict[str, NDArray[np.float64]]


def read_columns(path: Path) -> Columns:
    """Return every column of numbers by its heading; the extension gives the format.

    Raises
    ------
    ValueError
        When it cannot be read, or holds none.
    """
    readers = {".csv": _csv, ".txt": _csv, ".tsv": _csv, ".mat": _mat, ".npz": _npz}
    if path.suffix.lower() not in readers:
        raise ValueError(
            f"{path.name}: unknown ending {path.suffix!r}; known are .mcap, {', '.join(readers)}"
        )
    found = readers[path.suffix.lower()](path)
    if not found:
        raise ValueError(f"{path.name}: holds no columns of numbers")
    return found


def _csv(path: Path) -> Columns:
    try:
        lines = read_text(path).splitlines()
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None
    lines = [line for line in lines if line.strip() and not line.startswith(("#", "%"))]
    if len(lines) < 2:
        raise ValueError(f"{path.name}: lines = {len(lines)}: needs a heading and rows below it")
    mark = max("\t;,", key=lines[0].count)
    if mark != ",":  # then a comma within a number is a decimal one
        lines[1:] = [line.replace(",", ".") for line in lines[1:]]
    names = [name.strip().strip('"') for name in lines[0].split(mark)]
    if all(_is_number(name) for name in names):
        raise ValueError(
            f"{path.name}: has no heading; put the names of the columns into its first line"
        )
    try:  # as most files are; the rest looks for what is wrong, and for text
        return dict(zip(names, np.loadtxt(lines[1:], delimiter=mark, ndmin=2).T, strict=True))
    except ValueError:
        return _with_text(path.name, names, [line.split(mark) for line in lines[1:]])


def _with_text(file: str, names: list[str], rows: list[list[str]]) -> Columns:
    """Return the columns of numbers of a table that has others too: text, cells that are empty."""
    for number, cells in enumerate(rows, 1):
        if len(cells) != len(names):
            raise ValueError(
                f"{file}: row {number} has {len(cells)} cells, the heading {len(names)}"
            )
    out = {}
    for name, column in zip(names, zip(*rows, strict=True), strict=True):
        if any(_is_number(cell.strip().strip('"')) for cell in column):
            numbers = [_number(cell, file, number, name) for number, cell in enumerate(column, 1)]
            out[name] = np.array(numbers)
    return out


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _number(cell: str, file: str, row: int, column: str) -> float:
    text = cell.strip().strip('"')
    if text in ("", "-"):
        return float("nan")
    try:
        return float(text)
    except ValueError:
        raise ValueError(
            f"{file}: {text!r} in row {row}, column {column!r}, is no number"
        ) from None


@contextmanager
def archive_of(path: Path) -> Iterator[Any]:
    """Open an .npz file.

    Raises
    ------
    ValueError
        When it is none.
    """
    try:
        archive = np.load(path, allow_pickle=False)
        names = archive.files
    except (AttributeError, BadZipFile, EOFError, ValueError):
        raise ValueError(f"{path.name}: is no NumPy archive; write it by numpy.savez") from None
    with archive:
        if not names:
            raise ValueError(f"{path.name}: holds no arrays")
        yield archive


def _npz(path: Path) -> Columns:
    with archive_of(path) as archive:
        return _series({name: archive[name] for name in archive.files})


def _mat(path: Path) -> Columns:
    try:
        from scipy.io import loadmat
        from scipy.io.matlab import MatReadError
    except ImportError:
        raise ValueError(f"{path.name}: reading .mat needs SciPy: pip install scipy") from None
    try:
        content = loadmat(path, squeeze_me=True)
    except (MatReadError, NotImplementedError, TypeError, ValueError) as error:
        raise ValueError(f"{path.name}: cannot be read ({error}); save it with -v7") from None
    return _series({name: v for name, v in content.items() if not name.startswith("__")})


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
            continue
        if array.dtype.kind not in "fiub":
            continue
        array = np.squeeze(array.astype(float))
        name = f"{within.removeprefix('_')}{name}"
        if array.ndim == 1 and array.size > 1:
            out[name] = array
        elif array.ndim == 2:
            out |= {f"{name}_{i}": column for i, column in enumerate(array.T)}
    return out


def _of_numbers(cells: Any) -> bool:
    """Return whether cells of an array of objects hold one number each."""
    try:
        cells.astype(float)
    except (TypeError, ValueError):
        return False
    return True


#: The signals of a recording and their SI unit.
UNITS_OF = {"t": "s", "x": "m", "force": "N", "motor": "N", "desired": "N", "target": "m"}

#: Names that a column may have, the surest first; compared in small letters without unit.
NAMES: dict[str, tuple[str, ...]] = {
    "t": ("t", "time", "timestamp", "zeit", "seconds", "sec"),
    "x": ("x", "x_0", "pos", "position", "px", "x_pos", "handle", "displacement"),
    "force": (
        "f_meas",
        "f_meas_0",
        "force",
        "f",
        "fx",
        "f_hand",
        "fh",
        "f_sensor",
        "ft",
        "force_x",
        "grip_force",
    ),
    "motor": ("f_applied", "f_applied_0", "motor", "motor_force", "f_motor", "actuator_force"),
    "desired": ("f_env", "f_env_0", "f_desired", "desired", "fd", "f_d"),
    "target": ("target", "x0", "goal", "reference", "ref", "setpoint"),
}

#: The quantity of each signal.
QUANTITY = {
    "t": "time",
    "x": "length",
    "target": "length",
    "force": "force",
    "motor": "force",
    "desired": "force",
}


def name_and_unit(signal: str, heading: str) -> tuple[str, str | None]:
    """Return name and unit of a heading, were it that of a signal."""
    return split_heading(heading, FACTORS[QUANTITY[signal]])


def unit_factor(file: str, signal: str, unit: str) -> float:
    """Return what one of `unit` is in SI.

    Raises
    ------
    ValueError
        For a unit that does not fit the signal.
    """
    known = FACTORS[QUANTITY[signal]]
    if unit not in known:
        raise ValueError(
            f"{file}: {signal} in {unit!r}: must be one of {', '.join(known)}; convert the column, or name the unit"
        )
    return known[unit]


def assign(
    file: str, headings: Sequence[str], given: Mapping[str, str]
) -> tuple[dict[str, str], list[str]]:
    """Return the column of each signal, and what was guessed.

    Raises
    ------
    ValueError
        For a given column that does not exist.
    """
    chosen, remarks = {}, []
    for signal, name in given.items():
        bare = {name_and_unit(signal, h)[0].lower(): h for h in headings}
        if name not in headings and name.lower() not in bare:
            raise ValueError(
                f"{file}: there is no column {name!r} for {signal}; there are: {', '.join(headings)}"
            )
        chosen[signal] = name if name in headings else bare[name.lower()]
    for signal, names in NAMES.items():
        if signal in chosen:
            continue
        bare = {name_and_unit(signal, h)[0].lower(): h for h in headings}
        match = next((bare[n] for n in names if n in bare and bare[n] not in chosen.values()), None)
        if match is not None:
            chosen[signal] = match
            remarks.append(f"{signal}: guessed to be column {match!r}")
    return chosen, remarks
