"""The operator: intended paths, tremor, letting go, presets."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ebac

times = st.floats(0, 100)


def target(path: Any, t: float, **changes: Any) -> float:
    return ebac.Hand(path=path, **changes).target(t)


# --- paths ---


@given(t=times, at=st.floats(0, 100), goal=st.floats(-1, 1))
def test_a_step_is_at_its_target_from_its_time_on(t: float, at: float, goal: float) -> None:
    assert target(ebac.Step(target=goal, at=at), t) == (goal if t >= at else 0.0)


@given(
    share=st.floats(0, 1), at=st.floats(0, 100), duration=st.floats(0.1, 10), goal=st.floats(-1, 1)
)
def test_minimum_jerk_is_the_polynomial_of_flash_and_hogan(
    share: float, at: float, duration: float, goal: float
) -> None:
    path = ebac.MinimumJerk(target=goal, at=at, duration=duration)
    expected = goal * (10 * share**3 - 15 * share**4 + 6 * share**5)
    assert target(path, at + share * duration) == pytest.approx(expected, abs=1e-9)
    assert target(path, at - 1e-9) == pytest.approx(0, abs=1e-12)
    assert target(path, at + duration + 1e-9) == pytest.approx(goal)


@given(
    t=times,
    centre=st.floats(-1, 1),
    amplitude=st.floats(0, 1),
    f=st.floats(0, 100),
    phase=st.floats(-10, 10),
)
def test_a_sine_swings_around_its_centre(
    t: float, centre: float, amplitude: float, f: float, phase: float
) -> None:
    path = ebac.Sine(centre=centre, amplitude=amplitude, frequency=f, phase=phase)
    expected = centre + amplitude * math.sin(2 * math.pi * f * t + phase)
    assert target(path, t) == pytest.approx(expected, abs=1e-9)


@given(cycle=st.integers(0, 1000), share=st.floats(0.001, 0.999), f=st.floats(0.01, 100))
def test_tapping_is_half_a_period_down_and_half_up(cycle: int, share: float, f: float) -> None:
    path = ebac.Tapping(target=0.03, rest=-0.02, frequency=f)
    if abs(share - 0.5) > 1e-3:
        assert target(path, (cycle + share) / f) == (0.03 if share < 0.5 else -0.02)


@given(
    points=st.lists(
        st.tuples(times, st.floats(-1, 1)), min_size=2, max_size=20, unique_by=lambda p: p[0]
    ),
    t=st.floats(-10, 110),
)
def test_a_recorded_path_is_straight_between_its_points(
    points: list[tuple[float, float]], t: float
) -> None:
    ts, xs = zip(*sorted(points), strict=True)
    path = ebac.Recorded(t=ts, x=xs)
    assert path.t == list(ts)
    assert path.x == list(xs)
    assert target(path, t) == pytest.approx(np.interp(t, ts, xs), abs=1e-9)


@pytest.mark.parametrize(
    ("t", "x", "why"),
    [
        ([0.0, 1.0], [0.0], r"t has 2 values and x 1; give one position for each time"),
        ([0.0], [0.0], r"needs at least 2 points, got 1"),
        ([], [], r"needs at least 2 points, got 0"),
        ([0.0, 1.0, 1.0], [0.0] * 3, r"time does not rise at point 2; sort the log by time"),
        ([0.0, 2.0, 1.0], [0.0] * 3, r"time does not rise at point 2"),
        ([0.0, 1.0], [0.0, math.nan], r"not a finite number at point 1"),
        ([-math.inf, 1.0], [0.0, 0.0], r"not a finite number at point 0"),
    ],
)
def test_a_bad_recording_is_refused_with_the_reason(
    t: list[float], x: list[float], why: str
) -> None:
    with pytest.raises(ValueError, match="Recorded: " + why):
        ebac.Recorded(t=t, x=x)


def test_tremor_rides_on_the_path() -> None:
    plain = ebac.Hand(path=ebac.Step(target=0.02))
    shaking = plain.replace(tremor_amplitude=1e-3, tremor_frequency=8.0)
    for t in np.linspace(0, 1, 37):
        expected = 1e-3 * math.sin(2 * math.pi * 8 * t)
        assert shaking.target(t) - plain.target(t) == pytest.approx(expected, abs=1e-12)
        assert shaking.target(t, 1) == pytest.approx(expected, abs=1e-12)  # on every axis


def test_tremor_is_felt_at_its_frequency() -> None:
    hand = ebac.Hand(tremor_amplitude=1e-3, tremor_frequency=8.0)
    scenario = ebac.Scenario(hand=hand, environment=ebac.Free(), seconds=4.0)
    x = ebac.simulate(scenario, "direct")["true.x"][2000:4000]
    spectrum = np.abs(np.fft.rfft(x - x.mean()))
    assert spectrum.argmax() / 2.0 == pytest.approx(8.0)


def test_the_other_axes_stay_at_zero_unless_they_have_a_path() -> None:
    assert ebac.Hand(path=ebac.Step(target=0.03)).target(1.0, 1) == 0
    two = ebac.Hand(path=[ebac.Step(target=0.03), ebac.Step(target=-0.01)])
    assert [two.target(1.0, axis) for axis in range(3)] == [0.03, -0.01, 0.0]
    assert len(two.path) == 3


@pytest.mark.parametrize("axis", [-1, 3])
def test_an_axis_that_no_hand_has_is_refused(axis: int) -> None:
    with pytest.raises(ValueError, match=rf"axis = {axis}: must lie in \[0, 2\]"):
        ebac.Hand().target(0.0, axis)


def test_a_target_is_short_for_a_step() -> None:
    assert ebac.Hand(target=0.02) == ebac.Hand(path=ebac.Step(target=0.02))
    both = [ebac.Step(target=0.02), ebac.Step(target=-0.01)]
    assert ebac.Hand(target=[0.02, -0.01]) == ebac.Hand(path=both)
    assert ebac.Hand(target=None) == ebac.Hand()
    with pytest.raises(TypeError, match="path and target are both given"):
        ebac.Hand(target=0.02, path=ebac.Step())
    with pytest.raises(TypeError, match=r"Hand.target = 'far': must be a number in m"):
        ebac.Hand(target="far")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"target = 11 m: must lie in \[-10, 10\] m"):
        ebac.Hand(target=11)


def test_a_hand_has_one_to_three_paths() -> None:
    for count in (0, 4):
        with pytest.raises(
            ValueError, match=rf"Hand.path has {count} paths: must have 1 to 3, one for each axis"
        ):
            ebac.Hand(path=[ebac.Step()] * count)
    with pytest.raises(
        TypeError, match=r"Hand.path = 'up': must be Step, MinimumJerk, Sine, Tapping, Recorded"
    ):
        ebac.Hand(path="up")


# --- the hand in a run ---

PATHS = [
    ebac.Step(target=0.02, at=0.1),
    ebac.MinimumJerk(target=0.02, duration=0.2),
    ebac.Sine(centre=0.0, amplitude=0.02, frequency=2.0),
    ebac.Tapping(frequency=4.0),
    ebac.Recorded(t=[0.0, 0.1, 0.3], x=[0.0, 0.02, -0.01]),
]


@pytest.mark.parametrize("path", PATHS, ids=lambda path: type(path).__name__)
def test_a_soft_device_follows_every_path(path: Any) -> None:
    hand = ebac.Hand(stiffness=5000.0, damping=40.0, path=path)
    trace = ebac.simulate(ebac.Scenario(hand=hand, environment=ebac.Free(), seconds=0.6), "direct")
    late = np.array([hand.target(t - 8e-3) for t in trace["t"]])  # B0 / K0
    error = np.abs(trace["true.x"] - late)
    assert np.median(error) < 1.5e-3
    assert np.ptp(trace["true.x"]) > 0.015


@pytest.mark.parametrize("path", PATHS, ids=lambda path: type(path).__name__)
def test_the_force_of_the_hand_is_equation_4(path: Any) -> None:
    hand = ebac.Hand(path=path)
    scenario = ebac.Scenario(
        hand=hand, environment=ebac.Free(), timing=ebac.Timing(dt=1e-4), seconds=0.5
    )
    trace = ebac.simulate(scenario, "direct")
    x, v, f = (trace[f"true.{name}"] for name in ("x", "v", "f_hand"))
    a = (v[2:] - v[:-2]) / 2e-4
    wanted = np.array([hand.target(t) for t in trace["t"][1:-1]])
    expected = 300 * (wanted - x[1:-1]) - 6 * v[1:-1] - 0.15 * a
    wrong = np.abs(f[1:-1] - expected) > 0.05
    assert np.count_nonzero(wrong) <= 12  # where the target jumps, so does the acceleration


@pytest.mark.parametrize("device", ["reference", "joystick"])
def test_a_hand_that_has_let_go_has_no_force(device: str) -> None:
    hand = ebac.Hand(release_at=0.2, tremor_amplitude=1e-3)
    scenario = ebac.Scenario(device=ebac.presets.device(device), hand=hand, seconds=0.4)
    trace = ebac.simulate(scenario, "ebac")
    force = trace["true.f_hand"].reshape(len(trace), -1)
    after = trace["t"] > 0.2005
    assert (force[after] == 0).all()
    assert (force[~after & (trace["t"] > 0.01)][:, 0] != 0).all()
    lagging = np.abs(trace.axis("f_meas")[after])
    assert lagging[-1] < 1e-9 < lagging[0]  # only the sensor remembers


def test_a_release_between_two_ticks_acts_from_the_next_tick_on() -> None:
    trace = ebac.simulate(ebac.Scenario(hand=ebac.Hand(release_at=0.0305), seconds=0.05), "eba")
    assert (trace["true.f_hand"][:32] != 0)[1:].all()
    assert (trace["true.f_hand"][32:] == 0).all()


# --- presets ---


@pytest.mark.parametrize("hand", ebac.presets.HANDS)
@pytest.mark.parametrize("device", ebac.presets.DEVICES)
def test_every_preset_simulates(hand: str, device: str) -> None:
    scenario = ebac.Scenario(
        device=ebac.presets.device(device), hand=ebac.presets.hand(hand), seconds=0.3
    )
    trace = ebac.simulate(scenario, "ebac")
    assert len(trace) == 301
    assert np.isfinite(trace["true.x"]).all()
    assert np.abs(trace["true.x"]).max() < 0.1


def test_every_preset_names_its_source() -> None:
    for preset in (*ebac.presets.HANDS.values(), *ebac.presets.DEVICES.values()):
        assert len(preset.source) >= 10


def test_the_reference_presets_are_the_defaults() -> None:
    assert ebac.presets.hand("reference") == ebac.Hand() == ebac.Scenario().hand
    assert ebac.presets.device("reference") == ebac.Device() == ebac.Scenario().device


@pytest.mark.parametrize("look_up", [ebac.presets.hand, ebac.presets.device])
def test_an_unknown_preset_lists_those_there_are(look_up: Any) -> None:
    with pytest.raises(
        KeyError, match=r"is called 'nobody'; (there are: reference, |`ebac presets` lists all)"
    ):
        look_up("nobody")


def test_the_pull_is_the_spring_of_eq_4_until_the_hand_lets_go() -> None:
    hand = ebac.Hand(
        stiffness=200, path=ebac.Sine(centre=0.01, amplitude=0.005, frequency=3), release_at=0.8,
        tremor_amplitude=1e-3,
    )  # fmt: skip
    t, x = np.linspace(0, 1, 101), np.linspace(-0.02, 0.03, 101)
    wanted = np.array([hand.target(at) for at in t.tolist()])
    expected = np.where(t < 0.8, 200 * np.abs(wanted - x), 0.0)
    np.testing.assert_allclose(hand.pull(t, x), expected, rtol=1e-12)
    with pytest.raises(ValueError, match="axis = 3: must lie in"):
        hand.pull(t, x, 3)


def test_a_path_given_as_a_target_is_told_where_it_goes() -> None:
    with pytest.raises(TypeError, match="a path, such as MinimumJerk, is given as path="):
        ebac.Hand(target=ebac.MinimumJerk(target=0.03))  # type: ignore[call-overload]
