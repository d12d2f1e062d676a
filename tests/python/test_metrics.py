"""A wall contact in numbers, on traces whose numbers are known."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.metrics.with_hand import moves_with_hand


def synthetic(x: NDArray[np.float64], dt: float = 1e-3, **more: NDArray[Any]) -> ebac.Trace:
    data = {"t": dt * np.arange(len(x)), "x": x, "f_applied": np.zeros(len(x)), **more}
    columns = {name: ebac.ColumnInfo(name=name, unit="1", meaning="made up") for name in data}
    return ebac.Trace(data=data, columns=columns, axes=1, law="made up")


T = 1e-3 * np.arange(6001)


@given(
    rest=st.floats(-0.01, 0.02),
    swing=st.floats(1e-3, 0.02),
    frequency=st.floats(3, 200),
    phase=st.floats(0, 6),
)
def test_a_swing_has_its_rest_size_and_frequency(
    rest: float, swing: float, frequency: float, phase: float
) -> None:
    x = rest + swing / 2 * np.sin(2 * np.pi * frequency * T + phase)
    row = ebac.contact(synthetic(x, f_applied=1000 * x))
    assert row.rest_m == pytest.approx(rest, abs=0.1 * swing)
    assert row.swing_m == pytest.approx(swing, rel=0.1)
    # 5 samples a period at 200 Hz show at least (1 + cos 36 deg)/2 = 0.905 of a swing
    assert row.force_swing_N == pytest.approx(1000 * row.swing_m)
    assert row.limit_cycle_Hz == pytest.approx(frequency, abs=0.1)
    assert row.settled_s is None
    assert not row.quiet


@given(rest=st.floats(-0.01, 0.02), start=st.floats(1e-3, 0.05), decay=st.floats(0.02, 0.5))
def test_what_settles_has_the_time_from_which_on_it_stays_close(
    rest: float, start: float, decay: float
) -> None:
    row = ebac.contact(synthetic(rest + start * np.exp(-T / decay)))
    if row.quiet:
        at_rest = row.rest_m - rest
        expected = decay * math.log(start / (0.125e-3 + at_rest))
        assert row.settled_s == pytest.approx(expected, abs=2e-3)
        assert row.limit_cycle_Hz is None
    assert row.rest_m == pytest.approx(rest, abs=1e-3)
    assert row.peak_m == rest + start


def test_what_never_moves_has_settled_at_once() -> None:
    row = ebac.contact(synthetic(np.full(100, 0.003)))
    assert (row.rest_m, row.swing_m, row.settled_s, row.peak_m) == (
        pytest.approx(0.003),
        0.0,
        0.0,
        0.003,
    )
    assert row.quiet


def test_a_part_of_a_run_settles_from_its_own_first_row_on() -> None:
    later = ebac.contact(ebac.simulate(ebac.Scenario(), "ebac")[3.0:])
    assert later.settled_s == pytest.approx(0, abs=1e-3)
    assert later.force_settled_s == pytest.approx(0, abs=1e-3)


def test_the_border_of_quiet_is_a_quarter_of_a_millimetre() -> None:
    for swing, quiet in ((0.249e-3, True), (0.251e-3, False)):
        x = swing / 2 * np.where(np.arange(1000) % 2, 1.0, -1.0)
        row = ebac.contact(synthetic(x))
        assert row.quiet is quiet
        assert (row.settled_s is not None) is quiet
        assert (row.limit_cycle_Hz is None) is quiet


def test_only_the_last_thirty_percent_count_as_rest() -> None:
    x = np.where(np.arange(1000) < 700, 0.01, 0.002)
    row = ebac.contact(synthetic(x))
    assert row.rest_m == pytest.approx(0.002)
    assert row.swing_m == 0
    assert row.settled_s == pytest.approx(0.7)
    assert row.peak_m == 0.01


def test_what_a_trace_does_not_hold_is_none() -> None:
    row = ebac.contact(synthetic(np.zeros(100)))
    assert row.ideal_m is None
    assert row.deviation_m is None
    assert row.exact is None
    assert row.least_energy_J is None
    assert row.clamped_share is None
    assert row.count_m is None


def test_energy_is_the_least_of_the_sum_of_all_axes() -> None:
    energy = np.zeros((100, 2))
    energy[30] = -2.0, 1.5
    energy[60] = 0.5, -0.2
    row = ebac.contact(synthetic(np.zeros(100), **{"true.energy": energy}))
    assert row.least_energy_J == -0.5


def test_the_true_position_goes_before_the_measured_one() -> None:
    row = ebac.contact(synthetic(np.zeros(100), **{"true.x": np.full(100, 0.001)}))
    assert row.rest_m == pytest.approx(0.001)


def test_without_the_truth_a_simulation_is_measured_as_a_recording() -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=1))
    told = {name: info for name, info in trace.columns.items() if not name.startswith("true.")}
    data = {name: trace[name] for name in told}
    recorded = ebac.Trace(data=data, columns=told, axes=1, law="ebac", scenario=trace.scenario)
    assert ebac.contact(trace, truth=False) == ebac.contact(recorded)
    assert ebac.contact(trace, truth=False).least_energy_J is None
    assert ebac.contact(trace) != ebac.contact(recorded)


def test_clamped_share_is_the_share_of_ticks() -> None:
    clamped = np.arange(200) % 4 == 0
    row = ebac.contact(synthetic(np.zeros(200), **{"law.clamped": clamped}))
    assert row.clamped_share == 0.25


def test_a_trace_too_short_or_without_that_axis_is_refused() -> None:
    with pytest.raises(ValueError, match="9 rows: a contact needs at least 10"):
        ebac.contact(synthetic(np.zeros(9)))
    with pytest.raises(ValueError, match="axis = 1"):
        ebac.contact(synthetic(np.zeros(10)), axis=1)


def test_each_axis_is_measured_by_itself(run: Any) -> None:
    hand = ebac.Hand(path=[ebac.Step(target=0.02), ebac.Step(target=-0.01)])
    two = ebac.Device(kinematics=ebac.Linear(axes=2))
    trace = run("eba", device=two, hand=hand, environment=ebac.Free(), seconds=2.0)
    rests = [ebac.contact(trace, axis=axis).rest_m for axis in (0, 1)]
    assert rests == pytest.approx([0.02, -0.01], abs=1e-4)


def test_an_axis_that_swings_is_judged_whichever_it_is() -> None:
    """`direct` swung by 12 mm at the peak force on the second axis, and the verdict of the first was quiet."""
    device = ebac.Device(kinematics=ebac.Linear(axes=2), sensor=ebac.ForceSensor(noise=0.03))
    hand = ebac.Hand(path=[ebac.Step(target=0.02), ebac.Step(target=0.02)])
    soft, stiff = (300.0, 20e3)
    swings = []
    for first, second in ((soft, stiff), (stiff, soft)):
        corner = ebac.Corner(
            first=ebac.Wall(stiffness=first), second=ebac.Wall(stiffness=second, angle=math.pi / 2)
        )
        run = ebac.Scenario(device=device, hand=hand, environment=corner)
        found = ebac.contact(ebac.simulate(run, "direct"))
        outcome = ebac.sweep([run], ["direct"])
        assert (found.still, found.quiet) == (False, False)
        assert (outcome["still"][0], outcome["quiet"][0]) == (False, False)
        assert outcome["swing_m"][0] == pytest.approx(found.swing_m)
        assert "swings" in found.verdict
        swings.append(found.swing_m)
    assert swings[0] == pytest.approx(swings[1], rel=0.1)
    assert swings[0] > 10e-3


def test_the_command_says_what_it_shows_of_several_axes(tmp_path: Path) -> None:
    device = ebac.Device(kinematics=ebac.Linear(axes=2))
    file = tmp_path / "two.toml"
    ebac.Scenario(device=device, seconds=1.0).save(file)
    done = CliRunner().invoke(app, ["wall", "--scenario", str(file), "--law", "direct"])
    assert done.exit_code == 0, done.output
    assert "Of the 2 axes: rest and deepest are those of the first" in " ".join(done.output.split())
    alone = CliRunner().invoke(app, ["wall", "--law", "direct", "--seconds", "1"])
    assert "axes" not in alone.output


def test_an_axis_in_free_air_may_move() -> None:
    device = ebac.Device(kinematics=ebac.Linear(axes=2))
    sine = ebac.Sine(centre=0.0, amplitude=0.01, frequency=1.0)
    hand = ebac.Hand(path=[ebac.Step(target=0.02), sine])
    trace = ebac.simulate(ebac.Scenario(device=device, hand=hand), "ebac")
    assert ebac.contact(trace).quiet
    assert not ebac.contact(trace, axis=1).still


# --- the force ---


def force(f: NDArray[np.float64], dt: float = 1e-3) -> ebac.Contact:
    """Return the contact of a force at a position that never moves."""
    return ebac.contact(synthetic(np.zeros(len(f)), dt, f_applied=f))


def threshold_at(frequency: float, dt: float = 1e-3) -> tuple[float, float]:
    """Return the high-pass and the amplitude that is just detected [N], from the transfer functions of the docs."""
    k = math.tan(math.pi * frequency * dt) / math.tan(math.pi * 20 * dt)
    high = k**2 / math.sqrt(1 + k**4)
    pole = np.exp(2 * math.pi * 200 * dt * (-0.5 + 1j * math.sqrt(0.75)))
    z = np.exp(2j * math.pi * frequency * dt)
    low = abs(1 - pole) ** 2 / (abs(1 - pole / z) * abs(1 - pole.conjugate() / z))
    return high, 25e-3 / (high * low)


@given(rest=st.floats(-50, 50), rows=st.integers(10, 3000))
def test_a_constant_force_is_quiet(rest: float, rows: int) -> None:
    row = force(np.full(rows, rest))
    assert row.force_rest_N == pytest.approx(rest)
    assert (row.force_settled_s, row.ripple_N, row.jumps) == (0, 0, 0)
    assert row.ripple_rms_N == pytest.approx(0, abs=1e-9)
    assert row.perceived == pytest.approx(0, abs=1e-6)
    assert row.still
    assert row.force_quiet


@given(
    rest=st.floats(-20, 20),
    amplitude=st.floats(1e-3, 0.19),
    frequency=st.floats(22, 240),
    phase=st.floats(0, 6),
)
def test_a_sine_ripples_as_its_amplitude_says_and_is_perceived_as_the_curve_says(
    rest: float, amplitude: float, frequency: float, phase: float
) -> None:
    row = force(rest + amplitude * np.sin(2 * np.pi * frequency * T + phase))
    high, threshold = threshold_at(frequency)
    assert row.force_settled_s == 0
    assert row.ripple_N == pytest.approx(2 * amplitude, rel=0.15)  # four samples a period or more
    assert row.ripple_rms_N == pytest.approx(amplitude / math.sqrt(2), rel=0.02)
    assert row.ripple_high_N == pytest.approx(high * amplitude / math.sqrt(2), rel=0.02)
    assert row.perceived == pytest.approx(amplitude / threshold, rel=0.04)
    assert row.force_quiet is ((row.perceived or 0) < 3)


@given(frequency=st.floats(0.2, 2), amplitude=st.floats(0.01, 0.19))
def test_what_moves_slowly_is_not_perceived(frequency: float, amplitude: float) -> None:
    row = force(10 + amplitude * np.sin(2 * np.pi * frequency * T))
    assert row.ripple_N == pytest.approx(2 * amplitude, rel=0.01)
    assert row.force_quiet


@given(seed=st.integers(0, 99), factor=st.floats(0.01, 10), offset=st.floats(-20, 20))
def test_ripple_and_what_is_perceived_of_it_scale_with_the_force(
    seed: int, factor: float, offset: float
) -> None:
    noise = np.random.default_rng(seed).uniform(-0.01, 0.01, 2000)
    one, other = force(noise), force(factor * noise + offset)
    for name in ("ripple_N", "ripple_rms_N", "ripple_high_N", "perceived"):
        assert getattr(other, name) == pytest.approx(factor * getattr(one, name), rel=1e-6), name
    assert other.force_rest_N == pytest.approx(factor * one.force_rest_N + offset)


@given(size=st.floats(-5, 5), at=st.integers(100, 900))
def test_a_step_is_one_jump_if_it_is_larger_than_a_fifth_of_a_newton(size: float, at: int) -> None:
    row = force(np.where(np.arange(1000) < at, 3.0, 3.0 + size))
    if abs(abs(size) - 0.2) > 1e-9:
        assert row.jumps == (abs(size) > 0.2)


@given(count=st.integers(0, 40), size=st.floats(0.25, 5))
def test_every_click_is_two_jumps(count: int, size: float) -> None:
    f = np.full(1000, 3.0)
    f[100 : 100 + 20 * count : 20] += size
    assert force(f).jumps == 2 * count


@given(last=st.integers(0, 999), rest=st.floats(0.1, 50), beyond=st.floats(1.01, 3))
def test_a_force_settles_after_it_left_its_band_for_the_last_time(
    last: int, rest: float, beyond: float
) -> None:
    f = np.full(1000, rest)
    f[last] += beyond * max(0.05 * rest, 0.2) + (0.02 if last >= 700 else 0)
    row = force(f)
    if last < 700:
        assert row.force_settled_s == pytest.approx(1e-3 * (last + 1))
    else:
        assert row.force_settled_s is None
        assert not row.force_quiet


def test_without_a_settled_position_the_force_is_measured_over_the_tail() -> None:
    x = 0.001 * (-1.0) ** np.arange(1000)
    f = np.full(1000, 2.0)
    f[600], f[800] = 9.0, 2.1
    row = ebac.contact(synthetic(x, f_applied=f))
    assert (row.still, row.settled_s, row.jumps) == (False, None, 0)
    assert row.ripple_N == pytest.approx(0.1)
    f[900] = 3.0
    assert ebac.contact(synthetic(x, f_applied=f)).jumps == 2


def test_few_rows_a_second_show_no_vibration() -> None:
    row = force(np.zeros(100), dt=0.0126)
    assert (row.ripple_high_N, row.perceived, row.force_quiet) == (None, None, False)


def test_the_completed_law_clicks_on_the_encoder_alone_and_the_bounded_one_does_not(
    run: Any,
) -> None:
    clicks, smooth = ebac.contact(run("ebac", observer=False)), ebac.contact(run("eba"))
    assert clicks.still
    assert not clicks.force_quiet
    assert clicks.jumps > 300
    assert clicks.force_settled_s > 2
    assert clicks.perceived > 10
    assert smooth.still
    assert smooth.force_quiet
    assert smooth.jumps == 0
    assert smooth.perceived < 1


def test_an_ideal_wall_is_quiet() -> None:
    """A spring and a damper, continuous: the handle rings down on it at 25 Hz."""
    mass, damping, stiffness, pull = 0.4, 40.0, 10e3, 12.0
    decay, ring = damping / (2 * mass), math.sqrt(stiffness / mass - (damping / (2 * mass)) ** 2)
    swing = np.exp(-decay * T) * (np.cos(ring * T) + decay / ring * np.sin(ring * T))
    x = pull / stiffness * (1 - swing)
    row = ebac.contact(synthetic(x, f_applied=stiffness * x))
    assert row.quiet
    assert row.force_quiet


def test_a_wall_that_gives_way_first_is_soft_on_impact(run: Any) -> None:
    stiff = ebac.contact(run("ebac"))
    assert stiff.impact_share == pytest.approx(1, abs=0.05)
    assert not stiff.soft
    slow = ebac.Variant(
        "lag-compensator", {"stiffness": 500, "recovery_time": 0.3, "virtual_damping": 20}
    )
    noisy = ebac.Scenario(observer="every-law")
    soft = ebac.contact(ebac.simulate(noisy, slow))
    assert soft.exact
    assert soft.soft
    assert soft.verdict == "exact and quiet, soft on impact"
    trace = ebac.simulate(noisy, slow)
    deepest = int(trace["true.x"].argmax())
    assert soft.impact_share == trace["f_applied"][deepest] / trace["f_env"][deepest]


def test_a_handle_that_never_touches_has_no_stiffness_on_impact() -> None:
    scenario = ebac.Scenario(environment=ebac.Wall(position=0.2), seconds=0.5)
    assert ebac.contact(ebac.simulate(scenario, "ebac")).impact_share is None


def test_the_verdict_on_the_force_is_read_in_words(run: Any) -> None:
    assert (
        ebac.contact(run("ebac", observer=False)).force_verdict
        == "not quiet: settled 2.994 s, 338 jumps, vibration 19.8 thresholds"
    )
    assert (
        ebac.contact(run("eba")).force_verdict
        == "quiet: settled 0.407 s, no jump, vibration 0.809 thresholds"
    )
    assert "vibration not known" in force(np.zeros(100), dt=0.1).force_verdict
    assert force(np.where(np.arange(1000) < 990, 1.0, 2.0)).force_verdict.startswith(
        "not quiet: settled never, 1 jump, vibration "
    )


def test_a_still_contact_that_is_not_quiet_says_so(run: Any) -> None:
    rippling = ebac.contact(run("ebac", observer=False))
    assert rippling.verdict == "exact, force not quiet"
    assert replace(rippling, rest_m=0.002).verdict == "too deep by 0.835 mm, force not quiet"
    assert replace(rippling, ideal_m=None).verdict == "force not quiet"
    assert replace(rippling, still=False).verdict == "swings"


# --- the ideal ---

#: A handle that tips the lever of 100 mm over: 3 kg of 9.81 m/s^2 are 294 N/m away from the middle.
TIPS = ebac.Device(
    kinematics=ebac.Gimbal(), mechanics=ebac.Mechanics(handle_mass=3.0, gravity=9.81)
)


@given(
    stiffness=st.floats(50, 2000),
    target=st.floats(-0.05, 0.05),
    wall=st.floats(100, 1e6),
    position=st.floats(-0.02, 0.02),
    gravity=st.floats(-10, 10),
)
def test_the_ideal_is_where_all_forces_balance(
    stiffness: float, target: float, wall: float, position: float, gravity: float
) -> None:
    scenario = ebac.Scenario(
        device=ebac.Device(mechanics=ebac.Mechanics(gravity=gravity)),
        hand=ebac.Hand(stiffness=stiffness, path=ebac.Step(target=target)),
        environment=ebac.Wall(stiffness=wall, position=position),
    )
    x = ebac.ideal_rest(scenario)
    assert x is not None
    push = wall * max(0.0, x - position)
    assert stiffness * (target - x) + 0.114 * gravity == pytest.approx(push, abs=1e-6)


@pytest.mark.parametrize(
    "changes",
    [
        {"environment": ebac.Free()},
        {"environment": ebac.Corner()},
        {"environment": ebac.Wall(angle=0.1)},
        {"environment": ebac.Wall(motion_amplitude=2e-3)},
        {"hand": ebac.Hand(release_at=1.0)},
        {"hand": ebac.Hand(path=ebac.Sine())},
        {"hand": ebac.Hand(path=ebac.Tapping())},
        {"hand": ebac.Hand(path=ebac.Recorded(t=[0.0, 6.0], x=[0.0, 1.0]))},  # as long as the run
        {"hand": ebac.presets.hand("open")},
        {
            "device": ebac.Device(kinematics=ebac.Gimbal()),
            "hand": ebac.Hand(path=(ebac.Step(), ebac.Sine())),
        },
        {"device": TIPS, "hand": ebac.Hand(stiffness=20)},
    ],
)
def test_there_is_no_ideal_where_nothing_comes_to_rest(changes: dict[str, Any]) -> None:
    assert ebac.ideal_rest(ebac.Scenario(**changes)) is None


def test_a_recorded_path_rests_where_it_ends() -> None:
    stepped = ebac.Scenario(hand=ebac.Hand(path=ebac.Step(target=0.03)))
    recorded = ebac.Hand(path=ebac.Recorded(t=[0.0, 1.0, 2.0], x=[0.0, 0.05, 0.03]))
    assert ebac.ideal_rest(stepped.replace(hand=recorded)) == ebac.ideal_rest(stepped)


def test_the_reference_rests_ideally_at_the_figure_of_the_theory() -> None:
    assert ebac.ideal_rest(ebac.Scenario()) == pytest.approx(1.165e-3, abs=1e-6)


# --- the reference scenario, issue by issue ---


@pytest.mark.parametrize(
    ("law", "stiffness", "path", "verdict"),
    [
        ("ebac", 1500, ebac.Sine(centre=0.03, amplitude=0.005, frequency=5), "moves with the hand"),
        ("ebac", 1500, ebac.MinimumJerk(target=0.05, at=0.5, duration=1.4), "moves with the hand"),
        ("direct", 10e3, ebac.Sine(centre=0.03, amplitude=0.005, frequency=5), "swings"),
        ("direct", 10e3, ebac.MinimumJerk(target=0.05, at=0.5, duration=1.4), "swings"),
        ("ebac", 10e3, ebac.Sine(centre=0.04, amplitude=0.03, frequency=4), "moves with the hand"),
        # The hand goes a longer way than the handle, which swings at 16 Hz.
        ("direct", 10e3, ebac.Sine(centre=0.04, amplitude=0.03, frequency=4), "swings"),
        ("tca", 10e3, ebac.Sine(centre=0.04, amplitude=0.03, frequency=4), "swings"),
    ],
)
def test_a_handle_that_follows_its_hand_is_in_no_limit_cycle(
    law: str, stiffness: float, path: Any, verdict: str
) -> None:
    scenario = ebac.Scenario(
        hand=ebac.Hand(path=path), environment=ebac.Wall(stiffness=stiffness), seconds=2
    )
    trace = ebac.simulate(scenario, law)
    for truth in (True, False):
        met = ebac.contact(trace, truth=truth)
        assert met.verdict == verdict
        assert met.swing_m > 0.25e-3
        assert ("limit cycle         none" in str(met)) == (verdict != "swings")


def test_energy_beyond_the_reserve_comes_first_in_a_verdict() -> None:
    """A hand that moved and drew 47.5 J was said to move alone."""
    moving = {"with_hand": True, "still": False, "quiet": False}
    calm = ebac.contact(ebac.simulate(ebac.Scenario(), "ebac"))
    for least, before in ((-0.009, ""), (-0.0123, "draws 12.3 mJ: "), (-47.53, "draws 47.5 J: ")):
        drew = replace(calm, least_energy_J=least)
        assert drew.verdict == f"{before}exact and quiet"
        assert replace(drew, **moving).verdict == f"{before}moves with the hand"
        assert replace(drew, still=False).verdict == "swings"
        assert replace(drew, drawn_J=0.0).verdict == "exact and quiet", "a moving wall did the work"
        assert replace(drew, surface_moves=True).verdict == "not judged: the surface moves"


@pytest.mark.parametrize("name", ["t", "x", "f_applied"])
def test_a_row_that_is_no_number_is_not_judged(run: Any, name: str) -> None:
    trace = run("ebac", seconds=0.5)
    values = trace[name].copy()
    values[400] = np.nan
    with pytest.raises(
        ValueError, match=rf"{name} is no number in 1 of 501 rows, first in row 400"
    ):
        ebac.contact(trace.with_column(name, values), truth=False)


def test_tremor_and_a_hand_that_has_let_go_excuse_no_swing() -> None:
    shaking = ebac.Hand(target=0.03, tremor_amplitude=0.01, tremor_frequency=5)
    scenario = ebac.Scenario(
        hand=shaking, environment=ebac.Wall(stiffness=1500), observer=False, seconds=2
    )
    assert ebac.contact(ebac.simulate(scenario, "ebac")).verdict == "swings"
    moving = ebac.Hand(path=ebac.Sine(amplitude=0.01, frequency=1))
    made = synthetic(0.001 * np.sin(6 * T))
    for release, follows in ((1.0, False), (np.inf, True)):
        own = scenario.replace(hand=moving.replace(release_at=release))
        trace = ebac.Trace(
            data={name: made[name] for name in made}, columns=made.columns, axes=1, scenario=own
        )
        assert moves_with_hand(trace) is follows


@pytest.mark.parametrize("seconds", [6, 7, 8.3, 10])
@pytest.mark.parametrize("frequency", [0.8, 1.3])
def test_a_hand_that_taps_has_one_verdict_whenever_the_run_ends_and_no_limit_cycle(
    frequency: float, seconds: float
) -> None:
    tapping = ebac.Hand(path=ebac.Tapping(target=0.04, rest=-0.01, frequency=frequency))
    trace = ebac.simulate(ebac.Scenario(hand=tapping, seconds=seconds), "ebac")
    met = ebac.contact(trace)
    assert met.verdict == "moves with the hand"
    assert met.limit_cycle is None
    rows = {name: trace[name] for name in trace if not name.startswith("true.")}
    recorded = ebac.contact(ebac.Trace(data=rows, columns=tuple(rows), axes=1))
    if seconds > 7:  # else it is less than two swings
        assert recorded.limit_cycle_Hz == pytest.approx(frequency, rel=0.02)
    assert (recorded.verdict, recorded.limit_cycle) == ("swings", None)  # nobody knows its target


def test_neither_a_data_set_nor_free_air_names_the_pace_of_a_hand_a_limit_cycle(
    tmp_path: Path,
) -> None:
    tapped = ebac.contact(ebac.load(ebac.datasets.write("tapping", tmp_path)))
    assert (tapped.verdict, tapped.limit_cycle) == ("moves with the hand", None)
    waving = ebac.Hand(path=ebac.Sine(centre=0.0, amplitude=0.012, frequency=1.3))
    air = ebac.Scenario(hand=waving, environment=ebac.Free(), seconds=6)
    assert ebac.contact(ebac.simulate(air, "ebac")).limit_cycle is None
    shaking = ebac.simulate(ebac.Scenario(seconds=3), "tca")
    rows = {name: shaking[name] for name in shaking if not name.startswith("true.")}
    recorded = ebac.contact(ebac.Trace(data=rows, columns=tuple(rows), axes=1))
    assert recorded.limit_cycle == pytest.approx(18.9, abs=2)


def test_tca_swings_by_five_millimetres_or_more(run: Any) -> None:
    row = ebac.contact(run("tca"))
    assert row.swing_m >= 5e-3
    assert row.settled_s is None
    assert 5 < (row.limit_cycle_Hz or 0) < 50


def test_eba_is_still_but_too_deep(run: Any) -> None:
    row = ebac.contact(run("eba"))
    assert row.count_m is not None
    assert row.swing_m <= row.count_m
    assert (row.deviation_m or 0) > 1e-3
    assert row.exact is False


@pytest.mark.parametrize("seed", range(1, 21))
def test_ebac_rests_quietly_at_the_ideal(seed: int, run: Any) -> None:
    row = ebac.contact(run("ebac", seed=seed))
    assert row.exact
    assert row.swing_m < 0.25e-3
    assert row.settled_s is not None
    assert row.settled_s < 1.5
    assert (row.least_energy_J or 0) >= -1e-3


@pytest.mark.parametrize("position", [0.0, 0.002, 0.01, 0.03])
def test_ebac_finds_a_wall_wherever_it_stands(position: float, run: Any) -> None:
    row = ebac.contact(run("ebac", environment=ebac.Wall(position=position)))
    assert row.exact, f"rests {row.deviation_m} m beyond the ideal"
    assert row.quiet


def test_friction_widens_what_counts_as_exact_by_the_band_it_can_hold() -> None:
    def allowed(wall: ebac.Wall, **mechanics: float) -> float:
        device = ebac.Device(mechanics=ebac.Mechanics(**mechanics))
        scenario = ebac.Scenario(device=device, environment=wall)
        return ebac.metrics.allowed_deviation(scenario) - 2 * device.count

    reached, missed = ebac.Wall(stiffness=10e3), ebac.Wall(position=0.1)
    assert allowed(reached) == 0
    assert allowed(reached, coulomb=1.0) == pytest.approx(1 / (300 + 10e3))
    assert allowed(reached, coulomb=0.2, breakaway=0.5) == pytest.approx(0.5 / (300 + 10e3))
    assert allowed(missed, coulomb=1.0) == pytest.approx(1 / 300)


@pytest.mark.parametrize("friction", [0.3, 1.0])
def test_an_ideal_wall_under_friction_is_good_for_every_hand(friction: float) -> None:
    """A hand stops anywhere within the band of friction, so a narrower criterion would blame the ideal."""
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=friction))
    scenarios = ebac.Operators.grid().scenarios(ebac.Scenario(device=device))
    from ebac.studies.ideal import ideal_contacts

    away = np.abs(
        ideal_contacts(scenarios)["rest_m"] - [ebac.ideal_rest(s) or np.nan for s in scenarios]
    )
    allowed = np.array([ebac.metrics.allowed_deviation(s) for s in scenarios])
    assert (away <= allowed).all()
    if friction == 1:
        assert (away > 2 * device.count).sum() > 10


@pytest.mark.parametrize("law", ["direct", "ebac"])
def test_force_step_and_pull_are_those_of_the_columns(law: str, run: Any) -> None:
    trace = run(law, seconds=1.0)
    row = ebac.contact(trace)
    assert row.force_step_N == np.abs(np.diff(trace["f_applied"])).max()
    acts = (trace["f_env"] != 0) | (trace["f_cmd"] != 0) | (trace["f_applied"] != 0)
    pull = 300 * np.abs(0.04 - trace["true.x"])
    assert row.most_pull_N == pytest.approx(pull[acts].max(), rel=1e-12)
    [swept] = ebac.sweep([trace.scenario], law)["most_pull_N"]
    assert swept == row.most_pull_N


def test_a_hand_that_touches_nothing_pulls_at_nothing() -> None:
    scenario = ebac.Scenario(environment=ebac.Wall(position=0.2), seconds=0.5)
    assert ebac.contact(ebac.simulate(scenario, "ebac")).most_pull_N == 0


def test_the_row_is_the_documented_one(run: Any) -> None:
    row = ebac.contact(run("ebac")).row()
    assert list(row) == [
        "law", "rest_m", "ideal_m", "swing_m", "force_swing_N", "settled_s", "peak_m",
        "limit_cycle_Hz", "least_energy_J", "clamped_share",
        "force_rest_N", "force_settled_s", "ripple_N", "ripple_rms_N", "ripple_high_N", "jumps", "perceived",
        "still", "force_quiet", "quiet", "touched_at_rest", "drawn_J", "impact_share",
        "deviation_m", "exact", "verdict",
    ]  # fmt: skip
    assert json.loads(json.dumps(row)) == row


@pytest.mark.parametrize("noise", [0.0, 0.03])
@pytest.mark.parametrize("stiffness", [10e3, 20e3])
def test_the_force_above_20_hz_is_a_part_of_its_ripple(noise: float, stiffness: float) -> None:
    """The ring of the filter after the impact was counted, and the part was larger than the whole."""
    device = ebac.Device(sensor=ebac.ForceSensor(noise=noise))
    scenario = ebac.Scenario(device=device, environment=ebac.Wall(stiffness=stiffness))
    row = ebac.contact(ebac.simulate(scenario, "ebac"))
    assert row.ripple_high_N is not None
    assert 0 < row.ripple_high_N < row.ripple_rms_N


def test_a_contact_on_the_second_axis_alone_is_one() -> None:
    """It was "no contact", with a handle that shook at the peak force."""
    side = ebac.worlds.Box(width=0.2, depth=0.02, height=0.2)
    world = ebac.worlds.World(ebac.worlds.Placed(side, at=(0.0, 0.02, 0.0)))
    scenario = ebac.Scenario(
        device=ebac.Device(kinematics=ebac.Linear(axes=2)),
        hand=ebac.Hand(path=[ebac.Step(target=0.0), ebac.Step(target=0.04)]),
        environment=world,
        seconds=1.0,
    )
    met = ebac.contact(ebac.simulate(scenario, "direct"))
    assert met.touched
    assert met.touched_at_rest
    assert met.verdict == "swings"


@pytest.mark.parametrize(
    "path",
    [ebac.Step(target=0.03, at=5.0), ebac.MinimumJerk(target=0.03, duration=10.0)],
)
def test_a_hand_on_its_way_when_the_run_ends_is_not_judged(path: Any) -> None:
    """It was "not deep enough"."""
    scenario = ebac.Scenario(hand=ebac.Hand(path=path), seconds=2.0)
    assert ebac.ideal_rest(scenario) is None
    assert ebac.ideal_rest(scenario.replace(seconds=20.0)) is not None
    assert ebac.contact(ebac.simulate(scenario, "ebac")).exact is None
