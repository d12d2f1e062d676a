"""What is possible, but more likely not meant: `doubts()` of scenarios and runs, and the warnings of `simulate`."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.worlds import Body, Elastic, Placed, Sphere, World

MILLIMETRES = ebac.Scenario(environment=ebac.Wall(position=10.0), seconds=0.1)
BALL = World(Body(solid=Sphere(radius=0.02), material=Elastic(stiffness=1e4)))


def test_what_is_usual_is_not_doubted() -> None:
    for name in ebac.presets.DEVICES:
        device = ebac.presets.device(name)
        for world in (ebac.Wall(), ebac.Free(), ebac.worlds.preset("sphere")):
            assert ebac.Scenario(device=device, environment=world).doubts() == ()
    for name in ebac.presets.HANDS:
        scenario = ebac.Scenario(hand=ebac.presets.hand(name))
        assert all(text.startswith("Too hot") for text in scenario.doubts())
        with warnings.catch_warnings():
            warnings.simplefilter("error", ebac.DoubtWarning)
            assert ebac.simulate(scenario).doubts() == ()


@pytest.mark.parametrize(
    ("scenario", "words"),
    [
        (MILLIMETRES, ["environment.position = 10 m: the handle never reaches the wall", "10 mm are 0.01"]),
        (
            ebac.Scenario(environment=ebac.Wall(stiffness=10.0)),
            ["environment.stiffness: a wall of 10 N/m: usual are 50 to 500000 N/m; it is in N/m, 10 kN/m are 10000"],
        ),
        (
            ebac.Scenario(device=ebac.Device(mechanics=ebac.Mechanics(handle_mass=90))),
            ["device: mass at the handle = 90.14 kg: usual are 0.001 to 20 kg"],
        ),
        (
            ebac.Scenario(device=ebac.Device(sensor=ebac.ForceSensor(quantum=0.2))),
            ["device.sensor.quantum = 0.2 N", "Scenario(observer=False) runs it on the encoder alone"],
        ),
        (
            ebac.Scenario(device=ebac.Device(motor=ebac.Motor(rated_torque=0.01))),
            ["No law can be exact: the ideal rest needs 11.7 N, and the motor gives 8 N at most"],
        ),
        (
            ebac.Scenario(environment=ebac.Wall(position=-0.005)),
            ["the handle begins 5 mm inside the wall and is pushed with 50 N", "it stays inside"],
        ),
        (ebac.Scenario(environment=BALL), ["the handle begins 20 mm inside body 1 and is pushed with "]),
    ],
)  # fmt: skip
def test_a_scenario_lists_what_is_doubtful_of_it(scenario: ebac.Scenario, words: list[str]) -> None:
    (text,) = scenario.doubts()
    assert all(word in text for word in words), text


@pytest.mark.parametrize(
    "world",
    [
        ebac.Wall(position=-0.9e-3),  # it grazes
        ebac.Wall(position=-0.02, stiffness=49.9 / 0.05, damping=0.0).replace(stiffness=0.0),
        World(Body(solid=Placed(Sphere(radius=0.02), at=(0.02, 0, 0)))),
        ebac.Corner(),
    ],
)
def test_a_handle_that_begins_outside_or_is_not_pushed_is_not_doubted(world: Any) -> None:
    device = ebac.Device(kinematics=ebac.Linear(axes=2))
    said = ebac.Scenario(device=device, environment=world).doubts()
    assert not [text for text in said if "inside" in text]


def test_simulate_warns_at_the_line_of_the_user() -> None:
    with pytest.warns(ebac.DoubtWarning) as caught:
        ebac.simulate(MILLIMETRES)
    assert [str(one.message) for one in caught] == list(MILLIMETRES.doubts())
    assert caught[0].filename == __file__
    line = Path(__file__).read_text(encoding="utf-8").split("\n")[caught[0].lineno - 1]
    assert line.strip() == "ebac.simulate(MILLIMETRES)"


def test_a_wall_that_was_not_met_is_doubted_after_the_run() -> None:
    hand = ebac.Hand(target=0.01)
    scenario = ebac.Scenario(hand=hand, environment=ebac.Wall(position=0.02), seconds=1)
    with pytest.warns(
        ebac.DoubtWarning, match=r"comes to 0\.01 m at most.*by hand\.path"
    ) as caught:
        trace = ebac.simulate(scenario)
    assert trace.doubts() == tuple(str(one.message) for one in caught)
    assert ebac.contact(trace).verdict == "no contact"
    assert scenario.doubts() == (), "an overshoot could reach it"


def test_a_handle_that_leaves_the_workspace_is_doubted_after_the_run() -> None:
    hand = ebac.Hand(target=0.18)
    with pytest.warns(ebac.DoubtWarning, match="leaves the workspace of its device after 0"):
        trace = ebac.simulate(ebac.Scenario(hand=hand, environment=ebac.Free(), seconds=1))
    (text,) = trace.doubts()
    assert f"up to {1e3 * np.abs(trace['true.x']).max():.4g} mm from the middle" in text


def test_rows_without_a_scenario_are_not_doubted() -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.1))
    trace.scenario = None
    assert trace.doubts() == ()


def test_many_runs_do_not_warn() -> None:
    """A study of 60 hands would warn 60 times; its threads and those of searches are no line of the user's."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", ebac.DoubtWarning)
        ebac.sweep([MILLIMETRES] * 3, ["ebac", Quiet()])


class Quiet:
    """A law in Python, which a sweep runs one by one by `simulate`."""

    name = "quiet"

    def step(self, port: ebac.Port) -> float:
        return 0.0

    def reset(self) -> None:
        pass


def test_the_command_line_notes_and_does_not_warn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    words = "wall --law ebac --wall-position -0.005 --seconds 0.1 --no-files"
    said = " ".join(CliRunner().invoke(app, words.split()).stderr.split())
    assert said.count("the handle begins 5 mm inside the wall") == 1
    assert said.startswith("Note: --wall-position: the handle begins")
    assert "DoubtWarning" not in said
    study = "study --law ebac --hands 1 --population random --condition d1K10 --seconds 0.5"
    Path("inside.toml").write_text('[environment]\ntype = "Wall"\nposition = -0.005\n')
    words = [*study.split(), "--no-files", "--scenario", "inside.toml"]
    said = CliRunner().invoke(app, words).stderr
    assert "begins" not in said, "hands of a population begin before the wall, by their approach"


def test_studies_warn_once_at_the_line_that_calls_them() -> None:
    weak = ebac.Device(motor=ebac.Motor(rated_torque=0.01))
    base = ebac.Scenario(device=weak, seconds=0.1)
    hands = ebac.Operators.grid()[-2:]
    walls = {"population": hands, "stiffnesses": [1e4, 2e4]}  # N/m
    calls: dict[str, Any] = {
        "2 of the 2 hands press with more": lambda: ebac.study(hands, "tca", base=base),
        "at a wall of 10 kN/m and stiffer": lambda: ebac.stiffest("tca", base=base, **walls),
    }
    for words, call in calls.items():
        with pytest.warns(ebac.DoubtWarning) as caught:
            call()
        doubted = [one for one in caught if one.category is ebac.DoubtWarning]
        texts = [str(one.message) for one in doubted]
        assert [text.partition(":")[0] for text in texts[:1]] == ["Scenario.seconds = 0.1 s"]
        assert len(texts) == 2
        assert words in texts[1]
        assert {one.filename for one in doubted} == {__file__}
