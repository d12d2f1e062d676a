"""Reads the formats of other programs that `ebac.logs.export` writes: Parquet, MATLAB, HDF5."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac.logs.csv_file import gathered
from ebac.logs.export import CHECKSUM, checked, needs
from ebac.scenario import scenario_of_log
from ebac.trace import Trace
from ebac.trace.columns import ColumnInfo

#: What to do about a damaged file.
REMEDY = "use a copy of it, or write it again"


def from_parquet(path: Path) -> Trace:
    """Read a Parquet file of `to_parquet`."""
    needs("pyarrow", "sweep")
    import pyarrow
    import pyarrow.parquet

    with ExitStack() as stack:
        with _whole(path, "not a Parquet file, or damaged"):
            file = stack.enter_context(
                pyarrow.parquet.ParquetFile(path, page_checksum_verification=True)
            )
            schema = file.schema_arrow
            about = _texts(schema.metadata or {})
            infos = {field.name: _texts(field.metadata or {}) for field in schema}
        axes, flat = _axes(path, about), {}
        for name in infos:
            with _whole(path, f"column {name} is damaged"):
                flat[name] = file.read([name])[name].to_numpy()
                if len(flat[name]) != file.metadata.num_rows:  # the head of a page has no checksum
                    raise ValueError(f"{len(flat[name])} of {file.metadata.num_rows} rows")
    data, first = gathered(flat, list(flat), axes)
    columns = {name: _info(path, name, infos[part], part) for name, part in first.items()}
    return _trace(path, data, columns, about)


def from_mat(path: Path) -> Trace:
    """Read a MATLAB file of `to_mat`."""
    needs("scipy", "log")
    from scipy.io import loadmat

    with path.open("rb") as file, _whole(path, "not a MATLAB file, or damaged"):
        found = loadmat(file, simplify_cells=True)
    about, units, meanings, names = (
        _words(found, part) for part in ("about", "units", "meanings", "names")
    )
    data, columns = {}, {}
    for short in units:
        name = names.get(short) or short
        data[name] = _column(np.asarray(found[short]), np.size(found["t"]))
        texts = {"unit": units[short], "meaning": meanings.get(short, "")}
        columns[name] = _info(path, name, texts, name)
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
    data, columns = {}, {}
    with ExitStack() as stack:
        with _whole(path, "not an HDF5 file, or damaged"):
            file = stack.enter_context(h5py.File(path, "r"))
            about = {name: str(text) for name, text in file.attrs.items()}
            names = list(file)
        _axes(path, about)  # before what is not of ebac is called damaged
        for name in names:
            with _whole(path, f"column {name} is damaged"):
                data[name] = file[name][()]
                texts = {key: str(text) for key, text in file[name].attrs.items()}
            columns[name] = _info(path, name, texts, name)
    return _trace(path, data, columns, about)


@contextmanager
def _whole(path: Path, what: str) -> Iterator[None]:
    """Say `what` is wrong with a file that cannot be read; of a damaged one a library raises all sorts."""
    try:
        yield
    except Exception as error:
        raise ValueError(f"{path}: {what} ({_first(error)}); {REMEDY}") from None


def _check(path: Path, what: str, texts: Mapping[str, str], name: str = "") -> None:
    """Raise ValueError where texts are not those of their checksum; older files have none."""
    rest = {key: text for key, text in texts.items() if key != CHECKSUM}
    if CHECKSUM in texts and checked(rest, name) != texts:
        raise ValueError(
            f"{path}: {what} damaged, or changed; {REMEDY}. If it is changed on purpose, delete its {CHECKSUM}"
        )


def _trace(
    path: Path,
    data: dict[str, NDArray[Any]],
    columns: dict[str, ColumnInfo],
    about: Mapping[str, str],
) -> Trace:
    _check(path, "law or scenario is", about)
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


def _info(path: Path, name: str, texts: Mapping[str, str], part: str) -> ColumnInfo:
    """Return what the texts of a column say of it; `part` is its name in the file."""
    _check(path, f"the name, unit or meaning of column {part} is", texts, part)
    return ColumnInfo(name=name, unit=texts.get("unit") or "1", meaning=texts.get("meaning") or "")


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
