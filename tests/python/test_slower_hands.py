"""Hands of a search that cannot change their force at once."""

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac import worst
from ebac.cli import app
from ebac.plot import plot_worst
from ebac.studies.families import Family, families
from ebac.studies.slower_hands import PER_TICK, no_quicker

FAMILIES = families(20.0)


def own_force(scenario: ebac.Scenario, t: Any) -> Any:
    """Return K0 X0 of the hand at times, as long as it holds on [N]."""
    hand = scenario.hand.replace(release_at=np.inf)
    return hand.pull(t, np.full(len(t), -20.0)) - 20.0 * hand.stiffness


def made(family: Family, share: float) -> ebac.Scenario:
    return family.make(ebac.Scenario(), family.values(np.full(len(family.parameters), share)))


@pytest.mark.parametrize("name", FAMILIES)
@given(share=st.floats(0, 1), rate=st.sampled_from([1.0, 1e3, 2e4, 1e6]))
@settings(max_examples=8)
def test_the_own_force_begins_at_zero_and_changes_no_quicker(
    name: str, share: float, rate: float
) -> None:
    scenario = made(no_quicker(FAMILIES[name], rate), share)
    t = np.linspace(0, min(scenario.seconds, 1.0), 4001)
    force = own_force(scenario, t)
    small = 1e-9 * scenario.hand.stiffness
    assert abs(force[0]) <= rate * scenario.timing.dt / PER_TICK + small
    assert np.abs(np.diff(force)).max() <= rate * (t[1] - t[0]) * (1 + 1e-6) + small


@pytest.mark.parametrize("name", FAMILIES)
def test_where_the_rate_suffices_the_hand_is_that_of_the_family(name: str) -> None:
    quick, slowed = (made(f, 0.4) for f in (FAMILIES[name], no_quicker(FAMILIES[name], 1e9)))
    ticks = 1e-3 * np.arange(1, 500) + 0.9e-3  # between changes, which a tick takes
    assert own_force(slowed, ticks) == pytest.approx(own_force(quick, ticks), abs=0.2)
    assert slowed.hand.replace(path=quick.hand.path) == quick.hand
    assert slowed.replace(hand=quick.hand) == quick


def test_a_hand_that_turns_round_within_a_tick_draws_what_a_slower_one_cannot() -> None:
    """The reserve holds for the slower ones; at 20 kN/m and two samples others draw twice as much."""
    noisy = ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03)))
    family = FAMILIES["tapping"]
    tap = {
        "mass": 0.0203, "damping": 18.7, "stiffness": 1171.0,
        "pull": 14.24, "lift": 0.0164, "frequency": 5.0756,
    }  # fmt: skip
    base = noisy.replace(timing=ebac.Timing(delay=2), environment=ebac.Wall(stiffness=2e4))
    drawn = [
        -(ebac.contact(ebac.simulate(one.make(base, tap), "ebac")).least_energy_J or 0.0)
        for one in (family, no_quicker(family, 2e4), no_quicker(family, 1e3))
    ]
    assert drawn[0] > 2e-3 > drawn[1]
    assert drawn[1] >= drawn[2] == pytest.approx(0, abs=1e-4)


@pytest.mark.slow
def test_the_command_names_the_rate() -> None:
    words = ["worst", "--family", "impact", "--evaluations", "40", "--pull-rate", "1000"]
    document = json.loads(CliRunner().invoke(app, [*words, "--json"]).stdout)
    assert document["allowed_pull_rate_N_per_s"] == 1000.0
    shown = " ".join(CliRunner().invoke(app, [*words, "--no-files"]).stdout.split())
    assert "The own force of each hand changes by 1000 N/s at most." in shown
    slow = worst(family=["impact"], evaluations=40, pull_rate=1e3)
    assert "own force at most 1000 N/s" in plot_worst(slow).get_suptitle()
    refused = CliRunner().invoke(app, [*words[:-1], "0"])
    assert refused.exit_code == 2
    assert "--pull-rate = 0 N/s: must lie in [1, 1e+09] N/s" in " ".join(refused.output.split())


def test_without_a_rate_none_is_reported() -> None:
    found = worst(family=["impact"], evaluations=40)
    assert found.pull_rate is None
