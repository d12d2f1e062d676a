"""Signs of motors and encoders: found on simulated drives that are wired wrongly, and written into the file."""

import json
import time
from collections.abc import Callable, Iterator
from importlib.resources import files
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac._core import DriveWiring, LoopbackJoystick, SharedHandTarget
from ebac.can.channels import resting_joystick, standing
from ebac.cli import app
from ebac.cli.drive.signs import show
from ebac.hardware import (
    AxisSigns,
    Configuration,
    PositionError,
    Signs,
    axis_positions,
    find_encoder_signs,
    find_signs,
)
from ebac.hardware.find_signs import gentle, judged
from ebac.hardware.rating import beyond_rating

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


def test_a_push_beyond_a_small_motor_names_the_option_of_its_current() -> None:
    known = Configuration.from_toml("")
    for torque, remedy in ((1e-3, "give less: `--current 0.074`"), (1e-4, "at least 0.02 A")):
        motor = known.device.motor.replace(rated_torque=torque)
        small = known.replace(device=known.device.replace(motor=motor))
        with pytest.raises(ValueError, match=r"current = 0\.1 A: is beyond the peak") as refused:
            find_signs(small, simulate=True)
        assert remedy in str(refused.value)
        ones = Signs().of_all(1)
        still = judged(0, 1, ones, np.zeros((2, 2)), small.device, 0.074, sensor=False)
        assert "A is the most of this test" in still.remark


def test_limits_of_the_file_beyond_the_motor_do_not_stop_the_pushes() -> None:
    """The command has no option that allows them, and needs neither."""
    known = Configuration.from_toml("[limits]\ncontinuous_current = 2.0\nthermal_time = 40.0\n")
    assert len(beyond_rating(known)) == 2
    assert not beyond_rating(gentle(known, 0.1))


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


@pytest.mark.parametrize("text", ["", "[signs] # mine\r\nmotor = [1, 1] # left\r\n"])
def test_a_comment_marks_signs_of_the_simulated_device(text: str) -> None:
    simulated = Signs(motor=(-1, 1), encoder=(1, -1))
    made = simulated.written_into(text, simulated=True)
    assert made == simulated.written_into(made, simulated=True)
    assert made.count("] # of the simulated device") + made.count("# left # of the sim") == 2
    found = Signs(motor=(1, 1), encoder=(1, 1))
    assert found.written_into(made) == found.written_into(text)


def test_the_command_marks_the_signs_of_a_rehearsal_until_hardware_shows_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = wired(tmp_path, [1, 1], [1, 1])

    def found(known: Configuration, *, simulate: bool, **_: Any) -> list[AxisSigns]:
        signs = known.signs.of_all(2)
        way = 4e-3 if simulate else -4e-3
        pushes = np.array([[way, 1.0], [way, 1.0]])
        return [judged(i, i + 1, signs, pushes, known.device, 0.1, sensor=True) for i in (0, 1)]

    monkeypatch.setattr("ebac.hardware.find_signs", found)
    rehearsed = CliRunner().invoke(app, ["drive", "signs", str(path), "--simulated", "--write"])
    said = " ".join(rehearsed.output.split())
    assert "[signs] is of the simulated device; find it again on yours" in said
    after = path.read_text(encoding="utf-8")
    assert after.count("# of the simulated device: find it again on yours") == 2
    wired_right = Configuration.load(path).signs
    done = CliRunner().invoke(app, ["drive", "signs", str(path), "--write", "--yes"])
    assert done.exit_code == 0, done.output
    assert "of the simulated device" not in done.output + path.read_text(encoding="utf-8")
    assert Configuration.load(path).signs == wired_right


def test_signs_in_another_form_are_left_alone() -> None:
    with pytest.raises(ValueError, match="by hand"):
        Signs(motor=(-1,), encoder=(1,)).written_into("signs = { motor = [1] }\n")


def test_a_device_wired_as_configured_runs_as_any() -> None:
    text = (EXAMPLES / "joystick.toml").read_text(encoding="utf-8") + "\n[signs]\nmotor = [-1, 1]\n"
    known = Configuration.from_toml(text)
    assert known.signs.against(known.simulated_signs) == Signs()
    assert known.signs.against(Signs(motor=(1, 1))) == Signs(motor=(-1, 1))
    assert ebac.hardware.Signs is Signs


# --- without a force sensor: pushed by hand ---

#: How the drives of `pushed` are wired.
MOTOR, ENCODER = (-1, 1), (1, -1)
Push = Callable[[float, float], None]
_numbers = count()


@pytest.fixture
def pushed(tmp_path: Path) -> Iterator[tuple[Path, Push]]:
    """A configuration without a force sensor, and a function that moves the hand to a place [m]."""
    path = wired(tmp_path, list(MOTOR), list(ENCODER), sensor=False)
    channel = f"signs-{next(_numbers)}"
    text = path.read_text(encoding="utf-8")
    profile = (files("ebac.drives") / "profiles" / "copley-accelnet.toml").read_text("utf-8")
    for before in ("event = 0.005", "consumer = 0.1"):  # a busy loop is no dead one
        assert before in profile
        profile = profile.replace(before, before.partition("=")[0] + "= 0.5")
    (tmp_path / "patient.toml").write_text(profile, "utf-8")
    drives = tmp_path / "drives.toml"
    drives.write_text("".join(f"[[node]]\nid = {i}\nprofile = 'patient.toml'\n" for i in (1, 2)))
    for before, after in (
        ('"socketcan"', '"ebac"'), ('"can0"', f'"{channel}"'), ('"verify"', '"apply"'),
        ('"joystick"', f'"{drives}"'),
    ):  # fmt: skip
        text = text.replace(before, after, 1)
    path.write_text(text[: text.index("[simulated.signs]")], encoding="utf-8")
    known, aim = Configuration.load(path), SharedHandTarget()

    def nodes(hub: Any) -> LoopbackJoystick:
        wiring = DriveWiring(motor=list(MOTOR), encoder=list(ENCODER))
        return LoopbackJoystick(hub, resting_joystick().setup(), wiring=wiring, aim=aim)

    def push(x: float, y: float) -> None:
        aim.post([x, y, 0.0])
        there = time.monotonic() + 60
        while time.monotonic() < there:
            at = [s * p.position_m for s, p in zip(ENCODER, axis_positions(known), strict=True)]
            if np.allclose(at, [x, y], atol=5e-4):
                return
            time.sleep(0.01)
        raise AssertionError(f"the simulated hand never came to {x}, {y} m")

    with standing(channel, nodes):
        yield path, push


def test_a_handle_pushed_along_each_axis_shows_the_signs_of_the_encoders(
    pushed: tuple[Path, Push], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever the file says of them; no drive is written to."""
    path, push = pushed
    known, asked = Configuration.load(path), list[str]()
    monkeypatch.setattr(ebac.drives.Drive, "write", None)

    def ask(request: str) -> None:
        push(*[(0.01, 0.0), (0.01, 0.01)][len(asked)])
        asked.append(request)

    assert find_encoder_signs(known, ask) == ENCODER
    assert [one[:56] for one in asked] == [
        "Push the handle towards +x, along axis 0 (node 1), by ab",
        "Push the handle towards +y, along axis 1 (node 2), by ab",
    ]
    asked.clear()
    push(0.0, 0.0)
    wrong = known.replace(signs=Signs(motor=(1, 1), encoder=(-1, -1)))
    assert find_encoder_signs(wrong, ask) == ENCODER


@pytest.mark.parametrize(
    ("to", "message"),
    [
        ((0.0, 0.0), r"axis 0 \(node 1\) moved by .0.00 mm: must be at least 2 mm; push the handle farther"),
        ((0.003, 0.01), r"axis 1 \(node 2\) moved by -\d+.\d\d mm, farther than axis 0 .* wrong order in the network"),
    ],
)  # fmt: skip
def test_a_handle_that_goes_elsewhere_shows_no_sign(
    pushed: tuple[Path, Push], to: tuple[float, float], message: str
) -> None:
    path, push = pushed
    with pytest.raises(PositionError, match=message):
        find_encoder_signs(Configuration.load(path), lambda request: push(*to))


@pytest.mark.parametrize(
    ("moved", "right", "found"),
    [
        (-1, 1, (1, 1, "right")),
        (1, 1, (-1, 1, "motor wrong")),
        (1, -1, (1, -1, "encoder wrong")),
        (-1, -1, (-1, -1, "motor and encoder wrong")),
    ],
)
def test_with_the_sign_of_the_encoder_known_that_of_the_motor_is_sure(
    moved: int, right: int, found: tuple[int, int, str]
) -> None:
    pushes = np.array([[moved * 4e-3, 0.0], [moved * 4e-3, 0.0]])
    ones = Signs().of_all(1)
    row = judged(0, 1, ones, pushes, ebac.Device(), 0.1, sensor=False, right=right)
    assert (row.motor, row.encoder, row.remark) == found


def test_known_signs_of_encoders_must_be_signs_of_all() -> None:
    for wrong in ([1], [1, 2]):
        with pytest.raises(ValueError, match="must be a list of 1 or -1 for each of the 2 axes"):
            find_signs(Configuration.from_toml(""), encoder=wrong)


@pytest.fixture
def answers(monkeypatch: pytest.MonkeyPatch, pushed: tuple[Path, Push]) -> list[str]:
    """Answer the questions of the command as a person does who pushes the handle; give the questions."""
    _, push = pushed
    places = [(0.01, 0.0), (0.01, 0.01), (0.0, 0.0)]
    asked = list[str]()

    def confirm(question: str, **_: Any) -> bool:
        push(*places[len(asked)])
        asked.append(question)
        return True

    here = SimpleNamespace(stdin=SimpleNamespace(isatty=lambda: True))
    monkeypatch.setattr("ebac.cli.drive.options.sys", here)
    monkeypatch.setattr("ebac.cli.drive.options.typer.confirm", confirm)
    return asked


def test_the_command_asks_for_the_pushes_before_it_gives_power(
    pushed: tuple[Path, Push], answers: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    given = []

    def found(known: Configuration, **how: Any) -> list[AxisSigns]:
        given.append(how["encoder"])
        pushes = np.array([[4e-3, 0.0], [4e-3, 0.0]])
        ones = Signs().of_all(2)
        rights = zip((1, 2), how["encoder"] or (None, None), strict=True)
        return [
            judged(i, node, ones, pushes, known.device, 0.1, sensor=False, right=right)
            for i, (node, right) in enumerate(rights)
        ]

    monkeypatch.setattr("ebac.hardware.find_signs", found)
    done = CliRunner().invoke(app, ["drive", "signs", str(pushed[0])])
    assert done.exit_code == 1, done.output
    assert [one.partition(" ")[0] for one in answers] == ["Push", "Push", "The"]
    assert "motors of axis 0 (node 1), axis 1 (node 2) get power" in answers[2]
    assert given == [ENCODER]
    said = " ".join(done.stdout.split())
    assert "--write writes motor = [-1, 1], encoder = [1, -1] into [signs] of the file" in said
    done = CliRunner().invoke(app, ["drive", "signs", str(pushed[0]), "--yes"])
    assert len(answers) == 3, "--yes asks nothing"
    assert given == [ENCODER, None]
    assert "by the encoder alone" in " ".join(done.stdout.split())


def test_a_handle_that_was_not_pushed_gets_no_power(
    pushed: tuple[Path, Push], monkeypatch: pytest.MonkeyPatch
) -> None:
    here = SimpleNamespace(stdin=SimpleNamespace(isatty=lambda: True))
    monkeypatch.setattr("ebac.cli.drive.options.sys", here)
    done = CliRunner().invoke(app, ["drive", "signs", str(pushed[0])], input="y\n")
    assert done.exit_code == 1
    assert "must be at least 2 mm" in " ".join(done.output.split())
    assert "get power" not in done.output
    monkeypatch.undo()
    done = CliRunner().invoke(app, ["drive", "signs", str(pushed[0])])
    assert done.exit_code == 2
    assert "add --yes" in " ".join(done.output.split())


@pytest.mark.real_time
@pytest.mark.slow
def test_every_wrong_sign_is_found_without_a_sensor(
    pushed: tuple[Path, Push], answers: list[str]
) -> None:
    path, _ = pushed
    done = CliRunner().invoke(app, ["drive", "signs", str(path), "--write"])
    assert done.exit_code == 0, done.output
    assert len(answers) == 3
    assert Configuration.load(path).signs == Signs(motor=MOTOR, encoder=ENCODER)
