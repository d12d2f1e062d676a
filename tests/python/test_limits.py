"""Limits, states and soft start of a simulated run: nothing exceeds them, and without them nothing changes."""

import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ebac
from ebac import _core
from ebac._util.fault_remedies import REMEDIES
from ebac.hardware import under_the_law

Limits = _core.Limits


def scenario(**changes: object) -> ebac.Scenario:
    return ebac.Scenario(seconds=0.5).replace(**changes)


def test_without_limits_a_row_has_the_bits_it_always_had() -> None:
    plain = ebac.simulate(scenario())
    wide = Limits(
        continuous_current=900,
        peak_current=1000,
        slew=1e9,
        speed=100,
        jump=1,
        edge=9,
        end=10,
        force_age=10,
    )
    limited = ebac.simulate(scenario(), limits=wide)
    for name in plain:
        assert np.array_equal(plain[name], limited[name], equal_nan=True), name
    assert set(limited) - set(plain) == {"limit.heat", "limit.ceiling"}
    assert (plain["state"] == int(_core.LoopState.RUN)).all()
    assert (plain["limited"] == 0).all()


def test_limits_of_the_device_do_not_touch_the_reference_wall_after_its_impact() -> None:
    trace = ebac.simulate(ebac.Scenario(), limits=True)
    assert trace["limit.heat"].max() < 1
    assert not trace["fault"].any()


@settings(max_examples=25)
@given(
    peak=st.floats(0.05, 3),
    share=st.floats(0.1, 1),
    slew=st.floats(5, 5000),
    thermal=st.floats(0.01, 10),
    law=st.sampled_from(["direct", "tca", "ebac"]),
)
def test_no_tick_exceeds_a_limit(
    peak: float, share: float, slew: float, thermal: float, law: str
) -> None:
    limits = Limits(
        continuous_current=peak * share,
        peak_current=peak,
        slew=slew,
        thermal_time=thermal,
        edge=1,
        end=2,
        speed=100,
        jump=1,
    )
    run = scenario()
    try:
        trace = ebac.simulate(run, law, limits=limits)
    except ebac.LoopFault as stopped:
        trace = stopped.trace
    current = trace["current"]
    assert np.abs(current).max() <= peak
    assert (
        np.abs(np.diff(current, prepend=0)).max() <= slew * run.timing.dt * (1 + 1e-9)
        or (trace["limited"] & int(_core.Limited.THERMAL)).any()
    )
    assert trace["limit.heat"].max() <= 1 + 1e-12
    held = np.abs(current) < np.abs(trace["tau"]) / (0.0538 * 20) * (1 - 1e-9)
    assert (trace["limited"][held] != 0).all(), "what was held back has a reason"


def test_soft_start_brings_the_force_in() -> None:
    trace = ebac.simulate(scenario(hand=ebac.Hand()), "direct", soft_start=0.2)
    share = trace["current"] * 0.0538 * 20 / np.where(trace["tau"] == 0, 1, trace["tau"])
    rows = (trace["tau"] != 0) & (trace["t"] < 0.19)
    assert rows.any()
    assert share[rows] == pytest.approx(trace["t"][rows] / 0.2, rel=1e-9)
    assert (trace["limited"][rows] == int(_core.Limited.RAMP)).all()
    later = (trace["t"] > 0.21) & (trace["tau"] != 0)
    assert share[later] == pytest.approx(1)


@pytest.mark.parametrize("observer", [True, False])
@pytest.mark.parametrize("soft_start", [0.2, 0.5])
def test_a_wall_that_is_met_while_the_force_comes_in_becomes_exact(
    soft_start: float, observer: bool
) -> None:
    """The ramp does the work of making it stiffer: without it the guard kept the wall soft, 4 to 12 mm too deep."""
    run = ebac.Scenario(
        environment=ebac.Wall(stiffness=1e4, position=0.002),
        hand=ebac.Hand(path=ebac.Step(target=0.04)),
        seconds=4.0,
        observer=observer,
    )
    trace = ebac.simulate(run, "ebac", soft_start=soft_start)
    assert ebac.contact(trace).exact
    assert trace["ramp"][-1] == 1
    assert trace["ramp"][:100] == pytest.approx(trace["t"][:100] / soft_start)
    assert trace["law.starved"].max() < 1  # s
    later = trace["t"] > soft_start + 1
    assert np.ptp(trace["true.energy"][later]) < 2e-3  # J


@pytest.mark.parametrize("through", [None, "can"])
def test_after_its_time_the_force_goes_out_and_the_drives_rest(through: str | None) -> None:
    run = ebac.Scenario(seconds=1.0)
    trace = ebac.simulate(run, "ebac", through=through, limits=True, ramp_down=0.2)
    usual = ebac.simulate(run, "ebac", through=through, limits=True)
    assert len(under_the_law(trace)) == len(usual) == 1001
    for name in ("true.x", "f_cmd", "current"):
        assert (trace[name][:1001] == usual[name]).all()
    assert trace["ramp"][1001:1201] == pytest.approx(1 - np.arange(1, 201) / 200, abs=1e-9)
    assert (trace["current"][1200:] == 0).all()
    assert len(trace) == 1200 + 10
    assert ebac.contact(trace).row() == ebac.contact(usual).row()
    # The hand still presses, and falls through.
    assert trace["true.x"][-1] > usual["true.x"][-1] + 5e-3


def test_a_fault_in_the_ramp_ends_it() -> None:
    slow = ebac.Limits.of(ebac.Device()).replace(speed=0.2)
    run = ebac.Scenario(
        hand=ebac.Hand(path=ebac.MinimumJerk(target=0.04, duration=1.0)), seconds=2.0
    )
    assert len(ebac.simulate(run, "ebac", limits=slow)) == 2001
    with pytest.raises(ebac.LoopFault) as caught:
        ebac.simulate(run, "ebac", limits=slow, ramp_down=0.05)
    assert caught.value.fault is ebac.Fault.OVERSPEED
    assert (caught.value.trace["current"][-10:] == 0).all()


@pytest.mark.parametrize("lever", [ebac.Linear, ebac.Gimbal])
@pytest.mark.parametrize("limit", [0.2, 0.5, 1.2])
def test_edge_and_end_lie_5_mm_before_and_behind_the_stops(lever: type, limit: float) -> None:
    limits = Limits.of(ebac.Device(kinematics=lever(radius=0.12, limit=limit)))
    assert limits.edge == pytest.approx(0.12 * limit - 5e-3)
    assert limits.end == pytest.approx(0.12 * limit + 5e-3)


def test_edge_lies_halfway_to_stops_closer_than_10_mm() -> None:
    limits = Limits.of(ebac.Device(kinematics=ebac.Linear(radius=0.02, limit=0.3)))
    assert (limits.edge, limits.end) == pytest.approx((3e-3, 9e-3))


def test_leaving_the_workspace_is_a_fault_with_zero_force() -> None:
    hand = ebac.Hand(path=ebac.Step(target=0.2))
    with pytest.raises(ebac.LoopFault) as stopped:
        ebac.simulate(
            scenario(hand=hand, environment=ebac.Free()), limits=Limits(speed=50, jump=0.5)
        )
    assert stopped.value.fault is _core.Fault.WORKSPACE
    assert re.search(r"axis 0 at \d+(\.\d+)? mm, beyond Limits\.end = ", str(stopped.value))
    trace = stopped.value.trace
    row = int((trace["fault"] != 0).argmax())
    assert (trace["state"][row:] == int(_core.LoopState.STOP)).all()
    assert len(trace) - row == 10
    assert (trace["current"][row:] == 0).all()
    assert (trace["limited"][:row] & int(_core.Limited.EDGE)).any(), "the soft wall came first"


def test_a_fast_hand_is_named() -> None:
    hand = ebac.Hand(path=ebac.Step(target=0.04), stiffness=5000, damping=1)
    with pytest.raises(ebac.LoopFault) as stopped:
        ebac.simulate(scenario(hand=hand, environment=ebac.Free()), limits=True)
    assert stopped.value.fault is _core.Fault.OVERSPEED
    text = r"\(overspeed: axis 0 at [12]\.\d+ m/s, beyond Limits\.speed = 1\.5 m/s\) in tick"
    assert re.search(text, str(stopped.value))
    remedy = stopped.value.remedy  # the handle may be pulled by a motor of the wrong sign
    assert remedy.startswith("keep your hand off")
    assert remedy.index("drive signs") < remedy.index("right") < remedy.index("grip")


def test_through_can_limits_are_the_same() -> None:
    plain = ebac.simulate(
        ebac.Scenario(seconds=0.3, device=ebac.Device(drive=ebac.Drive(permille=True))),
        limits=True,
    )
    bus = ebac.simulate(ebac.Scenario(seconds=0.3), through="can", limits=True)
    for name in plain:
        assert np.array_equal(plain[name], bus[name], equal_nan=True), name


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"peak_current": 0.5}, "Limits.continuous_current = 0.985 A: must lie in"),
        ({"end": 0.01}, "Limits.edge = 0.0474 m: must lie in"),
    ],
)
def test_limits_that_contradict_each_other_are_refused(
    changes: dict[str, float], words: str
) -> None:
    with pytest.raises(ValueError, match=words.replace(".", r"\.")):
        ebac.simulate(scenario(), limits=Limits(**changes))


def test_a_bad_soft_start_is_refused() -> None:
    with pytest.raises(ValueError, match="soft_start = -1 s"):
        ebac.simulate(scenario(), soft_start=-1)
    with pytest.raises(ValueError, match="soft_start"):
        ebac.simulate(scenario(), soft_start=math.nan)
    with pytest.raises(TypeError, match=r"simulate\.soft_start = True: must be a number"):
        ebac.simulate(scenario(), soft_start=True)


def test_times_of_a_run_may_be_numbers_of_numpy() -> None:
    """Its float32 and int64 were no number, and True was one second."""
    times: Any = {"soft_start": np.float32(0.5), "ramp_down": np.int64(1)}
    run = ebac.simulate(scenario(), "direct", **times)
    other = ebac.simulate(scenario(), "direct", soft_start=0.5, ramp_down=1)
    np.testing.assert_array_equal(run["ramp"], other["ramp"])


def test_every_fault_and_every_limit_is_documented() -> None:
    from pathlib import Path

    text = (Path(__file__).parents[2] / "docs" / "explanation" / "safety.md").read_text(
        encoding="utf-8"
    )
    for fault in _core.Fault:
        if fault is not _core.Fault.NONE:
            row = re.search(rf"^\| {int(fault)} \| `{fault.name}` \|.*\| (.+?) \|$", text, re.M)
            assert row is not None
            assert re.sub(r"\[([^]]+)\]\([^)]*\)", r"\1", row[1]) == REMEDIES[fault]
    for bit in _core.Limited:
        assert f"| {int(bit)} | `{bit.name}` |" in text
