"""Hands that press on a wall for minutes or an hour: the energy that they draw, and when their wall is limited."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from printed import Printed, Row, table

import ebac
from ebac._util.plural import plural

#: Length of a run [s], and of what is averaged [s]; from then on a hand rests [s].
HOUR, WINDOW, RESTS = 3600.0, 1.0, 100.0
#: Where the wall is, and to where each hand moves within 3 s [m].
SURFACE, TARGET = 0.01, 0.03
#: Share of the force below which a wall counts as limited.
LIMITED = 0.9


@dataclass(frozen=True)
class Held:
    """A hand: mass [kg], damping [N s/m], stiffness [N/m], target [m]; its wall [N/m], delay [samples], noise [N]."""

    mass: float
    damping: float
    stiffness: float
    wall: tuple[float, int] = (1e4, 1)
    noise: float = 0.03
    target: float = TARGET

    @property
    def label(self) -> str:
        """What the table calls the hand."""
        hand = f"{self.mass:g} kg, {self.damping:g} N s/m, {self.stiffness:g} N/m"
        if self.target != TARGET:
            hand += f", presses with {self.stiffness * (self.target - SURFACE):.2g} N"
        return hand if self.noise else f"{hand}; no noise"

    @property
    def where(self) -> str:
        """What the table calls its wall."""
        stiffness, delay = self.wall
        return f"{1e-3 * stiffness:g} kN/m, {plural(delay, 'sample')}"

    @property
    def name(self) -> str:
        """What its numbers are kept under."""
        stiffness, delay = self.wall
        parts = (self.mass, self.damping, self.stiffness, stiffness, delay, self.noise)
        gently = "" if self.target == TARGET else f"-{self.target:g}"
        return f"held-{'-'.join(f'{part:g}' for part in parts)}{gently}"

    def scenario(self, seed: int) -> ebac.Scenario:
        """Return the run of an hour."""
        stiffness, delay = self.wall
        return ebac.Scenario(
            device=ebac.Device(sensor=ebac.ForceSensor(noise=self.noise)),
            hand=ebac.Hand(
                mass=self.mass,
                damping=self.damping,
                stiffness=self.stiffness,
                path=[ebac.MinimumJerk(target=self.target, duration=3.0)],
            ),
            environment=ebac.Wall(stiffness=stiffness, position=SURFACE),
            timing=ebac.Timing(delay=delay),
            seconds=HOUR,
            seed=seed,
        )


#: Hands that draw: first the four of the page's script, then hostile ones.
DRAWING = (
    Held(0.15, 6, 300),
    Held(0.05, 20, 100),
    Held(1, 20, 100),
    Held(0.754, 36, 134),
    Held(1, 40, 100),
    Held(1, 60, 100),
    Held(1, 100, 100),
    Held(3, 70, 100),
    Held(6, 60, 50),
    Held(10, 40, 50, target=SURFACE + 0.008),
    Held(10, 50, 100, target=SURFACE + 0.006),
    Held(6.7, 180, 699),
    Held(7.5, 156, 81, (1e4, 2)),
    Held(3, 100, 200, (1e4, 2)),
    Held(3, 100, 200, (2e4, 1)),
    Held(3, 100, 1000, (1e4, 2)),
    Held(1, 20, 100, noise=0.0),
    Held(1, 100, 100, noise=0.0),
    Held(1.5, 100, 300, (3.5e4, 2), noise=0.0),
)
#: Hands that lose their wall, and the noises that they are tried with.
LOSING = (
    Held(1, 100, 100),
    Held(1, 60, 100),
    Held(1, 60, 200, (2e4, 1)),
    Held(0.1, 100, 200, (2e4, 2)),
    Held(1, 20, 100, (3.5e4, 2)),
    Held(3, 60, 1000, (1e4, 2)),
    Held(1.5, 25, 50, (3.5e4, 2)),
)
SEEDS = (1, 2)


def energy(printed: Printed) -> str:
    """What each hand draws in an hour, the power while it has its wall, and when the wall is limited."""
    rows = []
    for one in DRAWING:
        (found,) = _measured(printed, one, seed=1)
        rows.append(
            [
                one.label,
                one.where,
                f"{1e3 * found['drawn_J']:.3g} mJ",
                f"{1e6 * found['power_W']:.2g} µW",
                _after([found]),
            ]
        )
    heads = ["hand", "wall, delay", "drawn in an hour", "power at rest", "limited after"]
    return table(heads, rows)


def limited(printed: Printed) -> str:
    """When the force of a hand is limited, with two noises of the sensor, and how deep it is after the hour."""
    rows = []
    for one in LOSING:
        found = [_measured(printed, one, seed)[0] for seed in SEEDS]
        deep = sorted({round(1e3 * row["too_deep_m"], 1) for row in found})
        rows.append(
            [
                one.label,
                one.where,
                _after(found),
                f"{' to '.join(f'{d:.1f}' for d in deep)} mm",
            ]
        )
    return table(["hand", "wall, delay", "limited after", "too deep after an hour"], rows)


def _after(found: Sequence[Row]) -> str:
    times = [row["limited_s"] for row in found]
    return ", ".join("-" if time is None else f"{time:.0f} s" for time in times)


def _measured(printed: Printed, one: Held, seed: int) -> list[Row]:
    return printed.kept(f"{one.name}-{seed}", lambda: [_measure(one, seed)])


def _measure(one: Held, seed: int) -> Row:
    scenario = one.scenario(seed)
    trace = ebac.simulate(scenario, "ebac")
    drawn = trace.axis("true.energy")
    ticks = round(WINDOW / scenario.timing.dt)
    admitted = trace.axis("law.admitted")
    whole = admitted[: len(admitted) // ticks * ticks].reshape(-1, ticks)
    low = np.flatnonzero(np.mean(whole < LIMITED, axis=1) > 0.5)
    end = int(low[0]) if len(low) else int(HOUR)
    first = int(min(RESTS, end / 2))
    stiffness, _ = one.wall
    rest = (stiffness * SURFACE + one.stiffness * one.target) / (stiffness + one.stiffness)
    return {
        "drawn_J": max(0.0, -float(drawn.min())),
        "power_W": -float(drawn[end * ticks - 1] - drawn[first * ticks]) / (end - first),
        "limited_s": end if len(low) else None,
        "too_deep_m": float(trace.axis("true.x")[-ticks:].mean() - rest),
    }
