"""MuJoCo: the same mass, spring and damper, free and against a plane without friction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ebac._util.arrays import Values
from ebac.peers.row import Plant, program, quickest

#: Runs in one rollout, their steps, and substeps where a law in Python steps in.
RUNS, STEPS, SUBSTEPS = 8, 6000, 10
#: Damping of its wall [N s/m], without which it rattles, and the impedance: MuJoCo's own default.
WALL_DAMPING, IMPEDANCE = 20.0, 0.9


def _xml(plant: Plant, step: float, *, wall: bool) -> str:
    # A contact asks for accelerations, and at rest holds M k / (1 - d) against a push.
    k, b = plant.wall * (1 - IMPEDANCE) / plant.mass, WALL_DAMPING / plant.mass
    soft = f'condim="1" solref="{-k} {-b}" solimp="{IMPEDANCE} {IMPEDANCE} 0.001"'
    plane = f'<geom type="plane" size="1 1 1" pos="0.01 0 0" xyaxes="0 1 0 0 0 -1" {soft}/>'
    return f"""<mujoco>
      <option timestep="{step}" gravity="0 0 0"/>
      <worldbody>{plane if wall else ""}<body>
        <joint name="x" type="slide" axis="1 0 0" stiffness="{plant.stiffness}"
          springref="{plant.target}" damping="{plant.damping}"/>
        <geom type="sphere" size="0.01" mass="{plant.mass}" {soft}/>
      </body></worldbody>
      <actuator><motor joint="x"/></actuator>
    </mujoco>"""


def rollout(plant: Plant, *, wall: bool, threads: int, repeats: int) -> tuple[float, Values]:
    """Return the time per step and thread [s] of MuJoCo's threaded rollout, and one run's positions [m]."""
    mujoco: Any = program("mujoco")
    rollouts: Any = program("mujoco.rollout")
    model = mujoco.MjModel.from_xml_string(_xml(plant, plant.step, wall=wall))
    size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    start = np.zeros((RUNS, size))
    data = [mujoco.MjData(model) for _ in range(threads)]
    with rollouts.Rollout(nthread=threads if threads > 1 else 0) as pool:
        states, _ = pool.rollout(model, data, start, nstep=STEPS)
        taken = quickest(repeats, lambda: pool.rollout(model, data, start, nstep=STEPS))
    return threads * taken / (RUNS * STEPS), np.asarray(states[0, :, 1], float)


def ticks(plant: Plant, repeats: int) -> float:
    """Return the time of a tick [s] with ten substeps and a wall in Python."""
    mujoco: Any = program("mujoco")
    model = mujoco.MjModel.from_xml_string(_xml(plant, plant.step / SUBSTEPS, wall=False))
    count = 1000

    def run() -> None:
        data = mujoco.MjData(model)
        wall, step = spring(plant), mujoco.mj_step
        for _ in range(count):
            data.ctrl[0] = -wall(data.qpos[0])
            step(model, data, SUBSTEPS)

    return quickest(repeats, run) / count


def spring(plant: Plant) -> Callable[[float], float]:
    """Return the law in Python: the force of the wall, unchanged."""
    return lambda x: plant.wall * x if x > 0 else 0.0
