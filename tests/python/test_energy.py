"""The energy account: what the trace says, against sums done here and against physics."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import ebac

pytest.importorskip("scipy")


def power(trace: ebac.Trace, device: ebac.Device) -> NDArray[np.float64]:
    v = trace["true.v"]
    taken = device.mechanics.damping * v**2 + device.mechanics.coulomb * np.abs(v)
    return np.asarray(trace["true.f_motor"] * v + taken)


# --- true.energy: what really crosses the port ---


@pytest.mark.parametrize("friction", [0.0, 1.0])
@pytest.mark.parametrize("law", ["direct", "ebac"])
def test_true_energy_is_the_integral_of_the_power_of_a_finely_sampled_run(
    law: str, friction: float
) -> None:
    from scipy.integrate import cumulative_simpson

    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=friction))
    scenario = ebac.Scenario(device=device, timing=ebac.Timing(dt=1e-5), seconds=0.3)
    trace = ebac.simulate(scenario, law)
    expected = np.concatenate([[0.0], cumulative_simpson(power(trace, device), dx=1e-5)])
    reached = trace["true.energy"]
    assert np.ptp(reached) > 0.01
    assert np.abs(reached - expected).max() < 1e-6


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("plant", [ebac.ExactPlant, ebac.SteppedPlant])
def test_true_energy_is_the_integral_of_the_power_inside_a_tick(
    plant: Any, friction: float
) -> None:
    from scipy.integrate import simpson

    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=friction))
    alone = plant(device=device, hand=ebac.Hand(), tick=1e-3)
    parts, energy = 64, 0.0
    for k in range(60):
        current = 2.5 * np.sin(0.4 * k)
        samples = [alone.truth().as_dict()]
        for i in range(parts):
            alone.advance([current], (k + i / parts) * 1e-3, 1 / parts)
            samples.append(alone.truth().as_dict())
        v, f = (np.array([s[name] for s in samples]) for name in ("v", "f_motor"))
        energy += simpson(f * v + 2.0 * v**2 + friction * np.abs(v), dx=1e-3 / parts)
        assert alone.truth().energy == pytest.approx(energy, abs=1e-7)
    assert abs(energy) > 1e-3


def test_energy_is_what_the_hand_gave_less_what_still_moves() -> None:
    """With no wall and no force: the damping took the hand's work but for the kinetic energy."""
    device = ebac.Device()
    scenario = ebac.Scenario(
        device=device, environment=ebac.Free(), timing=ebac.Timing(dt=1e-5), seconds=0.2
    )
    trace = ebac.simulate(scenario, "direct")
    given_by_hand = np.trapezoid(trace["true.f_hand"] * trace["true.v"], dx=1e-5)
    kinetic = 0.5 * device.mass * trace["true.v"][-1] ** 2
    assert trace["true.energy"][-1] == pytest.approx(given_by_hand - kinetic, rel=1e-4)
    assert (np.diff(trace["true.energy"]) >= 0).all()


def test_energy_of_a_handle_that_coasts_is_its_kinetic_energy() -> None:
    """Pushed by 1 A for 10 ms, then let go: all of m v^2 / 2 goes into the damper."""
    device = ebac.Device()
    nobody = ebac.Hand(mass=0, damping=0, stiffness=0)
    plant = ebac.ExactPlant(device=device, hand=nobody, tick=1e-3)
    plant.advance([-1.0], 0.0, 10)
    plant.advance([0.0], 0.01, 10)  # 33 time constants of the current loop
    start = plant.truth()
    assert start.v > 0.1
    for k in range(30):
        plant.advance([0.0], 0.02 + 0.1 * k, 100)  # 24 time constants of the handle
    assert plant.truth().energy - start.energy == pytest.approx(
        device.mass * start.v**2 / 2, rel=1e-9
    )


# --- work and damped: what the loop can know ---


@pytest.mark.parametrize("name", ebac.LAWS)
@pytest.mark.parametrize("changes", [{}, {"jitter": 0.4}], ids=["even", "jitter"])
def test_work_is_the_sum_of_applied_force_times_displacement_to_the_bit(
    name: str, changes: dict[str, Any], run: Any
) -> None:
    trace = run(name, seconds=1.0, observer=False, **changes)
    steps = trace["f_applied"] * trace["dx"]
    assert trace["work"].tobytes() == np.add.accumulate(steps).tobytes()


@pytest.mark.parametrize("axes", [1, 2])
def test_damped_is_the_sum_of_known_damping_times_displacement_beyond_a_count_squared(
    axes: int,
) -> None:
    given_back = ebac.Compensation(friction=0.5, friction_speed=0.5)  # spends 1 of 3 N s/m
    device = ebac.Device(
        kinematics=ebac.Linear(axes=axes),
        mechanics=ebac.Mechanics(damping=3.0),
        compensation=given_back,
    )
    scenario = ebac.Scenario(device=device, seconds=0.5, jitter=0.2, observer=False)
    trace = ebac.simulate(scenario, "ebac")
    assert device.facts.damping == 2.0
    dx = trace["dx"].reshape(len(trace), axes)[1:]
    dt = trace["dt"].reshape(len(trace), axes)[1:]
    sure = np.maximum(np.abs(dx) - device.count, 0)
    expected = np.add.accumulate(2.0 / dt * sure * sure)
    assert trace["damped"].reshape(len(trace), axes)[1:].tobytes() == expected.tobytes()


HELD = (
    ebac.Hand(),
    ebac.Hand(mass=0.05, damping=20.0, stiffness=1000.0, target=0.01),
    ebac.Hand(path=[ebac.Sine(centre=4e-3, amplitude=2e-3, frequency=2.0)]),
)


@pytest.mark.parametrize("hand", range(len(HELD)))
@pytest.mark.parametrize("name", ["ebac", "tca-damped"])
@pytest.mark.parametrize("observer", [False, True])
def test_work_and_damped_are_right_while_a_wall_is_held(
    hand: int, name: str, observer: bool
) -> None:
    """While one count toggles, readings jump by a count under a device that hardly moves."""
    device = ebac.Device(sensor=ebac.ForceSensor(noise=0.03))
    scenario = ebac.Scenario(device=device, hand=HELD[hand], seconds=20.0, observer=observer)
    trace = ebac.simulate(scenario, name)
    x = trace["true.x"]
    work = np.cumsum(trace["f_applied"] * np.diff(x, prepend=x[0]))
    damped = np.cumsum(2.0 * trace["true.v"] ** 2 * trace["dt"])
    assert (np.abs(trace["work"] - work) <= trace["unsure"] + 1e-9).all()
    if observer:
        assert trace["damped"][-1] == pytest.approx(damped[-1], rel=0.45)
        assert np.abs(trace["work"] - work).max() < 2e-3
        assert trace["unsure"][-1] > 0
    else:
        assert (trace["damped"] <= damped + 1e-9).all()


@pytest.mark.parametrize(
    ("kinematics", "most"),
    [
        (ebac.Linear(), 5e-4),
        (ebac.Gimbal(), 3e-3),  # J; its torque is that for the pose of two ticks before
    ],
)
@pytest.mark.parametrize("gravity", [9.81, -9.81])
def test_to_carry_the_weight_of_the_device_is_no_work_of_the_law(
    gravity: float, kinematics: ebac.Linear | ebac.Gimbal, most: float
) -> None:
    """It filled the account by 54 mJ or emptied it, until the next wall was gone; 56 mJ seemed to be drawn."""

    def swayed(mechanics: ebac.Mechanics) -> ebac.Trace:
        carries = ebac.Compensation(gravity_mass=mechanics.handle_mass)
        device = ebac.Device(mechanics=mechanics, compensation=carries, kinematics=kinematics)
        sways = ebac.Hand(path=ebac.Sine(amplitude=0.05, frequency=0.5))
        scenario = ebac.Scenario(
            device=device, hand=sways, environment=ebac.Free(), seconds=6.0, observer=False
        )
        return ebac.simulate(scenario, "ebac")

    light, heavy = swayed(ebac.Mechanics()), swayed(ebac.Mechanics(gravity=gravity))
    assert np.abs(heavy.axis("f_applied")).max() > 0.3
    for column in ("law.energy", "true.energy", "work"):
        beside = np.abs(heavy.axis(column) - light.axis(column))
        assert beside.max() < most, column


@pytest.mark.parametrize("gravity", [9.81, -9.81])
def test_a_slow_press_keeps_its_wall_where_the_motor_carries_the_weight(gravity: float) -> None:
    mechanics = ebac.Mechanics(gravity=gravity)
    carries = ebac.Compensation(gravity_mass=mechanics.handle_mass)
    base = ebac.Scenario(device=ebac.Device(mechanics=mechanics, compensation=carries))
    [row] = ebac.study(ebac.Operators.grid()[::12], ["ebac"], ["slow-press"], base=base).rows
    assert row.exact_and_still == row.hands == 5
    assert row.most_drawn_J is not None
    assert row.most_drawn_J < 1e-3


@pytest.mark.parametrize("observer", [False, True])
@pytest.mark.parametrize("delay", [0, 1, 2])
@given(
    friction=st.floats(0.0, 0.5), inertia=st.floats(0.0, 0.004), gravity_mass=st.floats(0.0, 0.2)
)
@settings(max_examples=5)
def test_static_compensation_is_no_work_of_the_law(
    friction: float, inertia: float, gravity_mass: float, delay: int, observer: bool
) -> None:
    """Of the force that acted, the account has the command of the law alone."""
    given_back = ebac.Compensation(friction=friction, inertia=inertia, gravity_mass=gravity_mass)
    mechanics = ebac.Mechanics(coulomb=0.5, gravity=9.81)
    device = ebac.Device(mechanics=mechanics, compensation=given_back)
    timing = ebac.Timing(delay=delay)
    scenario = ebac.Scenario(device=device, timing=timing, seconds=0.3, observer=observer)
    trace = ebac.simulate(scenario, "ebac")
    own = np.roll(trace["f_cmd"], delay + 1)
    own[: delay + 1] = 0
    assert np.abs(trace["f_cmd"]).max() < 0.8 * device.peak_force
    moved = trace["est.dx"] if observer else trace["dx"]
    assert np.abs(trace["work"] - np.cumsum(own * moved)).max() < 1e-9


@pytest.mark.parametrize("observer", [False, True])
def test_friction_given_back_in_full_leaves_the_account_of_the_law_alone(observer: bool) -> None:
    """It was charged for the push and not given what friction takes: -120 mJ in 6 s, and the next wall was gone."""
    device = ebac.Device(
        mechanics=ebac.Mechanics(coulomb=0.3), compensation=ebac.Compensation(friction=0.3)
    )
    sways = ebac.Hand(path=ebac.Sine(amplitude=0.05, frequency=0.5))
    free = ebac.Scenario(
        device=device, hand=sways, environment=ebac.Free(), seconds=6.0, observer=observer
    )
    trace = ebac.simulate(free, "ebac")
    assert np.abs(trace["f_applied"]).max() > 0.29
    assert np.abs(trace["work"]).max() < 1e-9
    assert trace["law.energy"].min() > trace["law.energy"][0] - 1e-9
    assert trace["true.energy"].min() > -1e-4


def test_a_slow_press_keeps_its_wall_where_friction_is_given_back() -> None:
    device = ebac.Device(
        mechanics=ebac.Mechanics(coulomb=0.3), compensation=ebac.Compensation(friction=0.3)
    )
    conditions = ["slow-press", "slow-press-K20"]
    study = ebac.study(
        ebac.Operators.grid()[::12], ["ebac"], conditions, base=ebac.Scenario(device=device)
    )
    for row in study.rows:
        assert row.exact_and_still == row.hands == 5
        assert row.most_drawn_J is not None
        assert row.most_drawn_J < 1e-3


@pytest.mark.parametrize("peak_ratio", [10.0, 1.0])
def test_to_carry_weight_stores_nothing_where_the_motor_is_at_its_peak(peak_ratio: float) -> None:
    """With the share of the cut command, 0.2 W came in that nobody gave: what carries the weight must come back."""
    device = ebac.Device(
        mechanics=ebac.Mechanics(gravity=9.81),
        compensation=ebac.Compensation(gravity_mass=0.25),
        drive=ebac.Drive(peak_ratio=peak_ratio),
    )
    sways = ebac.Hand(stiffness=1000.0, path=ebac.Sine(amplitude=0.03, frequency=6.0))
    trace = ebac.simulate(ebac.Scenario(device=device, hand=sways, seconds=5.0), "ebac")
    if peak_ratio == 1:
        assert np.abs(trace["f_applied"]).max() == pytest.approx(device.peak_force)
    own = trace["f_applied"] - 9.81 * 0.25
    own[:2] = 0  # no command acts yet
    assert np.abs(trace["work"] - np.cumsum(own * trace["est.dx"])).max() < 1e-9


def test_a_soft_start_brings_compensation_in_softly() -> None:
    device = ebac.Device(
        mechanics=ebac.Mechanics(coulomb=0.3, gravity=9.81),
        compensation=ebac.Compensation(friction=0.3, gravity_mass=0.25),
    )
    sways = ebac.Hand(path=ebac.Sine(amplitude=0.05, frequency=0.5))
    free = ebac.Scenario(device=device, hand=sways, environment=ebac.Free(), seconds=1.0)
    trace = ebac.simulate(free, "ebac", soft_start=0.5)
    assert np.abs(trace["work"]).max() < 1e-4
    assert trace["law.energy"].min() > 1.9e-3


def test_damping_that_compensation_has_spent_is_not_counted() -> None:
    spent = ebac.Compensation(friction=1.0, friction_speed=0.1)
    device = ebac.Device(compensation=spent)
    assert device.facts.damping == -8.0
    trace = ebac.simulate(ebac.Scenario(device=device, seconds=0.1), "direct")
    assert (trace["damped"] == 0).all()


@pytest.mark.parametrize("name", ["tca", "eba", "ebac"])
@given(hand_mass=st.floats(0.05, 1.0), stiffness=st.floats(100, 1000))
@settings(max_examples=15)
def test_the_account_of_the_loop_is_a_lower_bound_of_the_energy(
    name: str, hand_mass: float, stiffness: float
) -> None:
    """The hold passes exactly sum F dx; damping takes at least (b/dt) dx^2 (Cauchy-Schwarz)."""
    device = ebac.Device(
        drive=ebac.Drive(current_lag=0.0), encoder=ebac.Encoder(counts_per_turn=1 << 26)
    )
    hand = ebac.Hand(mass=hand_mass, stiffness=stiffness)
    scenario = ebac.Scenario(device=device, hand=hand, seconds=0.5, jitter=0.2, observer=False)
    trace = ebac.simulate(scenario, name)
    slack = trace["true.energy"] - trace["work"] - trace["damped"]
    one_count = (
        2 * device.peak_force * device.count
    )  # J, what the encoder's rounding can hide in a tick
    assert np.diff(slack).min() > -one_count
    assert slack.min() > -one_count


# --- passive means passive ---

hands = st.builds(
    ebac.Hand,
    mass=st.floats(0.02, 1.0),
    damping=st.floats(0.0, 20.0),
    stiffness=st.floats(10, 1500),
    path=st.one_of(
        st.builds(ebac.Step, target=st.floats(-0.04, 0.04)),
        st.builds(ebac.Tapping, target=st.floats(0.0, 0.04), frequency=st.floats(0.5, 20)),
        st.builds(ebac.Sine, frequency=st.floats(0.1, 30), amplitude=st.floats(0.0, 0.03)),
    ),
    tremor_amplitude=st.floats(0, 1e-3),
    release_at=st.sampled_from([float("inf"), 0.25]),
)
walls = st.builds(
    ebac.Wall,
    stiffness=st.floats(0, 1e6),
    damping=st.floats(0, 200),
    position=st.floats(-0.01, 0.01),
    angle=st.sampled_from([0.0, 3.0]),
)


@given(
    hand=hands,
    wall=walls,
    delay=st.integers(0, 2),
    damping=st.floats(0.1, 10),
    friction=st.sampled_from([0.0, 1.0]),
    lag=st.sampled_from([0.0, 3e-4]),
)
def test_eba_with_its_account_keeps_its_bound_in_closed_loop(
    hand: ebac.Hand, wall: ebac.Wall, delay: int, damping: float, friction: float, lag: float
) -> None:
    device = ebac.Device(
        mechanics=ebac.Mechanics(damping=damping, coulomb=friction),
        drive=ebac.Drive(current_lag=lag),
    )
    scenario = ebac.Scenario(
        device=device, hand=hand, environment=wall, timing=ebac.Timing(delay=delay), seconds=0.5
    )
    trace = ebac.simulate(scenario, "eba-account")
    # What no encoder can see: motion within one count under a force that changes.
    unseen = device.count * np.abs(np.diff(trace["f_applied"], prepend=0.0)).sum()
    assert trace["law.account"].min() >= -unseen - 1e-12
    assert trace["true.energy"].min() >= -unseen - 1e-12


@given(
    hand=hands,
    wall=walls,
    law=st.sampled_from([("eba", 0), ("eba-account", 0), ("eba-account", 1), ("eba-account", 2)]),
    damping=st.floats(0.1, 10),
)
def test_eba_gives_out_no_energy_behind_an_ideal_drive_and_encoder(
    hand: ebac.Hand, wall: ebac.Wall, law: tuple[str, int], damping: float
) -> None:
    """The bound alone is proven without delay, with the account for any delay."""
    name, delay = law
    device = ebac.Device(
        mechanics=ebac.Mechanics(damping=damping),
        drive=ebac.Drive(current_lag=0.0),
        encoder=ebac.Encoder(counts_per_turn=1 << 26),
    )
    scenario = ebac.Scenario(
        device=device, hand=hand, environment=wall, timing=ebac.Timing(delay=delay), seconds=0.5
    )
    assert ebac.simulate(scenario, name)["true.energy"].min() > -1e-6


@pytest.mark.parametrize("seed", range(1, 6))
def test_ebac_stays_above_minus_one_millijoule_at_the_reference_wall(seed: int, run: Any) -> None:
    trace = run("ebac", seed=seed, device=ebac.Device(sensor=ebac.ForceSensor(noise=0.05)))
    assert trace["true.energy"].min() >= -1e-3


def test_the_account_does_see_a_law_that_gives_energy_out(run: Any) -> None:
    for name in ("direct", "tca"):
        trace = run(name)
        assert trace["true.energy"].min() < -1.0
        assert (trace["work"] + trace["damped"]).min() < -1.0


# --- hands that bring little energy: the account must not take their wall away ---

NOISY = ebac.Device(sensor=ebac.ForceSensor(noise=0.03))  # N


def test_hands_that_press_slowly_keep_a_stiff_wall() -> None:
    hands = ebac.Operators.grid()
    study = ebac.study(hands, ["ebac"], ["slow-press-d2K20"], base=ebac.Scenario(device=NOISY))
    [row] = study.rows
    assert row.exact_and_still == len(hands)
    assert row.most_drawn_J <= 1e-3


def test_a_hand_that_sways_keeps_a_stiff_wall_for_a_minute() -> None:
    sways = ebac.Hand(path=ebac.Sine(centre=0.03, amplitude=0.005, frequency=1.0))
    wall = ebac.Wall(stiffness=20e3)
    timing = ebac.Timing(delay=2)
    scenario = ebac.Scenario(
        device=NOISY, hand=sways, environment=wall, timing=timing, seconds=60.0
    )
    trace = ebac.simulate(scenario, "ebac")
    last = trace["t"] > 55
    assert np.sum(trace["f_applied"][last]) > 0.97 * np.sum(trace["f_env"][last])
