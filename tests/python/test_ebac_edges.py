"""The part of the account that counts from edge to edge of the encoder: what it costs, and that the rest is as safe."""

import numpy as np
import pytest

import ebac

DEVICE = ebac.Device(sensor=ebac.ForceSensor(noise=0.03))  # N
OFF = ebac.Variant("ebac", {"edges": False})


def test_it_is_on_unless_switched_off() -> None:
    law = ebac.EBAC.design(DEVICE, ebac.Timing())
    assert law.edges
    assert not ebac.EBAC.design(DEVICE, ebac.Timing(), edges=False).edges


def test_on_the_encoder_alone_it_changes_no_bit() -> None:
    scenario = ebac.Scenario(device=DEVICE, observer=False, seconds=1.0)
    one, two = (ebac.simulate(scenario, law) for law in ("ebac", OFF))
    assert all(one[name].tobytes() == two[name].tobytes() for name in ("x", "f_cmd", "law.energy"))


def test_hands_that_press_slowly_keep_their_wall_without_it() -> None:
    hands = ebac.Operators.grid()
    laws = {"on": "ebac", "off": OFF}
    study = ebac.study(hands, laws, ["slow-press-d2K20"], base=ebac.Scenario(device=DEVICE))
    on, off = study.rows
    assert off.exact_and_still == len(hands) > on.exact_and_still
    assert off.most_drawn_J <= 1e-3


def test_a_wall_that_sways_is_held_longer_without_it() -> None:
    path = ebac.Sine(centre=0.03, amplitude=0.005, frequency=1.0)
    scenario = ebac.Scenario(
        device=DEVICE,
        hand=ebac.Hand(path=path),
        environment=ebac.Wall(stiffness=20e3),
        timing=ebac.Timing(delay=2),
        seconds=40.0,
    )
    shares = []
    for law in ("ebac", OFF):
        trace = ebac.simulate(scenario, law)
        last = trace["t"] > 35
        shares.append(float(np.sum(trace["f_applied"][last]) / np.sum(trace["f_env"][last])))
    assert shares[0] < 0.9 < 0.97 < shares[1]


@pytest.mark.parametrize("condition", ["d1K10", "d2K20"])
def test_the_worst_hand_draws_no_more_than_five_millijoules_without_it(condition: str) -> None:
    base = ebac.Scenario(device=DEVICE)
    found = ebac.worst(OFF, condition=condition, evaluations=100, base=base, seed=3)
    assert max(hand.energy_J for hand in found.hands) < 5e-3
