"""`ebac random-worlds` and `ebac.random_worlds`: random hands in random worlds of several bodies."""

from __future__ import annotations

import json
import re
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac.cli import app, completion
from ebac.metrics.energy_drawn import drawn
from ebac.plot import plot_random_worlds
from ebac.studies import RandomWorlds, random_worlds
from ebac.studies.random_scenario import DEVICES, random_scenario
from ebac.studies.random_worlds_result import HELD_BACK, HandRun
from ebac.studies.world_kinds import KINDS
from ebac.studies.zwidth import passive_ceiling

cell = st.tuples(st.sampled_from(list(KINDS)), st.sampled_from(list(DEVICES)), st.integers(0, 999))


@pytest.fixture(scope="module")
def found() -> RandomWorlds:
    return random_worlds(("direct", "ebac"), kinds=("planes", "cavity"), hands=5)


@pytest.mark.slow
def test_rows_are_in_the_order_of_the_arguments(found: RandomWorlds) -> None:
    names = [(row.kind, row.device, row.law) for row in found.rows]
    assert names == [
        (kind, device, law)
        for kind in ("planes", "cavity")
        for device in ("2-axes", "3-axes", "gimbal")
        for law in ("direct", "ebac")
    ]
    assert all(
        len(energies) == row.hands == 5
        for row, energies in zip(found.rows, found.drawn_J, strict=True)
    )


def test_ebac_holds_no_hand_back_and_direct_gives_energy_out(found: RandomWorlds) -> None:
    direct, ours = found.totals()
    assert (direct.law, ours.law) == ("direct", "ebac")
    assert direct.hands == ours.hands == 30
    assert direct.faults == ours.faults == 0
    assert ours.held_back == ours.beyond_reserve == 0
    assert ours.reserve_J == 2e-3
    assert ours.longest_held_back_s is not None
    assert ours.longest_held_back_s <= HELD_BACK
    assert direct.drawn_J > 0.05 > ours.reserve_J >= ours.drawn_J
    no_guard = (
        direct.held_back,
        direct.longest_held_back_s,
        direct.beyond_reserve,
        direct.reserve_J,
    )
    assert no_guard == (None,) * 4
    assert np.isnan(found.held_back_s[0]).all()


def test_the_worst_hand_of_a_row_is_simulated_again(found: RandomWorlds, tmp_path: Path) -> None:
    direct, ours = found.worst()[:2]
    assert drawn(found.trace(direct)) == direct.drawn_J
    found.scenario(direct).save(tmp_path / "worst.toml")
    loaded = ebac.Scenario.load(tmp_path / "worst.toml")
    assert loaded == found.scenario(direct)
    assert drawn(ebac.simulate(loaded, "direct")) == direct.drawn_J
    every = [found.trace(ours, hand) for hand in range(ours.hands)]
    assert max(map(drawn, every)) == ours.drawn_J
    assert max(trace["law.starved"].max() for trace in every) == ours.longest_held_back_s


def test_a_hand_that_is_held_back_is_the_worst_of_its_row() -> None:
    """Walls ten times as stiff as the law is made for, at four samples of delay."""
    found = random_worlds(
        kinds=["balls"], devices=["2-axes"], stiffnesses=[100e3], delays=[4], moving=True, hands=5
    )
    [row] = found.rows
    assert row.held_back
    assert found.trace(row)["law.starved"].max() == row.longest_held_back_s
    [times] = found.held_back_s
    assert times.max() == times[row.worst_hand] == row.longest_held_back_s
    assert (times > HELD_BACK).sum() == row.held_back


@pytest.mark.parametrize("where", [("planes", "2-axes", 321), ("three-planes", "gimbal", 66)])
def test_a_hand_that_follows_a_yielding_surface_keeps_it(where: tuple[str, str, int]) -> None:
    """Both had lost it for 4 s: the guard set aside what the wall takes, at a force it then did not allow."""
    scenario = random_scenario(*where, stiffness=20e3, delay=2, moving=True)
    trace = ebac.simulate(scenario, "ebac")
    assert trace["law.starved"].max() <= HELD_BACK
    assert drawn(trace) == 0


@pytest.mark.slow
@pytest.mark.weekly
def test_threads_more_hands_and_other_rows_change_no_hand() -> None:
    few = random_worlds(kinds=["balls"], devices=["2-axes"], hands=3, moving=True, threads=1)
    more = random_worlds(
        ("direct", "ebac"), kinds=["planes", "balls"], devices=["gimbal", "2-axes"], delays=[2, 1],
        hands=4, moving=True, threads=3,
    )  # fmt: skip
    same = next(
        i
        for i, row in enumerate(more.rows)
        if (row.kind, row.device, row.delay_samples, row.law) == ("balls", "2-axes", 1, "ebac")
    )
    assert (more.drawn_J[same][:3] == few.drawn_J[0]).all()
    assert more.scenario(more.rows[same], 2) == few.scenario(few.rows[0], 2)
    again = random_worlds(
        kinds=["balls"], devices=["2-axes"], hands=3, moving=True, threads=3, seed=1
    )
    assert again.rows == few.rows
    assert again.scenario(again.rows[0], 0) != random_scenario(
        "balls", "2-axes", 0, moving=True, seed=2
    )


@given(cell, st.integers(0, 2**31 - 1))
@settings(max_examples=60)
def test_a_hand_begins_in_free_space_and_moves_in_the_same_world(
    where: tuple[str, str, int], seed: int
) -> None:
    still, moving = (random_scenario(*where, moving=moving, seed=seed) for moving in (False, True))
    world, swinging = still.environment, moving.environment
    assert isinstance(world, ebac.worlds.World)
    assert isinstance(swinging, ebac.worlds.World)
    around = 0.9e-3 * np.vstack([np.zeros(3), np.eye(3), -np.eye(3)])
    assert not any(touch.force.any() for place in around for touch in world.walk([place]))
    assert still.hand == moving.hand
    assert [body.solid for body in world.bodies] == [body.solid for body in swinging.bodies]
    assert all(body.motion.still() for body in world.bodies)
    assert not any(body.motion.still() for body in swinging.bodies)


def test_what_is_drawn_fills_the_ranges_of_the_docstring() -> None:
    """Only the page had those of the worlds."""
    drawn_from: dict[str, list[float]] = {}

    def put(key: str, *values: float) -> None:
        drawn_from.setdefault(key, []).extend(values)

    for kind, index in product(KINDS, range(150)):
        made = random_scenario(kind, "2-axes", index, moving=True)
        put("LOW to HIGH kg", made.hand.mass)
        put("LOW to HIGH N s/m", made.hand.damping)
        put("LOW to HIGH N/m", made.hand.stiffness)
        assert isinstance(made.environment, ebac.worlds.World)
        for path, body in zip(made.hand.path[:2], made.environment.bodies, strict=False):
            put("swings by LOW to HIGH mm", 1e3 * path.amplitude)
            put("15 mm at LOW to HIGH Hz", path.frequency)
            put("about LOW to HIGH mm", 1e3 * path.centre)
            put("up to 4 mm at LOW to HIGH Hz", body.motion.frequency)
            solid = body.solid
            where = 1e3 * np.linalg.norm(getattr(solid, "at", np.zeros(3)))
            match getattr(solid, "solid", solid), kind:
                case ebac.worlds.Plane(), _:
                    put("its surface LOW to HIGH mm", where)
                case ebac.worlds.Sphere() as ball, "balls":
                    put("two of one radius, LOW to HIGH mm", 1e3 * ball.radius)
                    put("their surfaces LOW to HIGH mm", where - 1e3 * ball.radius)
                case ebac.worlds.Sphere() as ball, "ball-and-plane":
                    put("one of LOW to HIGH mm", 1e3 * ball.radius)
                    put("mm, LOW to HIGH mm away", where - 1e3 * ball.radius)
                case ebac.worlds.Sphere() as hole, "cavity":
                    put("`cavity` of LOW to HIGH mm", 1e3 * hole.radius)
                case ebac.worlds.Cylinder() as column, "cavity":
                    put("a cylinder of LOW to HIGH mm", 1e3 * column.radius)
    said = " ".join(str(random_worlds.__doc__).split())
    for key, values in drawn_from.items():
        number = r"(-?[\d.]*\d)"
        found = re.search(key.replace("LOW", number).replace("HIGH", number), said)
        assert found, key
        low, high = map(float, found.groups())
        near = 0.05 * (high - low)
        assert min(values) == pytest.approx(low, abs=near), key
        assert max(values) == pytest.approx(high, abs=near), key


@given(cell, st.booleans())
@settings(max_examples=25)
def test_nothing_is_drawn_from_surfaces_so_soft_that_they_are_passive(
    where: tuple[str, str, int], moving: bool
) -> None:
    """Without a law; at 300 N/m the damping of the device makes up for sampling and delay."""
    scenario = random_scenario(*where, stiffness=300.0, moving=moving)
    assert passive_ceiling(scenario.device, scenario.timing) > 4 * 300
    assert drawn(ebac.simulate(scenario, "direct")) < 1e-5


def test_what_moving_bodies_do_is_not_drawn() -> None:
    found = random_worlds(
        ["direct"], kinds=["planes"], devices=["2-axes"], stiffnesses=[300.0], moving=True, hands=40
    )
    [row] = found.rows
    least = min(found.trace(row, i)["true.energy"].sum(axis=1).min() for i in range(row.hands))
    assert least < -1e-3
    assert row.drawn_J < 1e-5


def test_the_damper_of_a_law_at_a_surface_that_recedes_is_no_work_of_the_surface() -> None:
    """It brakes the handle that follows; taken as work of the surface, 9 mJ would seem to be drawn."""
    scenario = random_scenario("ball-and-plane", "gimbal", 341, moving=True)
    assert drawn(ebac.simulate(scenario, "ebac")) == 0


class Pushes:
    """A law in Python that pushes the handle on for as long as it is touched, with a fault in some hands."""

    def reset(self) -> None:
        pass

    def step(self, port: ebac.Port) -> float:
        return float("nan") if port.f_env > 20 else port.f_env


def test_a_fault_is_counted_and_its_hand_is_the_worst() -> None:
    found = random_worlds([Pushes()], kinds=["planes"], devices=["2-axes"], hands=4)
    [row] = found.rows
    assert 0 < row.faults < 4
    assert found.trace(row)["fault"].any()
    assert found.trace(row)["t"][-1] < 4


def test_it_is_printed_and_drawn(found: RandomWorlds) -> None:
    shown = repr(found)
    assert "5 random hands a row in worlds of still bodies, simulated" in shown
    assert "drawn [mJ]" in shown
    assert len(shown.splitlines()) < 20
    figure = plot_random_worlds(found)
    above, below = figure.axes[:2], figure.axes[2:]
    assert [ax.get_title() for ax in above] == ["two planes", "a cylinder in a round cavity"]
    for ax in above:
        direct, ours, reserve = ax.lines
        assert (np.diff(np.asarray(direct.get_ydata())) <= 0).all()
        assert np.asarray(reserve.get_xdata())[0] == 2.0
        assert np.asarray(ours.get_ydata())[-1] == 0
    for ax in below:
        ours, counted = ax.lines  # `direct` has no guard
        assert np.asarray(ours.get_ydata())[-1] == 0
        assert np.asarray(counted.get_xdata())[0] == HELD_BACK
    assert len(plot_random_worlds(random_worlds("direct", hands=1)).axes) == 5


@pytest.mark.parametrize(
    ("given", "kind", "says"),
    [
        ({"kinds": ["ball"]}, KeyError, "no kind of world is called 'ball', did you mean 'balls'"),
        (
            {"kinds": "balls"},
            TypeError,
            r"kinds = 'balls' \(str\): must be a sequence, such as \['balls'\]",
        ),
        ({"stiffnesses": 1e4}, TypeError, r"stiffnesses = 10000.0 \(float\): must be a sequence"),
        ({"devices": ["reference"]}, KeyError, "there are: 2-axes, 3-axes, gimbal"),
        ({"delays": ()}, ValueError, r"delays = \[\]: is empty; give one at least"),
        ({"stiffnesses": [-1]}, ValueError, "stiffness = -1 N/m: must lie in"),
        ({"hands": 0}, ValueError, r"hands = 0: must lie in \[1, 100000\]"),
        ({"hands": 1.5}, TypeError, "hands = 1.5: must be a whole number"),
        ({"seed": -1}, ValueError, r"seed = -1: must lie in \[0, 2147483647\]"),
        ({"threads": 0}, ValueError, r"threads = 0: must lie in \[1, 1024\]"),
        ({"moving": "still"}, TypeError, "moving=True or False, not 'still'"),
        ({"laws": ()}, ValueError, "no law given"),
    ],
)
def test_what_cannot_be_is_refused_before_any_run(
    given: dict[str, Any], kind: type[Exception], says: str
) -> None:
    with pytest.raises(kind, match=says):
        random_worlds(**given)


def test_the_command_prints_a_table_and_the_way_to_see_a_hand_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    call = "random-worlds --kind planes --device 2-axes --hands 3 --law direct,ebac"
    answer = CliRunner().invoke(app, call.split(), env={"COLUMNS": "100"})
    assert answer.exit_code == 0, answer.output
    text = " ".join(answer.output.split())
    assert "held back" in text
    assert "direct: of 3 runs the worst drew" in text
    assert "ebac: of 3 runs 0 were held back for longer than 0.1 s" in text
    assert "0 drew more than the reserve of 2.00 mJ" in text
    assert "the bodies stand still" in text
    replay = "wall --law ebac --scenario ebac-random-worlds/worst-ebac-planes.toml"
    assert replay in answer.output
    assert {file.name for file in Path("ebac-random-worlds").iterdir()} == {
        "random-worlds.json", "random-worlds.csv", "random-worlds.png",
        "worst-direct-planes.toml", "worst-ebac-planes.toml",
    }  # fmt: skip
    again = CliRunner().invoke(app, [*replay.split(), "--json"])
    assert again.exit_code == 0, again.output
    [row] = json.loads(again.stdout)["rows"]
    assert row["least_energy_J"] <= 0


def test_the_command_prints_the_same_as_json(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    call = "random-worlds --kind balls,cavity --device gimbal --hands 2 --moving --delay 0 --device-lag 0.003 --json"
    answer = CliRunner().invoke(app, call.split())
    assert answer.exit_code == 0, answer.output
    document = json.loads(answer.stdout)
    assert document["moving"] is True
    assert (document["noise_N"], document["lag_s"], document["seed"]) == (0.03, 0.003, 1)
    found = random_worlds(
        kinds=["balls", "cavity"], devices=["gimbal"], hands=2, moving=True, delays=[0], lag=0.003
    )
    assert found.scenario(found.rows[0]).device.sensor.lag == 0.003
    assert document["rows"] == found.table()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("call", "says"),
    [
        ("--kind ball", "--kind ball: no such name, did you mean 'balls' or 'ball-and-plane'"),
        ("--kind ,", "--kind: is empty; there are: planes"),
        ("--device joystick", "--device joystick: no such name; there are: 2-axes"),
        ("--stiffness -1", "--stiffness = -1 N/m: must lie in [0, 1e+07] N/m"),
        ("--delay 9", "--delay = 9 samples: must lie in [0, 8] samples"),
        ("--device-noise -1", "--device-noise = -1 N: must lie in [0, 10] N"),
        ("--device-lag 3", "--device-lag = 3 s: must lie in [0, 0.1] s"),
        ("--hands 0", "--hands = 0: must lie in [1, 100000]"),
        ("--law best", "--law best"),
    ],
)
def test_what_cannot_be_is_refused_by_its_option(
    call: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    answer = CliRunner().invoke(app, ["random-worlds", *call.split()])
    assert answer.exit_code == 2
    assert says in " ".join(answer.output.split())
    assert not list(tmp_path.iterdir())


def test_a_shell_completes_kinds_and_devices() -> None:
    assert completion.world_kinds("ba") == ["balls", "ball-and-plane"]
    assert completion.world_devices("") == ["2-axes", "3-axes", "gimbal"]


def test_a_shell_completes_the_last_name_of_a_list() -> None:
    assert completion.world_kinds("planes,ba") == ["planes,balls", "planes,ball-and-plane"]
    assert "tca,ebac" in completion.laws("tca,eb")
    assert completion.laws("tca,nothing") == []


def test_a_list_of_numbers_is_separated_by_commas_or_the_option_repeated(tmp_path: Path) -> None:
    few = ["random-worlds", *["--kind", "balls", "--device", "2-axes", "--hands", "1", "--json"]]
    calls = ["--delay 1,2", "--delay=1,2", "--delay 1 --delay 2", "--delay 1,1 --delay 2"]
    rows = [
        json.loads(CliRunner().invoke(app, few + call.split()).stdout)["rows"] for call in calls
    ]
    assert [row["delay_samples"] for row in rows[0]] == [1, 2]
    assert rows[1:] == rows[:1] * 3


@pytest.mark.parametrize(
    ("call", "says"),
    [
        ("--delay 1,two", "--delay = two: must be a whole number (in samples)"),
        ("--stiffness 1000,", "--stiffness = : must be a number (in N/m)"),
        ("--hands 1,2", "--hands = 1,2: must be a whole number; must lie in [1, 100000]"),
    ],
)
def test_a_wrong_number_of_a_list_is_named(call: str, says: str) -> None:
    answer = CliRunner().invoke(app, ["random-worlds", *call.split()])
    assert answer.exit_code == 2
    assert says in " ".join(answer.output.split())


def test_a_name_that_is_given_alone_is_completed_alone() -> None:
    assert completion.devices("joystick,re") == []
    assert completion.hands("finger-") == ["finger-pad"]


def test_what_a_law_lends_and_whether_it_is_guarded_is_asked_of_the_law() -> None:
    laws = {
        "on the encoder": ebac.Variant("ebac", {"observer": False}),
        "without guard": ebac.Variant("ebac", {"guard": False}),
        "direct": "direct",
    }
    encoder, bare, direct = random_worlds(laws, kinds=["planes"], devices=["2-axes"], hands=2).rows
    assert (encoder.reserve_J, encoder.held_back) == (ebac.EBAC().reserve, 0)
    assert (bare.reserve_J, bare.held_back) == (ebac.EBAC().observed_reserve, None)
    assert (direct.reserve_J, direct.held_back, direct.beyond_reserve) == (None, None, None)


def test_hands_that_touch_nothing_are_not_counted_as_touched() -> None:
    found = random_worlds("direct", kinds=["balls"], devices=["2-axes"], hands=12)
    met = [bool(found.trace(found.rows[0], i)["f_env"].any()) for i in range(12)]
    assert 0 < found.rows[0].touched == sum(met) < 12


def test_of_hands_that_drew_nothing_the_one_held_back_longest_is_looked_at() -> None:
    short, none = HandRun(0.01, 0.0, fault=False), HandRun(0.0, 0.0, fault=False)
    drew, long = HandRun(0.0, 1e-6, fault=False), HandRun(0.2, 0.0, fault=False)
    assert none.rank < short.rank < drew.rank < long.rank < HandRun(0.0, 0.0, fault=True).rank
