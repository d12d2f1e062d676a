"""An engine in another process: real programs, one that is killed in contact, and no memory left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

import ebac
from ebac._core import _EngineClient, _SharedEngineChannel
from ebac.hardware import Configuration, ConfigurationError, Run
from ebac.worlds import BridgeParams, EngineProcess, LocalModel, serve_engine
from ebac.worlds.engine_process import VARIABLE

MEMORY = Path("/dev/shm")
INSIDE, STILL = np.array([0.012, 0, 0]), np.zeros(3)

#: A plane at 10 mm, as a program of its own.
PLANE = """
from ebac.worlds import LocalModel, serve_engine

serve_engine(lambda x, v: LocalModel(at=(0.01, 0, 0), normal=(1, 0, 0), stiffness=2000), rate={rate})
"""

pytestmark = [
    pytest.mark.skipif(not MEMORY.is_dir(), reason="memory with names is Linux's"),
]


@pytest.fixture(autouse=True)
def nothing_is_left() -> Iterator[None]:
    """See that no memory of this process stays under its name."""
    yield
    assert not list(MEMORY.glob(f"ebac-engine-{os.getpid()}-*"))


@pytest.fixture
def engine(tmp_path: Path) -> Callable[..., list[str]]:
    """Return what writes a program and gives its command."""

    def written(text: str = PLANE, **named: float) -> list[str]:
        file = tmp_path / "engine.py"
        file.write_text(text.format(**{"rate": 500, **named}))
        return [sys.executable, str(file)]

    return written


def pressed(process: EngineProcess, enough: Callable[[float], bool], begin: float) -> float:
    """Tick in real time with the handle 2 mm inside until the force is what is waited for; return that time [s]."""
    t = begin
    for _ in range(20_000):
        t += 1e-3
        force = float(process.world.contact(INSIDE, STILL, t)[0][0])
        if enough(force):
            return t
        time.sleep(1e-3)
    raise AssertionError(f"the last force was {force} N")


def test_a_program_is_felt_and_ended(engine: Callable[..., list[str]]) -> None:
    with EngineProcess(engine(), rendering=BridgeParams(stale=10.0)) as process:
        pressed(process, lambda force: abs(force - 4) < 1e-3, 0.0)
        assert process.alive
        assert process.trouble == ""
        program = process._program
        assert program is not None
    assert program.returncode == 0
    assert process.posted > 0
    assert process.world.report.models > 0
    assert process.world.remark() == ""


def test_the_force_of_one_that_is_killed_in_contact_fades_and_the_world_says_so(
    engine: Callable[..., list[str]],
) -> None:
    rendering = BridgeParams(stale=0.3, fade=0.1)
    with EngineProcess(engine(), rendering=rendering) as process:
        t = pressed(process, lambda force: abs(force - 4) < 1e-2, 0.0)
        program = process._program
        assert program is not None
        program.kill()
        program.wait()
        end = pressed(process, lambda force: force == 0, t)
        assert end - t < 0.5
        assert not process.alive
        assert "was killed by SIGKILL" in process.trouble
        said = process.world.remark()
    assert "was killed by SIGKILL" in said
    assert "its force was faded or zero" in said


def test_one_that_stops_posting_fades_and_comes_back(engine: Callable[..., list[str]]) -> None:
    with EngineProcess(engine(), rendering=BridgeParams(stale=0.3)) as process:
        program = process._program
        assert program is not None
        t = pressed(process, lambda force: abs(force - 4) < 1e-2, 0.0)
        program.send_signal(signal.SIGSTOP)
        t = pressed(process, lambda force: force == 0, t)
        assert process.alive
        program.send_signal(signal.SIGCONT)
        pressed(process, lambda force: abs(force - 4) < 1e-2, t)
    assert "was older than 300 ms" in process.world.remark()


@pytest.mark.parametrize(
    ("text", "patience", "says"),
    [
        ("raise SystemExit(3)", 30.0, "has ended with exit code 3 before it opened its channel"),
        ("import time; time.sleep(60)", 0.5, r"has not opened the channel .* within 0\.5 s"),
    ],
)
def test_a_program_that_serves_nothing_is_refused(
    text: str, patience: float, says: str, engine: Callable[..., list[str]]
) -> None:
    with pytest.raises(RuntimeError, match=says), EngineProcess(engine(text), patience=patience):
        pass


def test_a_program_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="there is no program 'no-such-program'"):
        EngineProcess("no-such-program")
    file = tmp_path / "empty"
    file.touch(mode=0o755)
    with pytest.raises(RuntimeError, match="cannot be started: Exec format error"):
        EngineProcess([str(file)]).__enter__()


def test_one_started_by_hand_finds_the_loop_by_name(engine: Callable[..., list[str]]) -> None:
    name = f"ebac-test-hand-{os.getpid()}"
    process = EngineProcess(name=name, patience=60)
    program = subprocess.Popen(engine(), env=os.environ | {VARIABLE: name})
    with process:
        pressed(process, lambda force: force > 0, 0.0)
        program.kill()
        program.wait()
        assert "has left its channel" in process.trouble
    assert not (MEMORY / name).exists()


def test_a_forked_copy_of_the_loop_ends_nothing(engine: Callable[..., list[str]]) -> None:
    """As a worker of `multiprocessing` that ends with all that its parent had."""
    with EngineProcess(engine()) as process:
        pressed(process, lambda force: force > 0, 0.0)
        copy = os.fork()
        if copy == 0:
            process._channel.end()
            os._exit(0)
        os.waitpid(copy, 0)
        assert (MEMORY / process.name.removeprefix("/")).exists()
        assert process.trouble == ""
        copy = os.fork()
        if copy == 0:
            del process._channel  # its memory took the name away
            os._exit(0)
        os.waitpid(copy, 0)
        assert (MEMORY / process.name.removeprefix("/")).exists()


def test_an_engine_that_raises_ends_its_program(engine: Callable[..., list[str]]) -> None:
    text = "from ebac.worlds import serve_engine\nserve_engine(lambda x, v: 1 / 0, rate=1000)"
    with EngineProcess(engine(text)) as process:
        t = 0.0
        while "exit code" not in process.trouble and t < 20:
            t += 1e-3
            assert process.world.contact(INSIDE, STILL, t)[0][0] == 0
            time.sleep(1e-3)
        assert "has ended with exit code 1" in process.trouble
    assert "the engine never answered" in process.world.remark()


def test_a_loop_that_is_killed_ends_its_engine_and_leaves_no_memory(
    engine: Callable[..., list[str]], tmp_path: Path
) -> None:
    command = engine()
    text = (
        "import sys, time\nfrom ebac.worlds import EngineProcess\n"
        f"with EngineProcess({command!r}) as process:\n"
        "    print(process.name, process._program.pid, flush=True)\n    time.sleep(60)\n"
    )
    loop = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, text=True)
    assert loop.stdout is not None
    name, pid = loop.stdout.readline().split()
    loop.stdout.close()
    loop.kill()
    loop.wait()
    until = time.monotonic() + 20
    while Path(f"/proc/{pid}").exists() and time.monotonic() < until:
        if "Z" in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2]:
            break
        time.sleep(0.01)
    assert time.monotonic() < until
    assert not Path(f"{MEMORY}{name}").exists()


def test_what_is_given_wrongly_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    with pytest.raises(ValueError, match="give a command that starts the engine"):
        EngineProcess()
    with pytest.raises(ValueError, match="is empty"):
        EngineProcess("  ")
    with pytest.raises(ValueError, match="No closing quotation"):
        EngineProcess("python 'x")
    with pytest.raises(ValueError, match="letters, digits"):
        EngineProcess(name="a/b")
    with pytest.raises(ValueError, match="must be above 0 s"):
        EngineProcess("true", patience=0.0)
    with pytest.raises(TypeError, match=r"serve_engine\.engine = 3: must be callable"):
        serve_engine(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"serve_engine\.rate = 0\.5 Hz"):
        serve_engine(lambda x, v: None, rate=0.5)
    with pytest.raises(ValueError, match="no channel to a loop is named"):
        serve_engine(lambda x, v: None)
    with pytest.raises(FileNotFoundError, match="start the loop first"):
        serve_engine(lambda x, v: None, channel="ebac-nobody")


def test_memory_of_another_version_is_refused_by_name() -> None:
    channel = _SharedEngineChannel("")
    with Path(f"{MEMORY}{channel.name}").open("r+b") as file:
        file.seek(8)
        file.write((77).to_bytes(4, "little"))
    with pytest.raises(ValueError, match=r"has layout 77 .* must be of the same version of ebac"):
        serve_engine(lambda x, v: None, channel=channel.name)


def test_memory_of_something_else_and_a_taken_name_are_refused() -> None:
    file = MEMORY / f"ebac-test-foreign-{os.getpid()}"
    file.write_bytes(b"x" * 4096)
    try:
        with pytest.raises(ValueError, match="is not one of ebac"):
            serve_engine(lambda x, v: None, channel=file.name)
        with pytest.raises(ValueError, match="is taken by another program"):
            EngineProcess(name=file.name)
    finally:
        file.unlink()
    channel = _SharedEngineChannel("")
    client = _EngineClient(channel.name)
    with pytest.raises(RuntimeError, match=f"the engine of process {os.getpid()} was there first"):
        serve_engine(lambda x, v: None, channel=channel.name)
    assert client.loop_runs
    channel.end()
    assert not client.loop_runs


def test_a_number_out_of_range_is_refused_where_it_is_posted() -> None:
    channel = _SharedEngineChannel("")
    client = _EngineClient(channel.name)
    model = LocalModel(at=(0, 0, 0), normal=(1, 0, 0), stiffness=100)
    with pytest.raises(ValueError, match=r"stiffness = 2e.?0?7 N/m: must lie in"):
        client.post((model.at, model.normal, 0.0, 2e7, 0.0, model.velocity))
    assert channel.posted == 0


@pytest.mark.slow
@pytest.mark.real_time
def test_a_loop_on_simulated_drives_takes_an_engine_in_a_process(
    engine: Callable[..., list[str]],
    until: Callable[[Run, Callable[[], bool]], None],
    tmp_path: Path,
) -> None:
    known = Configuration.load(Path(__file__).parents[2] / "examples" / "joystick.toml")
    patient = known.limits.replace(overruns=100_000, pause=100, force_age=10, jump=1.0, speed=100.0)
    known = known.replace(silent=1000, limits=patient)
    with (
        EngineProcess(engine(), rendering=BridgeParams(stale=10.0)) as process,
        ebac.Device.open(known, simulate=True) as device,
        device.start("ebac", process.world, seconds=30, log=tmp_path / "run.mcap") as run,
    ):
        until(run, lambda: bool((run.trace()["f_env"] != 0).any()))
        run.stop()
    assert np.isfinite(run.finish()["f_env"]).all()
    assert process.world.report.models > 0
    assert len(ebac.load(tmp_path / "run.mcap")) > 0


def test_a_configured_engine_is_not_left_out_in_silence() -> None:
    text = (Path(__file__).parents[2] / "examples" / "joystick.toml").read_text()
    known = Configuration.from_toml(text + '\n[engine]\ncommand = "python it.py"\nstale = 0.2\n')
    assert known.engine == "python it.py"
    assert known.rendering == BridgeParams(stale=0.2)
    with (
        ebac.Device.open(known, simulate=True) as device,
        pytest.raises(RuntimeError, match=r"start it by worlds\.EngineProcess"),
    ):
        device.start()
    with pytest.raises(ConfigurationError, match=r"engine\.stale"):
        Configuration.from_toml(text + "\n[engine]\nstale = 1e9\n")
