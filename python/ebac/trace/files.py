"""A trace as text and as a NumPy archive; other formats are in `ebac.logs`."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ebac.scenario import scenario_of_log
from ebac.scenario_text import text_for_file
from ebac.trace.columns import ColumnInfo

if TYPE_CHECKING:
    from ebac.trace import Trace

#: Rows turned into text at a time.
_CSV_ROWS = 10_000


def write_csv(
    trace: Trace, path: str | Path, progress: Callable[[int, int], None] | None = None
) -> None:
    """Write CSV, see `Trace.to_csv`."""
    columns = list(trace.flat())
    heading = ",".join(
        _quoted(name if info.unit == "1" else f"{name} [{info.unit}]") for name, info, _ in columns
    )
    with Path(path).open("w", encoding="utf-8") as file:
        file.write(heading + "\n")
        for first in range(0, len(trace), _CSV_ROWS):
            part = slice(first, first + _CSV_ROWS)
            texts = [_texts(values[part]) for _, _, values in columns]
            file.writelines(",".join(row) + "\n" for row in zip(*texts, strict=True))
            if progress is not None:
                progress(min(first + _CSV_ROWS, len(trace)), len(trace))


def _quoted(heading: str) -> str:
    """Return a heading as a cell of CSV: in quotation marks where a comma or one of them is in it."""
    if not set(heading) & set(',"\n'):
        return heading
    return '"' + heading.replace('"', '""') + '"'


def write_npz(trace: Trace, path: str | Path) -> None:
    """Write an archive, see `Trace.to_npz`."""
    about = {
        "axes": trace.axes,
        "law": trace.law,
        "law_repr": trace.law_repr,
        "origin": trace.origin,
        "changed": trace.changed,
        "scenario": text_for_file(trace.scenario) or None,
        "columns": {c.name: [c.unit, c.meaning] for c in trace.columns.values()},
    }
    with Path(path).open("wb") as file:  # a file, because NumPy appends .npz to a name
        arrays: dict[str, Any] = {
            "about": np.array(json.dumps(about)),
            **{name: trace[name] for name in trace},
        }
        np.savez_compressed(file, **arrays)


def npz_parts(path: str | Path) -> dict[str, Any]:
    """Return what `write_npz` wrote, by the arguments of `Trace`.

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    ValueError
        When it is not such an archive.
    """
    try:  # NumPy leaves a file open that is none of its own
        with Path(path).open("rb") as file, np.load(file, allow_pickle=False) as archive:
            about = json.loads(str(archive["about"]))
            data = {name: archive[name] for name in about["columns"]}
    except Exception as error:  # a damaged archive has a dozen errors
        if isinstance(error, (FileNotFoundError, IsADirectoryError, PermissionError)):
            raise
        raise ValueError(f"{path}: not a trace written by to_npz ({_reason(error)})") from None
    return {
        "data": data,
        "columns": {
            name: ColumnInfo(name=name, unit=unit, meaning=meaning)
            for name, (unit, meaning) in about["columns"].items()
        },
        "axes": about["axes"],
        "scenario": scenario_of_log(about["scenario"]),
        "law": about["law"],
        "law_repr": about["law_repr"],
        "origin": about.get("origin", ""),
        "changed": about.get("changed", False),
    }


def _reason(error: Exception) -> str:
    """Return why a file is no archive; NumPy speaks of pickles where it knows no better."""
    return "no archive" if "pickle" in str(error) or not str(error) else str(error)


def _texts(values: NDArray[Any]) -> Iterator[str]:
    """Give numbers as text, with every digit."""
    return map(repr, (values.astype(np.int8) if values.dtype == bool else values).tolist())
