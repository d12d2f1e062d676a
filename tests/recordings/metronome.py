"""How exact taps must be for `--tapping`: `python tests/recordings/metronome.py [HANDS]`."""

import sys

import numpy as np

from ebac import Device, ForceSensor, Hand, Recorded, Scenario, Wall, simulate
from ebac.identify import Recording, Target, fit_arm

#: Deviation of the instants from those of the metronome [s].
OFF = (0.0, 0.003, 0.01, 0.03)
RATE, SECONDS, HIGH, LOW = 0.8, 10.0, 0.03, -0.015


def log(seed: int, off: float) -> Recording:
    """Return a log of a hand that taps by a metronome, each tap off by a random time."""
    random = np.random.default_rng(seed)
    t = np.arange(0, SECONDS + 0.5, 1e-3)
    at = np.arange(1, int(2 * RATE * SECONDS) + 1) * 0.5 / RATE
    passed = np.searchsorted(np.sort(at + random.normal(0, off, at.size)), t, side="right")
    x = np.where(passed % 2 == 0, HIGH, LOW)
    hand = Hand(
        mass=float(random.uniform(0.1, 0.8)),
        damping=float(random.uniform(3, 12)),
        stiffness=float(random.uniform(150, 500)),
        path=Recorded(t=t.tolist(), x=x.tolist()),
    )
    scenario = Scenario(
        hand=hand,
        device=Device(sensor=ForceSensor(noise=0.03)),
        environment=Wall(stiffness=3e3),
        seconds=SECONDS,
        seed=seed,
    )
    return Recording.from_trace(simulate(scenario, "ebac"))


def main(hands: int) -> None:
    """Print for each exactness how many logs determine all of the hand, and how many nothing of it."""
    for off in OFF:
        every = nothing = 0
        for seed in range(hands):
            recording = log(seed, off)
            result = fit_arm(recording, Target.tapping(RATE, SECONDS))
            lost = {"M0", "B0", "K0"}.intersection(result.undetermined)
            every += not lost
            nothing += result.nothing_determined
        print(f"taps off by {1e3 * off:g} ms: {every} of {hands} determined, nothing in {nothing}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
