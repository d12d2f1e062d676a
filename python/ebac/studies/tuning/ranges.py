"""What is searched of each law, and where in its ranges a point of the unit cube lies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TypeAlias

import numpy as np

from ebac._util.arguments import number, several, unknown_name
from ebac._util.arrays import Values
from ebac.laws import LAWS

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


class Ranges:
    """The ranges of a law's parameters as a unit cube; a wide one that begins above 0 is logarithmic."""

    def __init__(self, law: str, ranges: Mapping[str, Range]) -> None:
        _check(law, ranges)
        self.ranges = dict(ranges)
        self.switches = {f.name for f in LAWS[law].fields() if f.kind == "bool"}

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
                found[name] = float(f"{value:.4g}")
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


def _wide(low: float, high: float) -> bool:
    return low > 0 and high >= 10 * low


def _check(law: str, ranges: Mapping[str, Range]) -> None:
    if not ranges:
        names = ", ".join(RANGES)
        raise ValueError(f"law {law!r}: nothing to tune; give ranges, or one of {names}")
    fields = {f.name: f for f in LAWS[law].fields()}
    for name, span in ranges.items():
        if name not in fields:
            raise unknown_name(f"parameter of {law}", name, fields)
        ends = [number(name, value) for value in several(name, span)]
        if len(ends) != 2:
            raise ValueError(f"{name} = {ends}: must be its lowest and highest value, as (0.1, 10)")
        low, high = ends
        field = fields[name]
        unit = "" if field.unit == "1" else f" {field.unit}"
        if not field.low <= low < high <= field.high:
            raise ValueError(
                f"{name} from {low:g} to {high:g}{unit}: must lie in [{field.low:g}, {field.high:g}]{unit}, the lower "
                "one first"
            )
