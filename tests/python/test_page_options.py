"""Every option of a command that a page names, in a sentence too, is one the command has today."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from ebac.cli import app

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def commands(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    yield path, command
    for name, one in getattr(command, "commands", {}).items():
        yield from commands(one, (*path, name))


KNOWN = dict(commands(get_command(app)))


def named(text: str) -> Iterator[str]:
    """Give what stands behind `ebac` in a page: in lines of their own and between backticks."""
    for line in text.splitlines():
        yield from re.findall(r"^\s*(?:[A-Z_]+=\S+ )*ebac ([a-z][^#]*)", line)
        yield from re.findall(r"`ebac ([a-z][^`]*)`", line)


def wrong(words: list[str]) -> list[str]:
    """Return what is no command, or no option of it."""
    path: tuple[str, ...] = ()
    while len(path) < len(words) and (*path, words[len(path)]) in KNOWN:
        path = (*path, words[len(path)])
    if not path:
        return words[:1]
    has = {n for p in KNOWN[path].params for n in (*p.opts, *p.secondary_opts)} | {"--help"}
    given = [word.partition("=")[0] for word in words if re.match(r"--[a-z]", word)]
    return [f"{' '.join(path)} {word}" for word in given if word not in has]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_a_page_names_commands_and_options_that_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert [bad for words in named(text) for bad in wrong(words.split())] == []


def test_an_old_option_is_found() -> None:
    assert wrong(["jitter", "--rt", "off"]) == ["jitter --rt"]
    assert wrong(["wal"]) == ["wal"]
    assert wrong(["drive", "plan", "joystick", "--interface", "ebac"]) == []
