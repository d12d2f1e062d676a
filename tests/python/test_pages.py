"""README, documentation and help are done as they stand: every command and every block of Python, in an empty folder.

Files come from `ebac demo` and from the steps before. `tests/pages/page_rules.py` says what is not run, and why; what
takes seconds is run where EBAC_ALL_COMMANDS is set, as .ci/run does, with fewer hands, points or cases than the page.
"""

import contextlib
import fcntl
import io
import json
import os
import re
import select
import shlex
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import page_process
import pytest
import typer.main
from page_rules import NEVER, SLOW, as_run, rule
from page_steps import ROOT, Step, commands, examples, inline, notebooks, pages, steps

import ebac
from ebac.cli import app

ALL = "EBAC_ALL_COMMANDS" in os.environ
#: Longest time for a page [s].
TIMEOUT = 600 if ALL else 240
COMMANDS = commands()
GROUPS = sorted({" ".join(name.split()[:2]) for name in COMMANDS})


def name_of(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def wanted(found: list[Step], where: str) -> list[Step]:
    """Return the steps that are run now; what takes seconds and stands on several pages, on the first of them."""
    left_out = {NEVER} if ALL else {NEVER, SLOW}
    runs = [s for s in found if action(s.text) not in left_out]
    return [s for s in runs if action(s.text) != SLOW or first_page(s.text) in (where, "")]


@cache
def first_page(text: str) -> str:
    """Return the first page on which a command stands, or nothing."""
    return next((name_of(p) for p in pages() if any(s.text == text for s in steps(p))), "")


def action(command: str) -> str:
    known = rule(command)
    return "" if known is None else known.action


def environment(home: Path) -> dict[str, str]:
    """Return an environment whose `ebac` and `python` are these, and that leaves nothing in a home."""
    binaries = home / "bin"
    binaries.mkdir(parents=True)
    for name, text in (
        ("python", f'exec "{sys.executable}" "$@"'),
        ("ebac", f'exec "{sys.executable}" -m ebac.cli "$@"'),
    ):
        (binaries / name).write_text(f"#!/bin/sh\n{text}\n")
        (binaries / name).chmod(0o755)
    package = str(Path(ebac.__file__).parents[1])
    return {
        **os.environ,
        "PATH": f"{binaries}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": os.pathsep.join(filter(None, [package, os.environ.get("PYTHONPATH")])),
        "HOME": str(home),
        "XDG_STATE_HOME": str(home / "state"),
        "MPLBACKEND": "Agg",
    }


class PageServer:
    """The process of which every page is a fork."""

    def __init__(self) -> None:
        words = [sys.executable, page_process.__file__]
        package = str(Path(ebac.__file__).parents[1])
        env = {**os.environ, "MPLBACKEND": "Agg", "PYTHONPATH": package}
        self._process = subprocess.Popen(
            words,
            env=env,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def follow(self, steps_file: Path, room: Path, env: dict[str, str]) -> None:
        """Have a page followed."""
        answers, printed = steps_file.with_name("input"), steps_file.with_name("output")
        answers.write_text("y\n" * 10)  # what asks before it writes to a drive
        printed.touch()
        request = {
            "steps": str(steps_file),
            "room": str(room),
            "environment": env,
            "input": str(answers),
            "output": str(printed),
        }
        asked, answer = self._process.stdin, self._process.stdout
        assert asked is not None
        assert answer is not None
        print(json.dumps(request), file=asked, flush=True)
        in_time = select.select([answer], [], [], TIMEOUT)[0]
        told = printed.read_text(errors="replace")[-5000:]
        if not in_time:
            self.close()
            pytest.fail(f"not at its end after {TIMEOUT} s\n{told}", pytrace=False)
        judge(int(answer.readline() or 1), told)

    def close(self) -> None:
        """End it, and the page that it may still be at."""
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.communicate()

    @property
    def closed(self) -> bool:
        return self._process.poll() is not None


def follow(found: list[Step], where: str, tmp_path: Path, server: PageServer) -> None:
    """Run steps one after the other in an empty folder, in a process of their own."""
    chosen = wanted(found, where)
    if not chosen:
        pytest.skip("nothing of it is run here, see page_rules.py")
    room = tmp_path / "room"
    room.mkdir()
    env = environment(tmp_path / "home")
    tests = any(step.tests for step in chosen)
    if tests:  # pytest runs them, twice: the first run writes their golden traces
        file = room / "test_page.py"
        file.write_text("\n".join(s.text for s in chosen if s.kind == "python"), encoding="utf-8")
        for words in (["--ebac-update"], []):
            done([sys.executable, "-m", "pytest", "-q", *words, file.name], room, env)
        chosen = [s for s in chosen if s.kind == "sh"]
    file = tmp_path / "steps.json"
    data = [
        {**vars(s), "text": as_run(s.text), "page": where, "action": action(s.text)} for s in chosen
    ]
    file.write_text(json.dumps(data), encoding="utf-8")
    with sensor_port(chosen):
        server.follow(file, room, env)


@contextlib.contextmanager
def sensor_port(chosen: list[Step]) -> Iterator[None]:
    """Wait until no other page has a simulated sensor at the usual UDP port, where these steps start one."""
    if not any("sensor simulate" in step.text for step in chosen):
        yield
        return
    with (Path(tempfile.gettempdir()) / "ebac-pages-sensor-port").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def done(words: list[str], room: Path, env: dict[str, str]) -> None:
    run = subprocess.run(
        words, cwd=room, env=env, capture_output=True, text=True, timeout=TIMEOUT, check=False
    )
    judge(run.returncode, f"{run.stdout[-2000:]}\n{run.stderr[-3000:]}")


@pytest.fixture(scope="module")
def servers() -> Iterator[list[PageServer]]:
    """At most one process for pages; another where a page had to be ended."""
    made: list[PageServer] = []
    yield made
    for one in made:
        one.close()


@pytest.fixture
def server(servers: list[PageServer]) -> PageServer:
    if not servers or servers[-1].closed:
        servers.append(PageServer())
    return servers[-1]


def judge(code: int, told: str) -> None:
    """Fail where a page ended with an error; skip where it lacks a library."""
    if code == 0:
        return
    missing = re.search(
        r"pip install '?ebac\[|No module named '(pandas|h5py|pyarrow|bokeh|trimesh|websockets)'",
        told,
    )
    if missing and not ALL:
        pytest.skip(f"needs the library of an extra: {missing[0]}")
    pytest.fail(told, pytrace=False)


@pytest.mark.real_time  # where a run of a page ends by a stall, the whole page is run again
@pytest.mark.parametrize("page", [p for p in pages() if steps(p)], ids=name_of)
@pytest.mark.slow(every=True)
def test_a_page_can_be_followed(page: Path, tmp_path: Path, server: PageServer) -> None:
    follow(steps(page), name_of(page), tmp_path, server)


#: Commands whose examples CI runs: those that a newcomer meets first. A week is soon enough for the others: their
#: options are checked each time.
IN_CI = ("ebac wall", "ebac run", "ebac study", "ebac worst")


assert set(IN_CI) <= set(GROUPS)


@pytest.mark.real_time
@pytest.mark.parametrize(
    "group", [g if g in IN_CI else pytest.param(g, marks=pytest.mark.weekly) for g in GROUPS]
)
@pytest.mark.slow(every=True)
def test_the_examples_of_a_help_text_run(group: str, tmp_path: Path, server: PageServer) -> None:
    found = [
        s
        for name, c in COMMANDS.items()
        if f"{name} ".startswith(f"{group} ")
        for s in examples(name, c)
    ]
    if not found:
        pytest.skip("its help has no example")
    follow(found, f"{group} --help", tmp_path, server)


@pytest.mark.parametrize("page", notebooks(), ids=name_of)
def test_a_notebook_opens_in_jupyter(page: Path) -> None:
    """The building of the site executes it, in an empty folder, and ends where a cell raises."""
    jupytext = pytest.importorskip("jupytext", reason="opens a page as a notebook")
    notebook = jupytext.read(page)
    assert any(cell.cell_type == "code" for cell in notebook.cells)
    assert notebook.metadata.kernelspec.name == "python3"


@cache
def program() -> Any:
    """Return ebac as a command; to build it takes 40 ms."""
    return typer.main.get_command(app)


def refused(text: str) -> Any:
    """Parse a command line of ebac without running it; what the parser has against it, or None."""
    words = shlex.split(text.partition(">")[0], comments=True)[1:]
    command = program()
    name = "ebac"
    while hasattr(command, "commands") and words and words[0] in command.commands:
        name = words.pop(0)
        command = command.commands[name]
    if hasattr(command, "commands") and words and not words[0].startswith("-"):
        return f"no command {words[0]!r}"
    told = io.StringIO()
    try:
        with contextlib.redirect_stderr(told):
            command.make_context(name, words)
    except Exception as error:
        if "there is no such option" in told.getvalue():
            return told.getvalue()
        kind = type(error).__name__
        missing = "does not exist" in str(
            getattr(error, "message", "")
        )  # a file of the reader's own
        fine = missing or kind in ("Exit", "MissingParameter", "NoArgsIsHelpError")
        return None if fine else f"{kind}: {error}"
    return None


@pytest.mark.parametrize("page", pages(), ids=name_of)
def test_every_command_is_one_that_exists(page: Path) -> None:
    lines = [s.text for s in steps(page) if s.text.startswith("ebac ")] + inline(page)
    assert not {line: why for line in lines if (why := refused(line))}


def test_every_command_of_a_help_text_is_one_that_exists() -> None:
    lines = [
        s.text
        for name, c in COMMANDS.items()
        for s in examples(name, c)
        if s.text.startswith("ebac")
    ]
    assert not {line: why for line in lines if (why := refused(line))}


def test_a_command_that_does_not_exist_is_noticed() -> None:
    assert refused("ebac wall --wal tca")
    assert refused("ebac wal")
    assert refused("ebac wall --law tca") is None


def test_a_command_is_run_with_fewer_hands_before_its_output_goes_elsewhere() -> None:
    assert as_run("ebac study > table.txt").split()[-2:] == [">", "table.txt"]
    assert "--hands" in as_run("ebac study > table.txt").partition(">")[0]
    assert as_run("ebac wall --law tca") == "ebac wall --law tca --seconds 1 --no-files"
    assert as_run("ebac wall") == "ebac wall --seconds 1"
    assert as_run("ebac wall --law tca --out a") == "ebac wall --law tca --out a --seconds 1"
    assert as_run("ebac laws") == "ebac laws"
    assert as_run("ebac study -c holds --law ebac").startswith("ebac study -c hold-K20 --law ebac")


def test_a_block_of_python_is_run_with_fewer_hands() -> None:
    assert as_run("study = ebac.study(ebac.Operators.grid())").endswith(".grid()[::20])")


def test_most_commands_are_run() -> None:
    found = [s.text for page in pages() for s in steps(page)]
    found += [s.text for name, c in COMMANDS.items() for s in examples(name, c)]
    left_out = [text for text in found if action(text) == NEVER]
    assert len(found) > 60
    assert len(left_out) < 0.5 * len(found)


@pytest.mark.parametrize("page", pages(), ids=name_of)
def test_no_block_has_marks_for_machines(page: Path) -> None:
    marks = re.findall(r"# (?:needs |.*(?:by CI|\.ci/|EBAC_)).*", page.read_text(encoding="utf-8"))
    assert marks == []


def test_blocks_are_read_in_order_and_commands_one_by_one(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "1. so\n\n   ```sh\n   ebac wall  # seconds\n   # a remark\n   ebac map \\\n     --side 4\n   ```\n\n"
        "```python\ndef test_it():\n    pass\n```\n"
    )
    first, second, third = steps(page)
    assert (first.kind, first.text, first.line) == ("sh", "ebac wall", 4)
    assert second.text.split() == ["ebac", "map", "--side", "4"]
    assert (third.kind, third.tests, third.line) == ("python", True, 11)


@pytest.mark.parametrize("name", ["damped.hpp", "module.cpp"])
def test_the_law_of_the_page_is_that_of_the_example(name: str) -> None:
    page = (ROOT / "docs/how-to/write_a_law.md").read_text(encoding="utf-8")
    example = (ROOT / "examples/out_of_tree_law" / name).read_text(encoding="utf-8")
    assert f"```cpp\n{example}```" in page
