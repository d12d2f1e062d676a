"""The parts of a device, from encoder to drive."""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ebac
from ebac.studies.conditions import conditions

# --- encoder ---

encoders = st.builds(
    ebac.Encoder, counts_per_turn=st.integers(1, 1 << 26), counter_bits=st.integers(8, 63)
)


@given(encoder=encoders, share=st.floats(-0.49, 0.49), turns=st.integers(-(1 << 30), 1 << 30))
def test_encoder_shows_the_nearest_count(encoder: ebac.Encoder, share: float, turns: int) -> None:
    assert encoder.count == 2 * math.pi / encoder.counts_per_turn
    wide = encoder.replace(counter_bits=63)
    count = turns % (1 << 20)
    assert wide.read((count + share) * encoder.count) == count
    assert wide.read((-count + share) * encoder.count) == -count


@given(encoder=encoders, counts=st.integers(-(1 << 40), 1 << 40))
def test_counter_wraps_as_a_signed_number_of_its_width(encoder: ebac.Encoder, counts: int) -> None:
    coarse = encoder.replace(counts_per_turn=1)
    half = 1 << (encoder.counter_bits - 1)
    assert coarse.read(counts * 2 * math.pi) == (counts + half) % (2 * half) - half


@given(
    encoder=encoders,
    start=st.integers(-(1 << 40), 1 << 40),
    steps=st.lists(st.floats(-0.99, 0.99), max_size=30),
)
def test_unwrapping_follows_any_motion_slower_than_half_the_counter(
    encoder: ebac.Encoder, start: int, steps: list[float]
) -> None:
    width = 1 << encoder.counter_bits
    half = width // 2
    counts = start
    unwrapped = start
    for step in steps:
        counts = max(-(1 << 61), min(1 << 61, counts + int(step * half)))
        raw = (counts + half) % width - half
        unwrapped = encoder.unwrap(raw, unwrapped)
        assert unwrapped == counts


def test_a_simulated_handle_does_not_notice_that_its_counter_wraps() -> None:
    """40 mm are 1300 counts; a counter of 8 bits shows 256."""
    traces = [
        ebac.simulate(
            ebac.Scenario(
                device=ebac.Device(encoder=ebac.Encoder(counter_bits=bits)),
                environment=ebac.Free(),
                seconds=0.5,
            ),
            "direct",
        )
        for bits in (32, 8)
    ]
    assert traces[0]["counts"].max() > 1000
    for column in ("counts", "q", "x", "v", "true.x"):
        assert traces[0][column].tobytes() == traces[1][column].tobytes()


@pytest.mark.parametrize("counts_per_turn", [500, 1024, 65536])
def test_measured_position_is_the_true_one_to_a_count(counts_per_turn: int) -> None:
    device = ebac.Device(encoder=ebac.Encoder(counts_per_turn=counts_per_turn))
    trace = ebac.simulate(ebac.Scenario(device=device, seconds=1.0), "ebac")
    error = np.abs(trace["x"] - trace["true.x"])
    assert (
        0.4 * device.count < error.max() <= device.count
    )  # half a count, and where zero lies in one
    assert trace["x"] == pytest.approx(trace["counts"] * device.count, abs=1e-12)


# --- drive train, eq. (1) ---


def test_equation_1_gives_the_current_of_the_paper() -> None:
    assert ebac.copley_current(500, 5300, 5380) == pytest.approx(0.49257, abs=1e-5)
    motor = ebac.Motor()
    assert motor.current(0.5 * motor.rated_torque) == pytest.approx(0.4926, abs=5e-5)


@given(permille=st.floats(-4000, 4000), torque=st.floats(1e-3, 10), constant=st.floats(1e-3, 1))
def test_equation_1_is_the_same_in_copleys_units_and_in_si(
    permille: float, torque: float, constant: float
) -> None:
    motor = ebac.Motor(torque_constant=constant, rated_torque=torque)
    in_si = motor.current(permille / 1000 * torque)
    assert ebac.copley_current(permille, torque * 1e5, constant * 1e5) == pytest.approx(
        in_si, rel=1e-12
    )
    assert motor.torque(in_si) == pytest.approx(permille / 1000 * torque, rel=1e-12)


@given(
    drum=st.floats(1e-3, 0.1),
    sector=st.floats(0.01, 1),
    radius=st.floats(0.01, 1),
    current=st.floats(-10, 10),
)
def test_force_and_mass_pass_the_capstan_by_its_ratio(
    drum: float, sector: float, radius: float, current: float
) -> None:
    device = ebac.Device(
        capstan=ebac.Capstan(drum_radius=drum, sector_radius=sector),
        kinematics=ebac.Linear(radius=radius),
    )
    ratio = sector / drum
    assert device.capstan.ratio == pytest.approx(ratio)
    assert device.force(current) == pytest.approx(0.0538 * current * ratio / radius)
    assert device.reflected_mass == pytest.approx(3.4e-6 * (ratio / radius) ** 2)
    assert device.mass == pytest.approx(0.114 + device.reflected_mass)
    assert device.count == pytest.approx(2 * math.pi / 1024 / ratio * radius)


def test_reference_device_has_the_figures_of_the_paper() -> None:
    device = ebac.Device()
    assert device.count == pytest.approx(0.0307e-3, rel=2e-3)
    assert device.continuous_force == pytest.approx(10.6, rel=1e-3)
    assert device.peak_force == pytest.approx(42.4, rel=1e-3)
    assert device.mass == pytest.approx(0.25, rel=1e-3)


def test_peak_current_is_never_above_the_stall_current() -> None:
    motor = ebac.Motor()
    assert ebac.Drive(peak_ratio=10).peak_current(motor) == motor.stall_current
    assert ebac.Drive(peak_ratio=4).peak_current(motor) == motor.current(4 * motor.rated_torque)


def test_spec_sheet_stands_beside_the_paper() -> None:
    sheet = {spec.name: spec for spec in ebac.spec_sheet(ebac.presets.device("joystick"))}
    for name in ("resolution", "continuous force", "peak force"):
        assert sheet[name].value == pytest.approx(sheet[name].paper, rel=0.03), name
    assert sheet["travel, chord"].value == pytest.approx(0.1)
    assert sheet["travel, chord"].paper == 0.2
    assert sheet["joint range"].value == pytest.approx(math.pi / 3)
    for spec in sheet.values():
        assert spec.row() == {
            "name": spec.name, "value": spec.value, "unit": spec.unit,
            "paper": spec.paper, "how": spec.how, "remark": spec.remark,
        }  # fmt: skip


def test_the_spec_sheet_names_what_limits_the_peak() -> None:
    def how(name: str, **motor: float) -> str:
        device = ebac.Device(motor=ebac.Motor(**motor))
        return next(spec.how for spec in ebac.spec_sheet(device) if spec.name == name)

    assert how("peak force") == "4 times rated torque"
    assert how("peak current") == "peak torque over torque constant"
    stalled = how("peak force", stall_current=3.0)
    assert stalled == "stall current of 3 A times torque constant, less than 4 times rated torque"
    assert how("peak current", stall_current=3.0) == "the stall current"
    mistyped = how("peak force", rated_torque=29.7)
    assert "less than the continuous force: one of rated_torque = 29.7 N m" in mistyped


def test_a_range_beyond_a_right_angle_has_no_chord() -> None:
    def chord(limit: float) -> ebac.Spec:
        device = ebac.Device(kinematics=ebac.Linear(limit=limit))
        return next(spec for spec in ebac.spec_sheet(device) if spec.name == "travel, chord")

    assert chord(np.pi / 2).value == pytest.approx(0.2)
    assert np.isnan(chord(30).value)
    assert "limit = pi/2 = 1.571 rad, and this is 30 rad; limit is in rad" in chord(30).how
    assert repr(chord(30)) == "<Spec travel, chord: -, paper 0.2 m>"


# --- kinematics ---

kinematics = st.one_of(
    st.builds(ebac.Linear, axes=st.integers(1, 3), radius=st.floats(0.01, 1)),
    st.builds(ebac.Gimbal, radius=st.floats(0.01, 1)),
)
triple = st.tuples(*[st.floats(-1.2, 1.2)] * 3)
vector = st.tuples(*[st.floats(-10, 10)] * 3)


@given(k=kinematics, angles=triple)
def test_inverse_undoes_forward(k: Any, angles: tuple[float, ...]) -> None:
    q = angles[: k.axes]
    assert k.inverse(k.forward(q)) == pytest.approx(q, abs=1e-9)


@given(k=kinematics, angles=triple)
def test_jacobian_is_the_slope_of_forward(k: Any, angles: tuple[float, ...]) -> None:
    q, h = np.array(angles[: k.axes]), 1e-5
    columns = [(k.forward(q + h * e) - k.forward(q - h * e)) / (2 * h) for e in np.eye(k.axes)]
    assert k.jacobian(q) == pytest.approx(np.array(columns).T, abs=1e-9)


@given(k=kinematics, angles=triple, rates=vector, forces=vector)
def test_power_at_the_joints_is_power_at_the_handle(
    k: Any, angles: tuple[float, ...], rates: tuple[float, ...], forces: tuple[float, ...]
) -> None:
    q, dq, f = (np.array(values[: k.axes]) for values in (angles, rates, forces))
    assert k.transpose(q, f) @ dq == pytest.approx(f @ (k.jacobian(q) @ dq), abs=1e-9)


@given(angles=triple, radius=st.floats(0.01, 1))
def test_gimbal_moves_on_a_sphere(angles: tuple[float, ...], radius: float) -> None:
    gimbal = ebac.Gimbal(radius=radius)
    x, y = gimbal.forward(angles[:2])
    assert math.hypot(x, y, gimbal.height(angles[:2])) == pytest.approx(radius)


@pytest.mark.parametrize("k", [ebac.Linear(axes=2, limit=0.5), ebac.Gimbal(limit=0.5)])
def test_limits_hold_for_every_joint(k: Any) -> None:
    assert k.within_limits([0.5, -0.5])
    assert not k.within_limits([0.0, math.nextafter(0.5, 1)])
    assert not k.within_limits([-math.nextafter(0.5, 1), 0.0])
    assert not k.within_limits([math.nan, 0.0])


def test_a_point_with_too_few_axes_is_refused() -> None:
    with pytest.raises(ValueError, match="q has 1 value: must have 2, one for each axis"):
        ebac.Gimbal().forward([0.1])
    with pytest.raises(ValueError, match="f has 3 values: must have 2"):
        ebac.Gimbal().transpose([0.0, 0.0], [1.0, 2.0, 3.0])


def test_joystick_shows_the_force_it_is_asked_for() -> None:
    """Off the middle too: f_applied comes back through the inverse of what sent it."""

    class Push:
        def reset(self) -> None: ...

        def step(self, port: ebac.Port) -> float:
            return 2.0

    device = ebac.presets.device("joystick")
    hand = ebac.Hand(path=[ebac.Step(target=0.03), ebac.Step(target=-0.02)])
    scenario = ebac.Scenario(device=device, hand=hand, environment=ebac.Free(), seconds=0.4)
    trace = ebac.simulate(scenario, Push())
    assert np.abs(trace["q"][-1]).min() > 0.1
    assert trace["f_applied"][2:] == pytest.approx(
        2.0, abs=0.05
    )  # sent at the angles of the tick before
    assert trace["f_applied"][-1] == pytest.approx(2.0, abs=1e-3)


# --- velocity ---

ESTIMATORS = [ebac.BackwardDifference(), ebac.LowPass(), ebac.AdaptiveWindow()]


@pytest.mark.parametrize("estimator", ESTIMATORS)
@pytest.mark.parametrize("speed", [-0.3, 0.05, 1.0])
def test_a_steady_unquantised_motion_is_read_exactly(estimator: Any, speed: float) -> None:
    x = speed * 1e-3 * np.arange(200)
    v = ebac.estimate_velocity(estimator, x, 1e-3, 3e-5)
    assert v[0] == 0
    assert v[150:] == pytest.approx(speed, rel=1e-8)


@given(speed=st.floats(-1, 1), phase=st.floats(0, 1))
def test_a_steady_quantised_motion_is_read_to_one_count_over_the_window(
    speed: float, phase: float
) -> None:
    count, dt, longest = 3e-5, 1e-3, 16
    x = count * np.floor(speed * dt * np.arange(300) / count + phase)
    error = {
        type(e).__name__: np.abs(ebac.estimate_velocity(e, x, dt, count)[40:] - speed).max()
        for e in (ebac.BackwardDifference(), ebac.AdaptiveWindow(longest=longest))
    }
    assert error["BackwardDifference"] <= count / dt * (1 + 1e-9)
    # A line within one count of every reading may tilt by a count either way over its length.
    assert (
        error["AdaptiveWindow"] <= 2 * count / dt / longest * (1 + 1e-6) or abs(speed) * dt > count
    )


@pytest.mark.parametrize("speed", [0.004, 0.02, 0.11, 0.5])
def test_the_window_is_quieter_than_the_difference_on_a_quantised_ramp(speed: float) -> None:
    count, dt = 3e-5, 1e-3
    x = count * np.floor(speed * dt * np.arange(2000) / count)
    difference, window = (
        ebac.estimate_velocity(e, x, dt, count)[100:] for e in (ESTIMATORS[0], ESTIMATORS[2])
    )
    assert window.std() < 0.2 * difference.std()
    assert window.mean() == pytest.approx(speed, rel=0.02)


def test_the_window_does_not_lag_on_a_reversal_and_the_low_pass_does() -> None:
    count, dt = 3e-5, 1e-3
    t = dt * np.arange(200)
    x = count * np.round(0.5 * np.minimum(t, 0.2 - t) / count)  # turns back at 0.1 s
    window, low_pass = (
        ebac.estimate_velocity(e, x, dt, count) for e in (ESTIMATORS[2], ESTIMATORS[1])
    )
    assert window[99] == pytest.approx(0.5, abs=0.05)
    assert window[102] == pytest.approx(-0.5, abs=0.05)
    assert low_pass[102] > 0


def test_the_low_pass_has_its_time_constant() -> None:
    x = 1e-3 * np.arange(100.0)
    v = ebac.estimate_velocity(ebac.LowPass(time_constant=10e-3), x, 1e-3, 0.0)
    expected = 1 - (10 / 11) ** np.arange(100.0)  # implicit Euler
    assert v == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("estimator", ESTIMATORS)
def test_the_estimator_of_a_trace_is_the_one_of_the_device(estimator: Any) -> None:
    device = ebac.Device(velocity=estimator)
    trace = ebac.simulate(ebac.Scenario(device=device, seconds=0.5), "direct")
    alone = ebac.estimate_velocity(estimator, trace["q"], 1e-3, device.count / device.radius)
    assert trace["dq"] == pytest.approx(alone, rel=1e-9, abs=1e-9)
    assert trace["v"] == pytest.approx(trace["dq"] * device.radius)


@pytest.mark.parametrize(
    ("dt", "count", "message"),
    [
        (0.0, 3e-5, r"estimate_velocity.dt = 0 s: must lie in \[1e-06, 3600\] s"),
        (-1e-3, 3e-5, r"estimate_velocity.dt = -0.001 s: must lie in"),
        (math.nan, 3e-5, r"estimate_velocity.dt = nan s: must lie in"),
        (1e-3, -3e-5, r"estimate_velocity.count = -3e-05 m: must lie in \[0, 1\] m"),
    ],
)
def test_a_velocity_without_time_is_refused(dt: float, count: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ebac.estimate_velocity(ebac.LowPass(), np.zeros(3), dt, count)


# --- force sensor ---


def sensed(**sensor: float) -> ebac.Trace:
    device = ebac.Device(sensor=ebac.ForceSensor(**sensor))
    return ebac.simulate(ebac.Scenario(device=device, seconds=1.0), "eba")


def test_a_clean_sensor_shows_the_force_of_the_hand_behind_its_lag() -> None:
    trace = sensed()
    assert (trace["f_meas"] == trace["true.f_sensor"]).all()
    assert (trace["f_meas"] != trace["true.f_hand"]).any()
    instant = sensed(lag=0.0)
    assert (instant["f_meas"] == instant["true.f_hand"]).all()


def test_a_sensor_shows_whole_quanta() -> None:
    trace = sensed(quantum=0.25)
    quanta = trace["f_meas"] / 0.25
    assert (quanta == np.round(quanta)).all()
    assert np.abs(trace["f_meas"] - trace["true.f_sensor"]).max() <= 0.125
    assert len(np.unique(quanta)) > 5


def test_a_sensor_saturates_at_its_range() -> None:
    trace = sensed(range=3.0)
    assert trace["f_meas"].max() == 3.0
    assert trace["true.f_sensor"].max() > 3.0
    inside = np.abs(trace["true.f_sensor"]) < 3
    assert (trace["f_meas"][inside] == trace["true.f_sensor"][inside]).all()


def test_the_noise_of_a_sensor_has_its_size() -> None:
    trace = sensed(noise=0.3)
    noise = trace["f_meas"] - trace["true.f_sensor"]
    assert noise.std() == pytest.approx(0.3, rel=0.1)
    assert abs(noise.mean()) < 0.05
    assert abs(np.corrcoef(noise[1:], noise[:-1])[0, 1]) < 0.1


# --- compensation, tau_static of eq. (2) ---


def test_a_gravity_compensated_joystick_drifts_less_when_nobody_holds_it() -> None:
    falling = ebac.presets.device("joystick")
    held = falling.replace(
        compensation=ebac.Compensation(gravity_mass=falling.mechanics.handle_mass)
    )
    nudge = ebac.Hand(mass=0.0, stiffness=200.0, path=ebac.Step(target=0.005), release_at=0.1)
    drift = []
    for device in (falling, held):
        scenario = ebac.Scenario(device=device, hand=nudge, environment=ebac.Free(), seconds=0.8)
        x = ebac.simulate(scenario, "direct")["true.x"][:, 0]
        drift.append(x[-1] - x[100])
    assert drift[1] > 0  # it coasts to a stop
    assert drift[0] > 10 * drift[1]  # it falls


def test_carrying_the_weight_of_a_straight_axis_cancels_it() -> None:
    heavy = ebac.Device(
        mechanics=ebac.Mechanics(gravity=9.81), compensation=ebac.Compensation(gravity_mass=0.114)
    )
    nobody = ebac.Hand(mass=0, damping=0, stiffness=0)
    scenario = ebac.Scenario(device=heavy, hand=nobody, environment=ebac.Free(), seconds=0.5)
    trace = ebac.simulate(scenario, "direct")
    assert trace["f_applied"][5:] == pytest.approx(0.114 * 9.81)
    assert np.abs(trace["true.v"][-1]) < 0.02
    fallen = ebac.simulate(
        scenario.replace(device=heavy.replace(compensation=ebac.Compensation())), "direct"
    )
    assert fallen["true.v"][-1] > 0.4


def test_giving_friction_back_makes_a_handle_coast_further() -> None:
    sticky = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.3, damping=1.0))
    helped = sticky.replace(compensation=ebac.Compensation(friction=0.25))
    hand = ebac.Hand(stiffness=300.0, path=ebac.Step(target=0.05), release_at=0.06)
    reach = [
        ebac.simulate(
            ebac.Scenario(device=d, hand=hand, environment=ebac.Free(), seconds=1.0), "direct"
        )["true.x"][-1]
        for d in (sticky, helped)
    ]
    assert reach[1] > 1.2 * reach[0]


def test_giving_inertia_back_makes_a_handle_quicker() -> None:
    heavy = ebac.Device(mechanics=ebac.Mechanics(handle_mass=1.0))
    helped = heavy.replace(compensation=ebac.Compensation(inertia=0.3, inertia_lag=2e-3))
    assert helped.facts.mass == pytest.approx(heavy.mass - 0.3)
    hand = ebac.Hand(mass=0.0, damping=0.0, stiffness=10.0)
    reach = [
        ebac.simulate(
            ebac.Scenario(device=d, hand=hand, environment=ebac.Free(), seconds=0.2), "direct"
        )["true.x"][-1]
        for d in (heavy, helped)
    ]
    assert reach[1] > 1.1 * reach[0]


@given(friction=st.floats(0, 5), speed=st.floats(1e-3, 1), v=st.floats(-2, 2), a=st.floats(-50, 50))
def test_compensation_helps_the_motion_by_at_most_the_friction(
    friction: float, speed: float, v: float, a: float
) -> None:
    given_back = ebac.Compensation(friction=friction, friction_speed=speed)
    force = given_back.force(v, a)
    assert abs(force) <= friction
    assert force * v <= 0
    if abs(v) >= speed:
        assert abs(force) == friction
    assert ebac.Compensation(inertia=0.5).force(v, a) == -0.5 * a


@given(
    friction=st.floats(0, 5),
    speed=st.floats(1e-3, 1),
    damping=st.floats(0, 20),
    coulomb=st.floats(0, 5),
    v=st.floats(-2, 2),
)
def test_the_damping_left_is_really_left(
    friction: float, speed: float, damping: float, coulomb: float, v: float
) -> None:
    """Real damping and friction, less the help, take what is counted on, at every speed."""
    given_back = ebac.Compensation(friction=friction, friction_speed=speed)
    left = given_back.damping_left(damping, coulomb)
    taken = damping * v * v + coulomb * abs(v) + given_back.force(v, 0) * v
    assert taken >= left * v * v - 1e-12
    if friction <= coulomb:
        assert left == damping


def test_a_device_refuses_parts_that_do_not_fit() -> None:
    with pytest.raises(
        ValueError, match=r"Mechanics.backlash = 0.001 m: needs a cable_stiffness above 0 N/m"
    ):
        ebac.Device(mechanics=ebac.Mechanics(backlash=1e-3))
    with pytest.raises(
        ValueError, match=r"Compensation.inertia = 0.2 kg: must lie in \[0, 0.125\] kg"
    ):
        ebac.Device(compensation=ebac.Compensation(inertia=0.2))
    with pytest.raises(TypeError, match=r"Device.motor = Drive\(.*: must be a Motor"):
        ebac.Device(motor=ebac.Drive())
    with pytest.raises(TypeError, match="no parameter 'encodr', did you mean 'encoder'"):
        ebac.Device(encodr=ebac.Encoder())


# --- drive: what is asked and what acts ---


@pytest.mark.parametrize("delay", range(9))
@pytest.mark.parametrize("jitter", [0.0, 0.4])
def test_a_command_acts_exactly_delay_ticks_after_it_was_computed(
    delay: int, jitter: float
) -> None:
    """f_applied of row k + 1 acted from tick k to k + 1: the command of tick k - delay."""
    device = ebac.Device()
    scenario = ebac.Scenario(timing=ebac.Timing(delay=delay), seconds=0.3, jitter=jitter)
    trace = ebac.simulate(scenario, "tca")
    asked = np.concatenate([np.zeros(delay + 1), trace["current"]])[: len(trace)]
    assert np.abs(asked).max() > 1
    assert trace["current_applied"].tobytes() == asked.tobytes()
    per_amp = device.motor.torque_constant * device.capstan.ratio
    assert trace["f_applied"].tobytes() == (per_amp / device.radius * asked).tobytes()
    assert trace["f_applied"][delay + 1 :] == pytest.approx(
        trace["f_cmd"][: len(trace) - delay - 1], abs=1e-12
    )


def test_one_pulse_shows_the_delay() -> None:
    class Pulse:
        tick = 0

        def reset(self) -> None:
            self.tick = 0

        def step(self, port: ebac.Port) -> float:
            self.tick += 1
            return 5.0 if self.tick == 21 else 0.0  # in row 20

    for delay in range(4):
        trace = ebac.simulate(ebac.Scenario(timing=ebac.Timing(delay=delay), seconds=0.05), Pulse())
        assert np.flatnonzero(trace["f_cmd"]).tolist() == [20]
        assert np.flatnonzero(trace["f_applied"]).tolist() == [21 + delay]
        assert np.flatnonzero(trace["true.f_motor"])[0] == 21 + delay


def test_permille_drives_set_whole_thousandths_of_rated() -> None:
    device = ebac.Device(drive=ebac.Drive(permille=True))
    trace = ebac.simulate(ebac.Scenario(device=device, seconds=0.5), "ebac")
    one = device.motor.current(device.motor.rated_torque) / 1000
    permille = trace["current_applied"] / one
    assert permille == pytest.approx(np.round(permille), abs=1e-9)
    assert len(np.unique(np.round(permille))) > 20
    asked = trace["current"][: len(trace) - 2] / one
    assert np.abs(permille[2:] - asked).max() <= 0.5 + 1e-9
    assert np.abs(permille[2:] - asked).max() > 0.3


def test_current_saturates_at_the_peak() -> None:
    class Shout:
        def reset(self) -> None: ...

        def step(self, port: ebac.Port) -> float:
            return math.copysign(1e4, math.sin(50 * port.x * 1e3 + 0.1))

    device = ebac.Device()
    trace = ebac.simulate(ebac.Scenario(device=device, seconds=0.3), Shout())
    peak = device.drive.peak_current(device.motor)
    assert set(np.unique(np.abs(trace["current"]))) == {peak}
    assert set(np.unique(np.abs(trace["current_applied"]))) == {0.0, peak}
    assert np.abs(trace["f_applied"]).max() == pytest.approx(device.peak_force)
    assert trace["tau"].max() == pytest.approx(1e4 * device.radius)


def test_current_lag_is_the_one_of_the_drive() -> None:
    class Push:
        def reset(self) -> None: ...

        def step(self, port: ebac.Port) -> float:
            return 1.0

    for lag in (0.0, 3e-4, 5e-3):
        device = ebac.Device(drive=ebac.Drive(current_lag=lag))
        scenario = ebac.Scenario(device=device, timing=ebac.Timing(delay=0), seconds=0.02)
        trace = ebac.simulate(scenario, Push())
        expected = 1 - np.exp(-trace["t"] / lag) if lag else (trace["t"] > 0).astype(float)
        assert trace["true.f_motor"] == pytest.approx(expected, abs=1e-9)


# --- what compensation costs ---


def test_given_back_inertia_is_charged_as_damping() -> None:
    device = ebac.Device(compensation=ebac.Compensation(inertia=0.005, inertia_lag=5e-3))
    assert device.facts.damping == pytest.approx(2.0 - 1.0)
    assert device.facts.mass == pytest.approx(0.245)


def test_energy_laws_refuse_a_device_whose_damping_is_spent() -> None:
    device = ebac.Device(compensation=ebac.Compensation(inertia=0.1))
    message = (
        r"Compensation\.inertia = 0\.1 kg: leaves -18 N s/m of .* 2 N s/m for EBA\.damping; .* less"
    )
    with pytest.raises(ValueError, match=message):
        ebac.simulate(ebac.Scenario(device=device), "eba")
    device = ebac.Device(compensation=ebac.Compensation(friction=0.3))
    message = r"Compensation\.friction = 0\.3 N: more than the Coulomb friction of the device, 0 N, .* -13 N s/m"
    with pytest.raises(ValueError, match=message):
        ebac.simulate(ebac.Scenario(device=device), "eba")
    with pytest.raises(ValueError, match=message):  # a study knows the facts of the device alone
        ebac.study(ebac.Operators.grid()[:1], "eba", base=ebac.Scenario(device=device))
    with pytest.raises(ValueError, match=r"EBA\.damping = 0 N s/m: must lie in \[0\.01, 500\]"):
        ebac.simulate(ebac.Scenario(device=device), "eba", damping=0.0)


@pytest.mark.parametrize("law", ["eba-account", "force-bounding"])
def test_a_passive_law_stays_passive_with_what_inertia_is_given_back(law: str) -> None:
    device = ebac.Device(compensation=ebac.Compensation(inertia=0.008))
    hand = ebac.Hand(mass=0.02, damping=0, stiffness=900, path=ebac.Tapping(frequency=7))
    trace = ebac.simulate(ebac.Scenario(device=device, hand=hand, seconds=2), law)
    lent = 0.5 * 0.008 * (trace["true.v"] ** 2).max()  # kinetic energy of the mass given back
    assert trace["true.energy"].min() >= -lent - 1e-3


@pytest.mark.parametrize("plant", [ebac.ExactPlant, ebac.SteppedPlant])
def test_a_plant_refuses_an_axis_it_does_not_have_and_a_tick_that_is_none(plant: Any) -> None:
    with pytest.raises(IndexError, match="axis 1: the plant has 1 axes"):
        plant(device=ebac.Device(), hand=ebac.Hand(), tick=1e-3).truth(1)
    for tick in (0.0, -1.0, float("nan")):
        with pytest.raises(ValueError, match=r"Timing\.dt = "):
            plant(device=ebac.Device(), hand=ebac.Hand(), tick=tick)


# --- in a file ---


def test_the_page_has_every_key_of_a_device_with_unit_and_default() -> None:
    page = Path(__file__).parents[2] / "docs" / "reference" / "configuration.md"
    shown: dict[str, dict[str, tuple[str, str]]] = {}
    part = ""
    for line in page.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) != 6 or not (key := re.fullmatch(r"`(\w+)`", cells[1])):
            continue
        if cells[0]:
            named = re.match(r"`\[device\.(\w+)\]`(?:, `type = \"(\w+)\"`)?$", cells[0])
            part = "" if named is None else named[2] or named[1]
        shown.setdefault(part, {})[key[1]] = (
            cells[2],
            cells[3].partition("; in a configuration")[0],
        )
    kinds = (ebac.Gimbal, ebac.SlidingGimbal, ebac.LowPass, ebac.AdaptiveWindow)
    parts = {
        ("Linear" if name == "kinematics" else name): type(value)
        for name, value in ebac.Device().as_dict().items()
        if name != "velocity"
    } | {kind.__name__: kind for kind in kinds}
    for name, kind in parts.items():
        assert shown[name] == {
            f.name: (
                "" if isinstance(f.default, bool) else f.unit,
                str(f.default).lower() if isinstance(f.default, bool) else f"{f.default:.4g}",
            )
            for f in kind.fields()
        }, name


def test_torque_ripple_is_felt_and_not_shown() -> None:
    """Under a current that hardly changes the true force of the motor ripples about the one that is applied."""
    device = ebac.Device(motor=ebac.Motor(ripple=0.02, waves=13), drive=ebac.Drive(current_lag=0.0))
    press = ebac.Hand(path=[ebac.MinimumJerk(target=0.04, duration=3.0)])
    wall = ebac.Wall(stiffness=1e3)
    scenario = ebac.Scenario(device=device, hand=press, environment=wall, seconds=4.0)
    trace = ebac.simulate(scenario, "direct")
    pressed = trace["f_applied"] > 1.0  # N
    share = trace["true.f_motor"][pressed] / trace["f_applied"][pressed] - 1
    assert 0.0199 < np.abs(share).max() <= 0.02 + 1e-9
    other = ebac.simulate(scenario.replace(seed=2), "direct")
    assert not np.array_equal(other["true.f_motor"], trace["true.f_motor"])


def test_an_offset_of_the_current_pushes_the_handle_where_nothing_is_asked_for() -> None:
    device = ebac.Device(drive=ebac.Drive(current_offset=0.01))
    scenario = ebac.Scenario(device=device, environment=ebac.Free(), seconds=1.0)
    trace = ebac.simulate(scenario, "direct")
    assert not trace["f_applied"].any()
    assert trace["true.f_motor"][-1] == pytest.approx(device.force(0.01))


@pytest.mark.parametrize(
    ("name", "motor", "drive"),
    [
        ("torque-ripple", {"ripple": 5e-3}, {}),
        ("torque-ripple-d2K20", {"ripple": 5e-3}, {}),
        ("current-noise", {}, {"current_noise": 5e-3}),
        ("current-offset", {}, {"current_offset": 10e-3}),
    ],
)
def test_errors_of_the_motor_are_conditions(name: str, motor: Any, drive: Any) -> None:
    [condition] = conditions([name])
    [made] = condition.scenarios(ebac.Operators.grid()[:1], ebac.Scenario())
    assert made.device == ebac.Device(motor=ebac.Motor(**motor), drive=ebac.Drive(**drive))
    assert made.device.facts == ebac.Device().facts, "no law knows of them"
