"""What ebac itself takes: a tick, a run of a sweep, a map, two threads, memory."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np

from ebac._core import Free, SweepProgress
from ebac._core import RunLimits as Limits
from ebac._util.arrays import Values
from ebac._util.cores import usable_cores
from ebac.laws import design
from ebac.peers.row import quickest
from ebac.scenario import Scenario
from ebac.simulation import simulate
from ebac.studies.maps import AXES, PRESETS, stability_map

#: Ticks of the run whose memory is measured.
LONG = 1_000_000


def tick(scenario: Scenario, repeats: int) -> float:
    """Return the time of a tick of the closed loop under EBAC [s]: law, account and row included."""
    law: Any = design("ebac", scenario.device, scenario.timing)
    return float(1e-9 * law._time_tick(scenario.setup(), repeats))


def sweep_tick(scenario: Scenario, repeats: int) -> float:
    """Return the time of a tick in a sweep under EBAC [s]: one thread, metrics, the run's setting up included."""
    law: Any = design("ebac", scenario.device, scenario.timing)
    setups, ticks = [scenario.setup()], round(scenario.seconds / scenario.timing.dt) + 1
    return (
        quickest(repeats, lambda: type(law)._sweep(setups, [law], 1, Limits(), SweepProgress()))
        / ticks
    )


def free_run(scenario: Scenario) -> Values:
    """Return the positions [m] in free motion, one a tick after the start."""
    trace = simulate(scenario.replace(environment=Free(), seconds=1.0), "direct")
    return np.asarray(trace.axis("true.x")[1:], float)


def map_seconds(side: int) -> float:
    """Return how long a K-B map of side x side runs of 2 s takes [s], everything but the figure."""
    x, y = PRESETS["KB"]
    xs, ys = AXES[x].values(side), AXES[y].values(side)
    return quickest(1, lambda: stability_map("ebac", x, y, xs=xs, ys=ys))


def thread_efficiency(scenario: Scenario, runs: int, repeats: int) -> float:
    """Return the time of one thread over twice that of two, the best of each, in turn."""
    law: Any = design("ebac", scenario.device, scenario.timing)
    setups = [scenario.replace(seed=i).setup() for i in range(runs)]

    def sweep(threads: int) -> None:
        type(law)._sweep(setups, [law] * runs, threads, Limits(), SweepProgress())

    one = two = float("inf")
    for _ in range(repeats):
        one = min(one, quickest(1, lambda: sweep(1)))
        two = min(two, quickest(1, lambda: sweep(2)))
    return one / (2 * two)


def has_two_cores() -> bool:
    """Whether two threads can run at once."""
    return usable_cores() >= 2


def memory(ticks: int = LONG) -> tuple[int, int]:
    """Return bytes per row, and by how much a run of `ticks` raises the peak memory of a process [bytes]."""
    code = f"""
import ebac, pathlib, re
# Of this program alone: getrusage would count what its parent had.
status = pathlib.Path("/proc/self/status")
peak = lambda: 1024 * int(re.search(r"VmHWM:\\s*(\\d+)", status.read_text())[1])
ebac.simulate(ebac.Scenario(seconds=0.1))
before = peak()
trace = ebac.simulate(ebac.Scenario(seconds={ticks - 1} * 1e-3))
print(trace["t"].strides[0], peak() - before)
"""
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    row, peak = run.stdout.split()
    return int(row), int(peak)
