"""Simulated logs of one axis at 1 kHz, with encoder counts and a noisy force sensor.

The sensor of the logs written as CSV has no lag, because CSV has no field for it: a log of your own may need `--lag`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ebac._core import Port
    from ebac.trace import Trace

#: Noise of the force sensor in every log, standard deviation [N].
NOISE = 0.02


def arm() -> Trace:
    """Return a log of a hand that holds the handle still while the motor pushes it, 10 s.

    The motor's force is a multisine of 0.3 to 20 Hz and at most 6 N. `trace.scenario.hand` is the true hand: 0.35 kg,
    6 N s/m, 300 N/m.
    """
    from ebac._core import Device, ForceSensor, Free, Hand, Step
    from ebac.identify import excitation
    from ebac.scenario import Scenario
    from ebac.simulation import simulate

    _, force = excitation.multisine(6.0, low=0.3, high=20.0, seconds=10.0, tries=0)
    scenario = Scenario(
        device=Device(sensor=ForceSensor(noise=NOISE, lag=0.0)),
        hand=Hand(mass=0.35, damping=6.0, stiffness=300.0, path=Step(target=0.0)),
        environment=Free(),
        seconds=10.0,
    )
    return simulate(scenario, Perturbation(force.tolist()))


def tapping() -> Trace:
    """Return a log of a hand that taps at a wall of 10 kN/m, 0.8 times a second, under the law `ebac`, 10 s.

    `trace.scenario.hand` is the true hand: 0.35 kg, 6 N s/m, 300 N/m.
    """
    from ebac._core import Device, ForceSensor, Hand, Tapping
    from ebac.scenario import Scenario
    from ebac.simulation import simulate

    scenario = Scenario(
        device=Device(sensor=ForceSensor(noise=NOISE)),
        hand=Hand(mass=0.35, damping=6.0, stiffness=300.0, path=Tapping(frequency=0.8)),
        seconds=10.0,
    )
    return simulate(scenario, "ebac")


def press() -> Trace:
    """Return a log of a hand that presses into a wall of 10 kN/m from 1 s on, 4 s, under `ebac` on the encoder alone.

    `trace.scenario.hand` is the true hand: 0.15 kg, 6 N s/m, 300 N/m.
    """
    from ebac._core import Device, ForceSensor, Hand, Step
    from ebac.scenario import Scenario
    from ebac.simulation import simulate

    scenario = Scenario(
        device=Device(sensor=ForceSensor(noise=NOISE, lag=0.0)),
        hand=Hand(mass=0.15, damping=6.0, stiffness=300.0, path=Step(at=1.0)),
        seconds=4.0,
        observer=False,  # a wall that settles at once excites the arm too little
    )
    return simulate(scenario, "ebac")


def device() -> Trace:
    """Return a log of a device that a hand moves to and fro against a soft wall, 5 s.

    `trace.scenario.device` is the true device: 0.25 kg, 3 N s/m, 0.4 N of Coulomb friction, and a weight of 0.23 N
    towards +x.
    """
    from ebac._core import Device, ForceSensor, Hand, Mechanics, Wall
    from ebac.identify import excitation
    from ebac.scenario import Scenario
    from ebac.simulation import simulate

    t, x = excitation.multisine(0.03, low=0.2, high=4.0, seconds=5.0)
    scenario = Scenario(
        device=Device(
            mechanics=Mechanics(damping=3.0, coulomb=0.4, gravity=2.0),
            sensor=ForceSensor(noise=NOISE, lag=0.0),
        ),
        hand=Hand(mass=0.1, damping=10.0, stiffness=900.0, path=excitation.path(t, x)),
        environment=Wall(stiffness=500.0),
        seconds=5.0,
    )
    return simulate(scenario, "direct")


def sway() -> Trace:
    """Return a log of a hand that presses on a wall of 2 kN/m to and fro once a second, 15 s, under the law `ebac`.

    The force sensor shows 2 % too little, and the device has 0.1 N of Coulomb friction.
    """
    from ebac._core import Device, ForceSensor, Hand, Mechanics, Sine, Wall
    from ebac.scenario import Scenario
    from ebac.simulation import simulate

    scenario = Scenario(
        device=Device(
            mechanics=Mechanics(coulomb=0.1), sensor=ForceSensor(noise=NOISE, scale=0.98)
        ),
        hand=Hand(
            mass=0.5,
            damping=10.0,
            stiffness=600.0,
            path=Sine(centre=0.03, amplitude=0.015, frequency=1.0),
        ),
        environment=Wall(stiffness=2000.0),
        seconds=15.0,
    )
    return simulate(scenario, "ebac")


@dataclass
class Perturbation:
    """Apply a force that was planned for each tick [N], whatever the port does; 0 after the last one."""

    force: Sequence[float]
    tick: int = 0
    name = "perturbation"

    def reset(self) -> None:
        """Begin again."""
        self.tick = 0

    def step(self, port: Port) -> float:
        """Return the force of this tick [N]."""
        self.tick += 1
        return self.force[self.tick - 1] if self.tick <= len(self.force) else 0.0
