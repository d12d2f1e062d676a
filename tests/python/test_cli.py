"""The command `ebac`: what it prints and writes, and how it refuses."""

import json
import re
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import ebac
from ebac._util import descriptions, formatting
from ebac._util.doubts import device as doubtful_device
from ebac._util.doubts import length, motor
from ebac._util.doubts import sensor as doubtful_sensor
from ebac.cli import app
from ebac.sensor import SensorConfig

COMMANDS = ("wall", "paper", "laws", "specs", "presets", "bench")
WALL_KEYS = [
    "law",
    "rest_m",
    "ideal_m",
    "swing_m",
    "force_swing_N",
    "settled_s",
    "peak_m",
    "limit_cycle_Hz",
    "least_energy_J",
    "clamped_share",
    "force_rest_N",
    "force_settled_s",
    "ripple_N",
    "ripple_rms_N",
    "ripple_high_N",
    "jumps",
    "perceived",
    "still",
    "force_quiet",
    "quiet",
    "touched_at_rest",
    "drawn_J",
    "impact_share",
    "deviation_m",
    "exact",
    "verdict",
]


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")


def ebac_command(*words: str, code: int = 0) -> Any:
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == code, result.output
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def refusal(*words: str, code: int = 2) -> str:
    """What the command says when it refuses, on one line and without a frame."""
    text = re.sub(r"[│╭╮╰╯─]", " ", ebac_command(*words, code=code).output)
    return " ".join(text.split())


def document(*words: str) -> dict[str, Any]:
    def refuse_nan(text: str) -> None:
        raise AssertionError(f"{text} in JSON")

    text = ebac_command(*words, "--json").stdout
    return json.loads(text, parse_constant=refuse_nan)  # type: ignore[no-any-return]


def wall_rows(*words: str) -> dict[str, dict[str, Any]]:
    return {row["law"]: row for row in document("wall", *words)["rows"]}


# --- words ---


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.0011841, "m", "1.184 mm"),
        (3.0679615e-5, "m", "0.0307 mm"),
        (-1e-12, "m", "0 mm"),
        (-5.6057, "J", "-5.61 J"),
        (58.314, "J", "58.31 J"),
        (0.9994, "J", "999.40 mJ"),
        (10.6, "N", "10.60 N"),
        (0.0622, "share", "6 %"),
        (1, "share", "100 %"),
        (0.25, "kg", "0.25 kg"),
        (3.0, "1", "3"),
        (None, "m", "-"),
        (float("nan"), "m", "-"),
    ],
)
def test_numbers_are_shown_with_their_unit(value: float | None, unit: str, text: str) -> None:
    assert formatting.quantity(value, unit) == text


def test_the_description_of_a_device_has_its_friction() -> None:
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.1))
    assert "friction 0.1 N" in descriptions.describe(ebac.Scenario(device=device))
    assert "friction" not in descriptions.describe(ebac.Scenario())


@pytest.mark.parametrize(
    ("part", "said"),
    [
        ({"sensor": ebac.ForceSensor(bias=0.2, lag=2e-3)}, "sensor without noise, sensor lag 2 ms, sensor bias 0.2 N)"),
        ({"encoder": ebac.Encoder(counts_per_turn=6283)}, ", count 5 um)"),
        ({"drive": ebac.Drive(peak_ratio=2.0, current_noise=5e-3)}, ", peak force 21.2 N, drive current noise 5 mA)"),
        ({"mechanics": ebac.Mechanics(cable_stiffness=1e5)}, ", cable stiffness 100 kN/m)"),
        ({"sensor": None}, "no force sensor)"),
        ({"sensor": ebac.ForceSensor(noise=0.03)}, "sensor noise 0.03 N)"),
    ],
)  # fmt: skip
def test_a_device_is_described_by_all_that_is_not_as_in_the_reference(
    part: dict[str, Any], said: str
) -> None:
    described = descriptions.described_device(ebac.Device(**part))
    assert described.startswith("a device (0.25 kg, 2 N s/m, ")
    assert described.endswith(said)


def test_a_device_by_name_is_described_by_its_name() -> None:
    assert descriptions.described_device(ebac.Device()).count(",") == 2


def test_a_scenario_is_told_in_one_line() -> None:
    hand = ebac.Hand(path=ebac.Tapping(), tremor_amplitude=1e-3)
    text = descriptions.describe(ebac.Scenario(hand=hand, environment=ebac.Corner(), jitter=0.1))
    assert "a Tapping path, tremor 1 mm at 9 Hz" in text
    assert (
        "a corner of a wall of 10 kN/m at 0 mm and a wall of 10 kN/m at 0 mm, turned by 90" in text
    )
    assert "1 kHz, 1 sample of delay, jitter 10 %" in text


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ((ebac.Step(target=0.01), ebac.Step(target=0.04)), "target 10, 40 mm)"),
        ((ebac.Step(target=0.01), ebac.Step(target=0.0)), "target 10 mm)"),
        ((ebac.Step(target=0.0),), "target 0 mm)"),
        ((ebac.Step(target=0.01), ebac.Sine()), "a Step path and a Sine path)"),
    ],
)
def test_a_hand_is_described_on_every_axis_that_it_moves_on(
    path: tuple[Any, ...], said: str
) -> None:
    """Only the first path was, where a corner is pressed into along two."""
    assert descriptions.described_hand(ebac.Hand(path=path)).endswith(said)


# --- help, version ---


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(command: str) -> None:
    text = ebac_command(command, "--help").output
    assert "--json" in text
    assert f"ebac {command}" in text or command == "presets"


def test_help_names_every_command_and_completion() -> None:
    text = ebac_command("--help").output
    assert all(command in text for command in COMMANDS)
    assert "--install-completion" in text


def test_version() -> None:
    assert ebac_command("--version").stdout == f"ebac {ebac.__version__}\n"


# --- wall ---


def test_wall_json_has_the_documented_keys_and_writes_nothing(tmp_path: Path) -> None:
    answer = document("wall")
    assert list(answer) == ["command", "version", "scenario", "through", "rows"]
    assert (answer["command"], answer["version"]) == ("wall", ebac.__version__)
    assert answer["scenario"]["environment"]["stiffness"] == 10e3
    assert answer["scenario"]["hand"]["release_at"] is None  # never; JSON has no infinity
    assert [row["law"] for row in answer["rows"]] == ["tca", "tca-damped", "eba", "ebac"]
    assert all(list(row) == WALL_KEYS for row in answer["rows"])
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("seed", range(1, 21))
def test_wall_shows_what_the_paper_shows(seed: int) -> None:
    rows = wall_rows("--seed", str(seed))
    count = ebac.Device().count
    assert rows["tca"]["swing_m"] >= 5e-3
    assert rows["tca"]["settled_s"] is None
    assert rows["eba"]["swing_m"] < count
    assert rows["eba"]["rest_m"] - rows["eba"]["ideal_m"] > 1e-3
    assert abs(rows["ebac"]["rest_m"] - rows["ebac"]["ideal_m"]) <= 0.062e-3
    assert rows["ebac"]["swing_m"] < 0.25e-3
    assert rows["ebac"]["settled_s"] <= 1.5
    assert rows["ebac"]["least_energy_J"] >= -1e-3


def test_wall_numbers_are_those_of_the_library() -> None:
    scenario = ebac.Scenario(environment=ebac.Wall(stiffness=5e3), seconds=2.0)
    expected = ebac.contact(ebac.simulate(scenario, "eba")).row()
    assert (
        wall_rows("--law", "eba", "--wall-stiffness", "5000", "--seconds", "2")["eba"] == expected
    )


@pytest.mark.slow
def test_wall_writes_table_figure_logs_and_scenario(tmp_path: Path) -> None:
    text = ebac_command("wall", "--seconds", "1").stdout
    names = {"wall.json", "wall.png", "scenario.toml"}
    laws = ("tca", "tca-damped", "eba", "ebac")
    names |= {f"{law}.{kind}" for law in laws for kind in ("npz", "csv")}
    folder = tmp_path / "ebac-wall"
    assert {file.name for file in folder.iterdir()} == names
    assert all(name in text for name in names)
    assert json.loads((folder / "wall.json").read_text()) == document("wall", "--seconds", "1")
    trace = ebac.Trace.from_npz(folder / "ebac.npz")
    assert len(trace) == 1001
    assert (folder / "wall.png").read_bytes().startswith(b"\x89PNG")


def test_wall_answers_in_words_and_units() -> None:
    text = ebac_command("wall", "--no-files").stdout
    for word in ("swings", "exact", "and quiet", "too deep"):
        assert word in text
    assert "Simulated, not measured" in text
    assert "10 kN/m" in text
    assert "1 sample of delay" in text


def test_wall_says_why_nothing_is_judged_exact() -> None:
    said = ebac_command("wall", "--hand", "open", "--seconds", 1, "--no-files").output
    assert "Not judged exact, there is no ideal rest: the hand has no stiffness." in said
    said = ebac_command("wall", "--device", "joystick", "--seconds", 1, "--no-files").output
    assert "ideal rest" in said
    assert "Not judged" not in said


def test_a_wall_that_the_motor_cannot_bear_says_so() -> None:
    """It was "too deep by 18.2 mm", as if the law were at fault."""
    words = ("wall", "--law", "ebac", "--seconds", "1", "--no-files")
    strong = " ".join(ebac_command(*words, "--hand-stiffness", "5000").stdout.split())
    assert "the ideal rest needs 133 N, and the motor gives 42.4 N at most" in strong
    assert "No law can be exact" not in ebac_command(*words).stdout


def test_wall_scenario_round_trip() -> None:
    given = [
        "--wall-stiffness",
        "3000",
        "--hand-mass",
        "0.3",
        "--delay",
        "2",
        "--rate",
        "2000",
        "--device-noise",
        "0.1",
    ]
    given += [
        "--device-permille",
        "--jitter",
        "0.1",
        "--seconds",
        "1",
        "--seed",
        "5",
        "--hand-target",
        "0.03",
    ]
    given += [
        "--wall-damping",
        "4",
        "--hand-damping",
        "7",
        "--hand-stiffness",
        "250",
        "--wall-position",
        "0.001",
    ]
    first = document("wall", *given, "--out", "first")
    assert document("wall", "--scenario", "first/scenario.toml") == first
    changed = document("wall", "--scenario", "first/scenario.toml", "--seed", "6")
    assert changed["scenario"] == {**first["scenario"], "seed": 6}
    assert changed["rows"] != first["rows"]


def test_wall_takes_every_option_into_the_scenario() -> None:
    device = "--device joystick --device-noise 0.2 --device-lag 0.003 --device-permille"
    words = f"--hand arm-hogan --hand-target 0.02 {device} --seconds 1"
    scenario = document("wall", *words.split())["scenario"]
    assert scenario["hand"]["stiffness"] == 568
    assert scenario["hand"]["path"][0]["target"] == 0.02
    assert scenario["device"]["kinematics"]["type"] == "Gimbal"
    assert scenario["device"]["sensor"]["noise"] == 0.2
    assert scenario["device"]["sensor"]["lag"] == 0.003
    assert scenario["device"]["drive"]["permille"] is True


@pytest.mark.parametrize(
    ("words", "note"),
    [
        ("--wall-position 10", "Note: --wall-position = 10 m: the handle never reaches the wall, the stops of the "
         "device stand at 0.05236 m (device.kinematics.limit); positions are in metres, 10 mm are 0.01"),
        ("--wall-position 10 --world sphere", "Note: --wall-position = 10 m: the handle never reaches the wall"),
        ("--scenario far.toml", "far.toml: environment.position = 10 m: the handle never reaches the wall"),
        ("--wall-position 0.02 --hand-target 0.01", "Note: the wall stands at 0.02 m (--wall-position), and the target "
         "of the hand comes to 0.01 m at most: the handle does not meet the wall; give a nearer wall, or a target "
         "behind it by --hand-target"),
        ("--wall-position 0.01", ""),
    ],
)  # fmt: skip
def test_a_wall_that_the_handle_never_reaches_is_noted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: str, note: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("far.toml").write_text('[environment]\ntype = "Wall"\nposition = 10.0\n')
    command = ["wall", "--law", "ebac", "--seconds", "0.3", "--no-files", *words.split()]
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 0
    assert note in (told := " ".join(result.stderr.split()))
    assert told.count("Note:") == bool(note)


def test_several_laws_have_commas_between_them() -> None:
    text = refusal("wall", "--law", "tca ebac")
    assert "--law tca ebac: separate names by commas: --law tca,ebac" in text


def test_a_condition_with_a_space_in_it_is_told_as_one_word() -> None:
    text = refusal("study", "--law", "ebac", "--condition", "d1 K10")
    assert "--condition d1 K10: a condition is one word: --condition d1K10" in text
    assert "commas" in refusal("study", "--law", "ebac", "--condition", "d1K10 d2K10")


def test_wall_runs_every_law_once() -> None:
    assert list(wall_rows("--law", "all", "--law", "tca", "--seconds", "0.1")) == list(ebac.LAWS)


def test_friction_its_compensation_and_the_encoder_of_the_device_are_options() -> None:
    words = ["wall", "--law", "ebac", "--seconds", "0.1", "--json", "--device-counts", "4096"]
    words += ["--device-friction-compensation", "0.4", "--device-coulomb", "0.5"]
    told = json.loads(CliRunner().invoke(app, words).stdout)
    assert told["scenario"]["device"]["encoder"]["counts_per_turn"] == 4096
    assert told["scenario"]["device"]["mechanics"]["coulomb"] == 0.5
    assert told["scenario"]["device"]["compensation"]["friction"] == 0.4
    refused = CliRunner().invoke(app, [*words[:-1], "-1"])
    assert refused.exit_code == 2
    assert "--device-coulomb = -1 N: must lie in [0, 100] N" in " ".join(refused.output.split())
    refused = CliRunner().invoke(app, ["wall", "--no-files", "--device-counts", "0"])
    assert refused.exit_code == 2
    assert "--device-counts = 0" in " ".join(refused.output.split())


def test_a_thing_that_does_not_exist_is_null() -> None:
    rows = wall_rows("--law", "tca", "--hand", "open", "--seconds", "1")
    assert rows["tca"]["ideal_m"] is None
    assert rows["tca"]["clamped_share"] is None


def test_a_fault_is_told_and_its_log_kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    class Broken:
        name = "broken"

        def step(self, port: ebac.Port) -> float:
            return float("nan")

        def reset(self) -> None:
            pass

    original = ebac.simulate
    monkeypatch.setattr(
        "ebac.simulation.simulate",
        lambda scenario, name, *, through: original(scenario, Broken(), through=through),
    )
    text = refusal("wall", "--law", "ebac", code=1)
    assert "law not finite" in text
    assert "ebac-wall/broken-fault.npz" in text
    assert [file.name for file in (tmp_path / "ebac-wall").iterdir()] == ["broken-fault.npz"]
    assert (
        ebac.Trace.from_npz("ebac-wall/broken-fault.npz")["fault"][-1] == ebac.Fault.LAW_NOT_FINITE
    )
    assert "--out" in refusal("wall", "--json", code=1)


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("wall --wall-stiffness -3", "--wall-stiffness = -3 N/m: must lie in [0, 1e+07] N/m"),
        ("wall --wall-stiffness nan", "--wall-stiffness = nan N/m"),
        ("wall --wall-stiffness x", "--wall-stiffness"),
        ("wall --delay 9", "--delay = 9 samples: must lie in [0, 8] samples"),
        ("wall --hand-mass -1", "--hand-mass = -1 kg"),
        ("wall --hand-damping -1", "--hand-damping = -1 N s/m"),
        ("wall --hand-target 11", "--hand-target = 11 m"),
        ("wall --device-noise -1", "--device-noise = -1 N"),
        ("wall --device-lag 3", "--device-lag = 3 s: must lie in [0, 0.1] s; 3 ms is 0.003 s"),
        ("wall --device-counts 2 --law ebac", "give more counts per turn, --device-counts"),
        (
            "wall --device-counts 2 --law ebac",
            "must lie in [0, 0.01] m; it is the way of the handle",
        ),
        (
            "wall --device-noise 30",
            "--device-noise = 30 N: must lie in [0, 10] N, as EBAC.force_noise follows",
        ),
        ("wall --jitter 0.6", "--jitter = 0.6"),
        ("wall --seed -1", "--seed = -1"),
        ("wall --seconds 0", "--seconds"),
        ("wall --seconds 0.001", "2 ticks: must lie in [10, 2000000]; change --seconds or --rate"),
        ("wall --seconds 1e5", "100000001 ticks"),
        ("wall --rate 0", "--rate = 0 Hz: must lie in [10, 100000] Hz"),
        ("wall --law ebca", "did you mean 'eba' or 'ebac'; `ebac laws` lists all"),
        ("wall --world sphere --wall-stiffness -3", "--wall-stiffness = -3 N/m: must lie in"),
        ("wall --world sphere --world-friction 5", "--world-friction = 5.0: must lie in [0, 2]"),
        ("live --world foo", "--world: there is no such option; see --help"),
        ("wall --stifness 3", "did you mean --wall-stiffness"),
        ("demo line nosuch", "NAME nosuch: no such name; `ebac demo` lists all"),
        ("log plot latin.csv --from 5 --to 1", "--to = 1 s: must be larger than --from, 5 s"),
        ("wall --law nonsense", "--law nonsense: no such name; `ebac laws` lists all"),
        ("wall --world corn", "no such name, did you mean 'corner'; `ebac worlds` lists all"),
        ("study -c d1L10", "--condition d1L10: no such name, did you mean 'd1K10'"),
        ("study -c d1L10", "`ebac conditions` lists all"),
        ("wall --hand bob", "no such name; `ebac presets` lists all"),
        ("wall --device bob", "joystick"),
        ("wall --scenario none.toml", "none.toml: there is no such file"),
        ("wall --scenario .", "cannot be read"),
        ("wall --scenario broken.toml", "not a TOML document"),
        ("wall --scenario unknown.toml", "did you mean 'seed'"),
        ("wall --scenario negative.toml", "environment.stiffness = -1 N/m"),
        ("wall --scenario corner.toml --wall-stiffness 3", "environment is a Corner"),
        ("wall --scenario sine.toml --hand-target 0.1", "Sine path, which has no target"),
        ("wall --wall-stiffness 10kN/m", "10kN/m: must be a number (in N/m); give 10000"),
        ("wall --wall-stiffness 10kN", "10kN: must be a number (in N/m); for 10 kN/m give 10000"),
        ("drive show joystick 11", "`ebac drive show --node 1` reads a drive on the bus"),
        ("wall --wall-position 2.5mm", "2.5mm: must be a number (in m); give 0.0025"),
        ("wall --wall-position 1.2.3mm", "1.2.3mm: must be a number (in m)"),
        ("wall --out file", "is a file"),
        ("wall --out file/below", "is a file or lies inside one"),
        *(
            (f"{command} --seconds 0.1 --out {folder}", f"--out {folder}: {end}")
            for command in ("wall", "map --side 2", "study", "ablation")
            for folder, end in (
                ("/proc/x", "cannot be written (No such file or directory); give another folder"),
                ("file", "is a file or lies inside one; give the name of a folder"),
            )
        ),
        *(
            (
                f"{command} /proc/x.{end}",
                f"/proc/x.{end}: cannot be written (No such file or directory); give another file",
            )
            for command, end in (
                ("wall --law ebac --seconds 0.1 --no-files --log", "mcap"),
                ("specs --out", "png"),
            )
        ),
        ("wall --no-files --out x", "exclude each other"),
        ("wall --stifness 3", "--wall-stiffness"),
        ("paper fig12", "did you mean 'fig"),
        ("paper eq1 --out file", "is a file"),
        ("laws ebca", "did you mean 'eba'"),
        ("laws --rate 1", "--rate = 1 Hz"),
        ("laws --device bob", "joystick"),
        ("specs --device bob", "joystick"),
        ("specs --device joystick --scenario corner.toml", "give one of the two"),
        ("specs --scenario none.toml", "none.toml: there is no such file"),
        ("specs --scenario negative.toml", "environment.stiffness = -1 N/m"),
        ("bench --repeats 0", "--repeats"),
        ("wal", "wal"),
        (
            "wall extra",
            "extra: `ebac wall` takes no argument, only options; quote a value that has",
        ),
        ("wall one two", "one two: `ebac wall` takes no argument"),
        ("specs mine.toml", "a file is given as --scenario mine.toml"),
        (
            "bus load joystick",
            "joystick: `ebac bus load` takes no argument, only options; `ebac drive plan FILE` prints",
        ),
        (
            "conditions d1",
            "d1: `ebac conditions` takes no argument, only options; `ebac study --condition NAME` runs",
        ),
        ("presets hand reference", "too many words; quote a value that has spaces, or see --help"),
        ("wall --scenario latin.toml", "latin.toml: is no text in UTF-8 (line 1, byte 0xe9)"),
        ("study --population latin.csv", "latin.csv: is no text in UTF-8 (line 1, byte 0xe9)"),
        ("log plot latin.csv", "latin.csv: is no text in UTF-8 (line 1, byte 0xe9)"),
        ("wall --law tca;ebac", "--law tca;ebac"),
        ("wall --format=", "--format: is empty; must be png, pdf or svg"),
        ("study --seed -1", "--seed = -1: must be at least 0"),
        (
            "study --device-friction 1",
            "did you mean --device-coulomb or --device-friction-compensation; see",
        ),
        ("tune mine.py:Mine", "LAW mine.py:Mine: there is no file mine.py"),
        ("ablation --beside mine.py:Mine", "this command takes the laws of the package only"),
        ("laws mine.py:Damped", "NAME mine.py:Damped: there is no file mine.py"),
        ("laws tca,eba", "NAME tca,eba: one law only; give one of tca, eba"),
        (
            "map --change guard=off",
            "--change: there is no such option here; `ebac ablation`, `ebac stiffest`, `ebac study`, `ebac wall`, "
            "`ebac worst` and `ebac zwidth` have it",
        ),
        ("wall --noise 1", "--noise: there is no such option, did you mean --device-noise; see"),
        (
            "wall --no-sensor",
            "--no-sensor: there is no such option, did you mean --no-device-sensor or --device-sensor",
        ),
        ("teleop simulate", "teleop simulate: there is no such command, did you mean 'run'; see"),
        ("bus joystick", "bus joystick: there is no such command, there is load; see"),
        ("drive joystick", "drive joystick: there is no such command, there are "),
        ("teleop network --delay 50", "--delay = 50 s: must lie in [0, 0.5] s; 50 ms is 0.05 s"),
        ("gastroscopy --delay 100", "--delay = 100 s: must lie in [0, 2] s; 100 ms is 0.1 s"),
        ("gastroscopy --insertion pedal", "--insertion pedal: no such name, did you mean 'pedals'"),
        ("gastroscopy --bending rat", "--bending rat: no such name, did you mean 'rate'"),
        (
            "run joystick.toml --simulated --log x.mcap",
            "--log: there is no such option here; a run always writes its log, run-TIME.mcap in the folder of --out",
        ),
        ("simulate", "simulate: there is no such command, did you mean 'wall'; see"),
        ("study --delay 2", "--delay: there is no such option here, --condition sets it"),
        ("study --hand-mass 2", "--hand-mass: there is no such option here, --population sets it"),
        ("worst --hand finger", "--hand: there is no such option here, --family sets it"),
        (
            "drive scan --interface soketcan",
            "--interface soketcan: no such name, did you mean 'soc",
        ),
        (
            "drive simulate --aim 99999999999999999999",
            "--aim = 99999999999999999999: must lie in [0,",
        ),
        (
            "identify arm file.csv --lag 1e-300",
            "--lag = 1e-300 s: must be 0, or lie in [1e-06, 0.1]",
        ),
    ],
)
def test_bad_input_is_refused_in_one_sentence(words: str, expected: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("kept")
    (tmp_path / "broken.toml").write_text("seed = = 1")
    (tmp_path / "unknown.toml").write_text("sed = 1")
    (tmp_path / "negative.toml").write_text("[environment]\nstiffness = -1")
    (tmp_path / "corner.toml").write_text('[environment]\ntype = "Corner"')
    for name in ("latin.csv", "latin.toml"):
        (tmp_path / name).write_bytes("# née\n".encode("latin-1"))
    (tmp_path / "sine.toml").write_text('[hand]\npath = [{type = "Sine"}]')
    before = {file.name for file in tmp_path.iterdir()}
    text = refusal(*words.split())
    assert expected in text
    assert "Traceback" not in text
    assert {file.name for file in tmp_path.iterdir()} == before
    assert (tmp_path / "file").read_text() == "kept"


@pytest.mark.parametrize("words", ["map --side 2 --seconds 0.1", "study --seconds 0.1"])
def test_no_files_writes_none(words: str, tmp_path: Path) -> None:
    assert "--no-files and --out exclude" in refusal(*words.split(), "--no-files", "--out", "x")
    ebac_command(*words.split(), "--no-files")
    assert not list(tmp_path.iterdir())


def test_a_study_without_files_names_none_as_written(tmp_path: Path) -> None:
    words = ("study", "--law", "direct", "--seconds", "0.6")
    assert "Without --no-files failures.csv names all 60 runs of them." in refusal(
        *words, "--no-files", code=0
    )
    assert "Without" not in refusal(*words, code=0)


def test_a_failure_leaves_the_folder_as_it_was(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    ebac_command("wall", "--seconds", "0.1", "--law", "eba")
    before = {file.name: file.read_bytes() for file in (tmp_path / "ebac-wall").iterdir()}

    def no_space(self: ebac.Trace, path: Path) -> None:
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr(ebac.Trace, "to_csv", no_space)
    assert "No space left on device" in refusal("wall", "--seconds", "0.2", code=2)
    assert {file.name: file.read_bytes() for file in (tmp_path / "ebac-wall").iterdir()} == before


# --- the others ---


def test_paper_prints_and_writes(tmp_path: Path) -> None:
    text = ebac_command("paper", "eq1", "specs", "fig7", "--out", "report").stdout
    assert "0.4926 A" in text
    assert "Verdict: reproduced in part" in text
    assert {file.name for file in (tmp_path / "report").iterdir()} == {
        "report.md",
        "report.json",
        "fig7.png",
    }


def test_paper_json() -> None:
    answer = document("paper", "eq1", "specs")
    assert list(answer) == ["command", "version", "rows"]
    assert [row["name"] for row in answer["rows"]] == ["eq1", "specs"]
    assert list(answer["rows"][0]) == [
        "name", "title", "claim", "rows", "verdict", "why", "claims", "figure",
    ]  # fmt: skip
    assert list(answer["rows"][0]["rows"][0]) == [
        "quantity",
        "value",
        "unit",
        "paper",
        "difference",
    ]


def test_laws_lists_all_and_shows_one() -> None:
    rows = document("laws")["rows"]
    assert [row["law"] for row in rows] == list(ebac.LAWS)
    keys = ["name", "unit", "meaning", "type", "default", "low", "high", "designed"]
    assert all(list(p) == keys for row in rows for p in row["parameters"])
    text = ebac_command("laws").stdout
    assert all(name in text for name in ebac.LAWS)
    shown = " ".join(ebac_command("laws", "ebac", "--delay", "2").stdout.split())
    assert "N s/m" in shown
    assert "designed: for the reference device at 1 kHz and 2 samples of delay;" in shown


def test_laws_are_designed_for_the_device_of_a_file() -> None:
    Path("mine.toml").write_text(
        "[device.mechanics]\ndamping = 5.0\n[timing]\ndelay = 3\n", encoding="utf-8"
    )
    (row,) = document("laws", "eba", "--scenario", "mine.toml")["rows"]
    assert {one["name"]: one["designed"] for one in row["parameters"]}["damping"] == 5.0
    shown = " ".join(ebac_command("laws", "eba", "--scenario", "mine.toml").stdout.split())
    assert "designed: for the device of mine.toml at 1 kHz and 3 samples of delay;" in shown


def test_laws_are_designed_for_the_device() -> None:
    (row,) = document("laws", "eba", "--device", "joystick")["rows"]
    designed = {p["name"]: p["designed"] for p in row["parameters"]}
    device = ebac.presets.device("joystick")
    law = ebac.EBA.design(device, ebac.Timing())
    assert designed == {name: getattr(law, name) for name in designed}


def test_specs() -> None:
    answer = document("specs")
    assert answer["device"] == "joystick"
    values = {row["name"]: row["value"] for row in answer["rows"]}
    assert values["continuous force"] == pytest.approx(10.6)
    assert "0.0307 mm" in ebac_command("specs").stdout


def test_specs_of_the_device_file_of_its_page() -> None:
    page = Path(__file__).parents[2] / "docs" / "how-to" / "describe_your_device.md"
    text = page.read_text(encoding="utf-8")
    (file,) = re.findall(r"```toml\n(# device\.toml\n.*?)```", text, re.DOTALL)
    shown, _ = re.findall(r"```text\n(.*?)```", text, re.DOTALL)
    Path("device.toml").write_text(file, encoding="utf-8")
    answer = document("specs", "--scenario", "device.toml")
    assert answer["device"] == "device.toml"
    assert {(row["paper"], row["remark"]) for row in answer["rows"]} == {(None, None)}
    values = {row["name"]: row["value"] for row in answer["rows"]}
    assert values["mass at the handle"] == pytest.approx(0.1775)
    assert values["continuous force"] == pytest.approx(7.5)
    assert values["continuous current"] == pytest.approx(1.176, rel=1e-3)
    printed = " ".join(ebac_command("specs", "--scenario", "device.toml").stdout.split())
    assert " ".join(shown.split()) in printed
    assert "device.toml, what it leaves out is that of the reference device" in printed
    assert "paper" not in printed


def test_specs_takes_the_configuration_of_a_run_and_says_what_its_device_starts_from() -> None:
    Path("mine.toml").write_text(
        "[bus]\n[device.kinematics]\ntype = 'Linear'\naxes = 2\n", encoding="utf-8"
    )
    told = ebac_command("specs", "--scenario", "mine.toml")
    printed, noted = (" ".join(text.split()) for text in (told.stdout, told.stderr))
    assert "what it leaves out is that of the device preset joystick" in printed
    assert "weight 1.12 N" in printed
    assert "gravity = 9.81 m/s^2 is that of the joystick" in noted


@pytest.fixture
def own_motor() -> Path:
    """The configuration of a device with another motor than the built-in drives are for."""
    file = Path("mine.toml")
    motor = "[device.motor]\ntorque_constant = 0.0255\nrated_torque = 0.030\n\n"
    text = (Path(__file__).parents[2] / "examples" / "joystick.toml").read_text()
    file.write_text(text.replace("[device.kinematics]", f"{motor}[device.kinematics]", 1))
    return file


@pytest.mark.parametrize("words", ["specs --scenario mine.toml", "laws --scenario mine.toml"])
def test_a_device_is_looked_at_before_its_drives_are_set_up(own_motor: Path, words: str) -> None:
    noted = " ".join(ebac_command(*words.split()).stderr.split())
    assert noted.count("are for different motors") == 1
    assert "does not protect" not in noted


def test_all_that_is_of_another_motor_is_listed_with_the_way_to_change_it(own_motor: Path) -> None:
    ran = CliRunner().invoke(app, ["run", str(own_motor), "--virtual"])
    assert ran.exit_code == 2
    refused = " ".join(ran.stderr.split())
    for part in (
        "bus.drives: the built-in joystick and the device are for different motors.",
        "nodes 1, 2: motor.torque_constant = 0.0538 N m/A, the device motor.torque_constant = 0.0255 N m/A; nodes 1, "
        "2: limits.rated_torque = 0.053 N m, the device motor.rated_torque = 0.03 N m.",
        "`ebac drive profile joystick --motor FILE > my-network.toml` writes the drives for the motor of FILE, then "
        'give drives = "my-network.toml" in [bus]',
    ):
        assert part in refused
    words = ["drive", "profile", "joystick", "--motor", str(own_motor)]
    made = CliRunner().invoke(app, words)
    assert made.exit_code == 0, made.output
    noted = " ".join(made.stderr.split())
    assert "does not give device.encoder.counts_per_turn, so 1024 counts of the device" in noted
    Path("my-network.toml").write_text(made.stdout, encoding="utf-8")
    text = own_motor.read_text(encoding="utf-8")
    own_motor.write_text(text.replace('"joystick" ', '"my-network.toml" '), encoding="utf-8")
    ran = CliRunner().invoke(
        app, ["run", str(own_motor), "--virtual", "--seconds", "0.2", "--no-files"]
    )
    assert ran.exit_code == 0, ran.output
    again = CliRunner().invoke(app, words)
    assert again.stdout == made.stdout, "also where the file names drives of its own"
    own_motor.write_text(own_motor.read_text().replace("= 0.0255", "= 0.027"), encoding="utf-8")
    ran = CliRunner().invoke(app, ["run", str(own_motor), "--virtual"])
    assert (
        "the values stand in my-network.toml, beside the profile of each node: change them there, or write it again "
        "for the motor of FILE: `ebac drive profile joystick --motor FILE > my-network.toml`"
    ) in " ".join(ran.stderr.split())
    assert "my-drive.toml" not in ran.stderr, "its keys would not count beside those of the nodes"


def test_the_specs_of_a_file_that_is_not_there_are_refused_as_those_of_a_scenario() -> None:
    result = CliRunner().invoke(app, ["specs", "--scenario", "none.toml"])
    assert result.exit_code != 0
    assert "none.toml" in result.stderr


@pytest.mark.parametrize(
    ("typed", "found"),
    [
        ({"rated_torque = 30e-3": "rated_torque = 30"}, ["1176 A, but rated_current = 1.2 A"]),
        ({"rated_torque = 30e-3": "rated_torque = 30", "rated_current = 1.2": ""},
         ["rated_torque / torque_constant = 1176 A: usual are 0.05 to 50 A"]),
        ({"torque_constant = 25.5e-3": "torque_constant = 25.5"}, ["0.001176 A, but rated_current = 1.2 A"]),
        ({"handle_mass = 0.09": "handle_mass = 9"}, []),
        ({"torque_constant = 25.5e-3": "torque_constant = 25.5", "rated_torque = 30e-3": "rated_torque = 30"},
         ["peak force at the handle = 3e+04 N: usual are 0.1 to 1000 N"]),
        ({"rated_current = 1.2 ": "rated_current = 2.2 "}, []),
        ({"rated_current = 1.2 ": "rated_current = 2.5 "}, ["= 1.176 A, but rated_current = 2.5 A"]),
        ({}, []),
    ],
)  # fmt: skip
def test_a_device_in_wrong_units_is_noted(typed: dict[str, str], found: list[str]) -> None:
    page = Path(__file__).parents[2] / "docs" / "how-to" / "describe_your_device.md"
    text = page.read_text(encoding="utf-8")
    (file,) = re.findall(r"```toml\n(# device\.toml\n.*?)```", text, re.DOTALL)
    for right, wrong in typed.items():
        assert right in file
        file = file.replace(right, wrong)
    Path("device.toml").write_text(file, encoding="utf-8")
    said = " ".join(ebac_command("specs", "--scenario", "device.toml").stderr.split())
    assert ("Note: device.toml: " in said) == bool(found)
    for part in found:
        assert part in said
    if list(typed.values()) == ["rated_torque = 30"]:  # as on the page
        (noted,) = re.findall(r"```text\n(Note: .*?)\n```", text, re.DOTALL)
        assert noted in said


@pytest.mark.parametrize(
    ("table", "wrong", "fine", "note"),
    [
        ("sensor", "noise = 30", "noise = 0.5", "device.sensor.noise = 30 N: usual are at most 1 N; it is the standard "
         "deviation at rest in N, 30 mN are 0.03"),
        ("motor", "stall_current = 10000", "stall_current = 100", "device.motor.stall_current = 10000 A: usual are at "
         "most 200 times the continuous current, 197 A; it is in A, 10000 mA are 10"),
        ("drive", "current_lag = 0.03", "current_lag = 0.001", "device.drive.current_lag = 0.03 s: usual are at most "
         "0.005 s"),
        ("mechanics", "gravity = -9.81", "gravity = 9.81", "device.mechanics.gravity = -9.81 m/s^2: pulls along -x; "
         "usual are 9.81, and 0"),
        ("mechanics", "gravity = 98.1", "gravity = 0", "device.mechanics.gravity = 98.1 m/s^2: is more than that of"),
        ("mechanics", "breakaway = 1\ncoulomb = 3", "breakaway = 4\ncoulomb = 3", "device.mechanics.breakaway = 1 N is "
         "less than coulomb = 3 N"),
    ],
)  # fmt: skip
def test_a_number_of_a_device_that_is_likely_in_a_wrong_unit_is_noted(
    table: str, wrong: str, fine: str, note: str
) -> None:
    for values, expected in ((wrong, note), (fine, "")):
        Path("device.toml").write_text(f"[device.{table}]\n{values}\n", encoding="utf-8")
        noted = " ".join(ebac_command("specs", "--scenario", "device.toml").stderr.split())
        assert expected in noted
        assert noted.count("Note:") == bool(expected)


def test_a_simulation_notes_a_device_in_wrong_units() -> None:
    Path("device.toml").write_text("[device.motor]\ntorque_constant = 25.5\n", encoding="utf-8")
    words = ("wall", "--law", "direct", "--seconds", "0.1", "--no-files", "--json")
    result = ebac_command(*words, "--scenario", "device.toml")
    assert "torque_constant = 0.002078 A: usual are 0.05 to 50 A" in " ".join(result.stderr.split())
    assert json.loads(result.stdout)["command"] == "wall"


def test_a_file_that_sets_nothing_is_named() -> None:
    Path("mine.toml").write_text("# stiffness = 2e4\n", encoding="utf-8")
    words = ("wall", "--law", "direct", "--seconds", "0.1", "--no-files", "--json")
    result = ebac_command(*words, "--scenario", "mine.toml")
    assert "mine.toml: sets nothing" in " ".join(result.stderr.split())


def test_a_run_notes_a_device_in_wrong_units() -> None:
    ebac_command("demo", "joystick")
    with Path("joystick.toml").open("a", encoding="utf-8") as file:
        file.write("\n[device.mechanics]\nhandle_mass = 90.0\n")
    words = ("run", "joystick.toml", "--virtual", "--law", "direct", "--seconds", "0.1")
    result = CliRunner().invoke(app, list(words))
    assert "mass at the handle = 90.14 kg" in " ".join(result.stderr.split())


def test_the_mass_of_a_device_in_grams_is_noted_and_no_built_in_device_is() -> None:
    heavy = ebac.Device(mechanics=ebac.Mechanics(handle_mass=90))
    (said,) = doubtful_device.doubts(heavy)
    assert "mass at the handle = 90.14 kg: usual are 0.001 to 20 kg" in said
    for preset in ebac.presets.DEVICES.values():
        assert doubtful_device.doubts(preset.device) == []


@pytest.mark.parametrize(("quantum", "count"), [(0.0, 0), (0.0625, 0), (0.125, 1)])
def test_a_coarse_force_sensor_is_doubted(quantum: float, count: int) -> None:
    sensor = ebac.ForceSensor(quantum=quantum)
    said = doubtful_device.doubts(ebac.Device(sensor=sensor))
    assert len(said) == count
    assert all("steps of the force from 0.1 N" in text for text in said)
    assert doubtful_device.doubts(ebac.Device(sensor=sensor.replace(fitted=False))) == []
    (said,) = doubtful_device.doubts(ebac.Device(sensor=sensor.replace(fitted=False, noise=0.03)))
    assert "fitted = false, but noise = 0.03 N" in said


@pytest.mark.parametrize(
    ("radius", "limit", "noted"),
    [(0.12, 26.0, True), (0.12, 1.5, False), (0.1, 10.0, False), (0.1, 26.0, True)],
)
def test_a_limit_in_degrees_is_noted_and_a_drum_of_many_turns_is_not(
    radius: float, limit: float, noted: bool
) -> None:
    said = doubtful_device.doubts(ebac.Device(kinematics=ebac.Linear(radius=radius, limit=limit)))
    assert [f"{limit:g} degrees are" in one for one in said] == [True] * noted


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (
            "[device.encoder]\ncounts_per_turn = 20",
            "a count of the encoder = 1.57 mm at the handle",
        ),
        (
            "[device.capstan]\ndrum_radius = 0.12",
            "drum_radius = 0.12 m is larger than sector_radius",
        ),
        (
            "[environment]\ntype = 'Wall'\nstiffness = 10.0",
            "environment.stiffness: a wall of 10 N/m",
        ),
    ],
)
def test_a_file_with_an_unusual_part_is_noted(table: str, words: str) -> None:
    Path("device.toml").write_text(table, encoding="utf-8")
    given = ("wall", "--law", "direct", "--seconds", "0.1", "--no-files", "--json")
    result = ebac_command(*given, "--scenario", "device.toml")
    assert re.search(rf"^Note: device\.toml: [^\n]*{words}", result.stderr, re.MULTILINE)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            "wall --wall-stiffness 10",
            "--wall-stiffness: a wall of 10 N/m: usual are 50 to 500000 N/m",
        ),
        (
            "wall --device-counts 32",
            "--device-counts: device: a count of the encoder = 0.982 mm at the handle",
        ),
        ("study --condition d1K10,d1K10000", "condition d1K10000: a wall of 1e+07 N/m: usual are"),
        ("study --condition d1b1K2000", "so that 2000 N/m is d1b1K2."),
    ],
)
def test_an_unusual_number_of_an_option_is_noted(given: str, words: str) -> None:
    small = ("--law", "direct", "--seconds", "0.5", "--no-files", "--json")
    result = ebac_command(*given.split(), *small)
    assert result.stderr.count("Note:") == 1
    assert words in result.stderr


def test_specs_of_a_device_file_draw_its_workspace() -> None:
    ebac.Scenario(device=ebac.presets.device("joystick")).save("mine.toml")
    ebac_command("specs", "--scenario", "mine.toml", "--out", "workspace.png")
    assert Path("workspace.png").is_file()


def test_presets() -> None:
    names = {row["name"] for row in document("presets")["rows"]}
    assert names == {*ebac.presets.HANDS, *ebac.presets.DEVICES}
    text = ebac_command("presets").stdout
    assert all(name in text for name in names)


@pytest.mark.parametrize("name", ["joystick", "let-go", "reference", "Finger"])
def test_a_preset_is_shown_as_a_scenario_file_has_it(name: str, tmp_path: Path) -> None:
    text = ebac_command("presets", name).stdout
    (tmp_path / "shown.toml").write_text(text)
    read = ebac.Scenario.load(tmp_path / "shown.toml")
    kinds = [row["kind"] for row in document("presets", name)["rows"]]
    for kind, known in (("hand", ebac.presets.HANDS), ("device", ebac.presets.DEVICES)):
        assert (kind in kinds) == (name.lower() in known)
        if kind in kinds:
            assert getattr(read, kind) == getattr(ebac.presets, kind)(name.lower())


def test_bench() -> None:
    rows = document("bench", "--repeats", "1")["rows"]
    assert [row["law"] for row in rows] == [*ebac.LAWS, "python"]
    assert all(list(row) == ["law", "step_ns", "tick_ns", "ticks_per_s"] for row in rows)
    assert all(row["tick_ns"] > 0 for row in rows)
    assert rows[-1]["step_ns"] is None
    assert "aim" in ebac_command("bench", "--repeats", "1").stdout


def test_a_mesh_without_its_library_is_refused_in_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh = '{ type = "Mesh", file = "part.off" }'
    material = '{ type = "Elastic", stiffness = 1e4 }'
    file = tmp_path / "scenario.toml"
    file.write_text(
        f'[environment]\ntype = "World"\n[[environment.bodies]]\nsolid = {mesh}\nmaterial = {material}\n'
    )
    (tmp_path / "part.off").write_text("OFF\n0 0 0\n")
    monkeypatch.setitem(sys.modules, "trimesh", None)
    assert "meshes need trimesh: pip install 'ebac[worlds]'" in refusal(
        "wall", "--scenario", str(file)
    )


@pytest.mark.parametrize(
    "words", [["run", "--virtual", "--seconds", "0.2"], ["specs", "--scenario"]]
)
def test_a_configuration_whose_wall_or_sensor_is_likely_in_a_wrong_unit_is_noted(
    words: list[str], tmp_path: Path
) -> None:
    """A wall of 5 N/m (5 kN/m was meant) and one count a newton were taken without a word."""
    example = (Path(__file__).parents[2] / "examples" / "joystick.toml").read_text()
    file = tmp_path / "joystick.toml"
    file.write_text(
        example.replace("stiffness = 10e3", "stiffness = 5.0").replace(
            "counts_per_force = 1e6", "counts_per_force = 1.0"
        )
    )
    done = CliRunner().invoke(app, [*words, str(file)])
    noted = " ".join(done.stderr.split())
    assert "environment.stiffness: a wall of 5 N/m: usual are 50 to 500000 N/m" in noted
    assert (
        "sensor.counts_per_force = 1 counts/(N): a step of 1 N, usual are at most 0.25 N" in noted
    )
    assert doubtful_sensor.doubts(SensorConfig()) == []


@pytest.mark.parametrize(
    ("torque", "said"), [(0.053, ""), (0.03, "Too hot to be held"), (0.01, "No law can be exact")]
)
def test_what_the_motor_cannot_give_at_rest_is_said(torque: float, said: str) -> None:
    """The ideal rest needs 11.7 N; 0.053, 0.03 and 0.01 N m hold 10.6, 6 and 2 N, at the peak four times that."""
    scenario = ebac.Scenario(device=ebac.Device(motor=ebac.Motor(rated_torque=torque)))
    found = motor.too_weak(scenario) or motor.too_hot(scenario)
    assert found.startswith(said)
    assert bool(found) == bool(said)


def test_hands_that_the_motor_is_too_weak_for_are_counted() -> None:
    base = ebac.Scenario()
    assert motor.of_many(ebac.Operators.grid(), base) == ""
    weak = base.replace(
        device=base.device.replace(motor=base.device.motor.replace(rated_torque=0.01))
    )
    told = motor.of_many(ebac.Operators.grid(), weak)
    presses = [
        abs(s.hand.steady(ebac.ideal_rest(s))) for s in ebac.Operators.grid().scenarios(weak)
    ]
    count = sum(force > weak.device.peak_force for force in presses)
    assert 0 < count < 60
    assert f"{count} of the 60 hands press with more than the motor can give, 8 N" in told


def test_a_weak_motor_is_distinguished_from_the_wall_on_where_it_is_too_weak() -> None:
    """It said the count of one wall of all of the search, and the table beside it had 60 of 60 hands."""
    device = ebac.Device(motor=ebac.Motor(rated_torque=0.008))
    base, hands = ebac.Scenario(device=device), ebac.Operators.grid()
    told = motor.of_walls(hands, base, (500.0, 100.0, 400.0))
    assert (
        "at a wall of 0.4 kN/m and stiffer, hands press with more than the motor can give, 6.4 N"
        in told
    )
    assert (
        "for 12 of the 60 hands there, for 24 at 0.5 kN/m; this does not concern softer walls"
        in told
    )
    told = motor.of_walls(hands, base, (500.0,))
    assert "at a wall of 0.5 kN/m, hands press" in told
    assert told.endswith("for 24 of the 60 hands there")
    assert motor.of_walls(hands, base, (100.0,)) == ""


def test_runs_of_many_hands_that_are_too_short_are_named() -> None:
    assert length.of_many(ebac.Scenario(seconds=0.5)) == ""
    told = length.of_many(ebac.Scenario(seconds=0.05), "--seconds")
    assert told.startswith("--seconds = 0.05 s: too short to judge a contact")


def test_the_wall_puts_other_parameters_of_a_law_beside_it() -> None:
    words = "wall --law tca --seconds 0.2 --change kp=0 --change kp=0.1,kd=0 --out out --json"
    told = json.loads(CliRunner().invoke(app, words.split()).stdout)
    rows = {row["law"]: row for row in told["rows"]}
    assert list(rows) == ["tca", "tca, kp=0", "tca, kp=0.1,kd=0"]
    alone = ebac.simulate(ebac.Scenario(seconds=0.2), ebac.Variant("tca", {"kp": 0.0}))
    assert rows["tca, kp=0"]["rest_m"] == ebac.contact(alone).rest_m
    assert rows["tca"]["rest_m"] != rows["tca, kp=0"]["rest_m"]
    kept = ebac.load("out/tca_kp_0.npz")
    assert kept.law == "tca, kp=0"
    assert kept["x"].tobytes() == alone["x"].tobytes()


def test_a_study_puts_other_parameters_of_a_law_beside_it() -> None:
    words = "study --law tca --seconds 0.5 -c d1K10 --hands 2 --population random --change kp=0 --out out --json"
    told = json.loads(CliRunner().invoke(app, words.split()).stdout)
    assert [row["law"] for row in told["rows"]] == ["tca", "tca, kp=0"]
    assert told["rows"][0]["most_drawn_J"] != told["rows"][1]["most_drawn_J"]
    assert Path("out/failure-tca_kp_0-d1K10-1.npz").is_file()
