"""Help texts: they name what a command does by default, and are whole in 80 columns."""

import os
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from typing import Any

import pytest
import typer.main
from typer.testing import CliRunner

from ebac.cli import app, completion
from ebac.cli.wall.wall import DEFAULT_LAWS


def helped(*words: str) -> str:
    text = CliRunner().invoke(app, [*words, "--help"]).output
    return " ".join(text.replace("│", " ").split())


def commands(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Give every command with the words that call it."""
    yield path, command
    for name, one in getattr(command, "commands", {}).items():
        yield from commands(one, (*path, name))


EVERY = dict(commands(typer.main.get_command(app)))


def test_the_help_names_the_laws_that_wall_runs() -> None:
    assert f"default: ({', '.join(DEFAULT_LAWS)})" in helped("wall")
    assert len(DEFAULT_LAWS) == 4
    assert "under four laws" in helped()


@pytest.mark.parametrize("name", ["study", "engines", "shapes", "tissue"])
def test_the_help_names_the_laws_that_a_study_runs(name: str) -> None:
    laws = import_module(f"ebac.studies.{name}").LAWS
    assert f"default: ({', '.join(laws)})" in helped(name)


@pytest.mark.parametrize("words", EVERY, ids=" ".join)
def test_help_is_whole_in_80_columns(words: tuple[str, ...]) -> None:
    text = CliRunner().invoke(app, [*words, "--help"], env={"COLUMNS": "80"}).output
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= 80
    shown = text.split()
    for one in EVERY[words].params:
        if getattr(one, "hidden", False):
            continue
        for name in (*one.opts, *one.secondary_opts):
            assert not name.startswith("--") or name in shown, name
    for name, one in getattr(EVERY[words], "commands", {}).items():
        assert one.hidden or name in shown


@pytest.mark.parametrize("words", [["--version"], ["laws", "--json"], ["wall", "-h"]], ids=" ".join)
def test_a_command_does_not_wait_for_the_others(words: list[str]) -> None:
    code = f"""
import atexit, sys
from ebac.cli import app, completion
others = ("numpy", "ebac.cli.drive", "ebac.cli.studies.study", "ebac.cli.teleop")
atexit.register(lambda: print([name for name in others if name in sys.modules], file=sys.stderr))
app({words!r})
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stderr.strip() == "[]"
    assert done.stdout


def test_names_that_an_argument_takes_are_completed() -> None:
    assert completion.data_sets("ta") == ["tapping"]
    assert completion.paper_items("eq1") == ["eq1", "eq10", "eq11", "eq12"]
    assert completion.schemes("waves,eb") == ["waves,ebac"]
    assert completion.several(completion.one_of("png", "pdf", "svg"))("png,p") == [
        "png,png",
        "png,pdf",
    ]


def test_help_is_printed_where_the_output_has_no_bullets() -> None:
    """It ended in a traceback."""
    environment = {**os.environ, "PYTHONIOENCODING": "latin-1"}
    done = subprocess.run(
        [sys.executable, "-m", "ebac", "map", "--help"],
        env=environment, capture_output=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, b"")
