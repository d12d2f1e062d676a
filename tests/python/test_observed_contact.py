"""A long contact under `ebac` with the observer: what it draws, the stiffness it sees, the estimate that comes back."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import ebac
from ebac.studies import scenario_changes as to

NOISY = ebac.Device(sensor=ebac.ForceSensor(noise=0.03))


def pressed(stiffness: float, *, path: Any, **more: Any) -> ebac.Trace:
    wall = ebac.Wall(stiffness=stiffness, position=0.01, damping=more.pop("damping", 0.0))
    hand = ebac.Hand(mass=0.15, damping=10.0, stiffness=300.0, path=path)
    return ebac.simulate(ebac.Scenario(device=NOISY, environment=wall, hand=hand, **more), "ebac")


@pytest.mark.parametrize("frequency", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("stiffness", [10e3, 20e3])
def test_a_press_that_varies_slowly_keeps_its_wall(stiffness: float, frequency: float) -> None:
    """An estimate that lags by a tenth of a count, or a charge for each, once spent the account in 10 s."""
    trace = pressed(
        stiffness,
        path=ebac.Sine(centre=0.03, amplitude=5e-3, frequency=frequency),
        seconds=40.0,
    )
    late = trace["t"] > 20
    assert trace["law.admitted"][late].min() > 0.9
    deepest = trace["true.x"][late].max() - 0.01
    assert deepest < 300 * 0.025 / stiffness + 3 * NOISY.count


@pytest.mark.parametrize(
    "hands",
    [
        pytest.param(ebac.Operators.grid()[::3], id="20"),
        pytest.param(ebac.Operators.grid(), id="60", marks=[pytest.mark.slow, pytest.mark.weekly]),
    ],
)
@pytest.mark.parametrize("friction", [0.1, 0.3])
@pytest.mark.parametrize("condition", ["d2K35", "slow-waves-K20", "slow-press-d2K20"])
def test_declared_friction_costs_no_wall(
    condition: str, friction: float, hands: ebac.Operators
) -> None:
    """Learned as a disturbance, it cost up to 24 of the 60 hands theirs, and 29 mJ were drawn in a window."""
    device = NOISY.replace(mechanics=NOISY.mechanics.replace(coulomb=friction))
    base = ebac.Scenario(device=device)
    [row] = ebac.study(hands, ["ebac"], [condition], base=base).rows
    assert row.exact_and_still == row.hands
    assert row.least_energy_J == 0
    assert row.most_drawn_J is not None
    assert row.most_drawn_J < 1e-3


@pytest.mark.parametrize("late", [0.0, 1e-4, 3e-4, 5e-4])
@pytest.mark.parametrize("stiffness", [30.0, 100.0, 300.0, 1000.0])
def test_the_first_contact_with_a_soft_world_does_not_click(stiffness: float, late: float) -> None:
    """The law counted with a stiff wall until it had met the world: 40 N for 1 ms on 30 N/m, then 3 N.

    `late` is a way [m], so that each hand lands at another part of a tick.
    """
    wall = ebac.Wall(stiffness=stiffness, position=0.01 - late)
    force = ebac.simulate(ebac.Scenario(device=NOISY, environment=wall, seconds=0.5))["f_cmd"]
    first = int(np.argmax(force != 0))
    assert 0 < force[first] < 1.3 * force[first + 1 : first + 5].min()


def test_a_slow_press_is_quiet_in_a_fast_loop() -> None:
    """A motion of less than a fiftieth of a count in each tick never showed the stiffness: 4 of 12 were quiet."""
    device = NOISY.replace(encoder=ebac.Encoder(counts_per_turn=256))
    rng = np.random.default_rng(1)
    scenarios = []
    for seed in range(12):
        stiffness, force, seconds = (rng.uniform(*r) for r in ((100, 500), (0.5, 5), (2, 6)))
        hand = ebac.Hand(
            mass=rng.uniform(0.1, 1.0),
            damping=rng.uniform(1, 5),
            stiffness=stiffness,
            path=[ebac.MinimumJerk(target=force / stiffness, duration=seconds)],
        )
        scenarios.append(
            ebac.Scenario(
                device=device, hand=hand, timing=ebac.Timing(dt=5e-4), seconds=10.0, seed=seed
            )
        )
    found = ebac.sweep(scenarios, "ebac")
    assert found.good.all()


@pytest.mark.parametrize("delay", [0, 1, 2])
def test_the_velocity_is_predicted_without_lag_in_slow_motion(delay: int) -> None:
    path = ebac.Sine(centre=0.03, amplitude=13e-3, frequency=2.0)
    trace = pressed(10e3, path=path, seconds=4.0, timing=ebac.Timing(delay=delay))
    rows = np.flatnonzero(trace["t"] > 1)[: -delay - 2]
    truth = trace["true.v"][rows + delay + 1]
    guess = trace["est.v_act"][rows]
    assert 0.85 < np.dot(guess, truth) / np.dot(truth, truth) < 1.15


@pytest.mark.parametrize("damping", [0.0, 20.0, 40.0])
@pytest.mark.parametrize("stiffness", [300.0, 3e3])
def test_the_stiffness_seen_is_the_walls_whatever_its_damping(
    stiffness: float, damping: float
) -> None:
    trace = pressed(stiffness, damping=damping, path=ebac.Step(target=0.03), seconds=2.0)
    inside = (trace["t"] > 0.1) & (trace["f_env"] > 0)
    seen = trace["law.slope"][inside]
    assert np.median(seen) == pytest.approx(stiffness, rel=0.02)
    assert seen.max() < 1.1 * stiffness


def test_an_estimate_that_comes_back_knows_nothing_of_the_contact_it_left() -> None:
    """The hand presses three times harder while the sensor is silent."""
    silent = to.device("sensor", stops_at=1.0, resumes_at=3.0)
    path = ebac.Recorded(t=[0.0, 0.5, 1.2, 2.0], x=[0.0, 0.02, 0.02, 0.05])
    hand = ebac.Hand(mass=0.15, damping=10.0, stiffness=300.0, path=path)
    base = ebac.Scenario(
        device=NOISY, hand=hand, environment=ebac.Wall(stiffness=20e3), seconds=4.0
    )
    trace = ebac.simulate(silent(base), "ebac")
    back = (trace["est.weight"] == 1) & (trace["t"] > 3.02) & (trace["t"] < 3.3)
    assert back.any()
    assert np.abs(trace["law.f_d"] - trace["f_env"])[back][:10].max() < 0.2


def test_the_force_shown_ends_with_the_force_of_the_world() -> None:
    """Lifted off slowly, what is shown stays between zero and twice the world's force."""
    path = ebac.Recorded(t=[0.0, 0.5, 2.0, 4.0], x=[0.0, 0.03, 0.03, 0.005])
    trace = pressed(20e3, path=path, seconds=4.5)
    inside = (trace["t"] > 1.5) & (trace["f_env"] > 0)
    shown, asked = trace["law.f_d"][inside], trace["f_env"][inside]
    assert asked.min() < 0.3
    assert (shown >= 0).all()
    assert (shown <= 2 * asked + 1e-9).all()


@pytest.mark.parametrize(
    ("condition", "friction", "good"), [("d0K10", 0.05, 53), ("d1K20", 0.1, 47), ("d2K20", 0.1, 43)]
)
def test_a_little_friction_leaves_the_force_quiet(
    condition: str, friction: float, good: int
) -> None:
    """It held the device where the model moves: estimates rested at the end of their counts, with a velocity. `good`
    hands of 60 were quiet.
    """
    device = NOISY.replace(mechanics=NOISY.mechanics.replace(coulomb=friction))
    base = ebac.Scenario(device=device)
    found = ebac.study(ebac.Operators.grid(), "ebac", conditions=[condition], base=base).rows[0]
    assert found.exact_and_still == 60
    assert found.good is not None
    assert good < 58 <= found.good


def test_friction_that_holds_the_device_is_learnt_as_a_force() -> None:
    device = NOISY.replace(mechanics=NOISY.mechanics.replace(coulomb=0.05))
    scenario = ebac.Scenario(device=device, timing=ebac.Timing(delay=0), seconds=3.0)
    trace = ebac.simulate(scenario, "ebac")
    assert trace["est.weight"].min() == 1
    rest = trace[2.0:]
    assert abs(rest["est.v"]).max() < 2e-3  # m/s; it was 3.5e-3 for as long as it was looked at
    assert abs(rest["est.x"] - rest["true.x"]).max() < 1.5 * device.count
