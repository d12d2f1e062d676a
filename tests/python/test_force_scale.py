"""The scale of the force sensor against the motor's: found on a hand that sways."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac import datasets
from ebac.cli import app
from ebac.identify import Recording, force_scale
from ebac.identify.cases import draw_sway
from ebac.identify.check import check


@pytest.fixture(scope="module")
def swaying() -> Recording:
    return Recording.from_trace(datasets.sway())


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return datasets.write("sway", tmp_path)


def run(*words: str, code: int = 0) -> str:
    result = CliRunner().invoke(app, ["identify", "scale", *words])
    assert result.exit_code == code, result.output
    return result.output


def test_the_sample_log_gives_its_true_values_back(swaying: Recording) -> None:
    found = force_scale(swaying)
    assert found.determined
    assert found.low <= 0.98 <= found.high
    assert found.friction == pytest.approx(0.1, abs=0.01)
    assert found.offset == pytest.approx(0, abs=0.02)
    assert str(found).startswith("1 N of the motor reads 0.9")


@settings(max_examples=15, deadline=None)
@given(by=st.floats(0.8, 1.25), bias=st.floats(-1, 1))
def test_a_reading_that_is_scaled_and_shifted_is_found_so(
    swaying: Recording, by: float, bias: float
) -> None:
    assert swaying.force is not None
    first = force_scale(swaying)
    found = force_scale(replace(swaying, force=by * swaying.force + bias))
    # Readings decide which intervals are slow, too.
    assert found.scale == pytest.approx(by * first.scale, abs=0.002)
    assert found.offset == pytest.approx(by * first.offset + bias, abs=0.02)


@settings(max_examples=10, deadline=None)
@given(by=st.floats(0.8, 1.25))
def test_a_motor_that_is_weaker_is_a_reading_that_is_larger(swaying: Recording, by: float) -> None:
    assert swaying.motor is not None
    found = force_scale(replace(swaying, motor=by * swaying.motor))
    assert found.scale == pytest.approx(force_scale(swaying).scale / by, abs=0.004)


def test_intervals_contain_the_true_scale() -> None:
    rows = check(40, what="scale", seed=3, seconds=15.0, workers=1).rows()
    assert rows[0]["determined"] >= 34
    assert rows[0]["covered_share"] >= 0.95
    assert rows[0]["median_error"] < 1.5e-3


def test_the_interval_is_wider_where_mass_and_damping_matter(swaying: Recording) -> None:
    found = force_scale(swaying, mass=0.25 * 1.1, damping=2.0 * 0.8)
    assert found.low <= 0.98 <= found.high


def test_it_is_judged_through_a_pause(swaying: Recording) -> None:
    kept = [i for i in range(len(swaying.t)) if not 7000 <= i < 7400]
    changes = {n: v[kept] for n, v in swaying.channels().items()}
    found = force_scale(replace(swaying, **changes))
    assert found.low <= 0.98 <= found.high


def test_a_recording_without_one_of_the_forces_is_refused(swaying: Recording) -> None:
    with pytest.raises(ValueError, match="lacks the force of the motor"):
        force_scale(replace(swaying, motor=None))
    with pytest.raises(ValueError, match="lacks the force of the hand"):
        force_scale(replace(swaying, force=None))


def test_mass_and_damping_are_needed_and_checked(swaying: Recording) -> None:
    foreign = replace(swaying, mass=None, damping=None)
    with pytest.raises(ValueError, match=r"give both, --mass KG --damping"):
        force_scale(foreign)
    with pytest.raises(ValueError, match=r"give both, --mass KG --damping"):
        force_scale(foreign, mass=0.25)
    assert force_scale(foreign, mass=0.25, damping=2.0) == force_scale(swaying)
    with pytest.raises(ValueError, match=r"mass = 0 kg: must lie in \[0.001, 100\] kg"):
        force_scale(swaying, mass=0.0)
    with pytest.raises(TypeError, match="mass"):
        force_scale(swaying, mass="heavy")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="force_scale"):
        force_scale("sway.mcap")  # type: ignore[arg-type]


def test_a_hand_that_taps_says_nothing_of_it() -> None:
    recording = Recording.from_trace(datasets.tapping())
    with pytest.raises(ValueError, match=r"moves slowly one way .* Press on a wall of 1 to 3 kN/m"):
        force_scale(recording)


def test_a_recording_of_a_trace_has_the_mass_of_its_device() -> None:
    case = draw_sway(0, 1, 1.0).scenario
    trace = ebac.simulate(case, "ebac")
    assert Recording.from_trace(trace).mass == pytest.approx(case.device.mass)


def test_the_command_names_both_remedies(log: Path) -> None:
    text = " ".join(run(str(log)).split())
    assert "shows 2.0 % less than the motor gives" in text
    assert "torque_constant of [device.motor]" in text
    assert "counts_per_force of [sensor]" in text


def test_the_command_gives_numbers_with_units(log: Path) -> None:
    document = json.loads(run(str(log), "--json"))
    (row,) = document["rows"]
    assert row["scale_low_N_per_N"] < 0.98 < row["scale_high_N_per_N"]
    assert {"friction_N", "offset_N", "left_N", "comparisons", "determined"} < set(row)


def test_the_command_fails_where_the_log_determines_nothing(tmp_path: Path) -> None:
    from ebac.logs.files import write_mcap

    loose = tmp_path / "loose.mcap"
    write_mcap(ebac.simulate(draw_sway(38, 3).scenario, "ebac"), loose)
    text = run(str(loose), code=1)
    assert "Not determined to 0.5 %" in text
