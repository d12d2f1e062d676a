"""`ebac run --engine-command`: a world computed by another program, and every way in which that can fail."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from busy_machine import patient_file
from typer.testing import CliRunner, Result

import ebac
from ebac import datasets
from ebac.cli import app

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
#: How long a busy machine may take for anything [s].
PATIENCE = 120.0

#: A plane at 5 mm, whose program kills itself in contact.
MORTAL = """
import os, signal
from ebac.worlds import LocalModel, serve_engine

calls = [0]
def plane(x, v):
    calls[0] += x[0] > 0.006
    if calls[0] > 100:
        os.kill(os.getpid(), signal.SIGKILL)
    return LocalModel(at=(0.005, 0, 0), normal=(1, 0, 0), stiffness=2000)

serve_engine(plane, rate=500)
"""
SILENT = """
import time
from ebac._core import _EngineClient

client = _EngineClient("")
while client.loop_runs:
    time.sleep(0.01)
"""

#: Posts for two seconds, and then no more.
HANGING = """
import time
from ebac.worlds import LocalModel, serve_engine

begun = time.monotonic()
def plane(x, v):
    if time.monotonic() - begun > 2:
        time.sleep(60)
    return LocalModel(at=(0.005, 0, 0), normal=(1, 0, 0), stiffness=2000)

serve_engine(plane, rate=500)
"""
#: With a child that ignores SIGTERM.
PARENT = """
import subprocess, sys
from ebac.worlds import LocalModel, serve_engine

deaf = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(300)"
child = subprocess.Popen([sys.executable, "-c", deaf])
open("child", "w").write(str(child.pid))
serve_engine(lambda x, v: LocalModel(at=(0.005, 0, 0), normal=(1, 0, 0), stiffness=2000), rate=500)
"""

pytestmark = [
    pytest.mark.real_time,
    pytest.mark.skipif(not Path("/dev/shm").is_dir(), reason="memory with names is Linux's"),
]


@pytest.fixture
def room(tmp_path: Path) -> Path:
    """A folder with the example, patient with a busy machine, and the engine of `ebac demo`."""
    text = patient_file(EXAMPLE.read_text(encoding="utf-8")) + "\n[engine]\nstale = 0.3\n"
    (tmp_path / "joystick.toml").write_text(text, encoding="utf-8")
    datasets.write("engine", tmp_path)
    return tmp_path


def words(engine: str, *more: str, seconds: float = 1.5) -> list[str]:
    known = ["run", "joystick.toml", "--simulated", "--no-live", "--seconds", str(seconds)]
    return [*known, "--out", "out", "--engine-command", engine, *more]


def run(room: Path, engine: str, *more: str) -> subprocess.CompletedProcess[str]:
    """Run the command in a process of its own."""
    command = [sys.executable, "-m", "ebac.cli", *words(engine, *more)]
    return subprocess.run(
        command, cwd=room, capture_output=True, text=True, timeout=PATIENCE, check=False
    )


def here(room: Path, command: list[str]) -> Result:
    """Run a command in this process, which has imported ebac; what a program warns of is no error."""
    with contextlib.chdir(room), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return CliRunner().invoke(app, command, catch_exceptions=False)


def written(room: Path, text: str) -> str:
    (room / "other.py").write_text(text)
    return f"{sys.executable} other.py"


def left() -> set[str]:
    """Return the memory that loops of this process share with engines."""
    return {path.name for path in Path("/dev/shm").glob(f"ebac-engine-{os.getpid()}-*")}


@pytest.mark.slow
def test_the_world_of_a_program_is_felt_and_the_program_is_ended(room: Path) -> None:
    done = run(room, f"{sys.executable} engine.py", "--json")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["engine"]["models"] > 100
    assert told["engine"]["rate_Hz"] > 30
    assert told["engine"]["trouble"] == ""
    assert told["engine"]["command"].endswith("engine.py")
    assert told["expected"] is None
    assert told["rows"][0]["verdict"] == "not judged: the surface moves"
    assert "stand still" not in done.stderr
    assert "environment" not in told["scenario"]
    assert told["ended_by"] == "time"
    trace = ebac.load(room / told["log"])
    assert trace["f_env"].max() > 1
    assert (
        subprocess.run(["pgrep", "-f", str(room)], capture_output=True, check=False).stdout == b""
    )
    about = ebac.logs.read(room / told["log"]).about
    assert "# the engine of this run:" in about.files["configuration.toml"]


@pytest.mark.slow
def test_one_that_is_killed_in_contact_fades_and_the_run_goes_on_and_says_so(room: Path) -> None:
    done = here(room, words(written(room, MORTAL), seconds=2.5))
    assert done.exit_code == 1, done.stderr
    assert "was killed by SIGKILL: its force fades to zero" in " ".join(done.stderr.split())
    assert "It did not last" in " ".join(done.stdout.split())
    assert "The verdict takes its surface to stand still." in " ".join(done.stdout.split())
    (log,) = (room / "out").glob("*.mcap")
    force = ebac.load(log)["f_env"][:, 0]
    assert force.max() > 2
    assert np.all(force[-200:] == 0)
    assert not left()


@pytest.mark.slow
def test_one_that_never_posts_is_reported(room: Path) -> None:
    done = here(room, words(written(room, SILENT)))
    assert done.exit_code == 1, done.stderr
    assert "the engine has posted nothing so far: no force is rendered" in done.stderr
    assert "posted nothing. No force was rendered." in " ".join(done.stdout.split())


@pytest.mark.slow
def test_one_that_hangs_is_told_while_the_run_goes_on(room: Path) -> None:
    done = here(room, words(written(room, HANGING), seconds=3))
    assert done.exit_code == 0, done.stderr
    assert "the engine has stopped posting: its force has faded to zero" in done.stderr


@pytest.mark.slow
def test_what_an_engine_has_started_is_ended_with_it(room: Path) -> None:
    """A shell about it, and a child that does not end when it is asked to."""
    (room / "other.py").write_text(PARENT)
    (room / "engine.sh").write_text(f"#!/bin/sh\n{sys.executable} other.py\n")
    (room / "engine.sh").chmod(0o755)
    done = here(room, words("./engine.sh"))
    assert done.exit_code == 0, done.stderr
    child = int((room / "child").read_text())
    state = Path(f"/proc/{child}/stat")
    assert not state.exists() or state.read_text().split()[2] == "Z"


@pytest.mark.parametrize(
    ("engine", "more", "code", "says"),
    [
        ("", [], 2, "--engine-command: is empty"),
        (f"{sys.executable} -c 'raise SystemExit(3)'", [], 1, "has ended with exit code 3 before"),
        ("no-such-program", [], 2, "there is no program 'no-such-program'"),
        ("python 'x", [], 2, "No closing quotation"),
        ("x", ["--wall-stiffness", "100"], 2, "--wall-stiffness: the engine computes the world"),
        ("x", ["--at", "1 environment.stiffness=5"], 2, "--at environment: the engine computes"),
    ],
)
def test_what_cannot_be_is_refused(
    engine: str, more: list[str], code: int, says: str, room: Path
) -> None:
    done = here(room, words(engine, *more))
    assert done.exit_code == code, done.stderr
    assert says in done.stderr
    assert not (room / "out").exists()


@pytest.mark.slow
def test_a_configured_engine_is_started_and_has_no_virtual_clock(room: Path) -> None:
    file = room / "joystick.toml"
    engine = f'[engine]\ncommand = "{sys.executable} engine.py"\n'
    file.write_text(file.read_text().replace("[engine]\n", engine))
    command = ["run", "joystick.toml", "--json", "--seconds", "1"]
    done = here(room, [*command, "--simulated"])
    assert done.exit_code == 0, done.stderr
    assert json.loads(done.stdout)["engine"]["models"] > 0
    done = here(room, [*command, "--virtual"])
    assert done.exit_code == 2
    assert "--virtual: the engine is a program in real time" in done.stderr
