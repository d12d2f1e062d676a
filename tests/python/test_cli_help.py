"""Help texts: they name what a command does by default, and are whole in 80 columns."""

from collections.abc import Iterator
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from ebac.cli import app
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
