"""Sample data: the same on every call, honest about what they are, and their true values lie in the intervals."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac import datasets, identify
from ebac.cli import app
from ebac.datasets import DATASETS
from ebac.identify import Target
from ebac.operators import Operators
from ebac.tracking import evaluate, read_path

ROOT = Path(__file__).parents[2]
by_name = pytest.mark.parametrize("name", DATASETS)


def run(*words: str) -> str:
    result = CliRunner().invoke(app, list(words))
    assert result.exit_code == 0, result.output
    return result.output


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@by_name
def test_a_file_is_the_same_every_time(name: str, tmp_path: Path) -> None:
    first = datasets.write(name, tmp_path / "a")
    assert first.name == DATASETS[name].file
    assert datasets.write(name, tmp_path / "b").read_bytes() == first.read_bytes()
    assert datasets.write(name, tmp_path / "a") == first  # equal: nothing is lost


@by_name
def test_a_file_says_that_it_is_simulated(name: str, tmp_path: Path) -> None:
    path = datasets.write(name, tmp_path)
    if path.suffix == ".mcap":
        text = ebac.logs.read(path).about.files["README.txt"]
    else:
        text = path.read_text(encoding="utf-8")
    said = "Simulated by ebac" if DATASETS[name].data else "No device was ever run with it"
    assert said in text


@by_name
def test_a_file_of_the_same_name_is_kept(name: str, room: Path) -> None:
    path = room / DATASETS[name].file
    path.write_text("mine")
    with pytest.raises(FileExistsError):
        datasets.write(name)
    refused = CliRunner().invoke(app, ["demo", name])
    assert refused.exit_code == 2
    assert f"{path.name} exists; --force replaces it" in refused.stderr
    assert path.read_text() == "mine"
    run("demo", name, "--force")
    assert path.read_bytes() != b"mine"
    assert [file.name for file in room.iterdir()] == [path.name]


def test_the_list_names_everything_and_a_command_for_it() -> None:
    text = run("demo")
    rows = {row["name"]: row for row in json.loads(run("demo", "--json"))["rows"]}
    assert list(rows) == list(DATASETS)
    for name, known in DATASETS.items():
        assert name in text
        assert all(known.file in command for command in rows[name]["commands"])


def test_bad_input_is_refused_in_a_sentence(room: Path) -> None:
    (room / "file").touch()
    for words, said in (
        (["amr"], "did you mean 'arm'"),
        (["arm", "--out", "file"], "--out file: is a file; give the name of a folder"),
        (
            ["arm", "--out", "file/folder"],
            "is a file or lies inside one; give the name of a folder",
        ),
    ):
        result = CliRunner().invoke(app, ["demo", *words])
        assert result.exit_code == 2
        assert said in result.stderr


@pytest.mark.parametrize("name", ["arm", "tapping", "press"])
def test_the_arm_is_recovered(name: str, tmp_path: Path) -> None:
    trace = getattr(datasets, name)()
    hand = trace.scenario.hand
    recording = identify.load(datasets.write(name, tmp_path))
    found = identify.fit_arm(recording, Target.of(hand, recording.t))
    assert found.undetermined == ()
    for key, true in (("M0", hand.mass), ("B0", hand.damping), ("K0", hand.stiffness)):
        assert found[key].low <= true <= found[key].high
        assert found[key].value == pytest.approx(true, rel=0.03)


def test_the_device_is_recovered(tmp_path: Path) -> None:
    device = datasets.device().scenario.device
    found = identify.fit_device(identify.load(datasets.write("device", tmp_path))).estimates
    mechanics = device.mechanics
    for key, true in (
        ("M_h", device.mass),
        ("B_h", mechanics.damping),
        ("coulomb", mechanics.coulomb),
        ("weight", mechanics.gravity * mechanics.handle_mass),
    ):
        assert found[key].low <= true <= found[key].high
        assert found[key].value == pytest.approx(true, rel=0.01)


def test_the_circle_and_the_line_are_recovered(tmp_path: Path) -> None:
    round_ = evaluate(read_path(datasets.write("circle", tmp_path)), shape="auto").fit
    assert abs(round_.radius - 0.040) <= 1.96 * round_.radius_sd_m
    straight = evaluate(read_path(datasets.write("line", tmp_path)), shape="auto").row()
    off = (straight["angle_deg"] - 30 + 90) % 180 - 90
    assert abs(off) <= 1.96 * straight["angle_sd_deg"]
    assert straight["length_m"] == pytest.approx(0.080, abs=5e-4)
    for name in ("line", "circle"):
        read = read_path(tmp_path / f"{name}.csv").points
        assert np.allclose(read, getattr(datasets, name)(), atol=1e-9)


def test_hands_and_joystick_are_read_back(tmp_path: Path) -> None:
    people = Operators.from_csv(datasets.write("hands", tmp_path))
    assert len(people.hands()) == 12
    assert np.array_equal(people.m_kg, datasets.hands().m_kg)
    for name in ("handle", "joystick", "joystick-3"):
        path = datasets.write(name, tmp_path)
        assert path.read_bytes() == (ROOT / "examples" / path.name).read_bytes()
    assert datasets.joystick().law == "ebac"


def test_a_log_as_csv_is_read_below_its_comment(tmp_path: Path) -> None:
    trace = ebac.load(datasets.write("arm", tmp_path))
    assert {"t", "x", "force", "motor"} <= set(trace)
    assert len(trace) == len(datasets.arm())
    assert trace.columns["force"].unit == "N"
