"""Put each bug of `mutants.toml` into the code, and see whether tests and fault campaign notice.

    python tests/mutants/run.py --build build

By hand or at night: half a minute of a core for each bug in C++. Ctrl-C ends it with the score so far. Nothing in the
clone is changed. A header with its bug lies in a folder before all others, and what includes it, the campaign or a
test, is compiled anew beside the library of the build, which must be that of this clone. A Python module with its bug
replaces the one of the package in a copy.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Generator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
#: One file of all that the campaign is made of: its headers are compiled once.
CAMPAIGN = (
    "cpp/ebac/faults/campaign.cpp",
    "cpp/ebac/faults/case.cpp",
    "cpp/ebac/faults/case_setup.cpp",
    "cpp/ebac/faults/referee.cpp",
    "cpp/ebac/faults/test_bench.cpp",
    "tests/cpp/faults_test.cpp",
)
#: Longest run of a compiled program [s], seven times that of the slowest: a loop that never ends is noticed, too.
LONGEST = 300.0


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """One bug."""

    name: str
    file: str
    old: str
    new: str
    tests: list[str]

    def text(self) -> str:
        """Return the file with the bug.

        Raises
        ------
        ValueError
            When the line does not stand once in the file.
        """
        text = (ROOT / self.file).read_text(encoding="utf-8")
        if text.count(self.old) != 1 or "\n" in self.old + self.new or self.old == self.new:
            raise ValueError(f"{self.name}: must change one line of {self.file}: {self.old!r}")
        return text.replace(self.old, self.new)


@dataclass(frozen=True, kw_only=True)
class Found:
    """Who noticed a bug; None for what was not asked."""

    name: str
    tests: bool | None
    campaign: bool | None

    def verdict(self) -> str:
        """Return who noticed it and who did not."""
        words = {True: "noticed by", False: "NOT noticed by"}
        asked = {"the tests": self.tests, "the campaign": self.campaign}
        found = [f"{words[one]} {who}" for who, one in asked.items() if one is not None]
        return ", ".join(found) or "nobody was asked"


def mutants() -> list[Mutant]:
    """Return all bugs of the file beside this one."""
    table = tomllib.loads(Path(__file__).with_name("mutants.toml").read_text(encoding="utf-8"))
    return [Mutant(**one) for one in table["mutant"]]


class Machine:
    """Compiler and library."""

    def __init__(self, build: Path, folder: Path) -> None:
        self.library = build / "libebac.a"
        commands = (build / "build.ninja").read_text(encoding="utf-8")
        self.flags = sorted(set(re.findall(r"-isystem \S+", commands)))
        self.folder = folder
        self.ccache = [] if shutil.which("ccache") is None else ["ccache"]
        self.campaign = folder / "campaign.cpp"
        lines = [f'#include "{ROOT / one}"' for one in CAMPAIGN]
        self.campaign.write_text("\n".join(lines) + "\n", encoding="utf-8")

    def fails(
        self, source: Path, folder: Path, overlay: Path | None = None, file: Path | None = None
    ) -> bool:
        """Return whether a test fails that is compiled in `folder`.

        The headers of `overlay` come first, and `file`, a source with a bug, takes the place of the library's own.
        """
        program = folder / source.stem
        headers = [one for one in (overlay, ROOT / "cpp", ROOT / "tests/cpp") if one is not None]
        things = [self.compiled(one, folder, headers) for one in (source, file) if one is not None]
        libraries = [str(self.library), "-lgtest_main", "-lgtest", "-lpthread"]
        made_of(source, ["g++", *map(str, things), *libraries, "-o", str(program)])
        try:
            ran = subprocess.run(
                [str(program), "--gtest_brief=1"], capture_output=True, check=False, timeout=LONGEST
            )
        except subprocess.TimeoutExpired:
            return True
        return ran.returncode != 0

    def compiled(self, source: Path, folder: Path, headers: list[Path]) -> Path:
        """Compile a file in `folder`; return the object."""
        thing = folder / f"{source.stem}.o"
        flags = [word for flag in self.flags for word in flag.split()]
        options = ["-std=c++20", "-O1", "-fno-math-errno", "-ffp-contract=off", "-w"]
        paths = [f"-I{one}" for one in headers]
        made_of(
            source,
            [*self.ccache, "g++", *options, *paths, *flags, "-c", str(source), "-o", str(thing)],
        )
        return thing

    def check(self, tests: set[str], *, campaign: bool) -> None:
        """Raise RuntimeError where a test fails without any bug: it would notice them all."""
        sources = {f"test {one}": test_source(one) for one in sorted(tests)}
        if campaign:
            sources["campaign"] = self.campaign
        for name, source in sources.items():
            if self.fails(source, self.folder):
                raise RuntimeError(f"the {name} fails without any bug")

    def judge(self, mutant: Mutant, *, tests: list[str], campaign: bool) -> tuple[bool, bool]:
        """Return whether tests and campaign fail with a bug."""
        with tempfile.TemporaryDirectory(dir=self.folder) as name:
            overlay = Path(name)
            made = overlay / mutant.file.removeprefix("cpp/")
            made.parent.mkdir(parents=True)
            made.write_text(mutant.text(), encoding="utf-8")
            file = made if made.suffix == ".cpp" else None
            by_tests = any(self.fails(test_source(one), overlay, overlay, file) for one in tests)
            return by_tests, campaign and self.fails(self.campaign, overlay, overlay, file)


def made_of(source: Path, command: list[str]) -> None:
    """Run a compiler or linker; raise RuntimeError where it fails."""
    made = subprocess.run(command, capture_output=True, text=True, check=False)
    if made.returncode != 0:
        raise RuntimeError(f"{source.name} does not compile: {made.stderr[-2000:]}")


def test_source(name: str) -> Path:
    """Return the file of a test in C++."""
    return ROOT / f"tests/cpp/{name}_test.cpp"


def fails_in_python(mutant: Mutant, folder: Path) -> bool:
    """Return whether the tests of a Python mutant fail, in a copy of the package."""
    with tempfile.TemporaryDirectory(dir=folder) as name:
        copy = Path(name) / "python"
        shutil.copytree(ROOT / "python", copy, ignore=shutil.ignore_patterns("__pycache__"))
        (copy.parent / mutant.file).write_text(mutant.text(), encoding="utf-8")
        files = [str(ROOT / f"tests/python/{one}.py") for one in mutant.tests]
        command = [sys.executable, "-m", "pytest", "-qx", "-m", "", "-pno:cacheprovider", *files]
        environment = {**os.environ, "PYTHONPATH": str(copy)}
        ran = subprocess.run(
            command, cwd=ROOT, env=environment, capture_output=True, check=False, timeout=600
        )
        return ran.returncode != 0


def judged(chosen: list[Mutant], build: Path, only: str, jobs: int) -> Generator[Found]:
    """Give what became of each bug, in the order of their ends."""
    compiled = [one for one in chosen if one.file.endswith("pp")]
    by_tests, by_campaign = only != "campaign", only != "tests"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        machine = Machine(build, folder) if compiled else None
        if machine is not None:
            named = {test for one in compiled for test in one.tests if by_tests}
            machine.check(named, campaign=by_campaign)

        def one(mutant: Mutant) -> Found:
            if machine is None or mutant.file.endswith(".py"):
                found = fails_in_python(mutant, folder) if by_tests else None
                return Found(name=mutant.name, tests=found, campaign=None)
            tests = mutant.tests if by_tests else []
            noticed = machine.judge(mutant, tests=tests, campaign=by_campaign)
            return Found(
                name=mutant.name,
                tests=noticed[0] if by_tests else None,
                campaign=noticed[1] if by_campaign else None,
            )

        pool = ThreadPoolExecutor(jobs)
        try:
            for future in as_completed([pool.submit(one, mutant) for mutant in chosen]):
                yield future.result()
        finally:
            pool.shutdown(cancel_futures=True)


def main() -> int:
    """Run, print the score, and return 1 where a bug was not noticed by the tests, 130 after Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--build", type=Path, default=ROOT / "build", help="build with libebac.a")
    parser.add_argument("--only", choices=["campaign", "tests"], default="", help="who is asked")
    parser.add_argument("--name", action="append", help="only mutants with this in name or file")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    chosen = [
        one
        for one in mutants()
        if not given.name or any(part in f"{one.name} {one.file}" for part in given.name)
    ]
    results: list[Found] = []
    stopped = False
    try:
        with closing(judged(chosen, given.build.resolve(), given.only, given.jobs)) as verdicts:
            for one in verdicts:
                results.append(one)
                line = f"{len(results)} of {len(chosen)}: {one.name}: {one.verdict()}"
                print(line, file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        stopped = True
        print(f"stopped after {len(results)} of {len(chosen)}", file=sys.stderr)
    score = {
        who: [sum(found), len(found)]
        for who in ("tests", "campaign")
        if (found := [bool(getattr(r, who)) for r in results if getattr(r, who) is not None])
    }
    if given.json:
        print(json.dumps({"score": score, "rows": [asdict(one) for one in results]}))
    else:
        for one in results:
            missed = [who for who in ("tests", "campaign") if getattr(one, who) is False]
            if missed:
                print(f"not noticed by the {' and the '.join(missed)}: {one.name}")
        for who, (noticed, of) in score.items():
            print(f"{who}: {noticed} of {of} ({100 * noticed / of:.0f} %)")
    if stopped:
        return 130
    return 0 if all(one.tests is not False for one in results) else 1


if __name__ == "__main__":
    sys.exit(main())
