"""Coverage of hands that follow a path at a wall, without the motor's column: `python tests/recordings/walled_path.py`.

The logs are not from this project's simulator: hand and device are one linear system, discretised exactly, and the wall
is a spring and a damper computed from counts, whose force stands for a tick and changes somewhere between two rows.
"""

import sys

import numpy as np

from ebac.identify import Recording, Target, fit_arm
from ebac.identify.parameters import HAND

DT, PARTS, SECONDS = 1e-3, 4, 10.0


def log(seed: int) -> tuple[Recording, Target, dict[str, float]]:
    """Return one log of a random hand, its target and what is true of the hand."""
    from scipy.linalg import expm

    random = np.random.default_rng([909, seed])

    def between(low: float, high: float) -> float:  # log-uniform
        return float(low * (high / low) ** random.random())

    mass, damping, reach = between(0.05, 1.2), between(2, 20), random.uniform(0.01, 0.04)
    stiffness = between(80, min(1000, 30 / reach))
    all_mass, all_damping = mass + between(0.1, 0.6), damping + between(1, 5)
    wall, count = between(1e3, 6e3), float(random.choice([5e-6, 1e-5, 3e-5]))
    noise = between(0.01, 0.1)
    waves, phases = random.uniform(0.2, 3, 5), random.random(5)
    rows, h = round(SECONDS / DT), DT / PARTS
    fine = h * np.arange(rows * PARTS + 1)
    angles = 2 * np.pi * (np.outer(fine, waves) + phases)
    target = 0.4 * reach * np.sin(angles).sum(axis=1)
    A = np.zeros((5, 5))  # of place, velocity; motor, target and its slope
    A[0, 1] = A[3, 4] = 1
    A[1] = np.array([-stiffness, -all_damping, 1, stiffness, 0]) / all_mass
    E = expm(A * h)
    steps_at, zero = int(random.integers(0, PARTS)), random.uniform(0, count)
    x, v, motor, asked, before = float(target[0]), 0.0, 0.0, 0.0, 0.0
    place, force = np.zeros(rows), np.zeros(rows)
    for i in range(rows):
        aim = target[i * PARTS]
        place[i] = count * np.floor((x + zero) / count)
        a = (motor - all_damping * v - stiffness * (x - aim)) / all_mass
        force[i] = -(mass * a + damping * v + stiffness * (x - aim))
        pushes = -wall * place[i] - 0.4 * (place[i] - before) / DT if place[i] > 0 else 0.0
        before = place[i]
        for part in range(PARTS):
            if part == steps_at:
                motor, asked = asked, pushes
            now, then = target[i * PARTS + part : i * PARTS + part + 2]
            x, v = (E @ np.array([x, v, motor, now, (then - now) / h]))[:2]
    t = DT * np.arange(rows)
    force += noise * random.standard_normal(rows)
    recording = Recording(name=f"path {seed}", t=t, x=place, force=force, count=count)
    truth = {"M0": mass, "B0": damping, "K0": stiffness}
    return recording, Target.following(target[:-1:PARTS]), truth


def main(logs: int) -> None:
    """Print how many intervals contain the true value, and the largest error."""
    results = []
    for seed in range(logs):
        recording, target, truth = log(seed)
        results.append((fit_arm(recording, target), truth))
    for name in HAND:
        found = [(r[name], truth[name]) for r, truth in results if r[name].determined]
        held = sum(e.low <= true <= e.high for e, true in found)
        off = max(abs(e.value / true - 1) for e, true in found)
        half = float(np.median([(e.high - e.low) / 2 / true for e, true in found]))
        print(
            f"{name}: {held} of {len(found)}, off by {100 * off:.2g} % at most, half an interval is {100 * half:.2g} %"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 120)
