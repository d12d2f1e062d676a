"""The quantities a map can run over."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ebac._core import Wall
from ebac.scenario import Scenario
from ebac.studies.scenario_changes import device_mass


@dataclass(frozen=True, kw_only=True)
class MapAxis:
    """A quantity of a scenario that a map runs over.

    Attributes
    ----------
    name, symbol, unit : str
        As shown.
    low, high : float
        Default range, in the unit.
    logarithmic : bool
        Whether the grid is even in the logarithm; the area share then is one of a logarithmic axis.
    whole : bool
        Whether it takes whole numbers alone.
    apply : callable
        Gives a scenario with this value.
    """

    name: str
    symbol: str
    unit: str
    low: float
    high: float
    apply: Callable[[Scenario, float], Scenario]
    logarithmic: bool = False
    whole: bool = False

    @property
    def label(self) -> str:
        """Name, symbol and unit, as a figure shows them."""
        return f"{self.name} {self.symbol} [{self.unit}]"

    @property
    def plain_symbol(self) -> str:
        """The symbol in plain text."""
        return self.symbol.strip("$").replace("_", "")

    def values(
        self, count: int, low: float | None = None, high: float | None = None
    ) -> NDArray[np.float64]:
        """Return `count` values from `low` to `high`, for whole numbers each once.

        Raises
        ------
        ValueError
            When the range is empty, or a logarithmic one does not start above zero.
        """
        low, high = self.low if low is None else low, self.high if high is None else high
        if not low < high or (self.logarithmic and low <= 0) or count < 2:
            floor = " above 0" if self.logarithmic else ""
            raise ValueError(
                f"{self.name}: {count} values from {low:g} to {high:g} {self.unit}: must be at least 2, "
                f"from low to high{floor}"
            )
        if self.whole:
            return np.unique(np.round(np.linspace(low, high, count)))
        return np.geomspace(low, high, count) if self.logarithmic else np.linspace(low, high, count)


def _wall(name: str) -> Callable[[Scenario, float], Scenario]:
    def apply(scenario: Scenario, value: float) -> Scenario:
        if not isinstance(scenario.environment, Wall):
            kind = type(scenario.environment).__name__
            raise ValueError(
                f"a map over the wall's {name} needs a wall: the environment is a {kind}"
            )
        return scenario.replace(environment=scenario.environment.replace(**{name: value}))

    return apply


def _hand(name: str) -> Callable[[Scenario, float], Scenario]:
    return lambda scenario, value: scenario.replace(hand=scenario.hand.replace(**{name: value}))


def _mechanics(name: str) -> Callable[[Scenario, float], Scenario]:
    def apply(scenario: Scenario, value: float) -> Scenario:
        mechanics = scenario.device.mechanics.replace(**{name: value})
        return scenario.replace(device=scenario.device.replace(mechanics=mechanics))

    return apply


def _device_mass(scenario: Scenario, value: float) -> Scenario:
    return device_mass(value)(scenario)


def _delay(scenario: Scenario, value: float) -> Scenario:
    delay = int(value) if value % 1 == 0 else value  # which Timing refuses
    return scenario.replace(timing=scenario.timing.replace(delay=delay))


#: Quantities by the name they have on the command line.
AXES: dict[str, MapAxis] = {
    "stiffness": MapAxis(name="wall stiffness", symbol="K", unit="N/m", low=1e3, high=1e5,
                         logarithmic=True, apply=_wall("stiffness")),
    "damping": MapAxis(name="wall damping", symbol="B", unit="N s/m", low=0, high=20,
                       apply=_wall("damping")),
    "delay": MapAxis(name="delay", symbol="d", unit="samples", low=0, high=8, whole=True, apply=_delay),
    "hand-mass": MapAxis(name="mass of the hand", symbol="$M_0$", unit="kg", low=0.03, high=1.5,
                         logarithmic=True, apply=_hand("mass")),
    "hand-damping": MapAxis(name="damping of the hand", symbol="$B_0$", unit="N s/m", low=1, high=25,
                            logarithmic=True, apply=_hand("damping")),
    "hand-stiffness": MapAxis(name="stiffness of the hand", symbol="$K_0$", unit="N/m", low=50, high=850,
                              logarithmic=True, apply=_hand("stiffness")),
    "device-mass": MapAxis(name="mass of the device", symbol="$M_h$", unit="kg", low=0.02, high=1,
                           logarithmic=True, apply=_device_mass),
    "device-damping": MapAxis(name="damping of the device", symbol="b", unit="N s/m", low=0.5, high=20,
                              logarithmic=True, apply=_mechanics("damping")),
}  # fmt: skip

#: The usual maps: name, and the quantities along x and y.
PRESETS: dict[str, tuple[str, str]] = {
    "KB": ("damping", "stiffness"),
    "Kd": ("delay", "stiffness"),
    "MB": ("hand-mass", "hand-damping"),
}
