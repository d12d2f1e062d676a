"""A recorded path from a file: names and units given or guessed, and remark."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ebac._util.arguments import require_file, unknown
from ebac._util.arrays import Values
from ebac._util.headings import FACTORS, split_heading
from ebac._util.sequences import several
from ebac._util.wrong_calls import plain_constructor
from ebac.operators.columns import read_csv
from ebac.trace import Trace

#: Metres per unit.
UNITS = FACTORS["length"]
#: What coordinates are called, tried in this order.
NAMES = (("x", "y", "z"), ("x_0", "x_1", "x_2"), ("px", "py", "pz"), ("X", "Y", "Z"))
#: No haptic handle is this far from its middle; such numbers are millimetres [m].
FARTHEST = 5.0
#: Farther than this is an error in the file [m].
MOST = 1000.0


@plain_constructor
@dataclass(frozen=True, kw_only=True, eq=False)
class RecordedPath:
    """A path and what was taken for it.

    Attributes
    ----------
    points : array, shape (n, 2) or (n, 3)
        Positions [m] in the order of recording.
    name : str
        Of the file.
    remark : str
        Which columns in which unit, and whether that was guessed.
    """

    points: Values
    name: str
    remark: str

    def __repr__(self) -> str:
        """Return one line: name, points, extent."""
        extent = " x ".join(f"{1e3 * float(np.ptp(axis)):.4g}" for axis in self.points.T)
        return f"<RecordedPath {self.name}: {len(self.points)} points in .points, {extent} mm; {self.remark}>"


def read_path(
    file: str | Path, *, columns: Sequence[str] | None = None, unit: str | None = None
) -> RecordedPath:
    """Read positions from a CSV file, or from a trace written by `Trace.to_npz` or `to_csv`.

    Parameters
    ----------
    file : path
        `.npz`, or text with a heading and commas, semicolons or tabs between the columns.
    columns : sequence of str, optional
        Two or three columns; default: x, y and z by their usual names.
    unit : str, optional
        m, mm, cm or um; default: the unit in the heading, `x [mm]` or `x_mm`, otherwise guessed from the size.

    Returns
    -------
    RecordedPath

    Raises
    ------
    FileNotFoundError
        When there is no such file.
    IsADirectoryError
        When it is a folder.
    ValueError
        When the file, a column or a number cannot be read; with the name of the file.

    Warns
    -----
    UserWarning
        When the last line of a CSV file has no end, and so its last number may be cut.
    """
    require_file(file, "ebac.tracking.read_path")
    path = Path(file)
    if unit is not None and str(unit) not in UNITS:
        raise ValueError(unknown(f"unit = {unit!r}", unit, UNITS))
    if columns is not None and len(several("columns", columns)) not in (2, 3):
        raise ValueError(f"columns = {','.join(map(str, columns))}: must be two or three, like x,y")
    try:
        if path.suffix == ".npz":
            return _from_trace(path, columns, unit)
        return _from_text(path, columns, unit)
    except ValueError as error:
        text = str(error)
        raise ValueError(text if text.startswith(str(path)) else f"{path}: {text}") from None


def _from_trace(path: Path, columns: Sequence[str] | None, unit: str | None) -> RecordedPath:
    if unit not in (None, "m"):
        raise ValueError(f"unit = {unit!r}: a trace is in m")
    trace = Trace.from_npz(path)
    every = {name: values for name, _, values in trace.flat()}
    if columns is None and trace.axes < 2:
        raise ValueError(f"the trace has {trace.axes} axis: a path needs two or three")
    chosen = list(columns) if columns else [f"x_{i}" for i in range(trace.axes)]
    _known(chosen, list(every))
    units = {trace.columns[c if c in trace else c.rpartition("_")[0]].unit for c in chosen}
    if units != {"m"}:
        raise ValueError(
            f"columns {', '.join(chosen)} are in {', '.join(sorted(units))}: a path is in m"
        )
    points = np.stack([every[c].astype(float) for c in chosen], axis=1)
    return RecordedPath(points=points, name=path.name, remark=f"columns {', '.join(chosen)} in m")


def _from_text(path: Path, columns: Sequence[str] | None, unit: str | None) -> RecordedPath:
    table = read_csv(path)
    bare = {_bare(heading)[0]: heading for heading in table}
    chosen = [bare.get(c, c) for c in columns] if columns else _guess(list(bare), bare)
    _known(chosen, list(table))
    points = np.stack([_numbers(c, table[c]) for c in chosen], axis=1)
    given_units = {_bare(c)[1] for c in chosen}
    if len(given_units) > 1:
        raise ValueError(f"columns {', '.join(chosen)} have several units: give files with one")
    found = unit or next(iter(given_units))
    if found is not None and found not in UNITS:
        raise ValueError(
            f"columns {', '.join(chosen)} are in {found!r}: must be one of {', '.join(UNITS)}; --unit names it"
        )
    how = ""
    if found is None:
        found = "m" if float(np.nanmax(np.abs(points))) < FARTHEST else "mm"
        how = f" (no unit given; {found} guessed from the size, --unit to change it)"
    remark = f"columns {', '.join(_bare(c)[0] for c in chosen)} in {found}{how}"
    points = points * UNITS[found]
    for i, j in np.argwhere(np.abs(points) > MOST)[:1]:
        raise ValueError(
            f"column {chosen[j]}, row {i + 1}: {points[i, j]:g} m: must lie in [-{MOST:g}, {MOST:g}] m; "
            "is the unit right?"
        )
    return RecordedPath(points=points, name=path.name, remark=remark)


def _bare(heading: str) -> tuple[str, str | None]:
    return split_heading(heading, UNITS)


def _guess(names: list[str], bare: dict[str, str]) -> list[str]:
    for triple in NAMES:
        found = [bare[n] for n in triple if n in names]
        if len(found) >= 2:
            return found
    raise ValueError(
        f"no columns x and y among {', '.join(names)}: name them with columns=[...], or --column"
    )


def _known(chosen: Sequence[str], names: list[str]) -> None:
    for column in chosen:
        if column not in names:
            raise ValueError(unknown(f"column {column!r}", column, names))


def _numbers(column: str, cells: list[str]) -> Values:
    values = np.empty(len(cells))
    for i, cell in enumerate(cells):
        try:
            values[i] = float(cell)
        except ValueError:
            raise ValueError(f"column {column}, row {i + 1}: {cell!r} is no number") from None
        if not np.isfinite(values[i]):
            raise ValueError(f"column {column}, row {i + 1}: {cell.strip()} is not finite")
    return values
