"""Columns of rows: names, units, meanings, and views of the bytes the loop wrote."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ebac import _core

#: Columns by words that people use for them, which look like none.
MEANT: dict[str, tuple[str, ...]] = {
    "time": ("t",),
    "position": ("x",),
    "velocity": ("v",),
    "speed": ("v",),
    "force": ("f_applied", "f_cmd", "f_meas"),
    "torque": ("tau",),
}
_KINDS = {"f": np.float64, "i": np.int64, "w": np.int32, "u": np.uint32, "b": np.bool_}


@dataclass(frozen=True, kw_only=True)
class ColumnInfo:
    """Unit and meaning of a column."""

    name: str
    unit: str
    meaning: str


def row_views(rows: _core.Rows, raw: NDArray[np.uint8]) -> dict[str, NDArray[Any]]:
    """Return the columns of whole rows as read-only views of their bytes."""
    count = len(raw) // rows.row_bytes
    data = {}
    for c in rows.columns:
        shape: tuple[int, ...] = (count,)
        strides: tuple[int, ...] = (rows.row_bytes,)
        if c.stride > 0 and rows.axes > 1:
            shape, strides = (*shape, rows.axes), (*strides, c.stride)
        if count:
            view = np.ndarray(shape, _KINDS[c.kind], raw, c.offset, strides)
        else:
            view = np.empty(shape, _KINDS[c.kind])
        view.setflags(write=False)
        data[c.name] = view
    return data


def column_infos(rows: _core.Rows) -> dict[str, ColumnInfo]:
    """Return unit and meaning of every column of rows."""
    return {c.name: ColumnInfo(name=c.name, unit=c.unit, meaning=c.meaning) for c in rows.columns}
