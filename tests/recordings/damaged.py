"""What a held force, a filtered position and an early motor do to a fit: `python tests/recordings/damaged.py [HANDS]`.

Of simulated hands that tap, follow a path, or are held while the motor shakes them; each log is read from a file.
"""

import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, filtfilt, lfilter, lfilter_zi

from ebac import Device, ForceSensor, Free, Hand, Scenario, Step, simulate
from ebac.datasets.logs import Perturbation
from ebac.identify import Recording, Target, excitation, fit_arm, load
from ebac.identify.cases import draw
from ebac.identify.parameters import HAND

Values = NDArray[np.float64]
Log = tuple[Recording, Target, dict[str, float]]

SECONDS = 6.0
LOW_PASS = butter(2, 30, fs=1000)


def shaken(hands: int) -> Iterator[Log]:
    """Yield logs of hands that are held in one place while the motor shakes them."""
    _, force = excitation.multisine(6.0, low=0.3, high=20.0, seconds=SECONDS, tries=0)
    for seed in range(hands):
        random = np.random.default_rng([77, seed])
        mass, damping, stiffness, noise = random.uniform((0.1, 3, 150, 0.01), (0.8, 12, 600, 0.06))
        hand = Hand(mass=mass, damping=damping, stiffness=stiffness, path=Step(target=0.0))
        scenario = Scenario(
            device=Device(sensor=ForceSensor(noise=noise)),
            hand=hand,
            environment=Free(),
            seconds=SECONDS,
            seed=seed + 1,
        )
        recording = Recording.from_trace(simulate(scenario, Perturbation(force)))
        yield recording, Target.held(), {"M0": mass, "B0": damping, "K0": stiffness}


def moving(hands: int) -> Iterator[Log]:
    """Yield logs of hands that tap or follow a path."""
    number = 0
    while hands:
        case = draw(number, 41, SECONDS)
        number += 1
        if case.task in ("tapping", "tracking"):
            hands -= 1
            recording = Recording.from_trace(simulate(case.scenario, case.law))
            yield recording, Target.of(case.scenario.hand, recording.t), case.truth()


def held(values: Values, every: float) -> Values:
    """Return what a reader shows that reads every so many rows, and holds between."""
    rows = np.arange(len(values))
    return values[np.round(np.floor(rows / every) * every).astype(int)]


def passed(x: Values) -> Values:
    """Return a position behind a low-pass of 30 Hz."""
    return np.asarray(lfilter(*LOW_PASS, x, zi=lfilter_zi(*LOW_PASS) * x[0])[0])


def early(r: Recording) -> Recording:
    """Return a recording whose motor stands one row early."""
    assert r.motor is not None
    return replace(r, motor=np.append(r.motor[1:], r.motor[-1]))


DAMAGES: dict[str, Callable[[Recording], Recording]] = {
    "none": lambda r: r,
    "force held for 10 rows": lambda r: replace(r, force=held(r.channels()["force"], 10)),
    "force held for 9.97 rows": lambda r: replace(r, force=held(r.channels()["force"], 9.97)),
    "position behind 30 Hz": lambda r: replace(r, x=passed(r.x)),
    "position behind 30 Hz, zero phase": lambda r: replace(r, x=filtfilt(*LOW_PASS, r.x)),
    "motor one row early": early,
}


def from_file(r: Recording, target: Target, file: Path) -> tuple[Recording, Target]:
    """Write a log and read it again."""
    columns = {name: v for name, v in r.channels().items() if name in ("t", "x", "force", "motor")}
    np.savez(file, **columns, **({} if target.path is None else {"target": target.path}))
    found = load(file, lag=r.lag, current_lag=r.current_lag)
    return found, target if found.target is None else Target.following(found.target)


def main(hands: int) -> None:
    """Print for each damage how many parameters are determined, wrong, and wrong without a remark."""
    with tempfile.TemporaryDirectory() as folder:
        for what, logs in (("shaken", list(shaken(hands))), ("moving", list(moving(hands)))):
            for damage, damaged in DAMAGES.items():
                counts = Counter[str]()
                for recording, target, truth in logs:
                    read, known = from_file(damaged(recording), target, Path(folder) / "log.npz")
                    result = fit_arm(read, known)
                    counts["logs with a remark"] += bool(result.misses)
                    for name in HAND:
                        e, true = result[name], truth[name]
                        wrong = e.determined and abs(e.value / true - 1) > 0.05
                        beside = wrong and not e.low <= true <= e.high
                        counts["determined"] += e.determined
                        counts["off by 5 %"] += wrong
                        counts["and outside"] += beside
                        counts["without a remark"] += beside and not result.misses
                print(f"{what}, {damage}: {', '.join(f'{n} {w}' for w, n in counts.items())}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
