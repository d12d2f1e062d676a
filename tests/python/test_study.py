"""Studies: conditions, what counts as good, and the command."""

import csv
import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac import CONDITIONS, Condition, Operators, Study, study
from ebac.cli import app
from ebac.cli.studies import study_results
from ebac.studies import GROUPS
from ebac.studies import scenario_changes as to
from ebac.studies.conditions import conditions as find
from ebac.studies.ideal import ideal_contacts

FEW = Operators.grid(mass=[0.15], damping=[2, 4, 6], stiffness=[300], target=[0.04])  # 3 hands
ROW = [
    "law", "condition", "hands", "good", "exact_and_still", "settled_in_time", "least_energy_J", "most_drawn_J",
    "median_settled_s", "ideal_good", "least_rest_power_W", "force_quiet", "median_impact_share", "ended_early",
]  # fmt: skip


@pytest.fixture(scope="module")
def few() -> Study:
    return study(FEW, ["tca", "ebac"], ["d1K10", "tapping-6Hz"])


def test_a_row_for_each_law_and_condition(few: Study) -> None:
    assert [(row.condition, row.law) for row in few.rows] == [
        ("d1K10", "tca"), ("d1K10", "ebac"), ("tapping-6Hz", "tca"), ("tapping-6Hz", "ebac"),
    ]  # fmt: skip
    assert list(few.rows[0].row()) == ROW
    assert all(row.hands == 3 for row in few.rows)


def test_the_completed_law_is_good_where_the_force_loop_swings(few: Study) -> None:
    tca, ebac_ = few.rows[:2]
    assert (tca.good, ebac_.good) == (0, 3)
    assert ebac_.settled_in_time == 3
    assert (tca.least_energy_J or 0) < -0.1
    assert (ebac_.most_drawn_J or 0) < 1e-3
    assert tca.median_settled_s is None
    assert (tca.force_quiet, ebac_.force_quiet) == (0, 3)


def test_a_hand_that_only_clicks_is_exact_and_still_and_not_good() -> None:
    found = study(FEW, {"ebac": ebac.Variant("ebac", {"observer": False})}, ["d1K10"])
    [row] = found.rows
    assert (row.good, row.exact_and_still, row.settled_in_time) == (0, 3, 3)
    assert all(failure.why.startswith("force not quiet: ") for failure in found.failures)


def test_the_command_does_not_call_good_what_it_does_not_judge() -> None:
    words = "study --law ebac --condition tapping-6Hz --population random --hands 2 --no-files"
    said = " ".join(CliRunner().invoke(app, words.split()).output.split())
    assert (
        "tapping-6Hz: hands are not judged good or exact, there is no ideal rest: the target of the hand"
        in said
    )
    assert "hand is good" not in said


class Broken:
    """A law that gives no number from 1 mm inside the wall on."""

    name = "broken"

    def step(self, port: ebac.Port) -> float:
        return float("nan") if port.f_env > 10 else port.f_env

    def reset(self) -> None:
        """Do nothing: it has no memory."""


def test_runs_that_end_early_are_counted_and_are_a_column_only_then(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    both = study(FEW, {"broken": Broken(), "ebac": "ebac"})
    assert [row.ended_early for row in both.rows] == [3, 0]
    study_results.show(both, files=False)
    said = " ".join(capsys.readouterr().out.split())
    assert "ended early: by a fault, or diverged" in said
    study_results.show(study(FEW, ["ebac"]), files=False)
    assert "ended early" not in capsys.readouterr().out


def test_what_never_rests_is_neither_good_nor_bad(few: Study) -> None:
    for row in few.rows[2:]:
        assert row.good is None
        assert row.settled_in_time is None
        assert row.least_energy_J is not None


def test_failures_are_named_and_can_be_run_again(few: Study) -> None:
    assert [(f.law, f.condition, f.operator) for f in few.failures] == [
        ("tca", "d1K10", 1), ("tca", "d1K10", 2), ("tca", "d1K10", 3),
    ]  # fmt: skip
    failure = few.failures[0]
    assert failure.name == "0.15 kg, 2 N s/m, 300 N/m, 40 mm"
    assert failure.why.startswith("swings by ")
    again = ebac.contact(few.trace(failure.run))
    assert again.swing_m == few.columns["swing_m"][failure.run]


def test_settled_in_time_is_measured_against_the_ideal_wall(few: Study) -> None:
    runs = few.runs("ebac", "d1K10")
    ideal = ideal_contacts(FEW.scenarios(ebac.Scenario()))["settled_s"]  # 10 mm of free air, too
    np.testing.assert_array_equal(few.columns["ideal_settled_s"][runs], ideal)
    in_time = few.columns["settled_s"][runs] <= 1.5 * ideal + 0.2
    np.testing.assert_array_equal(few.columns["settled_in_time"][runs], in_time)


def test_what_an_ideal_wall_cannot_settle_is_no_fault_of_a_law() -> None:
    shaking = to.hand(tremor_amplitude=5e-3, tremor_frequency=2.0)(ebac.Scenario())
    released = to.hand(release_at=1.0)(ebac.Scenario())
    settled = ideal_contacts([shaking, released, ebac.Scenario()])["settled_s"]
    assert settled[0] == np.inf
    assert np.isnan(settled[1])
    assert 0 < settled[2] < 1


# --- conditions ---


@pytest.mark.parametrize("name", list(CONDITIONS))
def test_every_condition_can_be_simulated(name: str) -> None:
    condition = CONDITIONS[name]
    base = ebac.Scenario()
    every = condition.scenarios(FEW, base)
    assert len(every) == (len(condition.drives) or len(FEW))
    for one in (every[0], every[-1]):
        law = ebac.design("ebac", *condition.believed(one))
        trace = ebac.simulate(one.replace(seconds=0.05), law)
        assert trace["fault"][-1] == 0
    assert condition.summary
    assert condition.summary[-1] != "."


def test_the_groups_are_those_of_the_theory() -> None:
    assert GROUPS["five"] == ("d1K10", "d0K10", "d2K10", "d1K20", "d1b1K5")
    assert len(set(GROUPS["cells"])) == 36
    assert set(GROUPS["all"]) == set(CONDITIONS)
    settings = set()
    for name in GROUPS["cells"]:
        one = CONDITIONS[name].scenarios(FEW, ebac.Scenario())[0]
        assert isinstance(one.environment, ebac.Wall)
        settings.add((one.timing.delay, one.device.mechanics.damping, one.environment.stiffness))
    assert settings == {
        (d, b, k) for d in (0, 1, 2) for b in (1, 2, 4) for k in (2e3, 5e3, 10e3, 20e3)
    }


def test_laws_are_told_what_the_condition_says() -> None:
    def told(name: str) -> tuple[ebac.DeviceFacts, ebac.Timing, ebac.Scenario]:
        one = CONDITIONS[name].scenarios(FEW, ebac.Scenario())[0]
        return *CONDITIONS[name].believed(one), one

    facts, timing, one = told("told-delay-1-of-3")
    assert (one.timing.delay, timing.delay) == (3, 1)
    facts, _, one = told("told-damping+50")
    assert facts.damping == 1.5 * one.device.facts.damping == 3.0
    facts, _, one = told("told-mass-50")
    assert facts.mass == pytest.approx(0.5 * one.device.mass)
    facts, _, one = told("told-lag-0.3-of-1")
    assert (facts.current_lag, one.device.drive.current_lag) == (3e-4, 1e-3)
    facts, _, one = told("device-0.1kg")
    assert facts.mass == pytest.approx(0.1)
    assert one.device.mass == pytest.approx(0.1)
    facts, timing, one = told("jitter")
    assert timing.jitter == one.jitter == 0.3


def test_a_hand_can_start_on_the_surface() -> None:
    [there], [here] = (
        CONDITIONS[name].scenarios(FEW[:1], ebac.Scenario()) for name in ("d1K10", "surface")
    )
    assert isinstance(there.environment, ebac.Wall)
    assert there.environment.position == 0.01
    assert here == there.replace(
        environment=there.environment.replace(position=0.0), hand=FEW[:1].replace(approach_m=0).hands()[0]
    )  # fmt: skip
    again = to.approach(0.01)(here)
    assert again.environment == there.environment
    assert again.hand.as_dict() == there.hand.as_dict()


def test_a_wall_that_is_pressed_for_two_minutes_does_not_dissolve() -> None:
    """An account over whole counts loses 0.25 mJ a second: the guard then lets go of the wall within a minute."""
    heavy = Operators.grid(mass=[0.05, 1.0], damping=[2.0], stiffness=[1000.0], target=[0.02])
    found = study(heavy, "ebac", ["hold"])
    assert (found.columns["ticks"] == 120_001).all()
    assert found.rows[0].good == len(heavy) == 2
    last = found.trace(0)[119.0:]
    assert (last["law.admitted"] == 1).all()
    assert last["law.energy"].min() > 1e-3


def test_a_condition_of_ones_own() -> None:
    soft = Condition(name="soft", summary="a wall of 1 kN/m", change=to.wall(stiffness=1e3))
    found = study(FEW, "direct", [soft, "five"])
    assert [row.condition for row in found.rows] == ["soft", *GROUPS["five"]]
    assert found.rows[0].good == 3


def test_a_drive_stands_for_the_population() -> None:
    drives = (to.pump(1e-3, 2.0), to.pump(4e-3, 10.0))
    pump = Condition(
        name="pump", summary="two pumps", change=to.scenario(seconds=0.5), drives=drives
    )
    found = study(FEW, "direct", [pump])
    assert found.rows[0].hands == 2
    assert found.columns["operator"].tolist() == [0, 0]
    one = found.scenarios[0].hand
    assert one.stiffness == 20e3
    path = one.path[0]
    assert isinstance(path, ebac.Sine)
    # At rest the drive would stand 2 mm deep.
    depth = one.stiffness * path.centre / (one.stiffness + 10e3)
    assert depth == pytest.approx(2e-3)


def test_a_study_resumes(tmp_path: Path, few: Study) -> None:
    for _ in range(2):
        again = study(FEW, ["tca", "ebac"], ["d1K10", "tapping-6Hz"], out=tmp_path)
        for name, values in few.columns.items():
            assert values.tobytes() == again.columns[name].tobytes(), name


def test_a_study_and_every_condition_come_back_from_pickle(few: Study) -> None:
    again = pickle.loads(pickle.dumps(few))
    assert again.rows == few.rows
    assert again.trace(0)["x"].tobytes() == few.trace(0)["x"].tobytes()
    for name, condition in CONDITIONS.items():
        twin = pickle.loads(pickle.dumps(condition))
        made = condition.scenarios(FEW, ebac.Scenario())
        assert twin.scenarios(FEW, ebac.Scenario()) == made, name
        assert twin.believed(made[0]) == condition.believed(made[0]), name


def test_what_is_no_condition_is_refused() -> None:
    with pytest.raises(ValueError, match="condition d1L10: no such name, did you mean 'd1K1"):
        study(FEW, "tca", ["d1L10"])
    with pytest.raises(ValueError, match="no condition given"):
        study(FEW, "tca", [])
    free = ebac.Scenario(environment=ebac.Free())
    with pytest.raises(
        ValueError, match=r"approach_m = 0\.01 m: needs a Wall, the scenario has a Free"
    ):
        study(FEW, "tca", ["d1K10"], base=free)
    with pytest.raises(
        TypeError, match=r"the environment is a Free: must be a Wall, .*; ebac\.sweep\("
    ):
        study(FEW.replace(approach_m=0.0), "tca", ["d1K10"], base=free)


def test_a_study_can_be_drawn(few: Study) -> None:
    from ebac.plot import plot_study

    names = [name for name, _ in plot_study(few)]
    assert names == ["overview", "hands"]
    _, hands = list(plot_study(few))[1]
    titles = [ax.get_title(loc="left") for ax in hands.axes]
    assert titles == ["0 of 3 good", "3 of 3 good"]


def test_the_overview_distinguishes_a_still_hand_that_clicks_from_one_that_swings(
    few: Study,
) -> None:
    from ebac.plot import plot_study

    table = next(plot_study(few))[1].axes[0]
    shown = [text.get_text() for text in table.texts]
    rows = {(row.condition, row.law): row for row in few.rows}
    every = [rows[c.name, law] for c in few.conditions for law in few.laws]
    clicks = [(row.exact_and_still or 0) > (row.good or 0) for row in every]
    assert ["(" in text for text in shown] == clicks


def test_a_study_draws_its_overview(few: Study) -> None:
    assert "good hands" in few.plot().axes[0].get_title()


def test_a_study_is_saved_as_the_command_prints_it(few: Study, tmp_path: Path) -> None:
    answer = json.loads(few.to_json())
    assert answer["command"] == "study"
    assert answer["version"] == ebac.__version__
    assert answer["rows"] == [row.row() for row in few.rows]
    few.save(tmp_path / "study.json")
    assert json.loads((tmp_path / "study.json").read_text(encoding="utf-8")) == answer
    few.save(str(tmp_path / "study.csv"))
    with (tmp_path / "study.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["law"] for row in rows] == [row.law for row in few.rows]
    assert list(rows[0]) == list(few.rows[0].row())
    with pytest.raises(ValueError, match=r"study\.xls: must end in \.json, \.csv"):
        few.save(tmp_path / "study.xls")


def test_a_printed_study_names_the_columns_that_do_not_fit(few: Study) -> None:
    last = repr(few).splitlines()[-1]
    assert 'more columns in .rows and .save("study.csv"): ' in last
    for name in ("ideal good", "force quiet"):
        assert name in last


def test_many_laws_under_one_condition_are_drawn_below_each_other() -> None:
    from ebac.plot import plot_study

    laws = ["direct", "tca", "tca-damped", "eba", "force-bounding", "ebac"]
    found = study(FEW[:1], laws, ["d1K10"], base=ebac.Scenario(seconds=0.5))
    panels = dict(plot_study(found))["hands"].axes
    assert len(panels) == 6
    assert len({round(ax.get_position().y0, 3) for ax in panels}) == 2
    named = [text.get_text() for ax in panels for text in ax.texts if text.get_text() in laws]
    assert named == laws


# --- the command ---


def command(*words: object, code: int = 0) -> Any:
    result = CliRunner().invoke(app, ["study", *(str(word) for word in words)])
    assert result.exit_code == code, result.output
    return result


@pytest.fixture
def hands_csv(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    FEW.to_csv(tmp_path / "hands.csv")
    return tmp_path / "hands.csv"


def test_json_has_exactly_the_documented_keys(hands_csv: Path) -> None:
    result = command("--population", hands_csv, "--law", "ebac", "-c", "d0K10", "--json")
    document = json.loads(result.stdout)
    assert document["command"] == "study"
    [row] = document["rows"]
    assert list(row) == ROW
    assert (row["law"], row["condition"], row["hands"], row["good"]) == ("ebac", "d0K10", 3, 3)
    assert list(hands_csv.parent.iterdir()) == [hands_csv]


@pytest.mark.slow
def test_a_folder_of_results(hands_csv: Path, few: Study) -> None:
    words = ("--population", hands_csv, "-l", "tca", "-l", "ebac", "--out", "out", "--traces", 2)
    shown = command(*words).stdout
    assert "swings by" in shown
    out = hands_csv.parent / "out"
    names = {file.name for file in out.iterdir()}
    assert {"study.csv", "study.json", "runs.csv", "failures.csv", "population.csv"} <= names
    assert {"study-overview.png", "study-hands.png", "failure-tca-d1K10-1.npz"} <= names
    assert len([name for name in names if name.startswith("failure-")]) == 2
    with (out / "study.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ROW
    kept = ebac.Trace.from_npz(out / "failure-tca-d1K10-1.npz")
    assert ebac.contact(kept).swing_m == few.columns["swing_m"][0]
    assert command(*words, "--resume").stdout == shown


@pytest.mark.slow
def test_one_failure_of_each_law_is_shown_and_its_trace_kept(hands_csv: Path) -> None:
    words = ("--population", hands_csv, "-l", "tca,tca-damped,ebac", "-c", "d1K10,d0K10")
    shown = command(*words, "--out", "out").stdout
    told = [line for line in shown.splitlines() if " not good, " in line]
    assert len(told) == len({line.split(":")[0] for line in told}) > 1
    with (hands_csv.parent / "out" / "failures.csv").open() as file:
        rows = list(csv.DictReader(file))
    kinds = {(row["law"], row["condition"]) for row in rows}
    assert {line.split(":")[0] for line in told} == {", ".join(kind) for kind in kinds}
    of_tca = [row for row in rows if (row["law"], row["condition"]) == ("tca-damped", "d1K10")]
    assert f"tca-damped, d1K10: {len(of_tca)} hands not good, the first #1 (" in shown
    assert f"failures.csv names all {len(rows)} runs of them." in shown
    kept = [file.name for file in (hands_csv.parent / "out").glob("failure-*.npz")]
    assert len(kept) == len(kinds)


def test_resume_continues_or_begins_but_not_among_other_files(
    tmp_path: Path, hands_csv: Path
) -> None:
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "study.json").write_text("mine")
    words = ("--population", hands_csv, "-l", "ebac", "--resume", "--out")
    text = " ".join(command(*words, mine, code=2).output.split())
    assert "mine has files but no runs of `ebac study` (sweep/sweep.json)" in text
    assert "leave --resume out" in text
    assert [file.read_text() for file in mine.iterdir()] == ["mine"]
    empty = tmp_path / "empty"
    empty.mkdir()
    for fresh in (empty, tmp_path / "new"):
        text = " ".join(command(*words, fresh).output.split())
        assert f"{fresh.name} has no runs yet, begins with the first" in text
        assert "no runs yet" not in command(*words, fresh).output
    other = command(*words[:3], "eba", *words[4:], tmp_path / "new", code=2).output
    assert "--force instead of --resume to start anew" in " ".join(other.split())


def test_random_hands_by_number_and_seed(hands_csv: Path) -> None:
    words = ("--population", "random", "--hands", 4, "-l", "ebac", "--json")
    first, again, other = (
        command(*words, "--seed", seed).stdout.split('"rows"')[1] for seed in (5, 5, 6)
    )
    assert first == again != other


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--population", "grid61"), "--population grid61: must be grid60, random or a CSV file"),
        (("--population", "none.csv"), "none.csv: there is no such file"),
        (("--hands", "3"), "only a random population has a size"),
        (("--law", "ebc"), "did you mean 'ebac'"),
        (("--condition", "fives"), "did you mean 'five'"),
        (("--resume", "--json"), "give it with --out"),
        (("--approach", "-1"), "--approach = -1 m: must lie in [0, 1] m"),
    ],
)
def test_what_cannot_be_is_refused(words: tuple[str, ...], message: str, hands_csv: Path) -> None:
    text = " ".join(command(*words, code=2).output.split())
    assert message in text
    assert list(hands_csv.parent.iterdir()) == [hands_csv]


def test_a_condition_leaves_the_device_its_damping_unless_its_name_has_one() -> None:
    light = ebac.Device(mechanics=ebac.Mechanics(damping=0.5))
    own = ebac.Scenario(device=light)
    for name in ("d2K20", "d1K10", "slow-press-d2K20", "B10K1", "hold-K20"):
        (found,) = find([name])
        assert found.change(own).device == light, name
    (found,) = find(["d2b4K20"])
    assert found.change(own).device.mechanics.damping == 4


def test_a_study_with_a_base_of_ones_own_leaves_it_as_it_is() -> None:
    own = ebac.Scenario(environment=ebac.Wall(stiffness=5e3), seconds=0.5)
    assert study(FEW[:1], ["tca"], base=own).rows[0].condition == "as-given"
    assert study(FEW[:1], ["tca"]).rows[0].condition == "d1K10"


def test_the_conditions_are_listed() -> None:
    result = CliRunner().invoke(app, ["conditions", "--json"])
    rows = json.loads(result.stdout)["rows"]
    assert [row["condition"] for row in rows] == list(CONDITIONS)
    groups = {row["condition"]: row["groups"] for row in rows}
    assert (groups["as-given"], groups["d1K10"]) == (["all"], ["five", "all"])


def test_the_seed_of_the_base_is_that_of_the_study() -> None:
    """It was not used, without a word."""
    device = ebac.Device(sensor=ebac.ForceSensor(noise=0.03))
    hands = ebac.Operators.grid()[:2]

    def drawn(base_seed: int, seed: int | None = None) -> list[float]:
        base = ebac.Scenario(device=device, seconds=0.5, seed=base_seed)
        found = ebac.study(hands, ["ebac"], ["d1K10"], base=base, seed=seed)
        return [float(x) for x in found.result()["ripple_N"]]

    assert drawn(2) == drawn(1, 2) != drawn(1)
    assert drawn(2, 1) == drawn(1)


def test_hands_that_never_reach_the_wall_are_reported() -> None:
    pytest.importorskip("pandas")
    hands = ebac.Operators.sample(4, 1)
    table = hands.to_pandas()
    table.loc[:1, "target_m"] = -0.005
    with pytest.warns(UserWarning, match="rest before the wall, 2 of 4 under d1K10: every law"):
        ebac.study(ebac.Operators.from_dataframe(table), ["direct"], ["d1K10"])


@pytest.mark.filterwarnings("default")
def test_the_command_notes_what_the_library_warns_of(tmp_path: Path) -> None:
    file = tmp_path / "hands.csv"
    file.write_text("m_kg,b_Ns_per_m,k_N_per_m,target_m\n0.2,5,300,-0.02\n0.2,5,300,0.04\n")
    told = CliRunner().invoke(
        app, ["study", "--population", str(file), "--law", "direct", "--no-files"]
    )
    assert told.exit_code == 0
    said = " ".join(told.stderr.split())
    assert "Note: hands that rest before the wall, 1 of 2 under d1K10" in said
    assert ".py" not in said


def test_a_hand_of_ones_own_in_the_base_is_not_lost_in_silence() -> None:
    base = ebac.Scenario(hand=ebac.presets.hand("reflex"), seconds=0.5)
    with pytest.warns(
        UserWarning, match="the hand of base, Reflex, gives way to those of the population"
    ):
        study(FEW, ["direct"], ["K8"], base=base)


class _Broken:
    """A law that gives no number after 0.2 s, with a name that is no file's."""

    name = "broken 1/2"

    def __init__(self) -> None:
        self.ticks = 0

    def step(self, port: Any) -> float:
        self.ticks += 1
        return float("nan") if self.ticks > 200 else 0.0

    def reset(self) -> None:
        self.ticks = 0


def test_every_failure_of_a_condition_of_drives_has_a_trace_of_its_own(tmp_path: Path) -> None:
    """All had the name of hand 0, and the last was left."""
    from ebac.cli.files import ResultOptions

    found = study(FEW[:1], _Broken(), ["pumping"], base=ebac.Scenario(seconds=0.5))
    assert [failure.drive for failure in found.failures] == list(range(1, 36))
    study_results.fill(tmp_path, found, 40, ResultOptions(), quiet=True)
    assert len(list(tmp_path.glob("failure-broken_1_2-pumping-drive*.npz"))) == 35
