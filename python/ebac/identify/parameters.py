"""The parameters of a fit: names, which are free, which recording has its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._util.arguments import number, shown, unknown

#: What a hand is made of in eq. (4).
HAND = ("M0", "B0", "K0")
SHARED = (*HAND, "delay")
#: Of a recording beside the shared ones and the levels.
OWN = ("onset", "bend", "stair")
#: Forces that are known but for a share: the motor's ripple, friction and weight of a device.
INPUTS = ("stair", "coulomb", "weight", "stribeck")
#: Unit, bounds, and the least step of a difference, of every parameter.
KINDS: dict[str, tuple[str, tuple[float, float], float]] = {
    "M0": ("kg", (1e-3, 10.0), 1e-7),
    "B0": ("N s/m", (0.0, 1e3), 1e-5),
    "K0": ("N/m", (0.0, 1e5), 1e-3),
    "delay": ("s", (-0.05, 0.2), 1e-6),
    "onset": ("s", (-0.5, 2.0), 1e-6),
    "bend": ("1", (-1.0, 1.0), 1e-4),
    "stair": ("1", (-1.0, 2.0), 1e-3),
    "X0": ("m", (-10.0, 10.0), 1e-7),
    "M_h": ("kg", (1e-3, 100.0), 1e-7),
    "B_h": ("N s/m", (-10.0, 1e3), 1e-5),
    "spring": ("N/m", (0.0, 0.0), 1e-3),
    "coulomb": ("N", (-100.0, 100.0), 1e-4),
    "weight": ("N", (-1e3, 1e3), 1e-4),
    "stribeck": ("N", (-100.0, 100.0), 1e-4),
}
UNITS = {name: unit for name, (unit, _, _) in KINDS.items()}
BOUNDS = {name: bounds for name, (_, bounds, _) in KINDS.items()}
STEPS = {name: step for name, (_, _, step) in KINDS.items()}
#: Held there unless asked for; of the motor's ripple a hand of M0 feels M0/(M0 + M_h).
USUALLY_FIXED = {"delay": 0.0, "onset": 0.0, "bend": 0.0, "stair": 0.5}


@dataclass(frozen=True, kw_only=True, eq=False)
class Parameters:
    """Names in order, bounds, what is free, and where each recording finds its own."""

    names: tuple[str, ...]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    fixed: NDArray[np.float64]  # NaN where free
    places: tuple[NDArray[np.intp], ...]  # theta of recording i = values[places[i]]
    before_levels: int  # how much of theta stands before the levels of the target

    @property
    def free(self) -> NDArray[np.intp]:
        """Indices of what is fitted."""
        return np.flatnonzero(np.isnan(self.fixed))

    def unit(self, name: str) -> str:
        """Return the unit of a parameter."""
        return UNITS[kind(name)]

    def clip(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return values within their bounds, fixed ones as fixed."""
        inside = np.clip(values, self.low, self.high)
        return np.where(np.isnan(self.fixed), inside, self.fixed)


#: Theta before the levels.
BEFORE_LEVELS = len(SHARED) + len(OWN)


def kind(name: str) -> str:
    """Return M0, B0, K0, delay, onset or X0 of a full name."""
    return name.split("@")[0].split("/")[0]


def lay_out(
    levels: Sequence[int],
    *,
    fixed: Mapping[str, float],
    bounds: Mapping[str, tuple[float, float]],
    free: Sequence[str],
    own: Sequence[str],
) -> Parameters:
    """Name the parameters of recordings with `levels` target levels each.

    A name is `K0`, `K0@2` where recording 2 has its own, `X0/2` for the second level of a target. What is fixed or
    bounded
    under a short name holds for all longer ones.

    Raises
    ------
    TypeError
        For a value that is no number.
    ValueError
        For a name that does not exist, or a number out of range.
    """
    many = len(levels) > 1
    names: list[str] = []
    places = []

    def place(name: str) -> int:
        if name not in names:
            names.append(name)
        return names.index(name)

    for i, count in enumerate(levels):
        mark = f"@{i + 1}" if many else ""
        theta = [place(n + (mark if n in own else "")) for n in SHARED]
        theta += [place(name + mark) for name in OWN]
        theta += [place("X0" + (f"/{j + 1}" if count > 1 else "") + mark) for j in range(count)]
        places.append(np.array(theta))
    known = (*SHARED, *OWN, "X0")
    for name in (*fixed, *bounds, *free, *own):
        if name not in names and name not in known:
            raise ValueError(
                unknown(f"parameter {name}", name, list(dict.fromkeys([*known, *names])))
            )
    rows = [_limits(name, fixed, bounds, free) for name in names]
    low, high, held = np.array(rows).T
    return Parameters(
        names=tuple(names),
        low=low,
        high=high,
        fixed=held,
        places=tuple(places),
        before_levels=BEFORE_LEVELS,
    )


def _limits(
    name: str,
    fixed: Mapping[str, float],
    bounds: Mapping[str, tuple[float, float]],
    free: Sequence[str],
) -> tuple[float, float, float]:
    short = kind(name)
    low, high = widest = BOUNDS[short]
    given = bounds.get(name, bounds.get(short))
    if given is not None:
        if np.shape(given) != (2,):
            raise TypeError(f"bounds of {name} = {shown(given)}: must be two numbers, low and high")
        low, high = (number(f"bounds of {name}", bound) for bound in given)
    if not widest[0] <= low < high <= widest[1]:
        unit = UNITS[short]
        raise ValueError(
            f"bounds of {name} = [{low:g}, {high:g}] {unit}: must lie in [{widest[0]:g}, {widest[1]:g}] {unit}, "
            "the lower one first"
        )
    held = fixed.get(name, fixed.get(short))
    if held is None and name not in free and short not in free:
        held = USUALLY_FIXED.get(short)
    if held is None:
        return low, high, np.nan
    if not low <= number(name, held) <= high:
        raise ValueError(
            f"{name} = {held:g} {UNITS[short]}: must lie in [{low:g}, {high:g}] {UNITS[short]}"
        )
    return low, high, float(held)
