"""What was swept: a column for every parameter in which the scenarios of a sweep differ."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from functools import cache
from math import nan
from typing import Any

import numpy as np

from ebac.scenario import Scenario
from ebac.studies.sweeps.measure import Columns

#: Unit of a parameter: the ending of its column; others are left out.
ENDINGS = {
    "N s/m": "_Ns_per_m", "N/m": "_N_per_m", "m": "_m", "kg": "_kg", "N": "_N", "s": "_s", "Hz": "_Hz",
    "rad": "_rad", "m/s": "_m_per_s", "samples": "_samples", "A": "_A", "N m": "_Nm",
}  # fmt: skip
_PARTS = ("device", "hand", "environment", "timing", "observer")
_NUMBERS = {"jitter": "jitter", "seconds": "seconds_s"}


def swept(scenarios: Sequence[Scenario]) -> Columns:
    """Return the parameters in which scenarios differ: `environment.stiffness_N_per_m`, `hand.mass_kg`.

    Parameters
    ----------
    scenarios : sequence of Scenario
        At least one.

    Returns
    -------
    dict of str to array, shape (scenarios,)
        NaN, or an empty text, where a scenario has no such parameter; a column `environment` with the kind of world
        where the scenarios have several.
    """
    rows = [dict[str, Any]() for _ in scenarios]
    for part in _PARTS:
        values = [getattr(scenario, part) for scenario in scenarios]
        distinct = {id(value): value for value in values}  # a part that stays is mostly one object
        if all(value == values[0] for value in distinct.values()):
            continue
        flat = {key: _flat(part, value) for key, value in distinct.items()}
        for value, row in zip(values, rows, strict=True):
            row.update(flat[id(value)])
    for name, column in _NUMBERS.items():
        for scenario, row in zip(scenarios, rows, strict=True):
            row[column] = getattr(scenario, name)
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: [row.get(name) for row in rows] for name in names}
    return {
        name: _array(values)
        for name, values in columns.items()
        if any(value != values[0] for value in values)
    }


def _flat(name: str, value: Any) -> dict[str, Any]:
    """Return the parameters of a value as a row."""
    row = dict[str, Any]()
    _flatten(name, value, row)
    return row


def _flatten(name: str, value: Any, row: dict[str, Any]) -> None:
    """Put the parameters of a value into a row, those of its parts below its name."""
    if isinstance(value, tuple):
        for i, one in enumerate(value):
            _flatten(name if i == 0 else f"{name}{i}", one, row)
    elif hasattr(value, "as_dict"):
        row[name] = type(value).__name__
        kind: Any = type(value)
        endings = _endings(kind)
        for key, one in value.as_dict().items():
            _flatten(f"{name}.{key}{endings.get(key, '')}", one, row)
    elif isinstance(value, (bool, int, float, str)):
        row[name] = value


@cache
def _endings(kind: Hashable) -> dict[str, str]:
    """Return how the columns of a type's parameters end: their units."""
    fields: Any = kind.fields() if hasattr(kind, "fields") else ()
    return {field.name: ENDINGS.get(field.unit, "") for field in fields}


def _array(values: list[Any]) -> Any:
    if any(isinstance(value, str) for value in values):
        return np.array(["" if value is None else str(value) for value in values])
    return np.array([nan if value is None else float(value) for value in values])
