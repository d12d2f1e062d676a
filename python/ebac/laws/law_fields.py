"""The parameters of any law: names, units, ranges, meanings; those of a law in Python are declared in its dataclass."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

from ebac._core import Field
from ebac._util.arguments import number, whole
from ebac.laws.protocols import is_core_law
from ebac.laws.variant import AnyLaw, class_of


@dataclasses.dataclass(frozen=True, kw_only=True)
class PythonField:
    """One parameter of a law in Python, as the core's `Field`; None and "" for what its dataclass does not declare."""

    name: str
    unit: str | None
    meaning: str
    kind: str
    default: Any
    low: float | None
    high: float | None


def fields_of(law: AnyLaw) -> Sequence[Field | PythonField]:
    """Return the parameters of a law: those of a law in Python are the fields of its dataclass, see `PythonLaw`.

    Raises
    ------
    TypeError
        For an end of a range that is no number.
    """
    if is_core_law(law):
        return law.fields()
    if isinstance(law, str) or hasattr(law, "_simulate"):
        return class_of(law).fields()  # type: ignore[arg-type]
    if not dataclasses.is_dataclass(law):
        return ()
    return [_declared(law, one) for one in dataclasses.fields(law) if one.init]


def as_declared(law: Any, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return new values of a law in Python; 2.0 becomes 2 where a whole number is declared.

    Raises
    ------
    TypeError
        For a value that is no number, no whole number or no switch where one is declared or there, and for an end of
        a range that is no number.
    ValueError
        For a value outside the range that its field declares.
    """
    owner = type(law).__name__
    found = dict(changes)
    for field in (field for field in fields_of(law) if field.name in changes):
        name, value = f"{owner}.{field.name}", changes[field.name]
        switch = field.kind == "bool" or isinstance(getattr(law, field.name), bool)
        if switch and not isinstance(value, bool):
            raise TypeError(f"{name} = {value!r}: must be on or off, in Python True or False")
        if isinstance(value, bool) and not switch:
            raise TypeError(f"{name} = {value}: must be a number")
        if field.kind == "int":
            is_whole = isinstance(value, float) and value.is_integer()
            found[field.name] = int(value) if is_whole else whole(name, value)
        if not switch:
            _refuse_outside(name, field, found[field.name])
    return found


def _refuse_outside(name: str, field: Field | PythonField, given: Any) -> None:
    if field.low is not None or field.high is not None:
        value = number(name, given)
        low = -math.inf if field.low is None else field.low
        high = math.inf if field.high is None else field.high
        if not low <= value <= high:
            unit = unit_of(field)
            raise ValueError(f"{name} = {value:g}{unit}: must lie in [{low:g}, {high:g}]{unit}")


def unit_of(field: Field | PythonField) -> str:
    """Return the unit of a parameter after a space; "" where it has none."""
    return f" {field.unit}" if field.unit not in ("1", None) else ""


def _declared(law: Any, one: dataclasses.Field[Any]) -> PythonField:
    owner = law if isinstance(law, type) else type(law)
    ends = [one.metadata.get(end) for end in ("low", "high")]
    low, high = (
        None if end is None else number(f"{owner.__name__}.{one.name}: an end of its range", end)
        for end in ends
    )
    return PythonField(
        name=one.name,
        unit=one.metadata.get("unit"),
        meaning=one.metadata.get("meaning", ""),
        kind=getattr(one.type, "__name__", str(one.type)),
        default=None if one.default is dataclasses.MISSING else one.default,
        low=low,
        high=high,
    )
