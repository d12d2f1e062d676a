"""Random arms on random devices, to try the method on; everything here is a simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ebac._core import (
    Device,
    ForceSensor,
    Free,
    Hand,
    Mechanics,
    Recorded,
    Sine,
    Step,
    Tapping,
    Wall,
)
from ebac.scenario import Scenario

#: What the hand does, and its share of the arms: `free` never touches a wall and does not determine the arm.
TASKS = {"tapping": 0.4, "tracking": 0.3, "press": 0.2, "free": 0.1}
LAWS = ("ebac", "eba", "tca-damped")


@dataclass(frozen=True, kw_only=True)
class Case:
    """One arm on one device under one law."""

    number: int
    task: str
    law: str
    scenario: Scenario

    def truth(self) -> dict[str, float]:
        """Return the true values by the names of a fit."""
        hand = self.scenario.hand
        out = {"M0": hand.mass, "B0": hand.damping, "K0": hand.stiffness}
        path = hand.path[0]
        if isinstance(path, Tapping):
            out |= {"X0/1": path.target, "X0/2": path.rest}
        elif isinstance(path, Step):
            out["X0"] = path.target
        return out

    def device_truth(self) -> dict[str, float]:
        """Return the true values of the device by the names of a fit."""
        device = self.scenario.device
        mechanics = device.mechanics
        return {
            "M_h": device.mass,
            "B_h": mechanics.damping,
            "coulomb": mechanics.coulomb,
            "weight": mechanics.handle_mass * mechanics.gravity,
        }


def draw(number: int, seed: int, seconds: float = 10.0) -> Case:
    """Draw case `number`; the same numbers give the same case."""
    random = np.random.Generator(np.random.PCG64([seed, number]))

    def between(low: float, high: float) -> float:  # log-uniform
        return float(low * (high / low) ** random.random())

    task = str(random.choice(list(TASKS), p=list(TASKS.values())))
    reach = float(random.uniform(0.01, 0.04))
    stiffness = between(80, min(1000, 30 / reach))
    makers: dict[str, Callable[[], Step | Tapping | Recorded]] = {
        "tapping": lambda: Tapping(
            target=reach, rest=-float(random.uniform(0.005, 0.02)), frequency=between(0.5, 2)
        ),
        "tracking": lambda: _wandering(random, reach, seconds),
        "press": lambda: Step(target=reach),
        "free": lambda: Step(target=reach),
    }
    path = makers[task]()
    hand = Hand(mass=between(0.05, 1.2), damping=between(2, 20), stiffness=stiffness, path=path)
    device = Device(
        mechanics=Mechanics(
            handle_mass=between(0.05, 0.5), damping=between(1, 5), coulomb=between(0.005, 0.1)
        ),
        sensor=ForceSensor(noise=between(0.01, 0.1), quantum=0.01),
    )
    wall = Wall(stiffness=between(1e3, 10e3))
    scenario = Scenario(
        hand=hand,
        device=device,
        environment=Free() if task == "free" else wall,
        seconds=seconds,
        seed=int(random.integers(1, 2**31)),
    )
    return Case(number=number, task=task, law=str(random.choice(LAWS)), scenario=scenario)


def _wandering(random: np.random.Generator, reach: float, seconds: float) -> Recorded:
    """Return a path on a screen: five slow sines around the wall."""
    t = np.arange(0, seconds + 0.01, 0.005)
    waves = sum(
        np.sin(2 * np.pi * (f * t + random.random())) for f in random.uniform(0.2, 3.0, size=5)
    )
    return Recorded(t=t.tolist(), x=(0.4 * reach * waves).tolist())


def draw_device(number: int, seed: int, seconds: float = 10.0) -> Case:
    """Draw case `number` with a device of more friction, tilted so that its handle weighs."""
    case = draw(number, seed, seconds)
    random = np.random.Generator(np.random.PCG64([seed, number, 1]))
    device = case.scenario.device
    mechanics = device.mechanics.replace(
        coulomb=float(0.02 * 40 ** random.random()), gravity=float(random.uniform(-3, 3))
    )
    scenario = case.scenario.replace(device=device.replace(mechanics=mechanics))
    return replace(case, scenario=scenario)


def draw_sway(number: int, seed: int, seconds: float = 15.0) -> Case:
    """Draw case `number`: a hand that presses on a soft wall to and fro, a sensor of another scale than the motor."""
    random = np.random.Generator(np.random.PCG64([seed, number, 2]))

    def between(low: float, high: float) -> float:
        return float(random.uniform(low, high))

    wall, hand = between(1e3, 3e3), between(300, 1000)
    depth = between(5, 12) * (1 / wall + 1 / hand)
    path = Sine(centre=depth, amplitude=depth * between(0.5, 1.0), frequency=between(0.5, 1.5))
    scenario = Scenario(
        device=Device(
            mechanics=Mechanics(
                handle_mass=between(0.05, 0.5), damping=between(1, 5), coulomb=between(0, 0.3)
            ),
            sensor=ForceSensor(
                noise=between(0.01, 0.1),
                quantum=0.01,
                bias=between(-0.3, 0.3),
                scale=between(0.9, 1.1),
            ),
        ),
        hand=Hand(mass=between(0.1, 1.2), damping=between(3, 20), stiffness=hand, path=path),
        environment=Wall(stiffness=wall, position=0.0),
        seconds=seconds,
        seed=int(random.integers(1, 2**31)),
    )
    return Case(number=number, task="sway", law="ebac", scenario=scenario)
