"""A random hand in a random world of several bodies: the same numbers give the same scenario."""

from __future__ import annotations

from math import pi
from zlib import crc32

import numpy as np

from ebac._core import Device, ForceSensor, Gimbal, Hand, Linear, Sine, Swing, Timing
from ebac._util.arguments import named
from ebac.scenario import Scenario
from ebac.studies.world_kinds import KINDS, direction
from ebac.worlds import Body, Elastic, World

#: Devices by name: the reference device with more axes, and on the gimbal of the paper's joystick.
DEVICES: dict[str, Device] = {
    "2-axes": Device(kinematics=Linear(axes=2)),
    "3-axes": Device(kinematics=Linear(axes=3)),
    "gimbal": Device(kinematics=Gimbal()),
}
#: Time constant of the filter of a force sensor of which nothing else is said [s].
LAG = ForceSensor().lag
#: Length of a run [s].
SECONDS = 4.0
#: Largest way of a body that moves, to either side [m], and its frequencies [Hz].
SWING, SWING_FREQUENCIES = 4e-3, (0.5, 3.0)
#: Coulomb's coefficient; one world in three has friction.
FRICTION = 0.4


def random_scenario(
    kind: str,
    device: str,
    index: int,
    *,
    stiffness: float = 10e3,
    delay: int = 1,
    moving: bool = False,
    noise: float = 0.03,
    lag: float = LAG,
    seed: int = 1,
) -> Scenario:
    """Return hand `index` with its own world. Stiffness, delay, noise, lag and `moving` change nothing else.

    `random_worlds` has the ranges from which hand and world are drawn.

    Parameters
    ----------
    kind : str
        Of the world, a name of `KINDS`.
    device : str
        A name of `DEVICES`.
    index : int
        Which hand, from 0.
    stiffness : float
        Of every surface [N/m], [0, 1e7].
    delay : int
        Until a command acts [samples], [0, 8].
    moving : bool
        Whether each body swings in a direction of its own, from where it stands still.
    noise : float
        Of the force sensor, standard deviation [N], [0, 100]; laws with a `force_noise` take 10 at most.
    lag : float
        Time constant of its filter [s], [0, 0.1].
    seed : int
        Of all hands, at least 0.

    Raises
    ------
    KeyError
        For an unknown kind or device.
    ValueError
        For a number out of its range.
    """
    chosen = named("kind of world", kind, KINDS)
    base = named("device for random worlds", device, DEVICES)
    axes = base.axes
    random = np.random.Generator(np.random.PCG64([seed, crc32(f"{kind} {device}".encode()), index]))
    solids = chosen.draw(random, axes)
    friction = FRICTION if random.random() < 1 / 3 else 0.0
    hand = _hand(random, axes)
    noise_seed = int(random.integers(2**31))
    motions = [_swing(random, axes) for _ in solids]  # last: bodies that stand still are the same
    bodies = [
        Body(solid=solid, material=Elastic(stiffness=stiffness), friction=friction, motion=motion)
        for solid, motion in zip(solids, motions if moving else [Swing()] * len(solids), strict=True)
    ]  # fmt: skip
    return Scenario(
        device=base.replace(sensor=ForceSensor(noise=noise, lag=lag)),
        hand=hand,
        environment=World(*bodies),
        timing=Timing(delay=delay),
        seconds=SECONDS,
        seed=noise_seed,
    )


def _hand(random: np.random.Generator, axes: int) -> Hand:
    path = [
        Sine(
            centre=random.uniform(-0.01, 0.02),
            amplitude=random.uniform(1e-3, 15e-3),
            frequency=random.uniform(0.3, 3.0),
            phase=random.uniform(0, 2 * pi),
        )
        for _ in range(axes)
    ]
    return Hand(
        mass=10 ** random.uniform(-1.7, 0.0),
        damping=random.uniform(2.0, 20.0),
        stiffness=10 ** random.uniform(2.0, 3.0),
        path=path,
    )


def _swing(random: np.random.Generator, axes: int) -> Swing:
    x, y, z = (random.uniform(0.0, SWING) * direction(random, axes)).tolist()
    frequency = random.uniform(*SWING_FREQUENCIES)
    return Swing(amplitude_x=x, amplitude_y=y, amplitude_z=z, frequency=frequency)
