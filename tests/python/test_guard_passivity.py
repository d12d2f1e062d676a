"""The guard of EBAC: whatever is asked, the port gives out no more than e(0) and what its page of theory excepts.

The rest of the law may be anything, so its other pieces are drawn at random too, and an adversary that reads the
port takes the place of the environment.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import ebac

#: Largest pull of a hand the guard is told [N]; hands that pulled harder are outside its assumption.
PULL = 60.0
#: More than is argued, what numbers leave open [J].
OVER = 1e-6


@dataclass
class Adversary:
    """An environment that asks for any force, in front of a law: `manner` chooses how it hurts."""

    law: Any
    manner: str
    size: float  # N
    hold: int  # ticks
    seed: int = 0
    name = "adversary"

    def reset(self) -> None:
        self.law.reset()
        self.random = np.random.default_rng(self.seed)
        self.tick, self.asked = 0, 0.0

    def step(self, port: ebac.Port) -> float:
        port.f_env = self.asked = getattr(self, self.manner)(port)
        self.tick += 1
        return float(self.law.step(port))

    def noise(self, port: ebac.Port) -> float:
        """A new random force every `hold` ticks."""
        new = self.tick % self.hold == 0
        return self.size * float(self.random.normal()) if new else self.asked

    def push(self, port: ebac.Port) -> float:
        """Along the motion, as hard as it can."""
        return -self.size * float(np.sign(port.v)) if abs(port.v) > 1e-3 else self.asked

    def switch(self, port: ebac.Port) -> float:
        """To and fro."""
        return self.size if self.tick // self.hold % 2 else -self.size

    def drive(self, port: ebac.Port) -> float:
        """A negative damper that never lets go."""
        return -100 * self.size * port.v + 1e-6

    def wall(self, port: ebac.Port) -> float:
        """A wall far too stiff."""
        return max(0.0, 2500 * self.size * (port.x + 1e-3))


MANNERS = ("noise", "push", "switch", "drive", "wall")

pieces = st.fixed_dictionaries({
    "continuity": st.booleans(),
    "recovery": st.booleans(),
    "injection": st.booleans(),
    "heaviest_hand": st.sampled_from([0.0, 0.05, 1.5]),
    "kp": st.sampled_from([0.0, 0.1]),
})  # fmt: skip


@st.composite
def hands(draw: st.DrawFn) -> ebac.Hand:
    stiffness = draw(st.sampled_from([20.0, 100.0, 300.0, 700.0, 1500.0]))
    step = st.builds(ebac.Step, target=st.floats(-10, 10).map(lambda f: f / stiffness))
    swing = st.builds(
        ebac.Sine,
        centre=st.just(0.0),
        amplitude=st.floats(0, 15).map(lambda f: f / stiffness),
        frequency=st.floats(0.1, 30),
    )
    return ebac.Hand(
        mass=draw(st.floats(0.02, 1.0)),
        damping=draw(st.floats(0, 20)),
        stiffness=stiffness,
        path=draw(st.one_of(step, swing)),
        release_at=draw(st.sampled_from([float("inf"), 0.3])),
    )


@st.composite
def scenarios(draw: st.DrawFn, lag: float) -> ebac.Scenario:
    device = ebac.Device(
        mechanics=ebac.Mechanics(
            damping=draw(st.floats(0.2, 8)), coulomb=draw(st.sampled_from([0.0, 0.5]))
        ),
        drive=ebac.Drive(current_lag=lag),
        encoder=ebac.Encoder(counts_per_turn=1 << draw(st.integers(10, 19))),
    )
    return ebac.Scenario(
        device=device,
        hand=draw(hands()),
        timing=ebac.Timing(delay=draw(st.integers(0, 2))),
        seconds=0.6,
    )


adversaries = st.fixed_dictionaries({
    "manner": st.sampled_from(MANNERS),
    "size": st.sampled_from([5.0, 20.0, 40.0, 200.0]),
    "hold": st.sampled_from([1, 2, 5, 20]),
    "seed": st.integers(0, 1000),
})  # fmt: skip


def given_out(
    scenario: ebac.Scenario, hostile: dict[str, Any], **changes: Any
) -> tuple[float, float, float]:
    """Energy the port gave out at most, what no encoder can see of it, and the hand's hardest pull [J, J, N]."""
    law = ebac.design("ebac", scenario.device, scenario.known_timing, pull=PULL, **changes)
    trace = ebac.simulate(scenario, Adversary(law, **hostile))
    turned = np.abs(np.diff(trace["f_applied"], prepend=0.0)).sum()
    pull = ebac.contact(trace).most_pull_N
    assert pull is not None
    return -float(trace["true.energy"].min()), scenario.device.count * float(turned), pull


@pytest.mark.parametrize("lag", [0.0, 3e-4])
@given(data=st.data(), hostile=adversaries, pieces=pieces, reserve=st.sampled_from([0, 1e-3, 0.01]))
@settings(max_examples=4 * settings.default.max_examples)
@pytest.mark.slow
def test_no_environment_takes_out_more_than_the_reserve(
    lag: float, data: Any, hostile: dict[str, Any], pieces: Any, reserve: float
) -> None:
    scenario = data.draw(scenarios(lag))
    energy, unseen, pull = given_out(scenario, hostile, reserve=reserve, **pieces)
    assume(pull <= PULL)
    assert energy <= reserve + unseen + OVER


@pytest.mark.xfail(
    strict=True,
    reason="mean force times displacement is not the work where both change within a tick",
)
def test_a_force_that_turns_every_other_tick_behind_a_lag_takes_no_more_either() -> None:
    """Without delay, injection and continuity, by an adversary that asks for 40 N to and fro."""
    scenario = ebac.Scenario(
        device=ebac.Device(
            mechanics=ebac.Mechanics(damping=3.0), encoder=ebac.Encoder(counts_per_turn=1 << 18)
        ),
        hand=ebac.Hand(
            mass=0.18,
            damping=15,
            stiffness=20,
            path=ebac.Sine(centre=0.0, amplitude=0.14, frequency=16.5),
        ),
        timing=ebac.Timing(delay=0),
        seconds=0.6,
    )
    hostile = {"manner": "switch", "size": 40.0, "hold": 2}
    bare: dict[str, Any] = {"injection": False, "continuity": False, "kp": 0.0}
    energy, unseen, pull = given_out(scenario, hostile, **bare)
    assert pull <= PULL
    assert energy <= 0.01 + unseen + OVER


walls = st.builds(
    ebac.Wall,
    stiffness=st.sampled_from([1e3, 1e4, 1e5, 1e6]),
    damping=st.sampled_from([0.0, 5.0, 50.0]),
    position=st.floats(-0.005, 0.005),
)


@given(data=st.data(), wall=walls, pieces=pieces)
@settings(max_examples=2 * settings.default.max_examples)
def test_no_wall_takes_out_more_than_the_reserve(data: Any, wall: ebac.Wall, pieces: Any) -> None:
    scenario = data.draw(scenarios(3e-4)).replace(environment=wall)
    law = ebac.design("ebac", scenario.device, scenario.known_timing, pull=PULL, **pieces)
    trace = ebac.simulate(scenario, law)
    found = ebac.contact(trace)
    assume((found.most_pull_N or 0) <= PULL)
    turned = np.abs(np.diff(trace["f_applied"], prepend=0.0)).sum()
    assert -trace["true.energy"].min() <= 0.01 + scenario.device.count * turned + OVER


def test_without_the_guard_the_same_adversaries_take_far_more() -> None:
    """The test above can fail: switched off, the guard leaves joules to take."""
    scenario = ebac.Scenario(
        device=ebac.Device(drive=ebac.Drive(current_lag=0.0)),
        hand=ebac.Hand(stiffness=100, path=ebac.Step(target=0.05)),
        seconds=0.6,
    )
    bare: dict[str, Any] = {"injection": False, "heaviest_hand": 0.05}
    worst = {True: 0.0, False: 0.0}
    for guard in worst:
        for manner in MANNERS:
            for hold in (1, 2, 5, 20):
                hostile = {"manner": manner, "size": 40.0, "hold": hold}
                energy, unseen, _ = given_out(scenario, hostile, guard=guard, **bare)
                worst[guard] = max(worst[guard], energy - unseen)
    assert worst[True] <= 0.01
    assert worst[False] > 0.1
