"""Two axes: a hand pressed into a corner, onto a wall that stands on a slant, and past a disc."""

from math import pi

import numpy as np

import ebac

device = ebac.Device(kinematics=ebac.Linear(axes=2))
hand = ebac.Hand(path=[ebac.Step(target=0.03), ebac.Step(target=0.02, at=0.5)])
corner = ebac.Corner(first=ebac.Wall(), second=ebac.Wall(angle=pi / 2))
slanted = ebac.Wall(angle=pi / 6)
disc = ebac.Disc(x=0.03, y=0.012, radius=0.02)

for name, world in (("corner", corner), ("slanted wall", slanted), ("disc", disc)):
    scenario = ebac.Scenario(device=device, hand=hand, environment=world, seconds=4)
    trace = ebac.simulate(scenario, "ebac")
    rest = trace[3.0:]
    x = rest["true.x"].mean(axis=0)
    f = rest["f_applied"].mean(axis=0)
    swing = np.ptp(rest["true.x"], axis=0).max()
    print(
        f"{name}: rests at ({1e3 * x[0]:.3f}, {1e3 * x[1]:.3f}) mm, "
        f"pushed with ({f[0]:.2f}, {f[1]:.2f}) N, swings {1e3 * swing:.3f} mm"
    )
