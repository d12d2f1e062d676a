"""The parameters of any law: names, units, ranges, meanings; those of a law in Python are declared in its dataclass."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

from ebac._core import Field
from ebac._util.arguments import number
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
