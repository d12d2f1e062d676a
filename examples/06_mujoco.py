"""A soft body in MuJoCo, felt at 1 kHz: the engine runs at 60 Hz, the loop renders its local model in every tick.

Needs pip install 'ebac[mujoco]'.
"""

import numpy as np

import ebac
from ebac.worlds import Bridge, EngineTiming, MujocoEngine

RATE = 60.0  # Hz
# A block of 6 x 6 x 6 cm, held at its back, and a ball of 3 cm that follows the handle.
SOFT = """
<mujoco>
  <option timestep="0.00208333" gravity="0 0 0" integrator="discrete" solver="CG" tolerance="1e-6"/>
  <worldbody>
    <flexcomp name="soft" type="grid" dim="3" count="4 4 4" spacing="0.02 0.02 0.02" pos="0.055 0 0"
              mass="0.3" radius="0.001">
      <elasticity young="3e4" poisson="0.2" damping="0.02"/>
      <contact selfcollide="none" solref="0.005 1"/>
      <pin gridrange="3 0 0 3 3 3"/>
    </flexcomp>
    <body name="tip" mocap="true"><geom type="sphere" size="0.015"/></body>
  </worldbody>
</mujoco>
"""

engine = MujocoEngine(SOFT, period=1 / RATE)
traces = {}
for name, held in (("force held", True), ("local model", False)):
    world = Bridge(engine, timing=EngineTiming(rate=RATE, compute=1 / RATE, jitter=0.01), held=held)
    hand = ebac.Hand(stiffness=300, path=[ebac.MinimumJerk(target=0.03)])
    scenario = ebac.Scenario(environment=world, hand=hand, seconds=2)
    traces[name] = ebac.simulate(scenario, "direct")
    x = 1e3 * traces[name]["x"][-600:]
    least = 1e3 * traces[name]["true.energy"].min()
    print(f"{name}: swings by {np.ptp(x):.2f} mm, least energy {least:.1f} mJ")

figure = ebac.plot.new_figure(8, 5)
above, below = figure.subplots(2, 1, sharex=True)
for name, trace in traces.items():
    above.plot(trace["t"], 1e3 * trace["x"], label=name)
    below.plot(trace["t"], trace["f_env"])
ebac.plot.dress(above, "position [mm]")
ebac.plot.dress(below, "force of the world [N]")
below.set_xlabel("t [s]")
above.legend()
figure.suptitle(f"A soft body of MuJoCo at {RATE:g} Hz, without a law")
figure.savefig("mujoco.png")
