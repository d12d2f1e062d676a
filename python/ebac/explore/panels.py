"""Which columns of a trace stand in which panel, in the units people read."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._util.formatting import QUANTITY_OF, SHOWN
from ebac.plot.marks import acts_on_observer
from ebac.trace import Trace

#: Panels of an exploration that names no columns: a title and what it shows where the trace has it.
USUAL: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("position", ("x", "true.x")),
    ("force", ("f_env", "f_meas", "f_cmd", "f_applied")),
    ("beta", ("law.beta_min", "law.beta_max", "law.beta")),
    ("energy", ("law.energy", "law.account", "true.energy")),
    ("force limited", ("law.clamped",)),
)
#: What a law has on the encoder alone.
BETAS = frozenset({"law.beta", "law.beta_min", "law.beta_max"})
#: The letters that the axis of a panel has room for; names that are longer stand in the legend alone.
ROOM = 20
#: A unit that runs over decades is drawn on an asinh scale: straight to 1, logarithmic beyond.
DECADES = frozenset({"kN/m"})


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One pair of axes: series of one unit.

    Attributes
    ----------
    title : str
        What the axis shows, without its unit.
    unit : str
        As people read it; "1" for a pure number.
    names : tuple of str
        Columns.
    values : tuple of array, shape (rows,)
        In `unit`, float32: seven digits, more than a screen shows.
    """

    title: str
    unit: str
    names: tuple[str, ...]
    values: tuple[NDArray[np.float32], ...]

    @property
    def label(self) -> str:
        """Title and unit, as the axis has it."""
        return self.title if self.unit == "1" else f"{self.title} [{self.unit}]".strip()

    @property
    def decades(self) -> bool:
        """Whether it is drawn on an asinh scale."""
        return self.unit in DECADES


def without_numbers(trace: Trace, shown: Panel) -> str:
    """Return why a panel is empty, for people to read; "" where it has a number."""
    if any(np.isfinite(values).any() for values in shown.values):
        return ""
    verb = "is" if len(shown.names) == 1 else "are"
    lines = [f"{', '.join(shown.names)} {verb} NaN in every row"]
    if any(name in BETAS for name in shown.names) and acts_on_observer(trace):
        why = f"with its state observer {trace.law} has no beta;\nin a Scenario(observer=False) it has"
        return f"{lines[0]}: {why}"
    if len(shown.names) == 1:
        lines.append(trace.columns[shown.names[0]].meaning)
    return ":\n".join(lines)


def usual(trace: Trace, axis: int) -> list[Panel]:
    """Return the panels of `USUAL` that the trace has columns for."""
    found = ((title, [name for name in names if name in trace]) for title, names in USUAL)
    return [panel(trace, names, axis, title) for title, names in found if names]


def chosen(trace: Trace, groups: Iterable[str | Sequence[str]], axis: int) -> list[Panel]:
    """Return one panel per group of columns.

    Raises
    ------
    KeyError
        For a column that does not exist.
    ValueError
        For a panel of several units, or without a column.
    """
    return [panel(trace, [g] if isinstance(g, str) else list(g), axis) for g in groups]


def panel(trace: Trace, names: Sequence[str], axis: int, title: str = "") -> Panel:
    """Return the panel of some columns; its title is their names, or what has their unit, where none is given."""
    if not names:
        raise ValueError(
            "a panel without a column: name at least one, as in explore('x', ['f_cmd'])"
        )
    columns = [np.asarray(trace.axis(name, axis), dtype=float) for name in names]
    units = {name: trace.columns[name].unit for name in names}
    if len(set(units.values())) > 1:
        listed = ", ".join(f"{name} [{unit}]" for name, unit in units.items())
        raise ValueError(f"one panel has one unit, not {listed}: put them into panels of their own")
    factor, unit = _read_in(units[names[0]], columns)
    listed = ", ".join(names)
    brief = listed if len(listed) <= ROOM else QUANTITY_OF.get(units[names[0]], "")
    return Panel(
        title=title or brief,
        unit=unit,
        names=tuple(names),
        values=tuple((factor * values).astype(np.float32) for values in columns),
    )


def _read_in(unit: str, columns: Sequence[NDArray[np.float64]]) -> tuple[float, str]:
    """Return factor and unit in which people read columns of an SI unit."""
    if unit == "N/m":
        return 1e-3, "kN/m"
    if unit == "J":
        known = (np.abs(values[np.isfinite(values)]).max(initial=0.0) for values in columns)
        return (1e3, "mJ") if max(known) < 1 else (1.0, "J")
    if unit == "m":
        return SHOWN["m"][0], SHOWN["m"][1]
    return 1.0, unit
