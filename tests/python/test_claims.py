"""The claims of `ebac.testing`: what each lets pass, what it catches and how it tells."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebac
from ebac.testing import (
    Tolerance,
    assert_force_continuous,
    assert_passive,
    assert_settles,
    assert_within_limits,
    compare,
    default_tolerance,
    strategies,
)

UNITS = {"t": "s", "x": "m", "f_applied": "N", "f_cmd": "N", "dx": "m", "dt": "s"}


def made_up(**columns: Any) -> ebac.Trace:
    data = {name: np.asarray(values) for name, values in columns.items()}
    data = {"t": 1e-3 * np.arange(len(next(iter(data.values())))), **data}
    info = {n: ebac.ColumnInfo(name=n, unit=UNITS.get(n, "1"), meaning="made up") for n in data}
    return ebac.Trace(data=data, columns=info, axes=1, law="made up")


# --- passive ---


def test_passive_names_when_and_how_much() -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=1.0), "tca")
    energy = trace["true.energy"]
    tick = int(energy.argmin())
    with pytest.raises(AssertionError) as caught:
        assert_passive(trace)
    assert (
        f"falls to {1e3 * energy[tick]:.6g} mJ at tick {tick}, t = {trace['t'][tick]:.6g} s"
        in str(caught.value)
    )
    assert_passive(trace, reserve=-float(energy.min()))
    assert_passive(ebac.simulate(ebac.Scenario(seconds=1.0), "eba-account"))


def test_passive_counts_what_can_be_observed_where_nothing_is_known() -> None:
    dx = np.array([0, 1e-3, -1e-3, 1e-3])
    trace = made_up(dx=dx, dt=np.full(4, 1e-3), f_applied=np.array([0.0, 1, 2, 3]))
    with pytest.raises(ValueError, match=r"no column true\.energy: give damping="):
        assert_passive(trace)
    with pytest.raises(
        AssertionError, match=r"the energy observed at the port falls to -1 mJ at tick 2"
    ):
        assert_passive(trace, damping=0.0)  # 1 - 2 + 3 mJ
    assert_passive(trace, damping=1.0)  # and 1 mJ more in each tick


def test_passive_adds_up_what_every_axis_gives_and_damps() -> None:
    dx = np.array([[0, 0], [1e-3, 0], [-1e-3, 1e-3], [1e-3, -1e-3]])
    force = np.array([[0.0, 0], [1, 2], [2, 3], [3, 6]])
    trace = made_up(dx=dx, dt=np.full((4, 2), 1e-3), f_applied=force)
    with pytest.raises(
        AssertionError, match=r"the energy observed at the port falls to -1 mJ at tick 3"
    ):
        assert_passive(trace, damping=0.0)  # 1, then - 2 + 3, then 3 - 6 mJ
    assert_passive(trace, damping=1.0)  # and 1 mJ more for each axis that moves


# --- settling ---


@given(start=st.floats(1e-3, 0.05), decay=st.floats(0.02, 0.2), rest=st.floats(-0.02, 0.02))
def test_settling_is_that_of_the_contact(start: float, decay: float, rest: float) -> None:
    trace = made_up(
        x=rest + start * np.exp(-1e-3 * np.arange(2001) / decay), f_applied=np.zeros(2001)
    )
    settled = ebac.contact(trace).settled_s
    assert settled is not None
    assert_settles(trace, within=settled)
    with pytest.raises(AssertionError, match=r"settles too late: within 0\.125 mm of its rest"):
        assert_settles(trace, within=settled - 1e-3)


def test_what_swings_never_settles() -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=1.0), "tca")
    with pytest.raises(AssertionError, match=r"never settles: .* it swings by \d"):
        assert_settles(trace, within=1)
    assert_settles(trace, within=1, band=0.1)


@pytest.mark.parametrize(("within", "more"), [(500, "; 500 ms are 0.5 s"), (1.5, "")])
def test_a_time_beyond_the_run_is_refused(within: float, more: str) -> None:
    """Milliseconds in place of seconds passed whatever the run did."""
    trace = ebac.simulate(ebac.Scenario(seconds=1.0), "ebac")
    with pytest.raises(ValueError, match=f"within = {within:g} s: must be at most 1 s.*{more}$"):
        assert_settles(trace, within=within)


def test_a_wrong_name_is_refused_with_the_nearest() -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.1), "ebac")
    with pytest.raises(TypeError) as refused:
        assert_within_limits(trace, travl=0.1)  # type: ignore[call-arg]
    assert str(refused.value) == (
        "ebac.testing.assert_within_limits has no parameter 'travl', did you mean 'travel' or 'trace'; it has: "
        "trace, force, current, travel, speed"
    )


# --- continuity and limits ---


@given(jump=st.floats(0.1, 30), tick=st.integers(1, 99))
def test_a_jump_is_found_where_it_is(jump: float, tick: int) -> None:
    trace = made_up(f_applied=np.where(np.arange(100) >= tick, jump, 0.0))
    assert_force_continuous(trace, step=jump)
    with pytest.raises(
        AssertionError, match=rf"jumps by \S+ N at tick {tick}, t = .* exceeded in 1 ticks"
    ):
        assert_force_continuous(trace, step=0.99 * jump)


@pytest.mark.parametrize("law", ["tca", "eba", "ebac"])
def test_the_laws_stay_within_the_limits_of_their_device(law: str) -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=1.0), law)
    assert_within_limits(trace)
    most = float(np.abs(trace["f_cmd"]).max())
    assert_within_limits(trace, force=most)
    with pytest.raises(AssertionError, match=r"f_cmd of axis 0 reaches \S+ N at tick \d+"):
        assert_within_limits(trace, force=0.99 * most)
    with pytest.raises(AssertionError, match=r"x of axis 0 reaches \S+ m at tick"):
        assert_within_limits(trace, travel=1e-6)


def test_limits_say_what_they_miss() -> None:
    trace = made_up(x=[0.0, math.nan, 1.0])
    with pytest.raises(ValueError, match="no limit given, and the trace has no scenario"):
        assert_within_limits(trace)
    with pytest.raises(AssertionError, match="x is nan at tick 1"):
        assert_within_limits(trace, travel=1)


@pytest.mark.parametrize(
    "claim",
    [assert_passive, assert_within_limits, partial(assert_force_continuous, step=1.0)],
)
def test_nothing_is_claimed_of_no_rows(claim: Callable[[ebac.Trace], None]) -> None:
    """NumPy spoke of reshape and argmax, and a force without rows was continuous."""
    with pytest.raises(ValueError, match="the trace has 0 rows: needs at least 1"):
        claim(ebac.simulate(ebac.Scenario(seconds=0.05), "direct").rows(0, 0))


def test_a_fault_is_no_run_within_limits() -> None:
    class Broken:
        def reset(self) -> None: ...

        def step(self, port: ebac.Port) -> float:
            return math.nan

    with pytest.raises(ebac.LoopFault) as fault:
        ebac.simulate(ebac.Scenario(seconds=0.1), Broken())
    with pytest.raises(AssertionError, match=r"fault \d+ at tick 0"):
        assert_within_limits(fault.value.trace)


# --- tolerances ---


@given(
    golden=st.floats(allow_nan=True, allow_infinity=True),
    absolute=st.floats(0, 1e3),
    relative=st.floats(0, 1),
    other=st.floats(allow_nan=True, allow_infinity=True),
)
def test_a_tolerance_is_its_formula(
    golden: float, absolute: float, relative: float, other: float
) -> None:
    tolerance = Tolerance(absolute=absolute, relative=relative)
    assert tolerance.allows(np.array([golden]), np.array([golden]))[0].all()
    passes, error = tolerance.allows(np.array([other]), np.array([golden]))
    if math.isfinite(golden) and math.isfinite(other):
        assert passes[0] == (abs(other - golden) <= absolute + relative * abs(golden))
    elif other != golden and not (math.isnan(other) and math.isnan(golden)):
        assert not passes[0]
        assert error[0] == math.inf


def test_whole_numbers_must_be_equal() -> None:
    assert default_tolerance("counts", "i") == Tolerance()
    assert default_tolerance("m").absolute == 1e-9
    assert default_tolerance("furlongs").absolute == 1e-9


@given(tick=st.integers(0, 99), size=st.floats(1e-3, 1))
def test_the_first_divergence_is_the_first(tick: int, size: float) -> None:
    x = np.zeros(100)
    other = x.copy()
    other[tick:] = size
    other[-1] += size
    result = compare(made_up(x=other, f_cmd=x), made_up(x=x, f_cmd=x))
    assert result.channels == ("t", "x", "f_cmd")
    assert result.first is not None
    assert (result.first.channel, result.first.tick) == ("x", tick)
    assert (result.first.largest, result.first.largest_tick) == (2 * size, 99)
    assert len(result.divergences) == 1


def test_axes_are_distinguished() -> None:
    device = ebac.Device(kinematics=ebac.Linear(axes=2))
    scenario = ebac.Scenario(device=device, environment=ebac.Corner(), seconds=0.1)
    one = ebac.simulate(scenario, "eba")
    other = ebac.simulate(scenario.replace(hand=ebac.Hand(path=[ebac.Step(), ebac.Step()])), "eba")
    found = {d.channel for d in compare(other, one, columns=["true.x"]).divergences}
    assert found == {"true.x_1"}


# --- strategies ---


def test_static_compensation_of_a_recording_is_no_energy_drawn() -> None:
    device = ebac.Device(
        mechanics=ebac.Mechanics(coulomb=0.3, gravity=9.81),
        compensation=ebac.Compensation(friction=0.3, gravity_mass=0.25),
    )
    sways = ebac.Hand(path=ebac.Sine(amplitude=0.05, frequency=0.2))
    free = ebac.Scenario(device=device, hand=sways, environment=ebac.Free(), seconds=6.0)
    recorded = ebac.replay(ebac.simulate(free, "ebac"), "ebac")  # without true.energy
    assert (recorded["f_applied"] * recorded["dx"]).cumsum().min() < -0.05
    assert_passive(recorded, reserve=2e-3, damping=device.facts.damping)


@settings(max_examples=25)
@given(data=st.data())
def test_what_is_drawn_can_be_simulated(data: st.DataObject) -> None:
    scenario = data.draw(
        strategies.scenarios(
            device=strategies.devices(axes=None, friction=(0, 1), noise=(0, 0.2)),
            hand=strategies.hands(tremor=True, lets_go=True),
            environment=strategies.walls(free=True, damping=(0, 20)),
            seconds=0.05,
        )
    )
    trace = ebac.simulate(scenario, "ebac")
    assert len(trace) == 51
    hand = scenario.hand
    assert hand.stiffness * abs(hand.path[0].target) <= 35 * (1 + 1e-12)


@given(timing=strategies.timings(jitter=(0, 0.45)), port=strategies.ports(extreme=True))
def test_timings_and_ports_are_what_a_law_may_see(timing: ebac.Timing, port: ebac.Port) -> None:
    assert 2.5e-4 <= timing.dt <= 4e-3
    assert timing.delay in (0, 1, 2)
    assert math.isfinite(port.f_env)
    assert port.dt >= 0


@given(values=strategies.parameters(ebac.EBAC))
def test_parameters_are_accepted(values: dict[str, Any]) -> None:
    law: Any = ebac.EBAC(**values)
    assert {name: law.as_dict()[name] for name in values} == values
