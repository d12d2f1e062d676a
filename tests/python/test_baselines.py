"""What each simple law promises, stepped by hand: one port, no device."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest

import ebac

DT = 1e-3
K = 10e3
DEVICE = ebac.Device()


def steps(law: Any, positions: Iterable[float], stiffness: float = K, **more: float) -> list[float]:
    """Return the forces of a law on a wall at 0, the handle at each position in turn, at first out of contact."""
    law.reset()
    law.step(ebac.Port(x=-1e-3))
    last, forces = -1e-3, []
    for x in positions:
        port = ebac.Port(
            x=x, dx=x - last, v=(x - last) / DT, dt=DT, f_env=max(0.0, stiffness * x), **more
        )
        forces.append(law.step(port))
        last = x
    return forces


def test_a_damper_of_nothing_and_no_gain_leaves_the_wall_itself() -> None:
    path = 1e-3 * np.abs(np.sin(np.arange(50)))
    law = ebac.TCADamped(virtual_damping=0, kp=0)
    assert steps(law, path) == steps(ebac.Direct(), path)


@pytest.mark.parametrize("delay", [0, 1, 2])
def test_the_design_of_the_damper_is_that_of_the_lag_compensator(delay: int) -> None:
    timing = ebac.Timing(delay=delay)
    damped = ebac.TCADamped.design(DEVICE, timing)
    lag = ebac.LagCompensator.design(DEVICE, timing)
    assert damped.virtual_damping == lag.virtual_damping > 0
    assert ebac.TCADamped.design(DEVICE, timing, virtual_damping=60).virtual_damping == 60


def test_a_retuned_damper_damps_anew() -> None:
    fast = [1e-3, 1.2e-3, 1.4e-3]
    soft, stiff = (ebac.TCADamped(virtual_damping=b, kp=0) for b in (10, 40))
    assert steps(stiff, fast)[-1] - K * fast[-1] == pytest.approx(
        4 * (steps(soft, fast)[-1] - K * fast[-1])
    )


# --- the lag compensator ---


def lag(**changes: float) -> Any:
    return ebac.LagCompensator(stiffness=4e3, virtual_damping=0, **changes)


@pytest.mark.parametrize("stiffness", [5e3, 20e3])
def test_the_lag_compensator_shows_its_stiffness_at_once_and_the_wall_at_rest(
    stiffness: float,
) -> None:
    law = lag(recovery_time=1.0)
    first, second, *rest = steps(law, [1e-3, 2e-3] + [2e-3] * 40_000, stiffness)
    assert second - first == pytest.approx(4e3 * 1e-3, rel=0.02)
    assert rest[-1] == pytest.approx(stiffness * 2e-3, rel=1e-3)
    assert np.diff(rest).min() >= 0


def test_the_lag_compensator_is_the_wall_where_that_is_softer() -> None:
    path = 2e-3 * np.abs(np.sin(0.3 * np.arange(80)))
    assert steps(lag(), path, 2e3) == pytest.approx(steps(ebac.Direct(), path, 2e3))


# --- the virtual coupling ---


@pytest.mark.parametrize("stiffness", [1e3, 10e3])
def test_the_coupling_is_in_series_with_the_wall(stiffness: float) -> None:
    law = ebac.VirtualCoupling(coupling_stiffness=4e3, coupling_damping=5)
    path = np.append(np.linspace(0, 3e-3, 30), np.full(400, 3e-3))
    both = 4e3 * stiffness / (4e3 + stiffness)
    assert steps(law, path, stiffness)[-1] == pytest.approx(both * 3e-3, rel=1e-6)
    assert law.state.proxy == pytest.approx(both * 3e-3 / stiffness, rel=1e-6)


def test_without_delay_the_coupling_meets_colgates_condition() -> None:
    facts = ebac.DeviceFacts(damping=2.0, current_lag=0)
    law = ebac.VirtualCoupling.design(facts, ebac.Timing(delay=0))
    needed = law.coupling_stiffness * DT / 2 + law.coupling_damping
    assert 0.99 * 2.0 < needed <= 2.0


def test_delay_makes_the_coupling_softer() -> None:
    found = [
        ebac.VirtualCoupling.design(DEVICE, ebac.Timing(delay=d)).coupling_stiffness
        for d in (0, 1, 2)
    ]
    assert found[0] > found[1] > found[2] > 0


# --- passivity control and ISS ---


def pushed_out(law: Any, times: int = 40) -> list[float]:
    """Return forces while the handle leaves the wall under a force that gives out energy."""
    return steps(law, np.linspace(5e-3, 1e-3, times), f_applied=20.0)


def test_an_account_per_contact_forgets_the_last_contact() -> None:
    taken = [1e-3, 3e-3, -1e-3]
    for per_contact, kept in ((False, True), (True, False)):
        law = ebac.PassivityControl(per_contact=per_contact)
        steps(law, [*taken, 1e-3], f_applied=30.0)
        assert (law.state.observed != 0) == kept


def test_iss_injects_what_is_missing_up_to_its_cap() -> None:
    law = ebac.ISS(gain=0, most_damping=5)
    extra = np.array(pushed_out(law)) - np.array(pushed_out(ebac.Direct()))
    speed = 4e-3 / 39 / DT
    assert extra.min() == pytest.approx(-5 * speed)
    assert law.state.alpha <= 5


def test_iss_leaves_alone_what_the_input_allows() -> None:
    law = ebac.ISS(gain=1.0)
    forces = steps(law, np.linspace(5e-3, 1e-3, 40), f_applied=20.0, f_meas=10.0)
    assert forces == steps(ebac.Direct(), np.linspace(5e-3, 1e-3, 40))
    assert law.state.energy < 0


# --- successive force augmentation ---


def test_sfa_shows_its_low_stiffness_until_a_swing_turns() -> None:
    law = ebac.SFA(stiffness=1e3, gain=0.5)
    press = np.linspace(0, 4e-3, 41)
    assert np.diff(steps(law, press)[1:]) == pytest.approx(0.1, abs=1e-9)


def test_sfa_raises_its_offset_where_releasing_turns_into_pressing_and_nowhere_else() -> None:
    law = ebac.SFA(stiffness=1e3, gain=0.5)
    steps(law, [1e-3, 2e-3, 3e-3, 2e-3])
    assert law.state.offset == 0
    forces = steps(law, [1e-3, 2e-3, 3e-3, 2e-3, 2.5e-3])
    assert law.state.offset == pytest.approx(0.5 * (25 - 3.5))
    assert forces[-1] == pytest.approx(0.5 * (25 + 3.5))


def test_the_transient_of_sfa_is_the_wall() -> None:
    law = ebac.SFA(stiffness=1e3, transient=True)
    press = np.linspace(0, 4e-3, 41)
    assert steps(law, press) == pytest.approx(steps(ebac.Direct(), press))


# --- EBA alone and with an account ---


def test_the_account_only_takes_force_away() -> None:
    """With as much of a cap as it likes, `eba-account` is `eba` until the account is spent."""
    path = 1e-3 * np.linspace(0, 1, 200)
    alone, held = ebac.EBA(), ebac.EBAAccount()
    for one, other in zip(steps(alone, path), steps(held, path, f_applied=0.0), strict=True):
        assert 0 <= other <= one + 1e-12
    assert ebac.EBAAccount.passive
    assert not ebac.EBA.passive
