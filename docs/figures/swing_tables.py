"""Hands that swing slowly on a wall for an hour: the energy that the account does not see."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from printed import Printed, Row, table

import ebac
from ebac._util.plural import plural

#: Lengths of a run [s], and where the wall is [m].
HOUR, MINUTES, SURFACE = 3600.0, 300.0, 0.01


@dataclass(frozen=True)
class Swung:
    """A hand: mass [kg], damping [N s/m], stiffness [N/m]; it pushes with mean and amplitude [N], so often [Hz]."""

    mass: float
    damping: float
    stiffness: float
    mean: float
    amplitude: float
    frequency: float
    wall: tuple[float, int] = (1e4, 1)

    @property
    def label(self) -> str:
        """What the table calls the hand."""
        hand = f"{self.mass:g} kg, {self.damping:g} N s/m, {self.stiffness:g} N/m"
        return f"{hand}: {self.mean:g} ± {self.amplitude:g} N at {self.frequency:g} Hz"

    @property
    def where(self) -> str:
        """What the table calls its wall."""
        stiffness, delay = self.wall
        return f"{1e-3 * stiffness:g} kN/m, {plural(delay, 'sample')}"

    def drawn(
        self,
        noise: float,
        scale: float = 1.0,
        *,
        observer: Literal["learns-scale"] | bool = True,
        true: ebac.Device | None = None,
        seconds: float = HOUR,
    ) -> float:
        """Return the most energy that the hand has drawn within a time [s], in J.

        Law and observer are made for the reference device with the sensor's `noise` [N] and what it shows of a force,
        `scale`; on a `true` device other than that they do not know of the difference.
        """
        stiffness, delay = self.wall
        known = ebac.Device(sensor=ebac.ForceSensor(noise=noise, scale=scale))
        pushes = ebac.Sine(
            centre=SURFACE + self.mean / self.stiffness,
            amplitude=self.amplitude / self.stiffness,
            frequency=self.frequency,
        )
        scenario = ebac.Scenario(
            device=known,
            hand=ebac.Hand(
                mass=self.mass, damping=self.damping, stiffness=self.stiffness, path=[pushes]
            ),
            environment=ebac.Wall(stiffness=stiffness, position=SURFACE),
            timing=ebac.Timing(delay=delay),
            seconds=seconds,
            observer=observer,
        )
        law = ebac.design("ebac", known, scenario.timing)
        if true is not None:
            scenario = scenario.replace(observer=scenario.designed_observer(), device=true)
        return max(0.0, -float(ebac.simulate(scenario, law).axis("true.energy").min()))


#: Those that searches found: at noise, without noise, and of hands up to 1.5 kg.
SWINGING = (
    Swung(10, 60, 325, 3.41, 2.99, 1.0, (1e4, 0)),
    Swung(10, 60, 325, 3.41, 2.99, 1.0),
    Swung(9.5, 149, 850, 6.5, 4.6, 1.55, (1e4, 2)),
    Swung(1.5, 101, 240, 5.3, 5.1, 1.43, (2e4, 2)),
)
#: Standard deviations of the noise of the force sensor [N].
NOISES = (0.0, 0.01, 0.03)


#: Random hands that draw where the force sensor shows too little, and what it shows of a force.
PUSHING = (
    Swung(0.37, 51, 227, 11.1, 11.1, 1.34),
    Swung(5.7, 77, 186, 14.0, 14.0, 0.8),
    Swung(10, 60, 325, 3.41, 2.99, 1.0),
)
SCALES = (0.99, 0.998, 1.0, 1.002, 1.01)


#: Without and with an observer that learns the scale.
OBSERVERS: tuple[tuple[str, Literal["learns-scale"] | bool], ...] = (
    ("as calibrated", True),
    ("learned", "learns-scale"),
)


def scaled(printed: Printed) -> str:
    """What each hand draws in an hour where the scale of the force is wrong, and the worst of random hands."""
    lines = []
    for one in PUSHING:
        for name, observer in OBSERVERS:

            def measured(
                one: Swung = one, observer: Literal["learns-scale"] | bool = observer
            ) -> list[Row]:
                return [{f"{s:g}": one.drawn(0.03, s, observer=observer) for s in SCALES}]

            (row,) = printed.kept(f"swung-{one.mass:g}-{name}", measured)
            lines.append([one.label, name, *(f"{1e3 * row[f'{s:g}']:.0f} mJ" for s in SCALES)])
    hands = _random(60)
    for name, observer in OBSERVERS:

        def worst(observer: Literal["learns-scale"] | bool = observer) -> list[Row]:
            return [{f"{s:g}": _most(hands, s, observer) for s in SCALES}]

        (row,) = printed.kept(f"swung-random-{name}", worst)
        label = f"the worst of {len(hands)} random hands"
        lines.append([label, name, *(f"{1e3 * row[f'{s:g}']:.0f} mJ" for s in SCALES)])
    return table(["hand", "scale", *(_off(scale) for scale in SCALES)], lines)


def _most(hands: list[Swung], scale: float, observer: Literal["learns-scale"] | bool) -> float:
    return max(h.drawn(0.03, scale, observer=observer) for h in hands)


def _random(count: int) -> list[Swung]:
    """Return hands of 0.05 to 10 kg that swing with up to 14 N at 0.2 to 3 Hz on the wall of 10 kN/m."""
    rng = np.random.default_rng(1)
    hands = []
    for _ in range(count):
        mass, damping, stiffness, frequency = np.exp(
            rng.uniform(np.log([0.05, 3, 100, 0.2]), np.log([10, 150, 1000, 3]))
        )
        amplitude = rng.uniform(1, 14)
        mean = amplitude * max(1.0, rng.uniform(0.6, 2))
        hands.append(Swung(mass, damping, stiffness, mean, amplitude, frequency))
    return hands


def _off(scale: float) -> str:
    if scale == 1:
        return "exact"
    return f"{100 * abs(scale - 1):.2g} % too {'much' if scale > 1 else 'little'}"


#: Times that are not what law and observer are made for: what the table calls them, and the sensor or drive [s].
WRONG_TIMES: tuple[tuple[str, dict[str, float], dict[str, float]], ...] = (
    ("none", {}, {}),
    ("force 0.05 ms late", {"delay": 5e-5}, {}),
    ("force 0.1 ms late", {"delay": 1e-4}, {}),
    ("force 0.2 ms late", {"delay": 2e-4}, {}),
    ("sensor lag of 0.9 ms, declared 0.8 ms", {"lag": 9e-4}, {}),
    ("sensor lag of 0.7 ms, declared 0.8 ms", {"lag": 7e-4}, {}),
    ("current lag of 0.35 ms, declared 0.3 ms", {}, {"current_lag": 3.5e-4}),
    ("current lag of 0.4 ms, declared 0.3 ms", {}, {"current_lag": 4e-4}),
    ("current lag of 0.2 ms, declared 0.3 ms", {}, {"current_lag": 2e-4}),
)
#: The worst of some searched by a referee, and an ordinary one.
LATE = (
    Swung(3.64, 39.3, 272, 5.33, 4.9, 1.97),
    Swung(1, 20, 300, 6.0, 4.8, 1.5),
)


def timed(printed: Printed) -> str:
    """What hands draw where force or current come at other times than declared: two in an hour, 60 random in 5 min."""
    hands = [([one], HOUR) for one in LATE] + [(_random(60), MINUTES)]
    heads = [
        f"{LATE[0].label}, 1 h",
        f"{LATE[1].label}, 1 h",
        "the worst of 60 random hands, 5 min",
    ]
    lines = []
    for label, sensor, drive in WRONG_TIMES:
        true = ebac.Device(sensor=ebac.ForceSensor(noise=0.03, **sensor), drive=ebac.Drive(**drive))

        def measured(true: ebac.Device = true) -> list[Row]:
            return [
                {
                    name: max(h.drawn(0.03, observer=o, true=true, seconds=s) for h in some)
                    for name, o in OBSERVERS
                }
                for some, s in hands
            ]

        rows = printed.kept(f"late-{label}", measured)
        drawn = ["; ".join(f"{1e3 * row[name]:.0f} mJ" for name, _ in OBSERVERS) for row in rows]
        lines.append([label, *drawn])
    return table(["error", *heads], lines)


def energy(printed: Printed) -> str:
    """What each hand draws in an hour, with three noises of the sensor."""
    rows = printed.kept("swung", _measure)
    lines = [
        [one.label, one.where, *(f"{1e3 * row[f'{noise:g} N']:.0f} mJ" for noise in NOISES)]
        for one, row in zip(SWINGING, rows, strict=True)
    ]
    return table(
        ["hand", "wall, delay", "no noise", *(f"{noise:g} N" for noise in NOISES[1:])], lines
    )


def _measure() -> list[Row]:
    return [{f"{noise:g} N": one.drawn(noise) for noise in NOISES} for one in SWINGING]
