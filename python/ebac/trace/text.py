"""A trace as text: its first rows, and a summary under 20 lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ebac._core import FEWEST_ROWS
from ebac._util import descriptions, formatting
from ebac._util.arguments import whole
from ebac._util.report import aligned

if TYPE_CHECKING:
    from ebac.trace.trace import Trace

#: What is shown unless columns are named, as far as the trace has it.
SHOWN = (
    "t",
    "x",
    "true.x",
    "v",
    "f_env",
    "f_cmd",
    "f_applied",
    "f_meas",
    "law.beta",
    "true.energy",
)


class Text(str):
    """Text that a console and a notebook show as it stands."""

    __slots__ = ()

    def __repr__(self) -> str:
        """Return the text itself."""
        return str(self)


def head(trace: Trace, rows: int, columns: tuple[str, ...]) -> Text:
    """Return the first rows of some columns, units in the headings."""
    if whole("rows", rows) < 0:
        raise ValueError(f"rows = {rows}: must be at least 0")
    part = trace.rows(0, rows)
    lines = []
    for name in columns or tuple(name for name in SHOWN if name in trace):
        for axis in range(1 if trace[name].ndim == 1 else trace.axes):
            factor, unit = _read_in(trace.columns[name].unit)
            label = name if trace[name].ndim == 1 else f"{name}, axis {axis}"
            values = (factor * float(value) for value in part.axis(name, axis).tolist())
            lines.append([_titled(label, unit), *(f"{value:.6g}" for value in values)])
    return Text("\n".join([repr(trace), *aligned(lines)]))


def summary(trace: Trace) -> Text:
    """Return the scenario of a trace, the verdict on its contact, and minimum, mean and maximum of its main columns."""
    from ebac.metrics import contact

    lines = [repr(trace)]
    if trace.scenario is not None:
        device, *parts = descriptions.describe(trace.scenario).split("; ")
        lines += [f"  {trace.origin}: {device}", *(f"    {part}" for part in parts)]
    if len(trace) >= FEWEST_ROWS and "f_applied" in trace:
        lines.append(f"  {contact(trace)!r}".replace("<Contact of", "contact of").removesuffix(">"))
    if "fault" in trace and trace["fault"].any():
        lines.append(f"  ended by fault {int(trace['fault'][trace['fault'].nonzero()[0][0]])}")
    return Text("\n".join([*lines, *_table(trace)]))


def _table(trace: Trace) -> list[str]:
    if len(trace) == 0:
        return []
    table = [["column"], ["unit"], ["first"], ["least"], ["mean"], ["most"], ["last"]]
    for name in SHOWN[1:]:
        if name not in trace:
            continue
        factor, unit = _read_in(trace.columns[name].unit)
        values = factor * trace[name].astype(float)
        known = values[np.isfinite(values)]
        if len(known) == 0:
            continue
        first, last = values[0].ravel()[0], values[-1].ravel()[0]
        numbers = (first, known.min(), known.mean(), known.max(), last)
        for cells, text in zip(table, [name, unit, *(f"{n:.4g}" for n in numbers)], strict=True):
            cells.append(text)
    return aligned(table)


def _read_in(unit: str) -> tuple[float, str]:
    """Return factor and unit in which people read an SI unit."""
    factor, shown, _ = formatting.SHOWN.get(unit, (1.0, unit, 0))
    return float(factor), shown


def _titled(name: str, unit: str) -> str:
    return name if unit in ("", "1") else f"{name} [{unit}]"
