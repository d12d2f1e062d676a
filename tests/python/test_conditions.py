"""Conditions that are written out, and what the command line says of conditions and laws that were named."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.studies import CONDITIONS, GROUPS, conditions


def told(*words: str, code: int = 0) -> str:
    """Return what a command says on stderr, in one line."""
    done = CliRunner().invoke(app, [*words])
    assert done.exit_code == code, done.output
    return " ".join(done.stderr.split())


def test_a_condition_that_is_written_out_is_what_it_says() -> None:
    (made,) = conditions(["d2b0.5K15"])
    scenario = made.change(ebac.Scenario())
    assert scenario.timing.delay == 2
    assert scenario.device.mechanics.damping == 0.5
    assert scenario.environment == ebac.Wall(stiffness=15e3)
    assert made.summary == "2 samples of delay, device damping 0.5 N s/m, wall 15 kN/m"


@given(kilo=st.floats(0.01, 1000), damping=st.floats(0, 10), delay=st.integers(0, 5))
def test_a_condition_of_the_wall_alone_changes_its_stiffness_and_nothing_else(
    kilo: float, damping: float, delay: int
) -> None:
    base = ebac.Scenario(
        device=ebac.Device(mechanics=ebac.Mechanics(damping=damping, coulomb=0.1)),
        environment=ebac.Wall(stiffness=3e3, damping=damping, position=1e-3),
        timing=ebac.Timing(delay=delay),
    )
    (made,) = conditions([f"K{kilo:.3f}"])
    changed = made.change(base)
    assert changed.environment.stiffness == pytest.approx(1e3 * kilo, abs=0.5)
    assert changed.replace(environment=changed.environment.replace(stiffness=3e3)) == base
    assert made.believed(changed) == (base.device.facts, base.known_timing)


@pytest.mark.parametrize(
    ("written", "name"),
    [
        ("k10", "K10"),
        ("K010.0", "K10"),
        ("d2K015", "d2K15"),
        ("d02b2K20", "d2b2K20"),
        ("d1b2.0K10", "d1b2K10"),
        ("d3b4K0.5", "d3b4K0.5"),
        ("d1K10", "d1K10"),
    ],
)
def test_a_condition_has_the_name_by_which_it_was_asked_for(written: str, name: str) -> None:
    (made,) = conditions([written, name])  # two names of one condition
    (same,) = conditions([name, written])
    assert (made.name, same.name) == (written, name)
    assert made.summary == same.summary
    assert same == CONDITIONS.get(name, same)


def test_a_condition_of_a_group_has_the_name_of_the_group() -> None:
    assert [one.name for one in conditions(["cells"])] == list(GROUPS["cells"])


def test_a_condition_of_ones_own_keeps_its_name_to_itself() -> None:
    mine = ebac.studies.Condition(name="K010", summary="mine", change=lambda scenario: scenario)
    assert [one.name for one in conditions([mine, "K010"])] == ["K010", "K10"]
    assert [one.name for one in conditions(["K010", mine])] == ["K10", "K010"]


def test_rows_are_found_by_the_name_that_was_asked_for() -> None:
    few, short = ebac.Operators.grid()[:1], ebac.Scenario(seconds=0.1)
    study = ebac.study(few, ["tca"], ["d1K10", "d1K15"], base=short)
    assert [row.condition for row in study.rows] == ["d1K10", "d1K15"]
    assert [row.hands for row in study.rows] == [1, 1]
    assert len(study.runs("tca", "d1K15")) == 1


def test_failures_contain_a_noisy_and_a_disconnected_sensor() -> None:
    assert {"force-noise", "sensor-disconnected"} <= set(GROUPS["failures"])
    sensor = CONDITIONS["sensor-disconnected"].change(ebac.Scenario()).device.sensor
    assert (sensor.disconnects, sensor.stops_at) == (True, 1.0)


def test_holds_are_on_stiff_walls_with_one_and_two_samples_of_delay() -> None:
    held = [CONDITIONS[name].change(ebac.Scenario()) for name in GROUPS["holds"]]
    assert {(s.environment.stiffness, s.timing.delay) for s in held} == {
        (10e3, 1), (20e3, 1), (20e3, 2), (35e3, 1), (35e3, 2),
    }  # fmt: skip
    assert {s.seconds for s in held} == {120}


@pytest.mark.parametrize("command", ["study", "worst", "tune tca-damped"])
def test_an_error_teaches_how_a_condition_is_written(command: str) -> None:
    text = told(*command.split(), "-c", "d2M15", code=2)
    assert "--condition d2M15: no such name" in text
    assert "`ebac conditions` lists all" in text
    assert "or write one out, as d2b1K15: 2 samples of delay, device damping 1 N s/m" in text
    assert "K15 changes the stiffness of the wall only" in text
    for name, right in (("d2K20000", "d2K20"), ("K20000", "K20")):
        text = told(*command.split(), "-c", name, code=2)
        assert (
            f"--condition {name}: Wall.stiffness = 2e+07 N/m: must lie in [0, 1e+07] N/m; " in text
        )
        assert f"the number after K is in kN/m: 20000 N/m is {right}" in text


def test_a_search_takes_one_condition() -> None:
    assert "--condition d1K10,d2K15: one condition only" in told(
        "worst", "-c", "d1K10,d2K15", code=2
    )


def test_a_study_runs_under_a_condition_that_is_written_out(tmp_path: Path) -> None:
    hands = tmp_path / "hands.csv"
    hands.write_text("m_kg,b_Ns_per_m,k_N_per_m,target_m\n0.15,6,300,0.04\n")
    done = CliRunner().invoke(
        app, ["study", "--population", str(hands), "-l", "ebac", "-c", "d2K15", "--json"]
    )
    assert '"condition": "d2K15"' in done.stdout


@pytest.mark.slow
def test_a_note_says_what_a_condition_replaces_of_a_scenario(tmp_path: Path) -> None:
    file, hands = tmp_path / "mine.toml", tmp_path / "hands.csv"
    hands.write_text("m_kg,b_Ns_per_m,k_N_per_m,target_m\n0.15,6,300,0.04\n")
    study = ("study", "--population", str(hands), "-l", "tca", "--json", "--scenario", str(file))
    mine = ebac.Scenario(
        environment=ebac.Wall(stiffness=3e3, damping=4),
        timing=ebac.Timing(delay=3),
        device=ebac.Device(mechanics=ebac.Mechanics(damping=5, coulomb=0.2)),
    )
    mine.save(file)
    text = told(*study, "-c", "d2b2K15")
    assert text == (
        "Note: of the scenario condition d2b2K15 replaces device.mechanics.damping = 5 N s/m by 2; "
        "environment.stiffness = 3000 N/m by 15000; timing.delay = 3 samples by 2."
    )
    text = told(*study, "-c", "K5,K10")
    assert text.removeprefix("Note: of the scenario the conditions replace ") == (
        "environment.stiffness = 3000 N/m by 5000 or 10000."
    )
    text = told(*study, "-c", "d1b2K10,d3b5K10")
    assert "the conditions replace device.mechanics.damping = 5 N s/m by 2; " in text
    assert "environment.stiffness = 3000 N/m by 10000" in text
    assert "timing.delay = 3 samples by 1." in text
    few = ("--law", "tca", "--beside", "eba")  # of few pieces
    ablation = ("ablation", *few, "--population", str(hands), "--json", "--scenario", str(file))
    text = told(*ablation)
    assert "timing.delay = 3 samples by " in text
    assert "device.mechanics.damping" not in text, "a device of one's own keeps its damping"
    assert told(*study) == "", "as it is given"
    ebac.Scenario(seconds=3).save(file)
    assert told(*study, "-c", "d1K10") == ""


@pytest.mark.parametrize(
    "command", [["study"], ["worst", "--evaluations", "40", "--family", "impact"]]
)
def test_a_scenario_stays_as_it_is_unless_a_condition_is_asked_for(
    tmp_path: Path, command: list[str]
) -> None:
    file = tmp_path / "mine.toml"
    mine = ebac.Scenario(environment=ebac.Wall(stiffness=3e3), timing=ebac.Timing(delay=2))
    mine.save(file)
    [as_given] = conditions(["as-given"])
    assert as_given.change(mine) == mine
    words = [*command, "--law", "tca", "--json"]
    given = CliRunner().invoke(app, [*words, "--scenario", str(file)])
    assert '"condition": "as-given"' in given.stdout, given.stderr
    assert '"condition": "d1K10"' in CliRunner().invoke(app, words).stdout


def test_a_law_with_tuned_parameters_is_explained() -> None:
    wall = ("wall", "--no-files", "--seconds", "0.1", "--law")
    text = told(*wall, "tca-damped-tuned,ebac")
    assert "Note: tca-damped-tuned is tca-damped with the parameters that `ebac tune` found" in text
    text = told(*wall, "tca-damped-tuned-observer")
    assert "acting on the observer's estimate" in text
    assert "Note" not in told(*wall, "ebac")
