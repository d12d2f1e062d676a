"""The comparison: one list of rows, every ratio from one run on one machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ebac._core import Free
from ebac._util.arrays import Values
from ebac._util.cores import usable_cores
from ebac.metrics import contact, ideal_rest
from ebac.peers import mujoco_peer, own, scipy_peer
from ebac.peers.row import PeerRow, Plant, program
from ebac.scenario import Scenario
from ebac.simulation import simulate

#: Subjects, and the goal of each.
FREE, WALL, LAW = (
    "a 1 ms step, free motion",
    "a 1 ms step, in contact",
    "a 1 ms step, law in Python",
)
AIMS = {FREE: "at least 20", WALL: "at least 40"}
SOLVE_AIM = "at least 500"
#: What each program does in a step, and what not.
NOTES = {
    "ebac": "plant with current and sensor lag, exact; encoder, delay, wall, the law EBAC, energy account, a row of "
    "the log; one thread",
    "ebac, in a sweep": "the same, of a run that is kept as metrics: no rows, but the setting up and the metrics "
    "included; one thread",
    "MuJoCo": "its threaded rollout of mass, spring and damper, in contact a sphere on a plane as stiff as the wall, a "
    "row of the state; no law, lag, delay, encoder, account; per step and thread, the better of one thread and all",
    "MuJoCo, ten substeps": "steps of 0.1 ms, the wall a spring in Python every 1 ms; no lag, delay, encoder, account",
    "SciPy solve_ivp": "RK45 at its default tolerance, called every 1 ms; plant and current lag, the wall a spring in "
    "Python; no delay, encoder, account",
}


def compare(
    *, repeats: int = 20, side: int = 200, step: Callable[[str], None] = lambda name: None
) -> list[PeerRow]:
    """Time the closed loop of ebac and the same plant, step and wall in MuJoCo and SciPy, in one run.

    Parameters
    ----------
    repeats : int
        Runs of each measurement; the quickest counts.
    side : int
        Of the stability map, side x side runs of 2 s.
    step : callable
        Called with what comes next, `STEPS` times.

    Returns
    -------
    list of PeerRow

    Raises
    ------
    ImportError
        When MuJoCo or SciPy is not installed.
    """
    program("mujoco")
    program("scipy.integrate")
    scenario = Scenario(observer=False)  # the others have none
    return [
        *_steps(scenario, repeats, step),
        *_errors(scenario, step),
        *_sweeps(scenario, repeats, side, step),
        *_memory(step),
    ]


#: How often `compare` calls `step`.
STEPS = 9


def _steps(scenario: Scenario, repeats: int, step: Callable[[str], None]) -> Iterator[PeerRow]:
    plant = Plant.of(scenario)
    few = max(3, repeats // 5)
    for subject, wall in ((FREE, False), (WALL, True)):
        step(f"ebac, {subject}")
        setting = scenario if wall else scenario.replace(environment=Free())
        mine = own.tick(setting, repeats)
        yield _time(subject, "ebac", mine, mine)
        yield _time(subject, "ebac, in a sweep", own.sweep_tick(setting, repeats), mine)
        step(f"MuJoCo, {subject}")
        threads = sorted({1, usable_cores()})
        theirs = min(
            mujoco_peer.rollout(plant, wall=wall, threads=n, repeats=few)[0] for n in threads
        )
        yield _time(subject, "MuJoCo", theirs, mine, AIMS[subject])
        if wall:
            step("MuJoCo, ten substeps")
            slow = mujoco_peer.ticks(plant, few)
            yield _time(LAW, "MuJoCo, ten substeps", slow, mine)
            step("SciPy")
            slowest, _ = scipy_peer.ticks(plant, wall=True, repeats=few)
            yield _time(LAW, "SciPy solve_ivp", slowest, mine, SOLVE_AIM)


def _time(subject: str, whose: str, seconds: float, mine: float, target: str = "") -> PeerRow:
    return PeerRow(
        subject=subject, program=whose, value=seconds, unit="s", times_ebac=seconds / mine,
        target=target, note=NOTES[whose],
    )  # fmt: skip


def _errors(scenario: Scenario, step: Callable[[str], None]) -> Iterator[PeerRow]:
    """Compare the positions in free motion with the closed form, and the rest with the ideal one."""
    step("errors")
    plant = Plant.of(scenario)
    _, theirs = mujoco_peer.rollout(plant, wall=False, threads=1, repeats=1)
    _, solved = scipy_peer.ticks(plant, wall=False, repeats=1)
    for whose, places in (
        ("ebac", own.free_run(scenario)),
        ("MuJoCo", theirs),
        ("SciPy solve_ivp", solved),
    ):
        yield PeerRow(
            subject="largest error, free motion", program=whose, value=_error(plant, places), unit="m",
            note="against the closed form of mass, spring, damper",
        )  # fmt: skip

    ideal = ideal_rest(scenario) or 0.0
    _, held = mujoco_peer.rollout(plant, wall=True, threads=1, repeats=1)
    mine = contact(simulate(scenario, "ebac")).rest_m
    for whose, rest in (("ebac", mine), ("MuJoCo", float(held[-1]))):
        yield PeerRow(
            subject="rest in contact", program=whose, value=rest, unit="m",
            note=f"an ideal wall: {1e3 * ideal:.3f} mm",
        )  # fmt: skip


def _error(plant: Plant, places: Values) -> float:
    t: Values = plant.step * np.arange(1.0, len(places) + 1)
    return float(np.abs(places - plant.free(t)).max())


def _sweeps(
    scenario: Scenario, repeats: int, side: int, step: Callable[[str], None]
) -> Iterator[PeerRow]:
    step(f"a map of {side} x {side}")
    aim = "at most 10 s on two cores" if side == 200 else ""
    yield PeerRow(
        subject=f"map, {side} x {side} runs of 2 s", program="ebac", value=own.map_seconds(side), unit="s",
        target=aim, note=f"K-B map under EBAC, metrics and not traces, {usable_cores()} cores",
    )  # fmt: skip
    step("two threads")
    if own.has_two_cores():
        # Short, often: on a busy machine two cores are free at once only for moments.
        share = own.thread_efficiency(scenario.replace(seconds=0.5), 100, 10 * repeats)
        yield PeerRow(
            subject="two threads", program="ebac", value=share, unit="1", target="at least 0.9",
            note="time of one thread over twice that of two, 100 runs of 0.5 s",
        )  # fmt: skip


def _memory(step: Callable[[str], None]) -> Iterator[PeerRow]:
    step("memory")
    row, peak = own.memory()
    million = f"{own.LONG:,} ticks"
    yield PeerRow(subject="a row of the log", program="ebac", value=float(row), unit="B",
                  note="one axis under EBAC, every column")  # fmt: skip
    yield PeerRow(subject=f"peak memory, {million}", program="ebac", value=float(peak), unit="B",
                  note="by how much one run raises it")  # fmt: skip
