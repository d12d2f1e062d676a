"""The search of the worst hand: families, determinism, the pull it may use, and the command."""

import json
import math
import pickle
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac import Condition, Variant, Worst, worst
from ebac.cli import app
from ebac.studies import scenario_changes as to
from ebac.studies.families import families
from ebac.studies.hand_search import HandSearch
from ebac.studies.worst import replays

FAMILIES = ("impact", "press-and-go", "tapping", "swinging", "drive", "noise", "periodic")
KEYS = [
    "law", "condition", "family", "energy_drawn_J", "energy_drawn_300_s_J", "reserve_J", "most_drawn_J", "most_pull_N",
    "within_declared_pull", "unseen_J", "runs", "parameters",
]  # fmt: skip

#: On the encoder alone, where hands draw more.
ALONE = ebac.Scenario(observer=False)


@pytest.fixture(scope="module")
def unguarded() -> Worst:
    law = Variant("ebac", {"guard": False})
    return worst(law, base=ALONE, family=["swinging", "drive"], evaluations=120, threads=2)


def test_a_search_comes_back_from_pickle(unguarded: Worst) -> None:
    assert pickle.loads(pickle.dumps(unguarded)).rows() == unguarded.rows()


# --- families ---


@pytest.mark.parametrize("name", FAMILIES)
@given(data=st.data())
@settings(max_examples=10)
def test_every_point_of_a_family_is_a_hand_within_its_bounds(name: str, data: Any) -> None:
    family = families(20.0)[name]
    shares = data.draw(st.lists(
        st.floats(0, 1), min_size=len(family.parameters), max_size=len(family.parameters)
    ))  # fmt: skip
    values = family.values(np.array(shares))
    for parameter in family.parameters:
        assert parameter.low <= values[parameter.name] <= parameter.high
    base = ebac.Scenario(environment=ebac.Wall(position=0.003))
    made = family.make(base, values)
    assert made.device == base.device
    again = ebac.Scenario.from_toml(made.to_toml())
    assert again.hand.as_dict().keys() == made.hand.as_dict().keys()
    trace = ebac.simulate(made.replace(seconds=0.1), "ebac")
    assert trace["fault"][-1] == 0


@pytest.mark.parametrize("name", ["impact", "press-and-go", "swinging", "noise"])
@given(shares=st.lists(st.floats(0, 1), min_size=9, max_size=9))
@settings(max_examples=15)
def test_hands_made_by_their_pull_pull_no_harder(name: str, shares: list[float]) -> None:
    """But for the little a wall lets them come out of it."""
    family = families(20.0)[name]
    n = len(family.parameters)
    made = family.make(ebac.Scenario(), family.values(np.array(shares[:n])))
    surface = made.environment.position  # type: ignore[union-attr]
    t = np.linspace(0, made.seconds, 997)
    wanted = made.hand.pull(t, np.full(997, surface))
    assert wanted.max() <= 20.0 * (1 + 1e-9)


def test_parameters_go_from_low_to_high_and_never_beyond() -> None:
    family = families(20.0)["impact"]
    n = len(family.parameters)
    for share, bound in ((-0.1, "low"), (0.0, "low"), (1.0, "high"), (1.1, "high")):
        values = family.values(np.full(n, share))
        assert values == {p.name: getattr(p, bound) for p in family.parameters}
    middle = family.values(np.full(n, 0.5))
    assert middle["mass"] == pytest.approx(math.sqrt(0.02 * 1.5))
    assert middle["damping"] == 12.5


# --- the search ---


def test_the_same_seed_finds_the_same_hand_on_any_number_of_threads() -> None:
    first, again, other = (
        worst(family=["swinging"], evaluations=60, seed=seed, threads=threads).rows()
        for seed, threads in ((3, 1), (3, 2), (4, 2))
    )
    assert first == again != other


def test_the_energy_is_minus_the_least_port_energy_of_the_run(unguarded: Worst) -> None:
    assert [hand.runs for hand in unguarded.hands] == [120, 120]
    for hand in unguarded.hands:
        found = ebac.contact(unguarded.trace(hand))
        assert hand.energy_J == -(found.least_energy_J or 0.0)
        assert hand.most_pull_N == found.most_pull_N
        assert hand.most_pull_N <= unguarded.pull == 20.0
        assert unguarded.within(hand) is True
    drawn = [hand.energy_J for hand in unguarded.hands]
    assert drawn == sorted(drawn, reverse=True)


def test_the_search_finds_what_the_guard_is_for(unguarded: Worst) -> None:
    assert unguarded.hands[0].energy_J > 0.1
    kept = worst(base=ALONE, family=["swinging", "drive"], evaluations=120, threads=2)
    assert kept.reserve == 0.010
    assert kept.hands[0].energy_J < 0.3 * unguarded.hands[0].energy_J


def test_a_search_does_better_than_chance() -> None:
    """What NLopt adds to the random half."""
    scenario = ebac.Scenario()
    law = ebac.design("tca", scenario.device, scenario.timing)
    chance = HandSearch(families(20.0)["impact"], scenario, law, 20.0, 2, lambda runs: None)
    random = np.random.default_rng(1)
    chance.measure(random.random((150, 5)))
    searched = worst("tca", family=["impact"], evaluations=150)
    assert searched.hands[0].energy_J > chance.value
    assert searched.reserve is None
    assert searched.declared is None
    assert searched.within(searched.hands[0]) is None


def test_a_hand_that_pulls_too_hard_does_not_count() -> None:
    scenario = ebac.Scenario()
    law = ebac.design("tca", scenario.device, scenario.timing)
    family = families(20.0)["drive"]
    hard = {"mass": 0.1, "damping": 50.0, "stiffness": 4e4, "depth": 3e-3, "amplitude": 3e-3,
            "frequency": 3.0, "phase": 0.0}  # fmt: skip
    shares = []
    for p in family.parameters:
        span = math.log(p.high / p.low) if p.log else p.high - p.low
        shares.append((math.log(hard[p.name] / p.low) if p.log else hard[p.name] - p.low) / span)
    search = HandSearch(family, scenario, law, 20.0, 1, lambda runs: None)
    [value] = search.measure(np.array([shares]))
    assert value < 0  # draws joules, but pulls with far more than 20 N
    free = HandSearch(family, scenario, law, 1e3, 1, lambda runs: None)
    assert free.measure(np.array([shares]))[0] > 0.1


@pytest.mark.slow(every=True)
@pytest.mark.parametrize("name", ["impact", "press-and-go"])
def test_a_run_is_as_long_as_asked(name: str) -> None:
    """But for a hand that lets go later."""
    usual, short, long = (
        worst(family=[name], evaluations=40, seconds=seconds, threads=1).hands[0].scenario
        for seconds in (None, 0.2, 10.0)
    )
    assert 0.5 <= usual.seconds <= 8.0
    assert short.seconds == (
        0.2 if np.isinf(short.hand.release_at) else short.hand.release_at + 0.5
    )
    assert long.seconds == 10.0


def test_an_interrupt_ends_the_search() -> None:
    def stop(done: int, total: int) -> None:
        if done >= 45:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        worst(family=["impact"], evaluations=80, progress=stop)


@pytest.mark.slow
def test_a_law_in_python_can_be_searched() -> None:
    class Bare:
        name = "bare"

        def reset(self) -> None: ...

        def step(self, port: ebac.Port) -> float:
            return port.f_env

    found = worst(Bare(), family=["impact"], evaluations=40)
    assert found.hands[0].energy_J > 0.1


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"evaluations": 39}, r"evaluations = 39: must lie in \[40, 1e\+07\]"),
        ({"seed": -1}, "seed = -1: must lie in"),
        ({"pull": 0.0}, r"pull = 0 N: must lie in \[0.001, 1000\] N"),
        ({"family": ["impct"]}, "family impct: no such name, did you mean 'impact'"),
        ({"condition": "d1L10"}, "condition d1L10: no such name"),
        ({"condition": "five"}, "condition five: stands for d1K10, "),
        ({"condition": "tremor-9Hz"}, "condition tremor-9Hz: changes the hand"),
        ({"condition": "pumping"}, "condition pumping: changes the hand"),
    ],
)
def test_what_cannot_be_searched_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        worst(**given)


def test_a_world_without_a_straight_wall_is_refused() -> None:
    here = Condition(name="here", summary="as it is", change=lambda s: s)
    free = ebac.Scenario(environment=ebac.Free())
    with pytest.raises(TypeError, match="the environment is a Free: must be a Wall"):
        worst(condition=here, base=free, evaluations=40)
    soft = Condition(name="soft", summary="1 kN/m", change=to.wall(stiffness=1e3))
    found = worst(condition=soft, family=["impact"], evaluations=40)
    assert found.hands[0].scenario.environment.stiffness == 1e3  # type: ignore[union-attr]


# --- the command ---


def command(*words: object, code: int = 0) -> Any:
    result = CliRunner().invoke(app, ["worst", *(str(word) for word in words)])
    assert result.exit_code == code, result.output
    return result


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")


def test_json_has_exactly_the_documented_keys(tmp_path: Path) -> None:
    words = ("--family", "impact", "--evaluations", 40, "--condition", "d2K10", "--json")
    document = json.loads(command(*words).stdout)
    assert document["command"] == "worst"
    assert document["allowed_pull_N"] == document["declared_pull_N"] == 20.0
    assert (document["evaluations"], document["seed"]) == (40, 1)
    [row] = document["rows"]
    assert list(row) == KEYS
    assert [p["name"] for p in row["parameters"]] == [
        "mass",
        "damping",
        "stiffness",
        "pull",
        "approach",
    ]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_the_worst_hand_is_written_so_that_it_can_be_replayed(tmp_path: Path) -> None:
    words = ("--family", "swinging", "--family", "noise", "--evaluations", 40, "--out", "out")
    shown = " ".join(command(*words).stdout.split())
    assert "the reserve is 2.00 mJ" in shown
    names = {file.name for file in (tmp_path / "out").iterdir()}
    assert names == {
        "worst.json", "worst.csv", "worst-noise.png", "worst-noise.toml", "worst-swinging.png", "worst-swinging.toml",
    }  # fmt: skip
    rows = json.loads((tmp_path / "out" / "worst.json").read_text())["rows"]
    for row in rows:
        path = tmp_path / "out" / f"worst-{row['family']}.toml"
        tomllib.loads(path.read_text())
        again = ebac.contact(ebac.simulate(ebac.Scenario.load(path), "ebac"))
        assert -(again.least_energy_J or 0.0) == row["energy_drawn_J"]
    assert f"ebac wall --law ebac --scenario out/worst-{rows[0]['family']}.toml" in shown


@pytest.mark.slow
def test_several_laws_are_each_searched_with_the_same_seed(tmp_path: Path) -> None:
    words = ("--family", "impact,tapping", "--evaluations", 40, "--law", "eba,ebac", "--out", "out")
    shown = " ".join(command(*words).stdout.split())
    assert "The worst hand of each law, d1K10" in shown
    for law in ("eba", "ebac"):
        assert f"ebac wall --law {law} --scenario out/worst-{law}.toml" in shown
    assert {file.name for file in (tmp_path / "out").iterdir()} == {
        "worst.json", "worst.csv", "worst-eba.png", "worst-eba.toml", "worst-ebac.png", "worst-ebac.toml",
    }  # fmt: skip
    document = json.loads((tmp_path / "out" / "worst.json").read_text())
    assert document["declared_pull_N"] == 20.0
    alone = [worst(law, family=["impact", "tapping"], evaluations=40) for law in ("eba", "ebac")]
    assert document["rows"] == [row for one in alone for row in one.rows()]


@pytest.mark.slow
def test_a_short_search_says_that_it_proves_less() -> None:
    words = ("--family", "impact", "--no-files", "--evaluations")
    shown = " ".join(command(*words, 40).stdout.split())
    assert "A short search, 40 runs per family: it proves less" in shown
    assert "The default is --evaluations 2000." in shown
    assert "short search" not in command(*words, 2000).stdout


def test_the_table_names_the_pull_that_the_law_is_made_for() -> None:
    words = ("--family", "press-and-go", "--no-files", "--evaluations", 40)
    assert "within the law's 20 N" in " ".join(command(*words).stdout.split())
    assert "within the law's 10 N" in " ".join(
        command(*words, "--change", "pull=10").stdout.split()
    )
    assert "within the law's" not in command(*words, "--law", "tca").stdout  # it declares none


def test_a_law_that_is_told_otherwise_is_not_replayed_by_a_scenario() -> None:
    words = ("--family", "impact", "--evaluations", 40, "--out", "out", "--change", "guard=off")
    assert "Replay from Python" in " ".join(command(*words).stdout.split())
    for name, same in (("d2K10", True), ("told-damping+50", False), ("told-delay-1-of-3", False)):
        condition = ebac.CONDITIONS[name]
        assert replays(condition, condition.change(ebac.Scenario())) is same


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--family", "impct"), "did you mean 'impact'"),
        (("--evaluations", "3"), "--evaluations = 3: must lie in [40, "),
        (("--law", "ebc"), "--law ebc: no such name"),
        (("--change", "kp"), "--change kp: must be NAME=VALUE"),
        (("--change", "kp=0,kp=1"), "--change kp=0,kp=1: kp is given twice; give it once"),
        (
            ("--change", "guard=off", "--change", "kp=0"),
            "--change kp=0: one law is searched, and --change guard=off was given already; "
            "separate the changes by commas: --change guard=off,kp=0",
        ),
        (
            ("--change", "kp=0", "--law", "tca,ebac"),
            "--change kp=0: changes one law, not 2; give one --law, as --law tca",
        ),
        (("--condition", "five"), "give one"),
        (("--pull", "-1"), "pull = -1 N: must lie in"),
        (("--seconds", "0.01"), "--seconds = 0.01 s: must lie in [0.1, 3600] s"),
    ],
)
def test_what_cannot_be_asked_is_refused(
    words: tuple[str, ...], message: str, tmp_path: Path
) -> None:
    text = " ".join(command(*words, code=2).output.split())
    assert message in text
    assert list(tmp_path.iterdir()) == []


class Pulling:
    """A law of somebody's own, in which `pull` is something else."""

    name = "pulling"
    pull = 3.0

    def step(self, port: ebac.Port) -> float:
        return port.f_env

    def reset(self) -> None:
        pass


@pytest.mark.slow
def test_an_attribute_of_a_law_does_not_weaken_the_hands_of_a_search() -> None:
    base = ebac.Scenario(seconds=0.2)
    found = ebac.worst(Pulling(), family=["impact"], evaluations=40, base=base, threads=1)
    assert found.pull == 20.0  # N
    stronger = ebac.Variant("ebac", {"pull": 40.0})
    found = ebac.worst(stronger, family=["impact"], evaluations=40, base=base, threads=1)
    assert found.pull == 40.0


def test_what_a_hand_draws_in_five_minutes_is_that_of_a_run_of_five_minutes(
    unguarded: Worst,
) -> None:
    for hand in unguarded.hands:
        scenario = hand.family.make(unguarded.condition.change(ALONE), hand.values, 300.0)
        met = ebac.contact(ebac.simulate(scenario, unguarded.made))
        assert hand.long_energy_J == pytest.approx(-min(0.0, met.least_energy_J or 0.0), rel=1e-9)
        assert hand.long_energy_J >= hand.energy_J
