"""Wrong input of every option of every command: exit code 2, and one sentence that names the option."""

import inspect
import re
import signal
import types
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Union, get_args, get_origin

import pytest
import typer.main
from typer.testing import CliRunner

from ebac import datasets
from ebac.cli import app
from ebac.cli.wrong_input import IN_CONFIGURATION, IN_FILES, OF_OTHERS
from ebac.hardware import Configuration

#: What a command needs beside the option that is wrong.
NEEDS = {
    "identify arm": ["arm.csv"],
    "identify device": ["device.csv"],
    "identify gains": ["press.csv"],
    "identify log": ["arm.csv"],
    "identify scale": ["sway.mcap"],
    "track": ["line.csv"],
    "tune": ["tca"],
    "drive signs": ["joystick.toml", "--simulated"],
    "drive zero": ["joystick.toml", "--simulated"],
    "run": ["joystick.toml", "--simulated", "--no-files"],
    "log info": ["run.npz"],
    "log export": ["run.npz", "new.csv"],
    "log repair": ["run.mcap"],
    "log plot": ["run.npz"],
    "drive enable": ["--node", "1", "--yes"],
    "drive profile": ["joystick"],
    "drive timing": ["joystick"],
    "jitter": ["--seconds", "0.01", "--alone"],
    "sensor bias": ["--host", "127.0.0.1"],
    "sensor read": ["--host", "127.0.0.1"],
}
#: The bus in the process, where a command opens one.
BUS = ["--interface", "ebac", "--channel", "joystick"]
#: Options whose text may be anything, or is looked up outside this program.
FREE = {"--host", "--interface", "--channel"}
#: Files that are written, not read.
WRITTEN = {"--out", "--log", "--backup", "--page", "OUT"}
#: Numbers that may be as large, or as far below zero, as one likes.
BOUNDLESS = {"--seed", "--axis", "--switch", "--from", "--to"}


@dataclass(frozen=True)
class Case:
    command: str
    option: str
    kind: str
    words: tuple[str, ...]
    hint: str = ""

    def __str__(self) -> str:
        return f"{self.command} {self.option} {self.kind}".replace(" ", "_")


def leaves(group: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    for name, one in group.commands.items():
        if hasattr(one, "commands"):
            yield from leaves(one, f"{path} {name}".strip())
        else:
            yield f"{path} {name}".strip(), one.callback


def plain(annotation: Any) -> Any:
    """Return what one value of an option is: float, int, str, bool, Path or an enumeration."""
    if get_origin(annotation) is Annotated:
        annotation = annotation.__origin__
    if get_origin(annotation) in (Union, types.UnionType):
        [annotation] = [one for one in get_args(annotation) if one is not type(None)]
    return get_args(annotation)[0] if get_origin(annotation) in (list, tuple) else annotation


def many(annotation: Any) -> int:
    text = str(annotation)
    return len(get_args(get_args(annotation)[0])) if "tuple[" in text else 1


def name_of(parameter: inspect.Parameter) -> tuple[str, bool]:
    """Return how an option or argument is called, and whether it is an argument."""
    [info] = parameter.annotation.__metadata__
    argument = type(info).__name__ == "ArgumentInfo"
    if argument:
        return str(info.metavar or parameter.name.upper()).strip("[]."), True
    long = [n for n in (info.default, *(info.param_decls or ())) if str(n).startswith("--")]
    return (long[0].split("/")[0] if long else f"--{parameter.name.replace('_', '-')}"), False


def cases() -> Iterator[Case]:
    """Give every option's wrong values; what no option differs in, once for each command and type."""
    for command, callback in leaves(typer.main.get_command(app)):
        seen: set[tuple[str, Any]] = set()
        for parameter in inspect.signature(callback).parameters.values():
            name, argument = name_of(parameter)
            kind = plain(parameter.annotation)
            times = 3 if name == "--hand-force" else many(parameter.annotation)
            for what, value, hint in wrong(name, kind):
                words = [value] if argument else [name, *[value] * times]
                if what in ("text", "nan") and (what, kind) in seen:
                    continue
                seen.add((what, kind))
                yield Case(command, name, what, tuple(words), hint)


def test_the_commands_that_have_an_option_of_theirs_are_named() -> None:
    for option, named in OF_OTHERS.items():
        have = {
            command
            for command, callback in leaves(typer.main.get_command(app))
            for parameter in inspect.signature(callback).parameters.values()
            if name_of(parameter)[0] == option
        }
        assert set(named) == have


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["wall", "--law", "tca", "ebac"], "several laws are given as --law tca,ebac"),
        (["sensor", "simulate", "--hand-force", "3"], "--hand-force: needs 3 values after it"),
        (["teleop", "run", "--loss", "10"], "--loss = 10: must lie in [0, 1]; 10 % is 0.1"),
        (["teleop", "run", "--loss", "10%"], "must lie in [0, 1]; 10 % is 0.1"),
        (["stiffest", "--share", "95"], "--share = 95: must lie in (0, 1]; 95 % is 0.95"),
        (["wall", "--delay", "2ms"], "a whole number (in samples); a sample is 1 ms at 1 kHz"),
    ],
)
def test_a_value_is_written_as_the_option_wants_it(words: list[str], says: str) -> None:
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 2
    assert says in " ".join(done.stderr.split())


@pytest.mark.parametrize("option", IN_FILES)
def test_a_fact_that_only_a_file_gives_is_named_by_its_key(option: str) -> None:
    done = CliRunner().invoke(app, ["wall", option, "1"])
    assert done.exit_code == 2
    assert f"{IN_FILES[option]} of the file of --scenario" in " ".join(done.stderr.split())
    preset = CliRunner().invoke(app, ["presets", "reference"]).output
    key, _, part = IN_FILES[option].rpartition("[")
    section = preset.partition(f"[{part}")[2].partition("\n[")[0]
    assert section
    assert not key or f"\n{key.split()[0]} = " in section


def test_a_value_of_a_file_is_not_blamed_on_an_option(tmp_path: Path) -> None:
    """The remedy began with --device-friction-compensation, which nobody had given."""
    (tmp_path / "device.toml").write_text("[device.compensation]\nfriction = 0.05\n")
    words = ["wall", "--law", "ebac", "--no-files", "--scenario", str(tmp_path / "device.toml")]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 2
    assert done.stderr.startswith("Error: Compensation.friction = 0.05 N: ")
    given = CliRunner().invoke(app, [*words, "--device-friction-compensation", "0.06"])
    assert given.stderr.startswith("Error: --device-friction-compensation = 0.06 N: ")


@pytest.mark.parametrize("option", IN_CONFIGURATION)
def test_an_option_that_is_a_key_of_the_configuration_is_named_by_it(option: str) -> None:
    done = CliRunner().invoke(app, ["run", "joystick.toml", option])
    assert done.exit_code == 2
    assert f"{IN_CONFIGURATION[option]} of the configuration" in " ".join(done.stderr.split())
    setting, _, table = IN_CONFIGURATION[option].partition(" in ")
    assert Configuration.from_toml(f"{table}\n{setting}\n[sensor]\nport = 49152\n").observer


def wrong(name: str, kind: Any) -> Iterator[tuple[str, str, str]]:
    if kind in (int, float):
        yield "text", "much", "must be a whole number" if kind is int else "must be a number"
        if name not in BOUNDLESS:
            yield "low", "-1000000000000", ""
            yield "high", "1000000000000" if kind is int else "1e300", ""
    if kind is float:
        yield "nan", "nan", "must"
    if kind is Path and name not in WRITTEN:
        yield (
            "missing",
            "missing.toml" if name in ("--scenario", "--config") else "missing.csv",
            "no such file",
        )
        yield "folder", "folder", "folder"
        yield "other", "picture.png", ""
    if kind is str and name not in FREE:
        yield "name", "nonsense", ""
    if inspect.isclass(kind) and kind.__name__ == "What":
        yield "choice", "nonsense", "there are"


@pytest.fixture(scope="module")
def room(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("room")
    for name in ("arm", "device", "press", "line", "joystick"):
        datasets.write(name, folder)
    (folder / "folder").mkdir()
    (folder / "picture.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(range(256)))
    import ebac

    trace = ebac.simulate(ebac.Scenario(seconds=0.1), "ebac")
    trace.save(folder / "run.npz")
    trace.save(folder / "run.mcap")
    return folder


def _too_long(number: int, frame: object) -> None:
    raise AssertionError("the command began its work")


#: One test for each command: one for each of the thousand cases would take half as long again.
CASES: dict[str, list[Case]] = {}
for _case in cases():
    CASES.setdefault(_case.command, []).append(_case)


@pytest.mark.parametrize("command", CASES)
def test_wrong_input_is_refused_in_a_sentence(
    command: str, room: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(room)
    failed = [f"{case}: {why}" for case in CASES[command] if (why := not_refused(case, room))]
    assert not failed, "\n\n".join(failed)


def not_refused(case: Case, room: Path) -> str:
    """Return what is wrong with how a command answers, or nothing."""
    try:
        refused(case, room)
    except AssertionError as why:
        return str(why) or "fails"
    return ""


def refused(case: Case, room: Path) -> None:
    needs = [] if case.option.isupper() else list(NEEDS.get(case.command, []))
    if case.command == "log export" and case.option == "OUT":
        needs = ["run.npz"]
    if case.command == "log export" and case.option == "FILE":
        case = Case(case.command, case.option, case.kind, (*case.words, "new.csv"), case.hint)
    if (
        case.command.startswith("drive")
        and case.command not in ("drive timing", "drive signs", "drive zero", "drive profile")
        and case.option not in BUS
    ):
        needs += BUS
    before = sorted(path.name for path in room.iterdir())
    usual = signal.signal(signal.SIGALRM, _too_long)
    signal.alarm(10)
    done = CliRunner().invoke(app, [*case.command.split(), *needs, *case.words])
    signal.alarm(0)
    signal.signal(signal.SIGALRM, usual)
    text = " ".join(done.stderr.split())
    assert done.exit_code == 2, (done.exit_code, text, done.output[-600:])
    assert text.startswith("Error: "), text
    assert text.count("Error") == 1, text
    assert case.option in text or any(word in text for word in case.words), text
    assert not case.hint or case.hint in text, text
    assert not re.search(r"Traceback|pydantic|Errno|Input should", text)
    assert sorted(path.name for path in room.iterdir()) == before
