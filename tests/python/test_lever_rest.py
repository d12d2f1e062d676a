"""The ideal rest on a lever: a gimbal without and with a slide."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import ebac
from ebac.metrics.lever_rest import lever_rest
from ebac.metrics.unjudged import no_ideal_rest

LEVERS = {"gimbal": ebac.Gimbal(), "slides": ebac.SlidingGimbal()}


def on_lever(
    lever: Any, *, gravity: float = 0.0, coulomb: float = 0.0, **hand: Any
) -> ebac.Scenario:
    mechanics = ebac.Mechanics(damping=2.0, gravity=gravity, coulomb=coulomb)
    return ebac.Scenario(
        device=ebac.Device(kinematics=lever, mechanics=mechanics),
        hand=ebac.Hand(**hand),
        environment=ebac.Wall(stiffness=10e3, position=0.01),
        seconds=6.0,
    )


@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.parametrize("lever", LEVERS)
@given(
    gravity=st.floats(-9.81, 9.81),
    coulomb=st.sampled_from([0.0, 0.5]),
    stiffness=st.floats(150, 600),
    target=st.floats(-0.03, 0.04),
    aside=st.floats(-0.02, 0.02),
)
def test_an_exact_law_rests_at_the_ideal_of_a_lever(
    lever: str, gravity: float, coulomb: float, stiffness: float, target: float, aside: float
) -> None:
    """A long simulation of `ebac`: exact, with the weight of the handle or without, however the handle leans.

    Near the surface the band of friction has a bend, on straight axes, too: what holds a hand before the wall is
    f_c / K0, what holds it inside f_c / (K0 + K).
    """
    assume(abs(stiffness * (target - 0.01)) > 2 * coulomb + 0.3)  # N, with what weight may add
    path = (ebac.Step(target=target), ebac.Step(target=aside))
    scenario = on_lever(
        LEVERS[lever], gravity=gravity, coulomb=coulomb, stiffness=stiffness, path=path
    )
    contact = ebac.contact(ebac.simulate(scenario, "ebac"))
    assert contact.exact, (contact.deviation_m, contact.allowed_m)


@given(target=st.floats(-0.004, 0.004), position=st.floats(-0.002, 0.002), coulomb=st.floats(0, 1))
def test_a_long_lever_is_a_straight_axis(target: float, position: float, coulomb: float) -> None:
    """At small angles, without weight."""
    assume(
        abs(target - position) > 1e-6
    )  # at the surface itself the last digit decides whose stiffness counts
    bent = on_lever(ebac.Gimbal(), coulomb=coulomb, path=ebac.Step(target=target))
    bent = bent.replace(environment=ebac.Wall(position=position))
    straight = bent.replace(device=bent.device.replace(kinematics=ebac.Linear()))
    assert ebac.ideal_rest(bent) == pytest.approx(ebac.ideal_rest(straight), abs=1e-12)
    allowed, same = (ebac.metrics.allowed_deviation(s) for s in (bent, straight))
    assert allowed == pytest.approx(same, rel=2e-3)


@pytest.mark.parametrize("model", [None, ebac.hands.NonlinearGrip()])
def test_the_weight_pulls_a_gimbal_out_and_a_slide_in(model: Any) -> None:
    """W x/h along x, h the height of the handle; on a lever that slides only the height feels it."""
    path = (ebac.Step(target=0.008), ebac.Step(target=0.02))
    light, heavy = (
        lever_rest(on_lever(ebac.Gimbal(), gravity=g, path=path, model=model)) for g in (0.0, 9.81)
    )
    assert light == pytest.approx([0.008, 0.02], abs=1e-9)
    height = np.sqrt(0.1**2 - heavy @ heavy)
    pull = 0.114 * 9.81 * heavy / height
    if model is None:
        assert 300 * (heavy - light) == pytest.approx(pull, rel=1e-6)
    assert (heavy > light).all()
    sunk = lever_rest(on_lever(ebac.SlidingGimbal(), gravity=9.81, path=path))
    assert sunk == pytest.approx([0.008, 0.02, -0.114 * 9.81 / 300], abs=1e-9)


@pytest.mark.parametrize("target", [0.03, 0.06, 0.08])
def test_a_gimbal_that_leans_far_out_has_a_rest_too(target: float) -> None:
    """The tap of a Z-width aims 60 mm out."""
    scenario = on_lever(ebac.Gimbal(), gravity=9.81, path=ebac.Step(target=target))
    assert ebac.ideal_rest(scenario.replace(environment=ebac.Wall(stiffness=100.0, position=0.02)))


@pytest.mark.slow
def test_a_study_judges_the_hands_on_the_papers_joystick() -> None:
    """It once said that every hand is good where tca gave out 13.8 J and `good` was not known."""
    base = ebac.Scenario(device=ebac.presets.device("joystick"))
    few = ebac.Operators.grid()[::7]
    study = ebac.study(few, ["tca", "ebac"], base=base)
    tca, exact = study.rows
    assert (tca.good, exact.good) == (0, 9)
    assert len(study.failures) == 9


def test_a_study_says_which_hands_it_does_not_judge() -> None:
    study = ebac.study(ebac.Operators.grid(mass=[0.15]), ["ebac"], ["d1K10", "tapping-6Hz"])
    assert study.unjudged == {"tapping-6Hz": "the target of the hand keeps moving"}


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({}, ""),
        ({"environment": ebac.Free()}, "there is no wall"),
        ({"environment": ebac.Wall(motion_amplitude=1e-3)}, "the wall moves"),
        ({"environment": ebac.Wall(angle=0.1)}, "the wall is not straight across the first axis"),
        ({"environment": ebac.Corner()}, "it is no wall; `ebac shapes` judges corners and discs"),
        ({"hand": ebac.Hand(release_at=1.0)}, "the hand lets go"),
        ({"hand": ebac.Hand(path=ebac.Sine())}, "the target of the hand keeps moving"),
        ({"hand": ebac.Hand(path=(ebac.Step(), ebac.Sine()))}, "the target of the hand keeps moving"),
        ({"hand": ebac.Hand(stiffness=0)}, "the hand has no stiffness"),
        ({"hand": ebac.Hand(stiffness=1)}, "hand and wall do not balance within reach of the device"),
    ],
)  # fmt: skip
def test_why_there_is_no_ideal_rest(changes: dict[str, Any], why: str) -> None:
    scenario = ebac.Scenario(device=ebac.presets.device("joystick")).replace(**changes)
    assert no_ideal_rest(scenario) == why
