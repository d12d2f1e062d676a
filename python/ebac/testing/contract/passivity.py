"""A law declared passive gives out no energy, in any environment."""

from __future__ import annotations

import math
from collections import deque
from typing import Any, ClassVar

import pytest
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st

import ebac
from ebac.testing.claims import assert_passive
from ebac.testing.contract.numbers import inherited
from ebac.testing.contract.subject import Subject, of_passive

#: One tick of a hostile world: how it moves, what force it asks for, and dt / T.
moves = st.one_of(
    st.tuples(st.just("by"), st.just(0.0) | st.floats(-0.01, 0.01)),
    st.tuples(st.just("dearest"), st.floats(0, 2)),
)
asked = st.one_of(
    st.tuples(st.just("wall"), st.floats(0, 1e6)),
    st.tuples(st.just("force"), st.floats(-1e3, 1e3)),
    st.tuples(st.just("against"), st.floats(0, 1e3)),
)


def worlds(ticks: st.SearchStrategy[float]) -> st.SearchStrategy[list[Any]]:
    """Draw some ticks of one kind, then some of another."""
    stretch = st.tuples(st.tuples(moves, asked, ticks), st.integers(1, 10))
    return st.lists(stretch, max_size=8).map(
        lambda all_: [tick for tick, n in all_ for _ in range(n)]
    )


even, late = worlds(st.just(1.0)), worlds(st.floats(0.1, 1.9))
#: A world that takes energy out of a bare spring.
PUMP = [(("by", 1e-3), ("wall", 1e4), 1.0)] * 5 + [(("dearest", 1.0), ("wall", 1e4), 1.0)] * 5


def bare(damping: float) -> ebac.DeviceFacts:
    """Return a device without lag and without counts: what the account of these worlds is exact for."""
    return ebac.DeviceFacts(damping=damping, current_lag=0, count=0)


def least_energy(law: Any, world: list[Any], b: float, timing: ebac.Timing) -> tuple[float, float]:
    """Return the lowest W + D [J] of a law whose commands act `delay` ticks late, and the sum of all sizes [J].

    "dearest" is the displacement that takes the most energy out of the force that acts, -F / (2 B);
    "against" asks for the opposite of the last command.
    """
    law.reset()
    law.step(ebac.Port())
    under_way = deque([0.0] * (timing.delay + 1))
    x = energy = least = size = 0.0
    for (how, amount), (kind, strength), share in world:
        dt = share * timing.dt
        applied = under_way.popleft()
        dx = amount if how == "by" else -amount * applied * dt / (2 * b) if b > 0 else 0.0
        x += dx
        energy += applied * dx + b / dt * dx * dx
        size += abs(applied * dx) + b / dt * dx * dx
        least = min(least, energy)
        f_env = max(0.0, strength * x) if kind == "wall" else strength
        if kind == "against":
            f_env = -math.copysign(strength, under_way[-1] if under_way else applied)
        under_way.append(
            law.step(ebac.Port(x=x, dx=dx, v=dx / dt, dt=dt, f_env=f_env, f_applied=applied))
        )
    return least, size


class Passivity:
    """No more energy leaves the port than the reserve."""

    timing_of_law: ClassVar[ebac.Timing] = ebac.Timing()

    @of_passive
    @settings(inherited, max_examples=4 * inherited.max_examples)
    @given(
        world=even,
        delay=st.integers(0, 2),
        dt=st.sampled_from([2.5e-4, 1e-3, 4e-3]),
        b=st.floats(0.01, 50),
    )
    @example(world=PUMP, delay=1, dt=1e-3, b=2.0)
    def test_a_passive_law_keeps_its_bound_in_any_world(
        self, subject: Subject, world: list[Any], delay: int, dt: float, b: float
    ) -> None:
        self._survives(subject, world, ebac.Timing(dt=dt, delay=delay), b)

    @of_passive
    @settings(inherited, phases=[Phase.explicit, Phase.generate])
    @given(world=late, delay=st.integers(0, 2))
    @example(
        world=[(("by", 1e-3), ("force", 100.0), 1.0), (("dearest", 1.0), ("force", 0.0), 1.9)],
        delay=0,
    )
    def test_a_passive_law_keeps_its_bound_when_ticks_come_late(
        self, subject: Subject, world: list[Any], delay: int
    ) -> None:
        if subject.designed:  # one that knows nothing of time promises nothing of late ticks
            self._survives(subject, world, ebac.Timing(delay=delay, jitter=0.45), 2.0)

    @of_passive
    @pytest.mark.parametrize("delay", [0, 1, 2])
    @pytest.mark.parametrize("stiffness", [1e3, 1e4, 1e5])
    def test_no_more_energy_leaves_the_simulated_port_than_was_lent(
        self, subject: Subject, delay: int, stiffness: float
    ) -> None:
        timing = ebac.Timing(delay=delay) if subject.designed else self.timing_of_law
        scenario = ebac.Scenario(
            device=subject.contract.device,
            environment=ebac.Wall(stiffness=stiffness),
            timing=timing,
            seconds=1.0,
        )
        law = subject.made(timing)
        reserve = float(getattr(law, "reserve", 0.0))
        assert_passive(ebac.simulate(scenario, law), reserve=reserve)

    def _survives(self, subject: Subject, world: list[Any], timing: ebac.Timing, b: float) -> None:
        if subject.designed:
            law = subject.made(timing, bare(b))
        else:  # made for one device and one timing
            timing, b = self.timing_of_law, subject.contract.device.facts.damping
            law = subject.made()
        least, size = least_energy(law, world, b, timing)
        reserve = float(getattr(law, "reserve", 0.0))
        assert least >= -reserve - 1e-12 * (size + 1e-6), (
            f"{subject.name} is declared passive and gave out {-least:.6g} J with b = {b:g} N s/m, {timing}"
        )
