"""Ctrl-C of every command that takes long: exit code 130, what is kept and how to go on, no traceback."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from importlib import import_module
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from ebac import datasets
from ebac.cli import app
from ebac.cli.interrupts import interruptible

pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")

#: What runs for minutes, and what Ctrl-C says beside that it stopped.
LONG = {
    "zwidth --seconds 30": "--points",
    "worst --evaluations 1000000": "--evaluations",
    "faults --cases 5000000": "--cases",
    "identify check arm --logs 5000 --workers 2": "--logs",
    "map --side 60 --seconds 200": "--resume --out ebac-map",
    "bench --repeats 100000": "--repeats",
    "bench --can --repeats 2000": "--repeats",
    "study --seconds 600": "--resume --out ebac-study",
    "stiffest --seconds 60": "--resume --out ebac-stiffest",
    "track --simulated --runs 100000": "--runs",
    "tune tca --evaluations 100000": "the best so far was printed",
}
#: What CI interrupts: workers, threads of the core, a search, a file to resume from, a best that was printed. Each of
#: the others stops as one of these does.
IN_CI = ("identify", "faults", "worst", "map", "tune")
#: Processor time after which a command is at its work [s].
BUSY = 2.0


def start(words: str, folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "ebac", *words.split()],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def busy(process: subprocess.Popen[str]) -> float:
    """Return the processor time a process and its workers have taken [s]."""
    ticks = 0
    for file in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):  # it ended meanwhile
            fields = file.read_text().rpartition(")")[2].split()
            if int(fields[2]) == process.pid:  # its group
                ticks += sum(map(int, fields[11:13]))
    return ticks / os.sysconf("SC_CLK_TCK")


def interrupted(
    words: str, folder: Path, kept: str = "", *, terminate: bool = False
) -> tuple[int, str, float]:
    """Return exit code, what it said and how long it took [s], of a command stopped at its work.

    With `kept`, it is stopped as soon as a file matches that pattern; with `terminate` by SIGTERM, as `kill` sends it.
    """
    process = start(words, folder)
    try:
        began = time.monotonic()
        while process.poll() is None and time.monotonic() - began < 120:
            if next(folder.rglob(kept), None) if kept else busy(process) > BUSY:
                break
            time.sleep(0.05)
        assert process.poll() is None, process.communicate()
        asked = time.monotonic()
        if terminate:
            process.terminate()
        else:
            os.killpg(process.pid, signal.SIGINT)  # as a terminal does: the command and its workers
        out, err = process.communicate(timeout=60)
        return process.returncode, " ".join((out + err).split()), time.monotonic() - asked
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)


@pytest.mark.parametrize(
    "words",
    [w if w.startswith(IN_CI) else pytest.param(w, marks=pytest.mark.weekly) for w in LONG],
)
@pytest.mark.slow
def test_ctrl_c_says_what_is_kept_and_how_to_go_on(words: str, tmp_path: Path) -> None:
    for name in ("press", "joystick"):
        datasets.write(name, tmp_path)
    # What there is to go on with is said once its folder is there, however slow the machine is.
    kept = f"{LONG[words].split()[-1]}/sweep*/sweep.json" if "--resume" in LONG[words] else ""
    code, said, seconds = interrupted(words, tmp_path, kept=kept)
    assert code == 130, said
    assert "Traceback" not in said
    assert "Ctrl-C" in said
    assert LONG[words] in said
    assert seconds < 20


@pytest.mark.parametrize(
    "words",
    ["study --seconds 600", "tune tca --evaluations 100000",
     pytest.param("identify check arm --logs 5000 --workers 2", marks=pytest.mark.weekly)],
)  # fmt: skip
@pytest.mark.slow
def test_sigterm_is_taken_as_ctrl_c(words: str, tmp_path: Path) -> None:
    kept = "ebac-study/sweep*/sweep.json" if words.startswith("study") else ""
    code, said, seconds = interrupted(words, tmp_path, kept=kept, terminate=True)
    assert code == 143, said
    assert "Traceback" not in said
    assert "Stopped by SIGTERM" in said
    assert LONG[words] in said
    assert seconds < 20


@pytest.mark.slow
def test_two_ctrl_c_end_workers_as_well(tmp_path: Path) -> None:
    """The command waited for workers that the first had interrupted, for ever."""
    process = start("identify check", tmp_path)
    while busy(process) < BUSY:
        time.sleep(0.02)
    for _ in range(2):
        os.killpg(process.pid, signal.SIGINT)
        time.sleep(0.15)
    assert "Stopped by Ctrl-C" in process.communicate(timeout=10)[1]


def test_a_command_that_sigterm_stops_has_its_exit_code(capsys: pytest.CaptureFixture[str]) -> None:
    before = signal.getsignal(signal.SIGTERM)

    def command() -> None:
        with interruptible():
            assert signal.getsignal(signal.SIGTERM) is not before, "it would end the tests"
            signal.raise_signal(signal.SIGTERM)

    with pytest.raises(typer.Exit) as stopped:
        command()
    assert stopped.value.exit_code == 143
    assert "Stopped by SIGTERM; nothing was written" in " ".join(capsys.readouterr().err.split())
    assert signal.getsignal(signal.SIGTERM) is before


@pytest.mark.slow
@pytest.mark.real_time
def test_a_run_that_was_interrupted_names_its_log_and_what_to_do_with_it(tmp_path: Path) -> None:
    datasets.write("joystick", tmp_path)
    process = start("run joystick.toml --simulated --seconds 60", tmp_path)
    while process.poll() is None and not list(tmp_path.glob("ebac-run/*.mcap")):
        time.sleep(0.05)
    time.sleep(2)  # its rows are under way
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    said = " ".join((out + err).split())
    assert process.returncode == 130, said
    (log,) = (tmp_path / "ebac-run").iterdir()
    assert f"`ebac log plot ebac-run/{log.name}`" in said


@pytest.mark.real_time
@pytest.mark.parametrize("clock", ["--simulated --seconds 0.2", "--virtual --seconds 0.2"])
def test_an_interruption_after_a_run_names_its_log(
    clock: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """While its result is being drawn."""

    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(import_module("ebac.cli.run.carry_out"), "give", stopped)
    datasets.write("joystick", tmp_path)
    result = CliRunner().invoke(app, ["run", "joystick.toml", *clock.split()])
    assert result.exit_code == 130
    (log,) = (tmp_path / "ebac-run").glob("*.mcap")
    assert f"`ebac log plot ebac-run/{log.name}`" in " ".join(result.output.split())


#: Sends itself Ctrl-C at each event of Python's calls, from the start of a campaign to its third look at the progress.
EVERY_MOMENT = """
import signal, sys
from ebac.faults import run_campaign

def interrupted_at(event):
    left, looks = [event], []
    def count(*_):
        left[0] -= 1
        if left[0] == 0:
            signal.raise_signal(signal.SIGINT)
    def look(done, cases):
        looks.append(done)
        if len(looks) == 3:
            sys.setprofile(None)
            raise KeyboardInterrupt
    sys.setprofile(count)
    try:
        run_campaign(100_000, threads=1, progress=look)
    except KeyboardInterrupt:
        sys.setprofile(None)
    return left[0] <= 0

event = 1
while interrupted_at(event):
    event += 1
print(event)
"""


@pytest.mark.slow
def test_ctrl_c_is_never_lost_while_a_campaign_runs(tmp_path: Path) -> None:
    """A lock of `threading` that it leaves taken kept the work from its end, and the command with it."""
    done = subprocess.run(
        [sys.executable, "-c", EVERY_MOMENT], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 20


#: Sends itself Ctrl-C where Python drops it.
IN_A_CALLBACK = """
import signal, time, weakref
from ebac.cli.interrupts import interruptible

with interruptible():
    thing = set()
    reference = weakref.ref(thing, lambda _: signal.raise_signal(signal.SIGINT))
    del thing
    time.sleep(30)
"""


def test_ctrl_c_that_python_drops_is_sent_again(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", IN_A_CALLBACK], cwd=tmp_path, capture_output=True, text=True, timeout=20
    )  # fmt: skip
    assert "Stopped by Ctrl-C" in done.stderr


@pytest.mark.slow
@pytest.mark.weekly
def test_what_was_interrupted_is_resumed(tmp_path: Path) -> None:
    words = "map --side 30 --seconds 5"  # long enough to be interrupted after its first points
    code, said, _ = interrupted(words, tmp_path, kept="ebac-map/sweep-ebac/*.npz")
    assert code == 130, said
    kept = {file: file.stat().st_mtime_ns for file in (tmp_path / "ebac-map").rglob("*.npz")}
    assert kept
    resume = start(f"{words} --resume --out ebac-map --json", tmp_path)
    out, err = resume.communicate(timeout=300)
    assert resume.returncode == 0, err
    assert '"runs": 900' in out
    assert all(file.stat().st_mtime_ns == when for file, when in kept.items() if file.exists())
