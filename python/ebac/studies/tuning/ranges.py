"""What is searched of each law, and where in its ranges a point of the unit cube lies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np

from ebac._core import Field
from ebac._util.arguments import require, unknown_name
from ebac._util.arrays import Values
from ebac._util.sequences import several_numbers
from ebac.laws import AnyLaw, law_name
from ebac.laws.law_fields import PythonField, fields_of, unit_of

Range: TypeAlias = tuple[float, float]

#: What is searched of each law, in SI units; (0, 1) for a switch. Facts about the device are left alone.
RANGES: dict[str, dict[str, Range]] = {
    "tca": {"kp": (0, 2), "kd": (0, 0.005)},
    "tca-damped": {"virtual_damping": (5, 200), "kp": (0, 1)},
    "lag-compensator": {
        "stiffness": (500, 3e5), "virtual_damping": (0.5, 200), "recovery_time": (0.01, 3)
    },
    "passivity-control": {"cap": (0.1, 60), "reference": (0, 1), "per_contact": (0, 1)},
    "iss": {"gain": (1e-7, 1e-2), "most_damping": (1, 200)},
    "virtual-coupling": {"coupling_stiffness": (500, 1e6), "coupling_damping": (0.01, 200)},
    "sfa": {"stiffness": (200, 1e4), "gain": (0.005, 1), "transient": (0, 1)},
    "eba": {"share": (0.1, 1)},
    "eba-account": {"share": (0.1, 1)},
}  # fmt: skip


#: So near to an end of a range, as a share of it, a parameter counts as at its bound.
AT_BOUND = 1e-3


class Ranges:
    """The ranges of a law's parameters as a unit cube; a wide one that begins above 0 is logarithmic."""

    def __init__(self, law: AnyLaw, ranges: Mapping[str, Range]) -> None:
        _check(law, ranges)
        self.ranges = dict(ranges)
        self._fields = {f.name: f for f in fields_of(law)}
        kinds = {f.name: f.kind for f in self._fields.values()}
        self.switches = {name for name, kind in kinds.items() if kind == "bool"}
        self.whole = {name for name, kind in kinds.items() if kind == "int"}

    def __len__(self) -> int:
        """Return the number of parameters."""
        return len(self.ranges)

    def at(self, point: Values) -> dict[str, float | bool]:
        """Return the parameters at a point of the unit cube."""
        found: dict[str, float | bool] = {}
        for share, (name, (low, high)) in zip(point.tolist(), self.ranges.items(), strict=True):
            if name in self.switches:
                found[name] = share > 0.5
            else:
                value = (
                    low * (high / low) ** share if _wide(low, high) else low + (high - low) * share
                )
                found[name] = (
                    round(value)
                    if name in self.whole
                    else min(max(float(f"{value:.4g}"), low), high)
                )
        return found

    def place_of(self, changes: Mapping[str, float | bool]) -> Values:
        """Return the point of the unit cube at which the parameters are."""
        shares = []
        for name, (low, high) in self.ranges.items():
            value = float(changes[name])
            if name in self.switches:
                shares.append(0.25 + 0.5 * value)
            elif _wide(low, high):
                shares.append(math.log(value / low) / math.log(high / low))
            else:
                shares.append((value - low) / (high - low))
        return np.asarray(np.clip(np.array(shares), 0, 1))

    def searched(self, changes: Mapping[str, float | bool]) -> tuple[dict[str, Any], ...]:
        """Return name, value found, unit, and lowest and highest value searched of each parameter."""
        return tuple(
            {"name": n, "value": changes.get(n), "unit": self._fields[n].unit or "1", "low": low, "high": high}
            for n, (low, high) in self.ranges.items()
        )  # fmt: skip

    def at_bounds(self, changes: Mapping[str, float | bool]) -> tuple[str, ...]:
        """Return which parameters stand at a bound of what was searched, and how to search beyond it.

        Not those that a built-in law itself allows no further.
        """
        if not changes:
            return ()
        found = []
        for share, name in zip(self.place_of(changes).tolist(), self.ranges, strict=True):
            if name in self.switches or AT_BOUND < share < 1 - AT_BOUND:
                continue
            field, above = self._fields[name], share > 0.5
            unit, span = unit_of(field), self.ranges[name]
            value = f"{name} = {changes[name]:g}{unit}"
            side, end = ("upper", "high") if above else ("lower", "low")
            if span[above] != getattr(field, end):
                found.append(
                    f"{value} is at the end of the range searched, [{span[0]:g}, {span[1]:g}]{unit}: give a wider one "
                    "in Python, ebac.tune(..., ranges=...)"
                )
            elif isinstance(field, PythonField):
                remedy = (
                    "raise `high` if it may be more" if above else "reduce `low` if it may be less"
                )
                found.append(f"{value} is at its {side} bound: {remedy}")
        return tuple(found)


def ranges_of(law: AnyLaw) -> Mapping[str, Range]:
    """Return what is searched of a law where nothing else is asked: of one in Python the ranges that it declares.

    Raises
    ------
    ValueError
        For a numeric field of a law in Python that declares no range.
    """
    if isinstance(law, str) or hasattr(law, "_simulate"):
        return RANGES.get(law_name(law), {})
    numeric = [f for f in fields_of(law) if type(getattr(law, f.name)) in (int, float)]
    return {f.name: _declared(law, f) for f in numeric}


def _declared(law: AnyLaw, field: Field | PythonField) -> Range:
    """Return the range that a field declares; ValueError names what is missing."""
    if field.low is not None and field.high is not None:
        return field.low, field.high
    value = getattr(law, field.name)
    missing = [end for end in ("low", "high") if getattr(field, end) is None]
    raise ValueError(
        f"{type(law).__name__}.{field.name} = {value:g}{unit_of(field)}: declares no {' and no '.join(missing)}, so "
        f"that there is no range to search; write {field.name}: {field.kind} = field(default={value:g}, "
        f"metadata={{'unit': {field.unit or 'UNIT'!r}, 'low': LOW, 'high': HIGH}}), or make it a ClassVar if it is not "
        "to be tuned"
    )


def _wide(low: float, high: float) -> bool:
    return low > 0 and high >= 10 * low


def _check(law: AnyLaw, ranges: Mapping[str, Range]) -> None:
    called = law_name(law)
    require(ranges, Mapping, "ebac.tune", "ranges by name, as {'kp': (0.1, 10)}")
    if not ranges:
        names = ", ".join(RANGES)
        raise ValueError(
            f"law {called!r}: nothing to tune; give ranges in Python, ebac.tune(..., ranges=...), or one of {names}"
        )
    fields = {f.name: f for f in fields_of(law)}
    for name, span in ranges.items():
        if name not in fields:
            raise unknown_name(f"parameter of {called}", name, fields)
        ends = several_numbers(name, span)
        if len(ends) != 2:
            raise ValueError(f"{name} = {ends}: must be its lowest and highest value, as (0.1, 10)")
        low, high = ends
        field = fields[name]
        unit = unit_of(field)
        least = -math.inf if field.low is None else field.low
        most = math.inf if field.high is None else field.high
        if not (least <= low < high <= most and math.isfinite(high - low)):
            raise ValueError(
                f"{name} from {low:g} to {high:g}{unit}: must lie in [{least:g}, {most:g}]{unit}, the lower one first"
            )
