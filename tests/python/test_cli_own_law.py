"""A law of one's own on the command line, `--law file.py:Name`."""

import json
import re
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app

MINE = """
from dataclasses import dataclass

print("I am read")


@dataclass
class Damped:
    damping: float = 30.0
    name = "damped"

    def step(self, port):
        return port.f_env + self.damping * port.v if port.f_env > 0 else 0.0

    def reset(self):
        pass


class Designed(Damped):
    name = "designed"

    @classmethod
    def design(cls, facts, timing, **changes):
        return cls(40.0 * facts.mass / 0.25)


class Direct(Damped):
    name = "direct"


class Needs(Damped):
    def __init__(self, damping):
        super().__init__(damping)


class NoReset:
    def step(self, port):
        return 0.0


softer = Damped(25.0)
"""


@pytest.fixture(autouse=True)
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.path", [*__import__("sys").path])
    file = tmp_path / "mine.py"
    file.write_text(MINE, encoding="utf-8")
    return file


def run(*words: str) -> Any:
    return CliRunner().invoke(app, words)


def rows(*words: str) -> list[dict[str, Any]]:
    result = run(*words, "--json")
    assert result.exit_code == 0, result.output
    found: list[dict[str, Any]] = json.loads(result.stdout)[
        "rows"
    ]  # what the file prints is not here
    return found


@pytest.mark.parametrize(
    ("word", "name", "damping"),
    [("mine.py:Damped", "damped", 30), ("mine.py:softer", "damped", 25), ("mine.py:Designed", "designed", 40)],
)  # fmt: skip
def test_a_class_an_object_and_a_designed_law_give_what_they_give_in_python(
    word: str, name: str, damping: float
) -> None:
    found = rows("wall", "--law", f"direct,{word}", "--seconds", "1")
    assert [row["law"] for row in found] == ["direct", name]

    class Same:
        def step(self, port: ebac.Port) -> float:
            return port.f_env + damping * port.v if port.f_env > 0 else 0.0

        def reset(self) -> None:
            pass

    told = ebac.contact(ebac.simulate(ebac.Scenario(seconds=1.0), Same()))
    assert found[1]["rest_m"] == told.rest_m
    assert found[1]["peak_m"] == told.peak_m


@pytest.mark.parametrize("command", ["map --side 2 --seconds 0.1", "study --seconds 0.1"])
def test_many_runs_of_a_law_in_python_are_noted(command: str) -> None:
    words = [*command.split(), "--no-files", "--law"]
    slow = "Note: --law mine.py:Damped: is written in Python, so that a run takes about ten times as long"
    noted = CliRunner().invoke(app, [*words, "mine.py:Damped,direct"])
    assert noted.exit_code == 0, noted.output
    assert slow in " ".join(noted.stderr.split())
    assert "in Python" not in CliRunner().invoke(app, [*words, "direct"]).stderr


def test_a_module_is_imported_by_its_name() -> None:
    Path("importable.py").write_text(MINE, encoding="utf-8")
    assert rows("wall", "--law", "importable:Damped", "--seconds", "1")[0]["law"] == "damped"


def test_a_file_imports_what_lies_beside_it(tmp_path: Path) -> None:
    (tmp_path / "laws").mkdir()
    (tmp_path / "laws" / "beside_it.py").write_text("DAMPING = 20.0\n", encoding="utf-8")
    text = "from beside_it import DAMPING\n" + MINE.replace("30.0", "DAMPING")
    (tmp_path / "laws" / "uses.py").write_text(text, encoding="utf-8")
    assert rows("wall", "--law", "laws/uses.py:Damped", "--seconds", "1")[0]["law"] == "damped"


@pytest.mark.parametrize(
    "command",
    [
        "study --population random --hands 2",
        "map --side 2",
        "stiffest --population random --hands 1",
        "zwidth --points 2 --delay 1 --most-stiffness 3000 --seconds 0.5",
        "random-worlds --kind planes --device 2-axes --hands 1",
        "shapes --world sphere --device reference --stiffness 2000",
        "worst --family impact --evaluations 40 --seconds 0.5",
    ],
)
def test_the_commands_that_compare_laws_take_it(command: str) -> None:
    assert "damped" in {row["law"] for row in rows(*command.split(), "--law", "mine.py:Damped")}


def test_an_ablation_looks_for_its_parts() -> None:
    result = run("ablation", "--law", "mine.py:Damped", "--no-files")
    assert result.exit_code == 2
    said = " ".join(result.stderr.split())
    assert "damped has no boolean parameter" in said
    assert "nothing can be taken away; name a change" in said


def test_its_fields_declare_what_is_shown_and_tuned() -> None:
    """`ebac laws` showed neither unit nor range, and `ebac tune` refused it."""
    short = ["-c", "d1K10", "--hands", "1", "--evaluations", "3", "--seconds", "0.5"]
    refused = run("tune", "mine.py:Damped", *short)
    assert refused.exit_code == 2
    assert "Error: Damped.damping = 30: declares no low and no high" in refused.stderr
    meta = '{"unit": "N s/m", "low": 0, "high": 90, "meaning": "in contact"}'
    text = MINE.replace("import dataclass", "import dataclass, field")
    text = text.replace("= 30.0", f"= field(default=30.0, metadata={meta})")
    Path("declares.py").write_text(text, encoding="utf-8")
    (row,) = rows("laws", "declares.py:Damped")
    assert row["parameters"] == [
        {"name": "damping", "unit": "N s/m", "meaning": "in contact", "type": "float", "default": 30.0,
         "low": 0, "high": 90, "designed": 30.0}
    ]  # fmt: skip
    shown = " ".join(run("laws", "declares.py:Damped").stdout.split())
    assert "damping 30 30 0 to 90 N s/m in contact" in shown
    (tuned,) = rows("tune", "declares.py:Damped", *short)
    assert (tuned["law"], tuned["tried"]) == ("damped", 3)
    assert set(tuned["changes"]) <= {"damping"}


@pytest.mark.parametrize("command", ["wall", "study -c d1K10", "worst --family impact"])
def test_a_change_beyond_the_range_of_its_field_is_refused(command: str) -> None:
    """Only `ebac tune` kept to the range."""
    meta = '{"unit": "N s/m", "low": 0, "high": 90}'
    text = MINE.replace("import dataclass", "import dataclass, field")
    text = text.replace("= 30.0", f"= field(default=30.0, metadata={meta})")
    Path("declares.py").write_text(text, encoding="utf-8")
    words = [*command.split(), "--law", "declares.py:Damped", "--no-files", "--change"]
    result = run(*words, "damping=-5")
    assert result.exit_code == 2
    assert "Damped.damping = -5 N s/m: must lie in [0, 90] N s/m" in " ".join(result.stderr.split())


WHOLE = """
from dataclasses import dataclass


@dataclass
class Window:
    rows: int = 3
    on: bool = True

    def step(self, port):
        return port.f_env / range(self.rows)[-1] if self.on else port.f_env

    def reset(self):
        pass
"""


@pytest.mark.parametrize(
    ("change", "refused"),
    [
        ("rows=4", ""),
        ("on=off", ""),
        ("rows=1.5", "Window.rows = 1.5: must be a whole number"),
        ("rows=inf", "Window.rows = inf: must be a whole number"),
        ("rows=on", "Window.rows = True: must be a number"),
        ("on=2", "Window.on = 2.0: must be on or off, in Python True or False"),
    ],
)
def test_a_change_is_of_the_type_that_its_field_declares(
    change: str, refused: str, tmp_path: Path
) -> None:
    """A whole number was set to 1.5, or to 4.0, with which Python does not count."""
    (tmp_path / "whole.py").write_text(WHOLE, encoding="utf-8")
    words = ["wall", "--law", f"{tmp_path / 'whole.py'}:Window", "--change", change, "--no-files"]
    done = CliRunner().invoke(app, [*words, "--seconds", "1"])
    assert done.exit_code == (2 if refused else 0), done.output
    assert refused in " ".join(done.output.split())


def test_a_search_changes_its_parameters_and_says_how_to_simulate_its_hand_again() -> None:
    command = "worst --law mine.py:Damped --family impact --evaluations 40 --seconds 0.5 --out"
    words = command.split()
    result = run(*words, "found")
    assert "ebac wall --law mine.py:Damped --scenario found/" in " ".join(result.stdout.split())
    told = run(*words, "other", "--change", "dampin=40")
    assert told.exit_code == 2
    assert "did you mean 'damping'" in told.stderr


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("mine.py", "--law mine.py: its laws are mine.py:Damped, mine.py:Designed, mine.py:Direct"),
        ("mine.py:Dampd", "mine.py has no Dampd; its laws are mine.py:Damped"),
        ("mine.py:Direct", "its name is direct, as that of another law"),
        ("mine.py:Damped,mine.py:softer", "its name is damped, as that of another law"),
        ("mine.py:Needs", "Needs() raises TypeError: Needs.__init__() missing 1 required positional argument"),
        ("mine.py:NoReset", "NoReset is no law: it needs reset()"),
        ("empty.py:Mine", "empty.py has no Mine; it has no law"),
        ("zero.py:X", "--law zero.py:X: zero.py raises ZeroDivisionError: division by zero (zero.py, line 2)"),
        ("grammar.py:X", "grammar.py raises SyntaxError: invalid syntax (grammar.py, line 1)"),
        ("lacks.py:X", "lacks.py raises ModuleNotFoundError: No module named 'not_there' (lacks.py, line 1)"),
        ("nowhere.py:Mine", "there is no file nowhere.py"),
        ("nowhere:Mine", "there is no module nowhere; a law of your own is given as FILE.py:NAME"),
        (":Mine", "a law of your own is given as FILE.py:NAME or MODULE:NAME"),
        ("mine.Damped", "no such name; `ebac laws` lists all; a law of your own is given as FILE.py:NAME"),
    ],
)  # fmt: skip
def test_what_is_no_law_is_refused_by_its_name(word: str, told: str) -> None:
    files = {
        "empty": "",
        "zero": "\nx = 1 / 0\n",
        "grammar": "def f(:\n",
        "lacks": "import not_there\n",
    }
    for name, text in files.items():
        Path(f"{name}.py").write_text(text, encoding="utf-8")
    result = run("wall", "--law", word, "--seconds", "1")
    assert result.exit_code == 2
    assert told in " ".join(result.stderr.split())
    assert "Traceback" not in result.output
    assert not list(Path().glob("ebac-*"))


def test_what_a_law_raises_ends_the_run_and_names_it() -> None:
    Path("raises.py").write_text(
        re.sub(r"return port.*", "raise OverflowError('wide')", MINE), encoding="utf-8"
    )
    result = run("wall", "--law", "raises.py:Damped", "--no-files")
    assert result.exit_code != 0
    assert "damped" in result.stderr.lower()
    assert "wide" in result.stderr
    assert "Traceback" not in result.output


COMPILED = (
    "import ebac\nheavy = ebac.TCADamped(virtual_damping=50.0, timing=ebac.Timing(delay=1))\n"
)


def test_a_compiled_law_runs_on_drives_and_in_a_gastroscopy() -> None:
    Path("compiled.py").write_text(COMPILED, encoding="utf-8")
    assert run("demo", "joystick").exit_code == 0
    found = rows(
        "run", "joystick.toml", "--virtual", "--law", "compiled.py:heavy", "--seconds", "0.5"
    )
    assert found[0]["law"] == "tca-damped"
    assert (
        rows("gastroscopy", "--law", "compiled.py:heavy", "--seconds", "0.2")[0]["law"]
        == "tca-damped"
    )


@pytest.mark.parametrize(
    "command",
    [
        "run joystick.toml --virtual",
        "gastroscopy",
        "gastroscopy master --simulated",
        "gastroscopy drives --seconds 1",
        "live --virtual",
    ],
)
def test_a_loop_without_python_refuses_a_law_in_python_by_its_name(command: str) -> None:
    assert run("demo", "joystick").exit_code == 0
    result = run(*command.split(), "--law", "mine.py:Damped")
    assert result.exit_code == 2
    told = " ".join(result.stderr.split())
    assert "Error: --law mine.py:Damped: is written in Python" in told  # it said --law damped
    assert "write it in C++" in told
    assert not list(Path().glob("ebac-*"))


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="loops in real time need Linux")
@pytest.mark.real_time
def test_a_compiled_law_runs_the_joystick_of_a_gastroscopy_on_drives() -> None:
    Path("compiled.py").write_text("import ebac\nheavy = ebac.TCADamped\n", encoding="utf-8")
    run("gastroscopy", "drives", "--law", "compiled.py:heavy", "--seconds", "1", "--out", "logs")
    assert ebac.load("logs/master.mcap").law == "tca-damped"


def test_a_module_that_does_not_load_says_why() -> None:
    text = "try:\n    1 / 0\nexcept ZeroDivisionError as error:\n    raise ImportError('failed') from error\n"
    Path("stale.py").write_text(text, encoding="utf-8")
    assert "ZeroDivisionError" in run("wall", "--law", "stale.py:X", "--no-files").stderr


RAISES = """
class Raises:
    name = "raises"

    def __init__(self):
        self.ticks = 0

    def step(self, port):
        self.ticks += 1
        if self.ticks > 20:
            raise RuntimeError("too warm")
        return port.f_env

    def reset(self):
        self.ticks = 0


class Undesigned(Raises):
    @classmethod
    def design(cls, facts, timing, **changes):
        return cls(1 / 0)
"""


def without_notes(output: str) -> list[str]:
    """Return the lines of an output but for notes, as that many runs of a law in Python take their time."""
    return [line for line in output.splitlines() if not line.startswith("Note: ")]


@pytest.mark.parametrize(
    "words",
    [
        ["wall"],
        ["study", "-c", "d1K10"],
        ["stiffest", "--delay", "1"],
        ["worst"],
        ["zwidth"],
        ["map", "--side", "2"],
        ["shapes"],
        ["tissue"],
        ["engines"],
        ["random-worlds", "--kind", "balls", "--hands", "2"],
    ],
    ids=lambda words: words[0],
)
def test_an_error_in_a_law_ends_every_command_in_one_line(words: list[str], mine: Path) -> None:
    """`random-worlds` swallowed it, and all but `wall` ended with a traceback."""
    mine.write_text(RAISES, encoding="utf-8")
    result = run(*words, "--law", "mine.py:Raises", "--no-files")
    assert result.exit_code == 1
    assert isinstance(result.exception, SystemExit)
    (error,) = without_notes(result.output)
    assert error.startswith("Error: raises: fault 4 (the law raises raised RuntimeError: ")
    assert "too warm (mine.py, line 11)) in tick 20, t = 0.02 s: " in error


def test_an_error_in_the_design_of_a_law_is_one_line(mine: Path) -> None:
    mine.write_text(RAISES, encoding="utf-8")
    result = run("study", "-c", "d1K10", "--law", "mine.py:Undesigned", "--no-files")
    assert result.exit_code == 1
    assert without_notes(result.output) == [
        "Error: --law mine.py:Undesigned raises ZeroDivisionError: division by zero (mine.py, line 21)"
    ]


def test_a_handle_that_leaves_the_workspace_is_noted(mine: Path) -> None:
    """A law with a wrong sign rested at 274 mm on a device of 60 mm, without a word."""
    mine.write_text(
        MINE + '\n\nclass Wrong(Damped):\n    name = "wrong"\n\n    def step(self, port):\n'
        "        return -port.f_env\n",
        encoding="utf-8",
    )
    result = run("wall", "--law", "mine.py:Wrong,direct", "--no-files")
    (note,) = [line for line in result.stderr.splitlines() if line.startswith("Note: ")]
    said = (
        r"Note: wrong: the handle leaves the workspace of its device after 0\.\d+ s and is up to "
    )
    assert re.match(said, note)
    assert "on axis 0; the stops of the device stand at 52.36 mm" in note
