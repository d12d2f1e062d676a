"""Random adversaries against the guard of EBAC, drawn as `tests/python/test_guard_passivity.py` draws them."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from printed import Printed, table

import ebac

TESTS = Path(__file__).parents[2] / "tests/python"
#: Numbers of the same seed are the same on every machine.
SEED, RUNS = 1, 3000


@dataclass(frozen=True, kw_only=True)
class Draw:
    """What is drawn: lag of the current loop [s], delays [samples], whether the law damps, how the adversary asks."""

    lag: float
    delays: tuple[int, ...]
    injection: tuple[bool, ...]
    words: tuple[str, str, str]
    manners: tuple[str, ...] = ("noise", "push", "switch", "drive", "wall")
    sizes: tuple[float, ...] = (5.0, 20.0, 40.0, 200.0)


DRAWS = (
    Draw(lag=0.0, delays=(0, 1, 2), injection=(True, False), words=("no lag", "on or off", "0, 1, 2")),
    Draw(lag=3e-4, delays=(0,), injection=(True,), words=("0.3 ms", "on", "0")),
    Draw(lag=3e-4, delays=(1, 2), injection=(True, False), words=("0.3 ms", "on or off", "1, 2")),
    Draw(lag=3e-4, delays=(0,), injection=(False,), words=("0.3 ms", "off", "0")),
    Draw(
        lag=3e-4, delays=(0,), injection=(False,), manners=("switch",), sizes=(20.0, 40.0, 200.0),
        words=("0.3 ms", "off, a force to and fro by 40 N or more", "0"),
    ),
)  # fmt: skip


def adversaries(printed: Printed) -> str:
    """How many adversaries of each kind took out more than is argued."""
    del printed  # no command draws them
    rows = []
    for draw in DRAWS:
        excess = _excess(draw)
        broke = excess[excess > 1e-6]  # J, what numbers leave open
        worst = f"{1e3 * broke.max():.2g} mJ" if len(broke) else ""
        lag, damping, delay = draw.words
        rows.append([str(len(excess)), lag, damping, delay, str(len(broke)), worst])
    return table(
        ["runs", "current loop", "damping of the law", "delay", "broke the bound", "worst"], rows
    )


def _excess(draw: Draw) -> np.ndarray:
    """Energy [J] beyond e(0) and what no encoder sees, for every hand that stays within the declared pull."""
    sys.path.insert(0, str(TESTS))
    from test_guard_passivity import PULL, given_out

    random = np.random.default_rng(SEED)
    found = []
    for _ in range(RUNS):
        reserve = float(random.choice([0.0, 1e-3, 0.01]))
        hostile = {
            "manner": str(random.choice(draw.manners)),
            "size": float(random.choice(draw.sizes)),
            "hold": int(random.choice([1, 2, 5, 20])),
            "seed": int(random.integers(1000)),
        }
        energy, unseen, pull = given_out(
            _scenario(draw, random), hostile, reserve=reserve, **_pieces(draw, random)
        )
        if pull <= PULL:
            found.append(energy - reserve - unseen)
    return np.array(found)


def _pieces(draw: Draw, random: np.random.Generator) -> dict[str, Any]:
    return {
        "continuity": bool(random.integers(2)),
        "recovery": bool(random.integers(2)),
        "injection": bool(random.choice(draw.injection)),
        "heaviest_hand": float(random.choice([0.0, 0.05, 1.5])),
        "kp": float(random.choice([0.0, 0.1])),
    }


def _scenario(draw: Draw, random: np.random.Generator) -> ebac.Scenario:
    device = ebac.Device(
        mechanics=ebac.Mechanics(
            damping=random.uniform(0.2, 8), coulomb=float(random.choice([0.0, 0.5]))
        ),
        drive=ebac.Drive(current_lag=draw.lag),
        encoder=ebac.Encoder(counts_per_turn=1 << int(random.integers(10, 20))),
    )
    return ebac.Scenario(
        device=device,
        hand=_hand(random),
        timing=ebac.Timing(delay=int(random.choice(draw.delays))),
        seconds=0.6,
    )


def _hand(random: np.random.Generator) -> ebac.Hand:
    stiffness = float(random.choice([20.0, 100.0, 300.0, 700.0, 1500.0]))
    swings = bool(random.integers(2))
    amplitude, frequency = random.uniform(0, 15) / stiffness, random.uniform(0.1, 30)
    step = random.uniform(-10, 10) / stiffness
    return ebac.Hand(
        mass=random.uniform(0.02, 1.0),
        damping=random.uniform(0, 20),
        stiffness=stiffness,
        path=ebac.Sine(centre=0.0, amplitude=amplitude, frequency=frequency)
        if swings
        else ebac.Step(target=step),
        release_at=float(random.choice([np.inf, 0.3])),
    )
