"""Every command in README and docs is run, or says why not and is at least one that exists.

A line of a fenced `sh` block may say, where readers see it too:

    # takes 20 s                  run only where EBAC_ALL_COMMANDS is set, as .ci/run does
    # takes 3 min, not run by CI  never run, but its options are checked
    # needs a CAN interface       the same, for the whole block when it stands alone on a line
    # runs until Ctrl-C           run in the background while the rest of the page runs
"""

import os
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer.main

import ebac
from ebac.cli import app

ROOT = Path(__file__).parents[2]
#: .ci/run runs the first two blocks of the README itself.
RUN_BY_CI = {"README.md": 2}


@dataclass(frozen=True, kw_only=True)
class Command:
    """One line of a block."""

    page: str
    text: str
    needs: bool
    seconds: float
    left_out: bool
    endless: bool

    @property
    def runs(self) -> bool:
        """Whether a test runs it at all."""
        return not (self.needs or self.left_out)

    @property
    def slow(self) -> bool:
        """Whether it says that it takes time."""
        return self.seconds > 0


def pages() -> list[Path]:
    """README and docs, tutorials included."""
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def commands(page: Path) -> list[Command]:
    """Every command of the fenced `sh` blocks of a page, in order."""
    name = page.relative_to(ROOT).as_posix()
    blocks = re.findall(r"^( *)```sh\n(.*?)^\1```", page.read_text(encoding="utf-8"), re.M | re.S)
    return [
        command
        for _, block in blocks[RUN_BY_CI.get(name, 0) :]
        for command in _of_block(name, block)
    ]


def _of_block(page: str, block: str) -> list[Command]:
    found, needs = [], False
    for line in block.splitlines():
        text, _, remark = line.strip().partition("#")
        if not text:
            needs = needs or remark.strip().startswith("needs")
            continue
        takes = re.search(r"takes (\d+) s\b", remark)
        found.append(
            Command(
                page=page,
                text=text.strip(),
                needs=needs or remark.strip().startswith("needs"),
                seconds=float(takes[1]) if takes else 0.0,
                left_out="not run by CI" in remark,
                endless="until Ctrl-C" in remark,
            )
        )
    return found


def inline(page: Path) -> list[str]:
    """Commands of ebac within sentences and tables that are written out: no capitals, no dots for more."""
    text = re.sub(r"^ *```.*?^ *```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    spans = re.findall(r"`(ebac [a-z][^`]*)`", text)
    return sorted({span for span in spans if not re.search(r"[A-Z]{3}|\.\.\.|,", span)})


ALL = "EBAC_ALL_COMMANDS" in os.environ
PAGES = [page for page in pages() if commands(page)]
by_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)


def test_there_are_commands_and_most_of_them_are_run() -> None:
    found = [command for page in PAGES for command in commands(page)]
    assert len(found) > 30
    assert sum(command.runs for command in found) > 0.5 * len(found)


def files(folder: Path) -> None:
    """What the pages take for granted: recorded paths, a log of a press, the examples."""
    (folder / "examples").symlink_to(ROOT / "examples")
    turn = np.linspace(0, 2 * np.pi, 400)
    rng = np.random.default_rng(1)
    for name, path in (
        ("line", np.column_stack([80 * turn / 6.3, 40 * turn / 6.3])),
        ("circle", 40 * np.column_stack([np.cos(turn), np.sin(turn)])),
    ):
        noisy = path + rng.normal(0, 0.1, path.shape)
        np.savetxt(
            folder / f"{name}.csv", noisy, delimiter=",", header="x [mm],y [mm]", comments=""
        )
    hand = ebac.Hand(path=[ebac.Step(at=1.0)])
    ebac.simulate(ebac.Scenario(hand=hand, seconds=4), "ebac").to_csv(folder / "press.csv")


def environment(home: Path) -> dict[str, str]:
    """Commands find this interpreter and this package, and leave nothing in a home."""
    binaries = home / "bin"
    binaries.mkdir()
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


@pytest.mark.real_time  # where a run of a page ends by a stall, the whole page is run again
@by_page
def test_the_commands_of_a_page_run(page: Path, tmp_path: Path) -> None:
    wanted = [c for c in commands(page) if c.runs and (ALL or not c.slow)]
    if not wanted:
        pytest.skip("all its commands take longer: EBAC_ALL_COMMANDS=1 runs them")
    home, room = tmp_path / "home", tmp_path / "room"
    home.mkdir()
    room.mkdir()
    files(room)
    env = environment(home)
    run = subprocess.run(
        ["bash", "-c", script(wanted)],
        cwd=room,
        env=env,
        input="y\n" * 10,  # what asks before it writes to a drive
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert run.returncode == 0, f"{run.stdout[-1500:]}\n{run.stderr[-3000:]}"


def script(wanted: list[Command]) -> str:
    """What bash runs; what runs until Ctrl-C gets it at the end, and must have lived until then."""
    stop = 'for pid in "${pids[@]}"; do kill -INT $pid && wait $pid || true; done'
    # With job control, what runs in the background hears SIGINT.
    lines = ["set -em", "pids=()", f"trap '{stop}' EXIT"]
    for command in wanted:
        lines += [f"{command.text} & pids+=($!); sleep 2"] if command.endless else [command.text]
    return "\n".join([*lines, 'for pid in "${pids[@]}"; do kill -0 $pid; done'])


def refused(text: str) -> Any:
    """Parse a command line of ebac without running it; what the parser has against it, or None."""
    words = shlex.split(text, comments=True)[1:]
    command: Any = typer.main.get_command(app)
    name = "ebac"
    while hasattr(command, "commands") and words and words[0] in command.commands:
        name = words.pop(0)
        command = command.commands[name]
    if hasattr(command, "commands") and words and not words[0].startswith("-"):
        return f"no command {words[0]!r}"
    try:
        command.make_context(name, words)
    except Exception as error:
        kind = type(error).__name__
        if "does not exist" in str(getattr(error, "message", "")):  # a file of the reader's own
            return None
        return (
            None
            if kind in ("Exit", "MissingParameter", "NoArgsIsHelpError")
            else f"{kind}: {error}"
        )
    return None


@pytest.mark.parametrize("page", pages(), ids=lambda page: page.stem)
def test_every_command_is_one_that_exists(page: Path, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    files(tmp_path)
    lines = [c.text for c in commands(page) if c.text.startswith("ebac ")] + inline(page)
    wrong = {line: why for line in lines if (why := refused(line))}
    assert not wrong


def test_a_command_that_does_not_exist_is_noticed() -> None:
    assert refused("ebac wall --wal tca")
    assert refused("ebac wal")
    assert refused("ebac wall --law tca") is None
