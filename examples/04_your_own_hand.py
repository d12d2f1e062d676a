"""A hand with a recorded path and tremor that lets go; the trace as a table and as files. Needs pandas."""

import numpy as np

import ebac

t = np.linspace(0, 2, 50)
reach = ebac.Recorded(t=t, x=0.03 * np.sin(0.5 * np.pi * t) ** 2)
hand = ebac.Hand(
    mass=0.3, stiffness=400, path=reach, tremor_amplitude=0.2e-3, tremor_frequency=9, release_at=1.5
)
scenario = ebac.Scenario(hand=hand, environment=ebac.Wall(stiffness=5e3, position=0.01), seconds=2)

trace = ebac.simulate(scenario, "ebac")
contact = trace.to_pandas().query("f_env > 0")
print(contact[["x", "f_env", "f_applied", "law.energy"]].describe().round(6))

trace.to_csv("hand.csv")
trace.to_npz("hand.npz")
scenario.save("hand.toml")
assert ebac.Trace.from_npz("hand.npz").scenario == scenario
