"""Reads the formats of other programs that `ebac.logs.export` writes: Parquet, MATLAB, HDF5."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.logs.csv_file import gathered
from ebac.logs.export import needs
from ebac.scenario import scenario_of_log
from ebac.trace import Trace
from ebac.trace.columns import ColumnInfo


def from_parquet(path: Path) -> Trace:
    """Read a Parquet file of `to_parquet`."""
    needs("pyarrow", "sweep")
    import pyarrow
    import pyarrow.parquet

    with _whole(path, "a Parquet file"):
        table = pyarrow.parquet.read_table(path)
        about = _texts(table.schema.metadata or {})
        flat = {field.name: table[field.name].to_numpy() for field in table.schema}
        infos = {field.name: _texts(field.metadata or {}) for field in table.schema}
    axes = _axes(path, about)
    data, first = gathered(flat, list(flat), axes)
    columns = {
        name: _info(name, infos[part].get("unit"), infos[part].get("meaning"))
        for name, part in first.items()
    }
    return _trace(path, data, columns, about)


def from_mat(path: Path) -> Trace:
    """Read a MATLAB file of `to_mat`."""
    needs("scipy", "log")
    from scipy.io import loadmat

    with path.open("rb") as file, _whole(path, "a MATLAB file"):
        found = loadmat(file, simplify_cells=True)
    about, units, meanings, names = (
        _words(found, part) for part in ("about", "units", "meanings", "names")
    )
    data, columns = {}, {}
    for short in units:
        name = names.get(short) or short
        data[name] = _column(np.asarray(found[short]), np.size(found["t"]))
        columns[name] = _info(name, units[short], meanings.get(short))
    return _trace(path, data, columns, about)


def _column(values: NDArray[Any], rows: int) -> NDArray[Any]:
    """Return a column of so many rows as it was written: MATLAB has whole numbers for on and off, and no single row."""
    column = np.atleast_1d(values)
    if column.dtype == np.uint8:  # no log has such a column
        column = column.astype(bool)
    return column.reshape(1, -1) if rows == 1 and column.size > 1 else column


def from_hdf5(path: Path) -> Trace:
    """Read an HDF5 file of `to_hdf5`."""
    needs("h5py", "log")
    import h5py

    with path.open("rb"):  # h5py names neither a missing file nor a folder
        pass
    with _whole(path, "an HDF5 file"), h5py.File(path, "r") as file:
        about = {name: str(text) for name, text in file.attrs.items()}
        data = {name: file[name][()] for name in file}
        columns = {
            name: _info(name, file[name].attrs.get("unit"), file[name].attrs.get("meaning"))
            for name in file
        }
    return _trace(path, data, columns, about)


@contextmanager
def _whole(path: Path, what: str) -> Iterator[None]:
    """Say of a file that cannot be read that it is none of its kind; of a damaged one a library raises all sorts."""
    try:
        yield
    except Exception as error:
        raise ValueError(f"{path}: not {what}, or damaged ({_first(error)})") from None


def _trace(
    path: Path,
    data: dict[str, NDArray[Any]],
    columns: dict[str, ColumnInfo],
    about: Mapping[str, str],
) -> Trace:
    axes = _axes(path, about)
    if "t" not in data:
        raise ValueError(f"{path}: not a log of ebac: the column t is missing")
    for values in data.values():
        values.setflags(write=False)
    text = about.get("scenario", "")
    return Trace(
        data=data,
        columns=columns,
        axes=axes,
        scenario=scenario_of_log(text),
        law=about.get("law", ""),
        law_repr=about.get("law_repr", ""),
        origin=about.get("origin", ""),
        changed=about.get("changed", "") == "true",
    )


def _axes(path: Path, about: Mapping[str, str]) -> int:
    try:
        return int(about["axes"])
    except (KeyError, ValueError):
        raise ValueError(f"{path}: not a log of ebac: the number of axes is not in it") from None


def _info(name: str, unit: object, meaning: object) -> ColumnInfo:
    return ColumnInfo(name=name, unit=str(unit or "1"), meaning=str(meaning or ""))


def _words(found: Mapping[str, Any], name: str) -> dict[str, str]:
    """Return a struct of MATLAB as texts; for one without letters MATLAB has an empty array."""
    part = found.get(name)
    if not isinstance(part, dict):
        return {}
    return {key: text if isinstance(text, str) else "" for key, text in part.items()}


def _texts(metadata: Mapping[bytes, bytes]) -> dict[str, str]:
    return {name.decode(): text.decode() for name, text in metadata.items()}


def _first(error: Exception) -> str:
    return str(error).partition("\n")[0].rstrip(".")
