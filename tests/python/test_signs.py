"""Signs of motors and encoders: found on simulated drives that are wired wrongly, and written into the file."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.cli.drive.signs import show
from ebac.hardware import Configuration, Signs, find_signs
from ebac.hardware.find_signs import judged

EXAMPLES = Path(__file__).parents[2] / "examples"
#: A busy machine is no wrong sign.
PATIENT = {"force_age": 10.0, "overruns": 100000, "pause": 100.0, "jump": 1.0}


def wired(tmp_path: Path, motor: list[int], encoder: list[int], *, sensor: bool = True) -> Path:
    example = EXAMPLES / ("joystick.toml" if len(motor) == 2 else "joystick-3.toml")
    text = example.read_text(encoding="utf-8").replace("[bus]\n", "[bus]\nsilent = 1000\n")
    if not sensor:
        text = text[: text.index("[sensor]")] + text[text.index("# [observer]") :]
    patient = "".join(f"{key} = {value}\n" for key, value in PATIENT.items())
    text = text.replace("speed = 1.0 # m/s\n", f"speed = 100.0\n{patient}")
    text += f"\n[simulated.signs]\nmotor = {motor}\nencoder = {encoder}\n"
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def signs(path: Path, *more: str) -> tuple[int, list[dict[str, object]]]:
    """Exit code and rows of the command on simulated drives."""
    done = CliRunner().invoke(app, ["drive", "signs", str(path), "--simulated", "--json", *more])
    assert done.stdout, done.stderr
    return done.exit_code, json.loads(done.stdout)["rows"]


@pytest.mark.real_time
@pytest.mark.slow
def test_each_wrong_sign_is_found_and_left_to_the_person(tmp_path: Path) -> None:
    path = wired(tmp_path, [-1, 1], [1, -1])
    before = path.read_text(encoding="utf-8")
    code, rows = signs(path)
    assert [row["motor"] for row in rows] == [-1, 1], rows
    assert [row["encoder"] for row in rows] == [1, -1], rows
    assert code == 1
    assert path.read_text(encoding="utf-8") == before


@pytest.mark.real_time
@pytest.mark.slow
def test_signs_are_found_at_25_hertz(tmp_path: Path) -> None:
    """Where a push is a dozen rows long."""
    path = wired(tmp_path, [-1, 1], [1, -1])
    path.write_text(path.read_text(encoding="utf-8").replace("dt = 1e-3", "dt = 0.04"), "utf-8")
    _, rows = signs(path)
    assert [row["motor"] for row in rows] == [-1, 1], rows
    assert [row["encoder"] for row in rows] == [1, -1], rows


@pytest.mark.real_time
@pytest.mark.slow
def test_each_wrong_sign_is_found_and_repaired(tmp_path: Path) -> None:
    """A motor, an encoder, and both of one axis."""
    motor, encoder = [-1, 1, -1], [1, -1, -1]
    path = wired(tmp_path, motor, encoder)
    before = path.read_text(encoding="utf-8")
    code, rows = signs(path, "--write")
    assert [row["motor"] for row in rows] == motor, rows
    assert [row["encoder"] for row in rows] == encoder, rows
    assert code == 0
    after = path.read_text(encoding="utf-8")
    assert set(before.splitlines()) <= set(after.splitlines()), "every other line stays"
    code, rows = signs(path)
    assert code == 0, rows


@pytest.mark.real_time
@pytest.mark.slow
def test_without_a_sensor_the_two_together_are_found(tmp_path: Path) -> None:
    known = Configuration.load(wired(tmp_path, [-1, 1], [1, -1], sensor=False))
    rows = find_signs(known, simulate=True)
    assert [(row.axis, row.node) for row in rows] == [(0, 1), (1, 2)]
    assert [(row.motor, row.encoder) for row in rows] == [(-1, 1), (-1, 1)]
    assert "by the encoder alone" in rows[0].remark


@pytest.mark.real_time
@pytest.mark.slow
def test_a_long_soft_start_does_not_weaken_the_pushes(tmp_path: Path) -> None:
    known = Configuration.load(wired(tmp_path, [1, 1], [1, 1], sensor=False))
    rows = find_signs(known.replace(soft_start=30.0), simulate=True)
    assert all(row.right for row in rows), rows


def test_a_current_out_of_range_is_refused() -> None:
    with pytest.raises(ValueError, match=r"current = 1 A: must lie in \[0.02, 0.3\] A"):
        find_signs(Configuration.from_toml(""), current=1)


@pytest.mark.real_time
def test_a_run_that_is_stopped_ends_the_test(tmp_path: Path) -> None:
    known = Configuration.load(wired(tmp_path, [1, 1], [1, 1]))
    with pytest.raises(RuntimeError, match="stopped before its end"):
        find_signs(known, simulate=True, look=lambda run: run.stop(at_once=True))


def test_what_moves_by_itself_or_not_at_all_is_no_sign() -> None:
    ones = Signs().of_all(1)
    still = judged(
        0, 1, ones, np.array([[1e-5, 1.0], [-1e-5, 1.0]]), ebac.Device(), 0.1, sensor=True
    )
    assert still.motor is None
    assert "give more: `--current 0.2` (at most 0.3 A" in still.remark
    most = judged(
        0, 1, ones, np.array([[1e-5, 1.0], [-1e-5, 1.0]]), ebac.Device(), 0.3, sensor=True
    )
    assert "0.3 A is the most of this test" in most.remark
    pushed = judged(
        0, 1, ones, np.array([[-4e-3, 1.0], [4e-3, 1.0]]), ebac.Device(), 0.1, sensor=True
    )
    assert pushed.encoder is None
    assert "something else pushes" in pushed.remark


def test_the_table_names_the_node_of_each_axis(capsys: pytest.CaptureFixture[str]) -> None:
    pushes = np.array([[-4e-3, 1.0], [-4e-3, 1.0]])
    ones = Signs().of_all(2)
    show([judged(axis, 5 - axis, ones, pushes, ebac.Device(), 0.1, sensor=True) for axis in (0, 1)])
    heads, *rows = [line.split() for line in capsys.readouterr().out.splitlines() if line.strip()]
    assert heads[:2] == ["axis", "node"]
    assert [row[:2] for row in rows if row[0] in "01"] == [["0", "5"], ["1", "4"]]


def test_a_bus_that_does_not_open_is_reported_once(tmp_path: Path) -> None:
    path = wired(tmp_path, [1, 1], [1, 1])
    path.write_text(path.read_text(encoding="utf-8").replace('"can0"', '"nocan7"'), "utf-8")
    done = CliRunner().invoke(app, ["drive", "signs", str(path), "--yes"])
    assert done.exit_code == 1
    assert done.output.count("Error:") == 1, done.output


def test_before_there_is_power_the_command_names_axes_and_nodes() -> None:
    asked = CliRunner().invoke(app, ["drive", "signs", str(EXAMPLES / "joystick.toml")], input="n")
    words = " ".join((asked.stdout + asked.stderr).split())
    assert "The motors of axis 0 (node 1), axis 1 (node 2) get power" in words


@pytest.mark.parametrize(
    "text",
    [
        "",
        'about = "x"',
        "[signs] # mine\nmotor = [1, 1] # left\n\n[run]\nseconds = 1.0\n",
        "[signs]\n[run]\nseconds = 1.0\n",
        "[run]\nseconds = 1.0\n[signs]\nencoder = [-1, 1]",
    ],
)
def test_signs_are_written_line_by_line(text: str) -> None:
    made = Signs(motor=(-1, 1), encoder=(1, -1)).written_into(text)
    known = Configuration.from_toml(made)
    assert known.signs == Signs(motor=(-1, 1), encoder=(1, -1))
    for comment in ("# mine", "# left"):
        assert (comment in made) == (comment in text)
    assert known.seconds == Configuration.from_toml(text).seconds


def test_signs_in_another_form_are_left_alone() -> None:
    with pytest.raises(ValueError, match="by hand"):
        Signs(motor=(-1,), encoder=(1,)).written_into("signs = { motor = [1] }\n")


def test_a_device_wired_as_configured_runs_as_any() -> None:
    text = (EXAMPLES / "joystick.toml").read_text(encoding="utf-8") + "\n[signs]\nmotor = [-1, 1]\n"
    known = Configuration.from_toml(text)
    assert known.signs.against(known.simulated_signs) == Signs()
    assert known.signs.against(Signs(motor=(1, 1))) == Signs(motor=(-1, 1))
    assert ebac.hardware.Signs is Signs
