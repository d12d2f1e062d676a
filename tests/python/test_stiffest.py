"""The stiffest wall up to which a law holds for all hands: counts, borders, the result, the command."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.cli.studies.stiffest import _show as show
from ebac.plot import plot_stiffest
from ebac.studies import Stiffest, stiffest
from ebac.studies.stiffest import LADDER
from ebac.studies.stiffest_result import CRITERIA

HANDS = ebac.Operators.grid(mass=[0.05, 0.5], damping=[2], stiffness=[300], target=[0.02, 0.04])
BASE = ebac.Scenario(
    device=ebac.Device(mechanics=ebac.Mechanics(damping=0.5, coulomb=0.1)),
    environment=ebac.Wall(stiffness=3e3, damping=4),
    timing=ebac.Timing(delay=2),
    seconds=2.0,
    observer=False,
)
WALLS = [1e3, 10e3, 50e3]


@pytest.fixture(scope="module")
def found() -> Stiffest:
    return stiffest(["direct", "tca-damped"], population=HANDS, stiffnesses=WALLS, base=BASE)


def counted(found: Stiffest, **counts: list[list[int]]) -> Stiffest:
    """Return a result with other counts."""
    return replace(found, counts={name: np.array(given) for name, given in counts.items()})


def test_only_the_stiffness_of_the_wall_and_the_hand_differ_from_the_scenario(
    found: Stiffest,
) -> None:
    every = found.study.scenarios
    assert [s.environment.stiffness for s in every] == [k for k in WALLS for _ in range(4)]
    for s in every:
        assert (s.device, s.timing, s.seconds) == (BASE.device, BASE.timing, BASE.seconds)
        assert s.environment.damping == 4


def test_counts_are_those_of_a_study(found: Stiffest) -> None:
    named = ebac.study(HANDS, ["direct", "tca-damped"], ["K1", "K10", "K50"], base=BASE)
    for row in named.rows:
        law, wall = list(named.laws).index(row.law), ["K1", "K10", "K50"].index(row.condition)
        assert found.counts["good"][law, wall] == row.good
        assert found.counts["exact_and_still"][law, wall] == row.exact_and_still
        [walls] = [
            one for one in found.walls()
            if (one["law"], one["stiffness_N_per_m"]) == (row.law, WALLS[wall])
        ]  # fmt: skip
        assert walls["most_drawn_J"] == row.most_drawn_J
        assert walls["median_settled_s"] == row.median_settled_s


def test_each_criterion_is_stricter_than_the_one_before(found: Stiffest) -> None:
    exact, good, in_time = (found.counts[name] for name in CRITERIA)
    assert (exact >= good).all()
    assert (good >= in_time).all()
    for row in found.rows:
        limits = [getattr(row, f"{name}_N_per_m") or 0 for name in CRITERIA]
        assert limits == sorted(limits, reverse=True)


@given(st.lists(st.integers(0, 4), min_size=3, max_size=3), st.floats(0.01, 1))
def test_up_to_a_wall_every_softer_wall_holds_and_the_next_one_fails(
    found: Stiffest, good: list[int], share: float
) -> None:
    made = replace(
        counted(found, exact_and_still=[good, good], good=[good, [0, 4, 4]]), share=share
    )
    holds = [n >= share * 4 - 1e-6 for n in good]
    first = (*holds, False).index(False)
    by_law = {row.law: row for row in made.rows}
    assert by_law["direct"].good_N_per_m == (WALLS[first - 1] if first else None)
    assert made.again("good")["direct"] == [
        k for k, held in zip(WALLS[first:], holds[first:], strict=True) if held
    ]
    assert by_law["tca-damped"].good_N_per_m is None
    assert made.again("good")["tca-damped"] == WALLS[1:]


def test_beside_a_wall_stands_its_stiffness_on_impact(found: Stiffest) -> None:
    for row in found.rows:
        walls = [w for w in found.walls() if w["law"] == row.law]
        at = [w for w in walls if w["stiffness_N_per_m"] == row.good_N_per_m]
        assert row.good_impact_share == (at[0]["median_impact_share"] if at else None)
        softest = walls[0]["median_impact_share"]
        assert softest is None or 0 < softest < 2


@given(st.integers(1, 1000), st.integers(1, 1000))
def test_a_share_asks_for_no_hand_too_many(hands: int, needed: int) -> None:
    """A share of 0.95 of 60 hands is 57, not 58."""
    needed = min(hands, needed)
    made = Stiffest.__new__(Stiffest)
    object.__setattr__(made, "share", needed / hands)
    object.__setattr__(made, "study", type("Study", (), {"operators": range(hands)}))
    assert made.needed == needed


def test_the_best_law_is_first_and_of_equals_the_one_that_draws_less(found: Stiffest) -> None:
    both = [[4, 4, 0], [4, 4, 0]]
    equal = counted(found, exact_and_still=both, good=both, good_in_time=both)
    drawn = [row.good_drawn_J or 0 for row in equal.rows]
    assert drawn == sorted(drawn)
    softer = counted(
        found, exact_and_still=both, good=[[4, 4, 0], [4, 0, 0]], good_in_time=[[0] * 3, [4, 0, 0]]
    )
    assert [row.law for row in softer.rows] == ["direct", "tca-damped"]
    late = counted(found, exact_and_still=both, good=both, good_in_time=[[4, 0, 0], [4, 4, 0]])
    assert [row.law for row in late.rows] == ["tca-damped", "direct"]


def test_where_no_ideal_time_is_known_in_time_is_not_judged(found: Stiffest) -> None:
    both = [[4, 4, 0], [4, 4, 4]]
    untimed = counted(found, exact_and_still=both, good=both)
    assert [row.law for row in untimed.rows] == ["tca-damped", "direct"]
    assert all(row.good_in_time_N_per_m is None for row in untimed.rows)
    assert all(row["good_in_time"] is None for row in untimed.walls())
    assert {row["late"] for row in json.loads(untimed.to_json())["rows"]} == {None}


def test_the_default_is_every_law_and_the_whole_ladder() -> None:
    one = ebac.Operators.grid()[:1]
    made = stiffest(population=one, base=ebac.Scenario(seconds=0.05))
    assert tuple(made.stiffnesses) == LADDER
    assert list(made.study.laws) == list(ebac.LAWS)


def test_walls_are_sorted_and_each_tried_once() -> None:
    short = ebac.Scenario(seconds=0.05)
    made = stiffest("tca", population=HANDS[:1], stiffnesses=[5e3, 1e3, 5e3], base=short)
    assert made.stiffnesses.tolist() == [1e3, 5e3]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"share": 0.0}, r"share = 0: must lie in \(0, 1\]"),
        ({"share": float("nan")}, "share = nan"),
        ({"stiffnesses": [1e3, 0.0]}, r"stiffnesses: 0 N/m: must lie in \(0, 1e\+07\] N/m"),
        ({"stiffnesses": [2e7]}, r"stiffnesses: 2e\+07 N/m"),
        ({"stiffnesses": []}, "stiffnesses = .*is empty"),
        (
            {"base": ebac.Scenario(environment=ebac.Wall(motion_amplitude=1e-3))},
            "no hand can be judged: the wall moves",
        ),
    ],
)
def test_what_cannot_be_searched_is_refused(given: dict[str, object], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        stiffest("tca", population=HANDS[:1], **given)  # type: ignore[arg-type]


def test_a_world_that_is_no_wall_is_refused() -> None:
    with pytest.raises(
        TypeError, match="takes a base with a Wall, whose stiffness it sets, not Free"
    ):
        stiffest("tca", base=ebac.Scenario(environment=ebac.Free()))


def test_a_result_is_saved_printed_and_drawn(found: Stiffest, tmp_path: Path) -> None:
    found.save(tmp_path / "found.csv")
    with (tmp_path / "found.csv").open(encoding="utf-8") as file:
        assert [row["law"] for row in csv.DictReader(file)] == [row.law for row in found.rows]
    found.save(tmp_path / "found.json")
    document = json.loads((tmp_path / "found.json").read_text())
    for row, wrote in zip(found.rows, document["rows"], strict=True):
        law = list(found.study.laws).index(row.law)
        good, in_time = found.counts["good"][law], found.counts["good_in_time"][law]
        hands = {"not_good": (4 - good).tolist(), "late": (good - in_time).tolist()}
        assert wrote == row.row() | hands
    assert document["walls"] == found.walls()
    assert (document["hands"], document["share"]) == (4, 1.0)
    with pytest.raises(ValueError, match=r"\.json"):
        found.save(tmp_path / "found.txt")
    assert "4 of 4 hands" in repr(found)
    assert "exact and still [N/m]" in repr(found)


def test_the_stiffest_wall_of_the_search_is_printed_with_or_more(found: Stiffest) -> None:
    every = counted(found, exact_and_still=[[4, 4, 4], [4, 4, 0]])
    for shown in (repr(every), every._repr_html_()):
        assert shown.count("50000 or more") == 1
        assert "10000 or more" not in shown


def test_the_figure_has_a_panel_for_each_law_the_best_first(found: Stiffest) -> None:
    figure = plot_stiffest(found)
    assert [ax.get_title().partition("\n")[0] for ax in figure.axes] == [r.law for r in found.rows]
    first = figure.axes[0]
    law = list(found.study.laws).index(found.rows[0].law)
    good: NDArray[np.float64] = np.asarray(first.lines[1].get_ydata())
    assert good.tolist() == (100 * found.counts["good"][law] / 4).tolist()
    assert np.asarray(first.lines[1].get_xdata()).tolist() == [1, 10, 50]


# --- the command ---


def command(*words: str, code: int = 0) -> str:
    done = CliRunner().invoke(app, ["stiffest", *words])
    assert done.exit_code == code, done.output
    return done.output if code else done.stdout


FEW = ("--population", "random", "--hands", "3", "--seconds", "1", "--wall-stiffness", "1000,5000")


def test_the_command_prints_rows_in_si_units() -> None:
    told = json.loads(command(*FEW, "--law", "direct,ebac", "--json"))
    assert {row["law"] for row in told["rows"]} == {"direct", "ebac"}
    assert told["stiffnesses_N_per_m"] == [1000, 5000]
    assert (told["hands"], len(told["walls"])) == (3, 4)


def test_the_command_says_of_one_wall_that_it_is_one() -> None:
    text = " ".join(command(*FEW[:-1], "1000", "--law", "direct").split())
    assert (
        "The one wall tried, 1 kN/m, holds where it is named; none (N): it fails, by N hands."
        in text
    )
    text = " ".join(command(*FEW, "--law", "direct").split())
    assert "2 walls tried hold, too; none (N): the softest, 1 kN/m, fails, by N hands." in text


def test_the_command_prints_how_many_hands_are_not_good_or_late_at_each_wall(
    found: Stiffest, capsys: pytest.CaptureFixture[str]
) -> None:
    both, last = [[4, 4, 0], [4, 3, 3]], [[1, 4, 0], [4, 2, 3]]
    show(counted(found, exact_and_still=both, good=both, good_in_time=last))
    text = capsys.readouterr().out
    assert "Of 4 hands at each wall [kN/m]: how many are not good, + good but late." in text
    rows = [" ".join(line.split()) for line in text.splitlines()]
    assert "direct 0 + 3 0 4" in rows
    assert "tca-damped 0 1 + 1 1" in rows
    assert "none (3)" in text
    show(counted(found, exact_and_still=both, good=both))
    text = capsys.readouterr().out
    assert "how many are not good." in text
    assert "direct 0 0 4" in [" ".join(line.split()) for line in text.splitlines()]


def test_the_command_has_the_delay_and_wall_damping_of_its_options(tmp_path: Path) -> None:
    file, out = tmp_path / "mine.toml", tmp_path / "out"
    file.write_text("[timing]\ndelay = 2\n[device.mechanics]\ndamping = 0.6\n", encoding="utf-8")
    words = ("--law", "tca-damped", "--change", "kp=0", "--wall-damping", "3", "--out", str(out))
    text = " ".join(command(*FEW, *words, "--scenario", str(file)).split())
    assert "tca-damped, kp=0" in text
    assert "2 samples of delay" in text
    assert "0.6 N s/m" in text
    base = ebac.Scenario.load(out / "scenario.toml")
    assert (base.timing.delay, base.device.mechanics.damping) == (2, 0.6)
    assert base.environment.damping == 3  # type: ignore[union-attr]
    assert {path.name for path in out.iterdir()} == {
        "stiffest.png",
        "stiffest.json",
        "stiffest.csv",
        "walls.csv",
        "failures.csv",
        "population.csv",
        "runs.csv",
        "scenario.toml",
        "sweep",
    }
    again = command(*FEW, *words, "--scenario", str(file), "--resume")
    assert "tca-damped, kp=0" in " ".join(again.split())


def test_the_command_says_what_a_wall_is_like_that_is_exact_and_not_quiet() -> None:
    words = (
        *FEW[:4],
        "--seconds",
        "3",
        "--law",
        "tca-damped,ebac",
        "--wall-stiffness",
        "5000",
        "--no-files",
    )
    text = " ".join(command(*words).split())
    row = next(
        row for row in json.loads(command(*words, "--json"))["rows"] if row["law"] == "tca-damped"
    )
    assert row["good_N_per_m"] is None
    assert "tca-damped: at 5 kN/m, exact and still, not quiet in force," in text
    assert f"{row['exact_and_still_impact_share']:.0%} on impact".replace("%", " %") in text
    assert "ebac: at" not in text


def test_the_command_refuses_by_the_names_of_its_options() -> None:
    assert "--share = 2: must lie in (0, 1]" in command("--share", "2", code=2)
    assert "did you mean 'direct'" in " ".join(command("--law", "dirct", code=2).split())
    assert "--hands 5: only a random population" in command("--hands", "5", code=2)
    text = command("--wall-stiffness", "1000,-5", code=2)
    assert "--wall-stiffness = -5 N/m: must lie in (0, 1e+07] N/m" in text


@pytest.mark.slow
def test_a_light_device_with_two_samples_of_delay_loses_hands_on_the_encoder_alone() -> None:
    """On 0.12 kg `ebac` loses hands at a stiff wall, and a plain damper holds a moderate one for all, in time."""
    motor = ebac.Motor(rotor_inertia=1e-6)
    device = ebac.Device(
        motor=motor,
        encoder=ebac.Encoder(counts_per_turn=15708),
        mechanics=ebac.Mechanics(handle_mass=0.08, damping=0.6, coulomb=0.1),
    )
    base = ebac.Scenario(device=device, timing=ebac.Timing(delay=2), observer=False)
    made = stiffest("ebac", stiffnesses=[10e3, 20e3], base=base)
    assert made.counts["good"].tolist() == [[51, 42]]
    assert made.rows[0].good_N_per_m is None
    assert replace(made, share=0.85).rows[0].good_N_per_m == 10e3
    damper = {"damper": ebac.Variant("tca-damped", {"kp": 0})}
    [row] = stiffest(damper, stiffnesses=[3e3, 10e3], base=base).rows
    assert row.good_in_time_N_per_m == 3e3
    assert (row.good_drawn_J or 0) < 1e-4


def test_bodies_are_refused_in_the_words_of_the_command(tmp_path: Path) -> None:
    """It spoke of Operators.grid(approach_m=0), which is Python."""
    file = tmp_path / "mine.toml"
    file.write_text('[environment]\ntype = "Disc"\n', encoding="utf-8")
    words = ["--scenario", str(file), "--law", "ebac", "--no-files"]
    refused = CliRunner().invoke(app, ["stiffest", *words])
    assert refused.exit_code == 2
    assert f"--scenario {file}: its environment is a Disc, and this search sets" in refused.stderr
    refused = CliRunner().invoke(app, ["study", *words])
    assert refused.exit_code == 2
    assert (
        "needs a Wall, the scenario has a Disc; start on the surface: --approach 0"
        in refused.stderr
    )


def test_where_no_law_is_good_the_command_says_what_to_try(tmp_path: Path) -> None:
    file = tmp_path / "device.toml"
    file.write_text("[device.sensor]\nfitted = false\n", encoding="utf-8")
    words = f"--scenario {file} --law tca --wall-stiffness 20000 --population random --hands 2 --seconds 1"
    said = " ".join(command(*words.split(), "--no-files").split())
    assert "No law is good here. What may change that: --share 0.95" in said
    assert "a force sensor; friction, if the device has some" in said
