"""Columns of rows: names, units, meanings, and views of the bytes the loop wrote."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
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
    layout = _known(rows.layout)
    count = len(raw) // rows.row_bytes
    views: dict[str, NDArray[Any]] = {}
    for block in layout.blocks:
        shape, strides = (count, *block.shape), (rows.row_bytes, *block.strides)
        if count:
            all_of_block = np.ndarray(shape, block.dtype, raw, block.offset, strides)
        else:
            all_of_block = np.empty(shape, block.dtype)
        all_of_block.setflags(write=False)
        for name in block.dtype.names or ():
            views[name] = all_of_block[name]
    return {name: views[name] for name in layout.infos}


def column_infos(rows: _core.Rows) -> dict[str, ColumnInfo]:
    """Return unit and meaning of every column of rows."""
    return dict(_known(rows.layout).infos)


@dataclass(frozen=True, kw_only=True)
class _Block:
    """Columns at one distance from axis to axis: a structured type, and where the first of them begins."""

    dtype: np.dtype[np.void]
    offset: int
    shape: tuple[int, ...]
    strides: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class _Layout:
    """What follows from the layout of rows."""

    infos: dict[str, ColumnInfo]
    blocks: list[_Block]


@lru_cache(maxsize=64)
def _known(layout: _core.RowLayout) -> _Layout:
    columns = list(layout.columns)
    infos = {c.name: ColumnInfo(name=c.name, unit=c.unit, meaning=c.meaning) for c in columns}
    blocks = []
    for stride in sorted({c.stride for c in columns}):
        own = [c for c in columns if c.stride == stride]
        kinds = [np.dtype(_KINDS[c.kind]) for c in own]
        begin = min(c.offset for c in own)
        dtype = np.dtype({
            "names": [c.name for c in own],
            "formats": kinds,
            "offsets": [c.offset - begin for c in own],
        })  # fmt: skip
        several = stride > 0 and layout.axes > 1
        shape, strides = ((layout.axes,), (stride,)) if several else ((), ())
        blocks.append(_Block(dtype=dtype, offset=begin, shape=shape, strides=strides))
    return _Layout(infos=infos, blocks=blocks)
