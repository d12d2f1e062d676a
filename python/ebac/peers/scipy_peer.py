"""SciPy: `solve_ivp` called tick by tick, as one writes a sampled loop with it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ebac._util.arrays import Values
from ebac.peers.mujoco_peer import spring
from ebac.peers.row import Plant, program, quickest

COUNT = 300


def ticks(plant: Plant, *, wall: bool, repeats: int) -> tuple[float, Values]:
    """Return the time of a tick [s] at the default tolerance, and the positions [m]."""
    solve: Any = program("scipy.integrate").solve_ivp
    places: list[float] = []

    def rate(_: float, z: Values, u: float) -> list[float]:
        pull = plant.stiffness * (plant.target - z[0]) - plant.damping * z[1] - z[2]
        return [z[1], pull / plant.mass, (u - z[2]) / plant.lag]

    def run() -> None:
        places.clear()
        force = spring(plant)
        z = np.zeros(3)
        for _ in range(COUNT):
            u = force(z[0]) if wall else 0.0
            z = solve(rate, (0, plant.step), z, args=(u,)).y[:, -1]
            places.append(float(z[0]))

    taken = quickest(repeats, run) / COUNT
    return taken, np.array(places)
