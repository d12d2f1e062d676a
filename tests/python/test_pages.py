"""The Python of README and docs is run: the blocks of a page in order, as one program in an empty folder.

A block may say in a comment on a line of its own, where readers see it too:

    # needs a force sensor  not run
    # takes 20 s            run only where EBAC_ALL_COMMANDS is set, as .ci/run does

Blocks with tests are run by pytest, twice: the first run writes their golden traces.
"""

import ast
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

import ebac

ROOT = Path(__file__).parents[2]
ALL = "EBAC_ALL_COMMANDS" in os.environ


@dataclass(frozen=True, kw_only=True)
class Block:
    """One fenced `python` block."""

    line: int
    text: str

    @property
    def needs(self) -> bool:
        """Whether it needs what a test has not."""
        return bool(re.search(r"^# needs ", self.text, re.M))

    @property
    def slow(self) -> bool:
        """Whether it says that it takes time."""
        return bool(re.search(r"^# takes \d+ s$", self.text, re.M))

    @property
    def tests(self) -> bool:
        """Whether pytest would find something in it."""
        names = [n.name for n in ast.parse(self.text).body if hasattr(n, "name")]
        return any(name.startswith(("test_", "Test")) for name in names)


def blocks(page: Path) -> list[Block]:
    """Every fenced `python` block of a page; cells of notebooks are run when the site is built."""
    text = page.read_text(encoding="utf-8")
    found = re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S)
    return [Block(line=text[: m.start()].count("\n") + 2, text=m[1]) for m in found]


PAGES = [
    page
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
    if any(not block.needs for block in blocks(page)) and "code-cell" not in page.read_text()
]
by_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)


def program(chosen: list[Block]) -> str:
    """Return blocks as one file in which each stands in its line of the page, for the traceback."""
    lines: list[str] = []
    for block in chosen:
        lines += [""] * (block.line - 1 - len(lines)) + block.text.splitlines()
    return "\n".join([*lines, ""])


@by_page
def test_the_python_of_a_page_runs(page: Path, tmp_path: Path) -> None:
    wanted = [b for b in blocks(page) if not b.needs and (ALL or not b.slow)]
    if not wanted:
        pytest.skip("all its blocks take longer: EBAC_ALL_COMMANDS=1 runs them")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    if "press.csv" in page.read_text(encoding="utf-8"):
        hand = ebac.Hand(path=[ebac.Step(at=1.0)])
        ebac.simulate(ebac.Scenario(hand=hand, seconds=4), "ebac").to_csv(tmp_path / "press.csv")
    file = tmp_path / f"test_{page.stem}.py"
    file.write_text(program(wanted), encoding="utf-8")
    as_script, as_tests = [sys.executable, file.name], [sys.executable, "-m", "pytest", "-q"]
    runs = [as_script]
    if any(block.tests for block in wanted):
        runs = [[*as_tests, "--ebac-update", file.name], [*as_tests, file.name]]
    for run in runs:
        done = subprocess.run(
            run,
            cwd=tmp_path,
            env=environment(),
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
        assert done.returncode == 0, f"{done.stdout[-3000:]}\n{done.stderr[-3000:]}"


def environment() -> dict[str, str]:
    """Return where this package is found, and no window."""
    package = str(Path(ebac.__file__).parents[1])
    known = filter(None, [package, os.environ.get("PYTHONPATH")])
    return {**os.environ, "PYTHONPATH": os.pathsep.join(known), "MPLBACKEND": "Agg"}


def test_most_of_the_python_in_the_pages_is_run() -> None:
    found = [block for page in PAGES for block in blocks(page)]
    assert len(found) > 15
    assert sum(not (block.needs or block.slow) for block in found) > 0.7 * len(found)


def test_a_block_stands_in_its_line_and_says_what_it_needs(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "# Page\n\n```python\n# takes 3 s\na = 1\n```\n\n```python\n# needs luck\na / 0\n```\n"
    )
    first, second = blocks(page)
    assert (first.slow, first.needs, first.tests, first.line) == (True, False, False, 4)
    assert second.needs
    assert program([first, second]).splitlines()[8:] == ["# needs luck", "a / 0"]
