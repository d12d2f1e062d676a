"""How honest are the intervals on logs of `recorded_arm`?

python tests/recordings/measure.py [logs a level] [--held] [--seed N]
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from time import process_time, sleep

import numpy as np
from recorded_arm import LEVELS, TASKS, RecordedArm, recorded

from ebac import identify

#: Threads of BLAS burn the processor for so long after the simulator needed them [s]; no part of a fit.
SETTLES = 0.1


@dataclass(frozen=True)
class Judged:
    """One parameter of one log."""

    level: str
    task: str
    name: str
    error: float  # of the value
    deviations: float  # from the truth, in those of the tool
    held: bool
    determined: bool
    seconds: float  # of processor time, for the whole log


def judged(log: RecordedArm, folder: Path) -> list[Judged]:
    """Write a log, read it and fit it as a user would."""
    path = folder / "log.npz"
    columns = {"t": log.t, "x": log.x, "force": log.force}
    np.savez(path, **(columns if log.path is None else columns | {"target": log.path}))
    sleep(SETTLES)
    began = process_time()
    recording = identify.load(path)
    if recording.target is None:
        target = identify.Target(switches=log.switches, segments=log.segments)
    else:
        target = identify.Target.following(recording.target)
    result = identify.fit_arm(recording, target)
    rows = [(result.estimates[name], truth) for name, truth in log.truth.items()]
    seconds = process_time() - began
    return [
        Judged(
            level=log.level,
            task=log.task,
            name=e.name,
            error=(e.value - truth) / truth,
            deviations=(e.value - truth) / max((e.high - e.low) / 3.92, 1e-300),
            held=e.low <= truth <= e.high,
            determined=e.determined,
            seconds=seconds,
        )
        for e, truth in rows
    ]


def every(
    logs: int, levels: tuple[str, ...] = LEVELS, seed: int = 1, *, held: bool = False
) -> Iterator[Judged]:
    """Judge so many logs of each level, the tasks in turn."""
    with tempfile.TemporaryDirectory() as folder:
        for level in levels:
            for number in range(logs):
                task = TASKS[number % len(TASKS)]
                log = recorded(number, level=level, task=task, seed=seed, held=held)
                yield from judged(log, Path(folder))


def line(name: str, found: list[Judged]) -> str:
    """Return coverage and bias of what is said to be determined, in words."""
    known = [j for j in found if j.determined]
    if not known:
        return f"{name:22} {len(found):4d} estimates, none determined"
    error = np.array([j.error for j in known])
    return (
        f"{name:22} {len(known):4d} of {len(found):4d} determined, "
        f"covered {100 * np.mean([j.held for j in known]):5.1f} %, "
        f"bias {100 * np.median(error):+6.2f} % (mean {100 * error.mean():+6.2f} %), "
        f"deviations {np.std([j.deviations for j in known]):.2f}, "
        f"worst {100 * np.abs(error).max():.1f} %, "
        f"{1e3 * np.median([j.seconds for j in found]):.0f} ms"
    )


def main() -> None:
    """Print one line a level, a task and a parameter."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("logs", nargs="?", type=int, default=80, help="logs of each level")
    parser.add_argument("--held", action="store_true", help="the motor moves in steps")
    parser.add_argument("--seed", type=int, default=1, help="of the logs")
    asked = parser.parse_args()
    found = list(every(asked.logs, seed=asked.seed, held=asked.held))
    for level in LEVELS:
        mine = [j for j in found if j.level == level]
        print(line(level, mine))
        for task in TASKS:
            print(line(f"  {task}", [j for j in mine if j.task == task]))
        for name in ("M0", "B0", "K0"):
            print(line(f"  {name}", [j for j in mine if j.name == name]))


if __name__ == "__main__":
    main()
