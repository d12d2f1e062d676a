"""The plant against SciPy, and the exact plant against the stepped one.

The reference below is written from eq. (4) to (6) alone, with its own stick and slip, and shares
nothing with the plant but the numbers of the scenario.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import ebac

pytest.importorskip("scipy")

TOLERANCES = {"rtol": 1e-10, "atol": 1e-10}
MICROMETRE, MILLINEWTON, MICROJOULE = 1e-6, 1e-3, 1e-6


class Reference:
    """One rigid axis and a hand, integrated by SciPy, restarted at every tick and event."""

    def __init__(self, device: ebac.Device, hand: ebac.Hand) -> None:
        self.device, self.hand = device, hand
        self.mass = device.mass + hand.mass
        self.state = [0.0] * 5  # x, v, f_motor, f_sensor, energy
        self.sliding = 0.0  # direction; 0 while friction holds
        self.weight = device.mechanics.handle_mass * device.mechanics.gravity

    def hand_force(self, z: Any, target: float) -> float:
        """Eq. (4): what the hand puts on the device, towards +x."""
        a = 0.0 if self.holds else self.net_force(z, target) / self.mass
        return float(
            self.hand.stiffness * (target - z[0]) - self.hand.damping * z[1] - self.hand.mass * a
        )

    def net_force(self, z: Any, target: float) -> float:
        """Mass times acceleration while sliding."""
        damping = self.device.mechanics.damping + self.hand.damping
        return self.pull(z, target) - damping * z[1] - self.sliding * self.device.mechanics.coulomb

    def pull(self, z: Any, target: float) -> float:
        """What friction has to hold at rest."""
        return float(self.hand.stiffness * (target - z[0]) + self.weight - z[2])

    @property
    def holds(self) -> bool:
        return self.device.mechanics.coulomb > 0 and self.sliding == 0

    def rates(self, z: Any, asked: float, target: float) -> list[float]:
        mechanics = self.device.mechanics
        v, f_motor = z[1], z[2]
        a = 0.0 if self.holds else self.net_force(z, target) / self.mass
        if self.holds:
            v = 0.0
        f_hand = self.hand.stiffness * (target - z[0]) - self.hand.damping * v - self.hand.mass * a
        return [
            v,
            a,
            (asked - f_motor) / self.device.drive.current_lag,
            (f_hand - z[3]) / self.device.sensor.lag,
            f_motor * v + mechanics.damping * v * v + mechanics.coulomb * abs(v),
        ]

    def advance(self, asked: float, t: float, time: float) -> None:
        """Move by `time` under the force `asked` of the motor; a path enters as its chord."""
        start, end = self.hand.target(t), self.hand.target(t + time)
        slope = (
            0.0
            if isinstance(self.hand.path[0], (ebac.Step, ebac.Tapping))
            else (end - start) / time
        )
        self.target = start + slope * time
        friction = self.device.mechanics.coulomb

        from scipy.integrate import solve_ivp

        def target(s: float) -> float:
            return start + slope * s

        def right(s: float, z: Any) -> list[float]:
            return self.rates(z, asked, target(s))

        def stops(s: float, z: Any) -> float:
            return float(z[1])

        def breaks_away(s: float, z: Any) -> float:
            return abs(self.pull(z, target(s))) - friction

        stops.terminal = breaks_away.terminal = True  # type: ignore[attr-defined]
        breaks_away.direction = 1  # type: ignore[attr-defined]
        s = 0.0
        while s < time:
            if (
                friction > 0
                and self.sliding == 0
                and abs(self.pull(self.state, target(s))) > friction
            ):
                self.sliding = math.copysign(1.0, self.pull(self.state, target(s)))
            event: Callable[[float, Any], float] | None = None
            if friction > 0:
                event = breaks_away if self.sliding == 0 else stops
                stops.direction = -self.sliding  # type: ignore[attr-defined]
            run = solve_ivp(right, (s, time), self.state, "DOP853", events=event, **TOLERANCES)
            assert run.success
            self.state, s = run.y[:, -1].tolist(), float(run.t[-1])
            if run.status == 1 and self.sliding == 0:
                self.sliding = math.copysign(1.0, self.pull(self.state, target(s)))
            elif run.status == 1:
                self.state[1] = self.sliding = 0.0


def largest_errors(trace: ebac.Trace) -> dict[str, float]:
    """Play the forces of a trace to the reference, and compare tick by tick."""
    assert trace.scenario is not None
    plant = Reference(trace.scenario.device, trace.scenario.hand)
    truth = [trace[f"true.{name}"] for name in ("x", "v", "f_motor", "f_sensor", "energy")]
    applied, t, f_hand = trace["f_applied"].tolist(), trace["t"].tolist(), trace["true.f_hand"]
    state = np.zeros((len(trace), 5))
    hand = np.zeros(len(trace))
    for k in range(1, len(trace)):
        plant.advance(applied[k], t[k - 1], t[k] - t[k - 1])
        state[k] = plant.state
        hand[k] = plant.hand_force(plant.state, plant.target)
    errors = {
        name: float(np.abs(state[:, i] - column).max())
        for i, (name, column) in enumerate(
            zip(("x", "v", "f_motor", "f_sensor", "energy"), truth, strict=True)
        )
    }
    return errors | {"f_hand": float(np.abs(hand - f_hand)[1:].max())}


def assert_agrees(errors: dict[str, float]) -> None:
    reached = ", ".join(f"{name} {error:.2g}" for name, error in errors.items())
    assert errors["x"] < MICROMETRE, reached
    assert errors["f_hand"] < MILLINEWTON, reached
    assert errors["f_sensor"] < MILLINEWTON, reached
    assert errors["f_motor"] < MILLINEWTON, reached
    assert errors["energy"] < MICROJOULE, reached


@pytest.mark.parametrize(("law", "friction"), [("tca", 1.0), ("ebac", 0.0)])
@pytest.mark.slow
def test_plant_agrees_with_scipy_over_the_reference_scenario(
    law: str, friction: float, run: Any
) -> None:
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=friction))
    trace = run(law, device=device, seconds=0.8)  # dozens of impacts of tca, and stops by friction
    assert_agrees(largest_errors(trace))


@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_plant_agrees_with_scipy_under_weight_noise_and_jitter(friction: float) -> None:
    scenario = ebac.Scenario(
        device=ebac.Device(
            mechanics=ebac.Mechanics(coulomb=friction, gravity=-9.81),
            sensor=ebac.ForceSensor(noise=0.1),
        ),
        hand=ebac.Hand(mass=0.05, damping=2.0, stiffness=800.0, path=ebac.Tapping(target=0.02)),
        environment=ebac.Wall(stiffness=3e3, damping=5.0),
        timing=ebac.Timing(delay=2),
        seconds=1.0,
        jitter=0.4,
    )
    assert_agrees(largest_errors(ebac.simulate(scenario, "eba")))


@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.parametrize("friction", [0.0, 1.0])
def test_plant_agrees_with_scipy_on_a_moving_target(friction: float) -> None:
    scenario = ebac.Scenario(
        device=ebac.Device(mechanics=ebac.Mechanics(coulomb=friction)),
        hand=ebac.Hand(path=ebac.Sine(centre=0.0, frequency=3.0), tremor_amplitude=0.001),
        seconds=0.7,
    )
    assert_agrees(largest_errors(ebac.simulate(scenario, "ebac")))


def test_friction_holds_a_handle_that_is_pulled_too_little() -> None:
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=2.0))
    weak = ebac.Hand(stiffness=100.0, path=ebac.Step(target=0.015))  # 1.5 N
    trace = ebac.simulate(ebac.Scenario(device=device, hand=weak, seconds=0.2), "direct")
    assert (trace["true.x"] == 0).all()
    assert (trace["true.v"] == 0).all()
    assert trace["true.f_hand"][-1] == pytest.approx(1.5, abs=1e-12)


# --- the exact plant and the stepped one ---

hands = st.builds(
    ebac.Hand,
    mass=st.floats(0.0, 1.0),
    damping=st.floats(0.0, 20.0),
    stiffness=st.floats(0.0, 2000.0),
    path=st.one_of(
        st.builds(ebac.Step, target=st.floats(-0.05, 0.05)),
        st.builds(ebac.Sine, frequency=st.floats(0.1, 10.0), amplitude=st.floats(0.0, 0.05)),
    ),
)


def states(plant: Any, currents: list[tuple[float, float]]) -> NDArray[np.float64]:
    t, rows = 0.0, []
    for current, share in currents:
        plant.advance([current], t, share)
        t += share * 1e-3
        rows.append(list(plant.truth().as_dict().values()))
    return np.array(rows)


@given(
    hand=hands,
    currents=st.lists(
        st.tuples(st.floats(-4, 4), st.sampled_from([0.25, 0.5, 1.0, 1.5])), min_size=1, max_size=60
    ),
    gravity=st.sampled_from([0.0, 9.81]),
)
@settings(max_examples=60)
def test_exact_and_stepped_plant_agree(
    hand: ebac.Hand, currents: list[tuple[float, float]], gravity: float
) -> None:
    device = ebac.Device(mechanics=ebac.Mechanics(gravity=gravity))
    exact = states(ebac.ExactPlant(device=device, hand=hand, tick=1e-3), currents)
    stepped = states(ebac.SteppedPlant(device=device, hand=hand, tick=1e-3), currents)
    columns = list(ebac.ExactPlant(device=device, hand=hand, tick=1e-3).truth().as_dict())
    errors = dict(zip(columns, np.abs(exact - stepped).max(axis=0), strict=True))
    reached = str(errors)
    assert errors["x"] < MICROMETRE, reached
    assert errors["f_hand"] < MILLINEWTON, reached
    assert errors["f_sensor"] < MILLINEWTON, reached
    assert errors["f_motor"] < MILLINEWTON, reached
    assert errors["energy"] < MICROJOULE, reached


@pytest.mark.parametrize("law", ["tca", "ebac"])
@pytest.mark.parametrize("friction", [0.0, 1.0])
def test_exact_and_stepped_plant_agree_over_the_reference_scenario(
    law: str, friction: float, run: Any
) -> None:
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=friction))
    trace = run(law, device=device)
    stepped = ebac.SteppedPlant(device=device, hand=trace.scenario.hand, tick=1e-3)
    errors = dict.fromkeys(stepped.truth().as_dict(), 0.0)
    for k in range(1, len(trace)):
        stepped.advance([trace["current_applied"][k]], trace["t"][k - 1])
        for name, value in stepped.truth().as_dict().items():
            errors[name] = max(errors[name], abs(value - trace[f"true.{name}"][k]))
    assert_agrees(errors)


@pytest.mark.parametrize("share", [1 / 4, 1 / 64, 2.5])
def test_a_tick_in_parts_is_the_same_tick(share: float) -> None:
    device, hand = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.5)), ebac.Hand()
    whole = states(ebac.ExactPlant(device=device, hand=hand, tick=1e-3), [(1.0, 5.0)])
    parts = round(5 / share)
    split = states(ebac.ExactPlant(device=device, hand=hand, tick=1e-3), [(1.0, share)] * parts)
    assert split[-1] == pytest.approx(whole[-1], rel=1e-9, abs=1e-9)


def test_exact_plant_refuses_what_it_cannot_do_exactly() -> None:
    for device in (
        ebac.presets.device("joystick"),
        ebac.Device(mechanics=ebac.Mechanics(breakaway=1.0)),
        ebac.Device(mechanics=ebac.Mechanics(cable_stiffness=1e5)),
    ):
        with pytest.raises(ValueError, match="stepped plant"):
            ebac.ExactPlant(device=device, hand=ebac.Hand(), tick=1e-3)


@pytest.mark.parametrize(("current", "share"), [([1.0] * 4, 1.0), ([1.0], 0.0), ([1.0], math.nan)])
def test_advance_refuses_what_makes_no_sense(current: list[float], share: float) -> None:
    plant = ebac.ExactPlant(device=ebac.Device(), hand=ebac.Hand(), tick=1e-3)
    with pytest.raises(ValueError, match="advance"):
        plant.advance(current, 0.0, share)


def test_friction_stops_only_what_stops() -> None:
    """The brake lets go before the handle stands: its speed has a least value that is not zero."""
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.5))
    nobody = ebac.Hand(mass=0, damping=0, stiffness=0)
    plant = ebac.ExactPlant(device=device, hand=nobody, tick=1e-3)
    reference = Reference(device, nobody)
    for k, current in enumerate([-1.0] * 5 + [1.0, -1.0, -1.0]):
        plant.advance([current], k * 1e-3)
        reference.advance(device.force(current), k * 1e-3, 1e-3)
        assert plant.truth().v == pytest.approx(reference.state[1], abs=1e-8)
        assert plant.truth().v > 0


@pytest.mark.parametrize("lag", [1e-308, 1e-20, 1e-15, 1e-10, 1e-8])
@pytest.mark.parametrize("part", ["sensor", "drive"])
def test_a_lag_that_is_hardly_there_is_none(part: str, lag: float) -> None:
    """The reciprocal of a tiny lag must neither overflow nor swallow the digits of the motion."""
    if part == "sensor":
        device, without = (ebac.Device(sensor=ebac.ForceSensor(lag=t)) for t in (lag, 0.0))
    else:
        device, without = (ebac.Device(drive=ebac.Drive(current_lag=t)) for t in (lag, 0.0))
    x, ideal = (
        ebac.simulate(ebac.Scenario(device=d, seconds=0.3), "ebac")["true.x"]
        for d in (device, without)
    )
    assert np.abs(x - ideal).max() < device.count
