"""The energy account of EBAC: what it charges, what it says when it runs out, and that it comes back."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import ebac

SENSOR = ebac.ForceSensor(noise=0.03)


def on_a_cable(stiffness: float) -> ebac.Device:
    return ebac.Device(mechanics=ebac.Mechanics(cable_stiffness=stiffness), sensor=SENSOR)


def undeclared(scenario: ebac.Scenario) -> ebac.laws.CoreLaw | ebac.laws.PythonLaw:
    """Return EBAC for a device whose cable nobody mentioned."""
    return ebac.design("ebac", scenario.device, scenario.timing, resonance=0)


@pytest.mark.parametrize("observer", [False, True])
@pytest.mark.parametrize("stiffness", [50e3, 100e3, 150e3, 200e3])
def test_the_account_falls_for_no_force_that_was_not_given(
    stiffness: float, observer: bool
) -> None:
    scenario = ebac.Scenario(device=on_a_cable(stiffness), seconds=8.0, observer=observer)
    trace = ebac.simulate(scenario, undeclared(scenario))
    energy, force = trace["law.energy"], trace["f_applied"]
    late = trace["t"] > 4.0
    assert energy[-1] > -5e-3
    given = np.abs(np.diff(force[late])).sum() * scenario.device.count  # J, at one count
    fallen = -np.minimum(np.diff(energy[late]), 0).sum()
    if not force[late].any():
        assert fallen < 1e-12
    else:
        leak = energy[late].mean() * 4.0
        assert fallen < 2 * given + leak + np.abs(force * trace["dx"])[late].sum()


def test_a_starved_guard_is_seen_in_the_row_and_ends_a_run_with_limits() -> None:
    scenario = ebac.Scenario(device=on_a_cable(100e3), seconds=6.0, observer=False)
    law = undeclared(scenario)
    trace = ebac.simulate(scenario, law)
    assert trace["law.starved"].max() > 3.0
    assert not trace["fault"].any()
    with pytest.raises(ebac.simulation.LoopFault) as stopped:
        ebac.simulate(scenario, law, limits=ebac.Limits(starved=1.0))
    limited = stopped.value.trace
    assert stopped.value.fault == ebac.Fault.STARVED
    assert not limited["f_applied"][-1]
    before = limited["law.starved"][limited["fault"] == 0]
    assert before[-1] == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize("observer", [False, True])
def test_no_ordinary_contact_is_starved(observer: bool) -> None:
    assert not ebac.simulate(ebac.Scenario(observer=observer), "ebac")["law.starved"].any()


def test_a_starved_wall_comes_back_when_the_hand_has_moved() -> None:
    """Away from the wall the device's damping gives the account what the next contact needs."""
    shake = ebac.Sine(centre=0.0, amplitude=0.03, frequency=0.5)
    hand = ebac.Hand(mass=0.3, path=[shake])
    scenario = ebac.Scenario(device=on_a_cable(100e3), hand=hand, seconds=8.0, observer=False)
    trace = ebac.simulate(scenario, undeclared(scenario))
    starved, force = trace["law.starved"], trace["f_cmd"]
    presses = [(trace["t"] > t) & (trace["t"] < t + 1) for t in (0, 2, 4, 6)]
    assert starved.max() > 0.05
    assert all(force[press].max() > 3.0 for press in presses)
    away = trace["x"] < -0.01
    assert not starved[away & (trace["t"] > 1.9)].all()


@pytest.mark.parametrize("stiffness", [50e3, 75e3, 100e3, 150e3, 200e3])
@pytest.mark.parametrize("mass", [0.05, 0.5])
def test_with_the_observer_a_declared_resonance_keeps_the_wall(
    stiffness: float, mass: float
) -> None:
    scenario = ebac.Scenario(
        device=on_a_cable(stiffness), hand=ebac.Hand(mass=mass), seconds=4.0, observer=True
    )
    assert scenario.device.facts.resonance > 90
    trace = ebac.simulate(scenario, "ebac")
    assert not trace["law.starved"].any()
    rest = trace["x"][-1200:]
    wall, hand = 10e3, scenario.hand
    ideal = hand.stiffness * 0.04 / (wall + hand.stiffness * (1 + wall / stiffness))
    assert np.ptp(rest) < ebac.metrics.STILL_SWING
    assert rest.mean() == pytest.approx(ideal, abs=3 * scenario.device.count)


@pytest.mark.parametrize("resonance", [50.0, 1e4])
def test_a_resonance_that_the_delay_does_not_drive_changes_nothing(resonance: float) -> None:
    scenario = ebac.Scenario(seconds=0.5, observer=False)
    plain = ebac.simulate(scenario, "ebac")
    law = ebac.design("ebac", scenario.device, scenario.timing, resonance=resonance)
    assert ebac.simulate(scenario, law)["f_cmd"].tobytes() == plain["f_cmd"].tobytes()


def test_a_resonance_that_it_drives_softens_the_damper() -> None:
    scenario = ebac.Scenario(seconds=0.5, observer=False)
    law = ebac.design("ebac", scenario.device, scenario.timing, resonance=100.0)
    plain, softer = (ebac.simulate(scenario, one) for one in ("ebac", law))
    damping = [trace["law.injected"].max() / trace["v"].max() for trace in (plain, softer)]
    assert 0.4 * damping[0] < damping[1] < 0.7 * damping[0]


# --- an account of readings that is proven ---

COUNT = ebac.DeviceFacts().count


def account_and_truth(law: Any, x: NDArray[np.float64], delay: int) -> tuple[float, float, float]:
    """Give a law the readings of a motion; return its account, the energy of the port [J] and the largest force [N]."""
    dt, damping, wall = 1e-3, ebac.DeviceFacts().damping, 10e3
    acting, reading, energy, most = [0.0] * (delay + 1), 0.0, 0.0, 0.0
    for before, now in pairwise(x.tolist()):
        force = acting.pop(0)
        most = max(most, abs(force))
        energy += force * (now - before) + damping / dt * (now - before) ** 2
        last, reading = reading, COUNT * math.floor(now / COUNT)
        port = ebac.Port(
            x=reading, dx=reading - last, dt=dt, f_env=wall * max(reading, 0), f_applied=force
        )
        acting.append(law.step(port))
    return law.state.account, energy, most


@pytest.mark.parametrize("law", ["eba-account", "force-bounding"])
@pytest.mark.parametrize("delay", [0, 1, 2, 3])
@given(
    share=st.floats(0.01, 0.4),
    deep=st.integers(5, 60),
    shift=st.integers(0, 3),
    period=st.integers(1, 5),
)
@settings(max_examples=10, deadline=None)
def test_a_dither_across_an_edge_earns_nothing(
    law: str, delay: int, share: float, deep: int, shift: int, period: int
) -> None:
    """One in step with the delay meets more force inwards than outwards: the sum over readings grew without end."""
    edge = deep * COUNT
    press = 3 * edge * np.minimum(np.arange(300) / 10, 1)
    dither = np.where((np.arange(4000) + shift) % period < period / 2, share, -share) * COUNT
    x = np.r_[press, np.linspace(press[-1], edge, 1500), edge + dither]
    facts = ebac.DeviceFacts(current_lag=0)
    made = ebac.design(law, facts, ebac.Timing(delay=delay))
    account, energy, most = account_and_truth(made, x, delay)
    assert account <= energy + COUNT * most
