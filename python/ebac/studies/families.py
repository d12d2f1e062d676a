"""Families of hands for the search of the worst one: parameters with units and bounds, and how each makes a hand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ebac._core import Hand, MinimumJerk, Recorded, Sine, Step, Tapping, Wall
from ebac._util.arguments import unknown

if TYPE_CHECKING:
    from ebac.scenario import Scenario

Values: TypeAlias = Mapping[str, float]


class Make(Protocol):
    """Puts the hand of some parameters on a scenario, for a run of some length [s] or that of the family."""

    def __call__(self, s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
        """Return the scenario with its hand."""


#: Largest pull of a hand [N] where a law declares none.
PULL = 20.0


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """What may vary in a family: unit, bounds, and whether it is searched on a logarithmic scale."""

    name: str
    unit: str
    low: float
    high: float
    log: bool = False

    def at(self, share: float) -> float:
        """Return the value at a share of the way from `low` to `high`, clipped to them."""
        share = min(max(share, 0.0), 1.0)
        if self.log:
            value = self.low * (self.high / self.low) ** share
        else:
            value = self.low + (self.high - self.low) * share
        return float(min(max(value, self.low), self.high))


@dataclass(frozen=True, kw_only=True)
class Family:
    """Hands of one kind.

    Attributes
    ----------
    name, summary : str
        How it is called, and what it is in a line.
    parameters : tuple of Parameter
        What varies.
    make : callable
        A scenario with a straight wall and the parameters by name in, the scenario with the hand on it out. A third
        argument is the length of the run [s]; None for that of the family, 2 to 8 s.
    """

    name: str
    summary: str
    parameters: tuple[Parameter, ...]
    make: Make

    def values(self, shares: NDArray[np.float64]) -> dict[str, float]:
        """Return the parameters at shares of their ranges, shape (len(parameters),), each in [0, 1]."""
        pairs = zip(self.parameters, shares.tolist(), strict=True)
        return {parameter.name: parameter.at(share) for parameter, share in pairs}

    def at_random(self, hands: int, random: np.random.Generator) -> NDArray[np.float64]:
        """Return a Latin hypercube of shares, shape (hands, parameters): each parameter over its whole range."""
        n = len(self.parameters)
        order = np.stack([random.permutation(hands) for _ in range(n)], axis=1)
        return np.asarray((order + random.random((hands, n))) / hands)


def families(pull: float) -> dict[str, Family]:
    """Return every family by its name, for hands that pull with at most `pull` [N].

    A force on the hand enters as its path, X0 = F/K0: eq. (4) knows no other.
    """
    mass = Parameter(name="mass", unit="kg", low=0.02, high=1.5, log=True)
    damping = Parameter(name="damping", unit="N s/m", low=0.0, high=25.0)
    stiffness = Parameter(name="stiffness", unit="N/m", low=20.0, high=1500.0, log=True)
    hand = (mass, damping, stiffness)
    force = Parameter(name="pull", unit="N", low=min(0.5, pull), high=pull)
    share = Parameter(name="swing", unit="share", low=0.0, high=1.0)
    knots = tuple(
        Parameter(name=f"force_{i}", unit="N", low=-0.97 * pull, high=0.97 * pull) for i in range(KNOTS)
    )  # fmt: skip
    every = (
        Family(
            name="impact",
            summary="the hand touches the wall out of free air and presses",
            parameters=(*hand, force, _p("approach", "m", 0, 0.05)),
            make=_impact,
        ),
        Family(
            name="press-and-go",
            summary="the hand presses along a minimum-jerk path, holds, and lets go",
            parameters=(*hand, force, _p("duration", "s", 0.05, 4, log=True), _p("hold", "s", 0.005, 2, log=True)),
            make=_press_and_go,
        ),
        Family(
            name="tapping",
            summary="the hand taps, half a period inside the wall, half before it",
            parameters=(*hand, force, _p("lift", "m", 1e-3, 0.02), _p("frequency", "Hz", 0.5, 30, log=True)),
            make=_tapping,
        ),
        Family(
            name="swinging",
            summary="a steady and a sinusoidal force, together within the pull",
            parameters=(*hand, force, share, _p("frequency", "Hz", 0.3, 400, log=True), _p("phase", "rad", 0, 6.2832)),
            make=_swinging,
        ),
        Family(
            name="drive",
            summary="a stiff position drive swings inside the wall; what pulls too hard is refused",
            parameters=(
                mass, _p("damping", "N s/m", 1, 200), _p("stiffness", "N/m", 1e3, 5e4, log=True),
                _p("depth", "m", 0, 5e-3), _p("amplitude", "m", 2e-5, 5e-3, log=True),
                _p("frequency", "Hz", 0.3, 60, log=True), _p("phase", "rad", 0, 6.2832),
            ),
            make=_drive,
        ),
        Family(
            name="noise",
            summary="a steady and a random force that changes every `hold`, together within the pull",
            parameters=(*hand, force, share, _p("hold", "s", 1e-3, 0.1, log=True)),
            make=_noise,
        ),
        Family(
            name="periodic",
            summary=f"any periodic force: straight lines through {KNOTS} points a period, within the pull",
            parameters=(mass, damping, _p("period", "s", 5e-3, 1, log=True), *knots),
            make=_periodic,
        ),
    )  # fmt: skip
    return {family.name: family for family in every}


def find_family(name: str, pull: float) -> Family:
    """Return a family by its name.

    Raises
    ------
    ValueError
        For an unknown name; suggests the nearest.
    """
    every = families(pull)
    if name not in every:
        raise ValueError(unknown(f"family {name}", name, list(every)))
    return every[name]


#: Points of a periodic force.
KNOTS = 8
#: Stiffness of the hand that carries a periodic force [N/m]: so soft that its motion hardly changes the force.
CARRIER = 50.0


def _p(name: str, unit: str, low: float, high: float, log: bool = False) -> Parameter:
    return Parameter(name=name, unit=unit, low=low, high=high, log=log)


def _surface(s: Scenario) -> float:
    if not isinstance(s.environment, Wall) or s.environment.angle != 0:
        kind = type(s.environment).__name__
        raise TypeError(f"the environment is a {kind}: must be a Wall across the first axis")
    return s.environment.position


def _hand(v: Values, path: Step | MinimumJerk | Sine | Tapping | Recorded) -> Hand:
    return Hand(mass=v["mass"], damping=v["damping"], stiffness=v["stiffness"], path=path)


def _impact(s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
    surface, way = _surface(s), v["approach"]
    path = Step(target=surface + way + v["pull"] / v["stiffness"])
    assert isinstance(s.environment, Wall)
    farther = s.environment.replace(position=surface + way)
    return s.replace(hand=_hand(v, path), environment=farther, seconds=seconds or 2.0)


def _press_and_go(s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
    path = MinimumJerk(target=_surface(s) + v["pull"] / v["stiffness"], duration=v["duration"])
    end = v["duration"] + v["hold"]
    length = max(end + 0.5, seconds or 0.0)
    return s.replace(hand=_hand(v, path).replace(release_at=end), seconds=length)


def _tapping(s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
    surface = _surface(s)
    path = Tapping(
        target=surface + v["pull"] / v["stiffness"],
        rest=surface - v["lift"],
        frequency=v["frequency"],
    )
    return s.replace(hand=_hand(v, path), seconds=seconds or 3.0)


def _swinging(s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
    most = v["pull"] / v["stiffness"]
    path = Sine(
        centre=_surface(s) + (1 - v["swing"]) * most,
        amplitude=v["swing"] * most,
        frequency=v["frequency"],
        phase=v["phase"],
    )
    return s.replace(hand=_hand(v, path), seconds=seconds or 4.0)


def _drive(s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
    surface = _surface(s)
    assert isinstance(s.environment, Wall)
    inside = v["depth"] * (
        1 + s.environment.stiffness / v["stiffness"]
    )  # it is pushed back by that
    path = Sine(
        centre=surface + inside,
        amplitude=v["amplitude"],
        frequency=v["frequency"],
        phase=v["phase"],
    )
    return s.replace(hand=_hand(v, path), seconds=seconds or 8.0)


def _noise(s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
    seconds = seconds or 3.0
    n = int(seconds / v["hold"]) + 2
    random = np.random.Generator(np.random.PCG64(s.seed)).uniform(-1, 1, n)
    most = v["pull"] / v["stiffness"]
    t = v["hold"] * np.arange(n)
    x = _surface(s) + most * (1 - v["swing"] + v["swing"] * random)
    return s.replace(hand=_hand(v, Recorded(t=t.tolist(), x=x.tolist())), seconds=seconds)


def _periodic(s: Scenario, v: Values, seconds: float | None = None) -> Scenario:
    seconds = seconds or 3.0
    forces = [v[f"force_{i}"] for i in range(KNOTS)]
    n = int(np.ceil(seconds / v["period"])) * KNOTS + 1
    t = v["period"] / KNOTS * np.arange(n)
    x = _surface(s) + np.resize(forces, n) / CARRIER
    hand = _hand({**v, "stiffness": CARRIER}, Recorded(t=t.tolist(), x=x.tolist()))
    return s.replace(hand=hand, seconds=seconds)
