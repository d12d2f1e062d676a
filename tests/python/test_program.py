"""The program around its commands: Ctrl-C while it starts, a reader that has gone, a full disk, no output at all."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

EBAC = [sys.executable, "-m", "ebac"]

#: Sends itself Ctrl-C while the commands are imported.
WHILE_IT_IMPORTS = """
import signal, sys
from ebac.__main__ import main

class Finder:
    def find_spec(name, path=None, target=None):
        if name == "ebac.cli.options":
            signal.raise_signal(signal.SIGINT)

sys.meta_path.insert(0, Finder)
sys.argv = ["ebac", "laws"]
main()
"""


def test_ctrl_c_while_it_starts_ends_it_in_silence(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", WHILE_IT_IMPORTS], cwd=tmp_path, capture_output=True, text=True
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


@pytest.mark.parametrize("words", ["laws", "laws --json", "--version"])
def test_a_reader_that_has_gone_ends_it_well(words: str) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "wb") as pipe:
        done = subprocess.run([*EBAC, *words.split()], stdout=pipe, stderr=subprocess.PIPE)
    assert (done.returncode, done.stderr) == (0, b"")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("words", ["laws", "laws --json"])
def test_a_full_disk_is_one_line(words: str) -> None:
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            [*EBAC, *words.split()], stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert done.returncode == 1
    assert done.stderr == ("Error: standard output: cannot be written (No space left on device)\n")


def test_without_a_standard_output_it_works() -> None:
    done = subprocess.run(["sh", "-c", f'"{sys.executable}" -m ebac laws >&-'], capture_output=True)
    assert (done.returncode, done.stderr) == (0, b"")
