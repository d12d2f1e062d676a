"""An identified arm shows itself in a notebook: its estimates with units and intervals, and the fit; it can be kept."""

import copy
import pickle

import numpy as np
import pytest

import ebac
from ebac import identify


@pytest.mark.slow
def test_an_arm_shows_its_estimates_and_its_fit_and_can_be_pickled() -> None:
    hand = ebac.Hand(mass=0.35, damping=6.0, stiffness=300.0, path=[ebac.Tapping(frequency=0.8)])
    trace = ebac.simulate(ebac.Scenario(hand=hand, seconds=4), "ebac")
    recording = identify.Recording.from_trace(trace, name="<tapping>")
    result = identify.fit_arm(recording, identify.Target.of(hand, recording.t))
    html = result._repr_html_()
    assert html.count('<img alt="figure"') == 1
    assert "from &lt;tapping&gt;" in html
    for name, unit in (("M0", "kg"), ("B0", "N s/m"), ("K0", "N/m")):
        assert f"<td>{name}</td><td>{result[name].value:.4g} {unit}</td>" in html
    for again in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
        assert repr(again) == repr(result)
        np.testing.assert_array_equal(again.drifts(0), result.drifts(0))
