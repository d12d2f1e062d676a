"""What commands say of files: what is missing, and what was written."""

import importlib.util
import os
import resource
import stat
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Thread
from typing import Any

import pytest
import typer
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

import ebac
from ebac import datasets, live, studies
from ebac._util.atomic_file import write_text
from ebac._util.atomic_folder import claimed, filled
from ebac.cli import output
from ebac.cli.files import claims, free_folder, own_folder
from ebac.operators import Operators
from ebac.plot.style import new_figure


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("nowhere/run.mcap", "nowhere: there is no such folder"),
        ("run.mcap", "run.mcap: there is no such file"),
        ("logs", "logs: there is no such file or folder"),
    ],
)
def test_a_missing_folder_is_no_file(
    name: str,
    text: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(typer.Exit) as end, output.refusing():
        Path(name).stat()
    assert end.value.exit_code == 2
    assert text in capsys.readouterr().err


@pytest.mark.parametrize("width", [60, 80, 200])
def test_a_wide_table_is_printed_in_parts_with_the_names_of_its_rows(
    width: int, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    names = ["condition", "law", "good hands", "least energy", "settled in time", "most drawn"]
    grid = output.table([*names, "meaning"], numbers=range(2, 6))
    laws = ["passivity-control", "virtual-coupling"]
    for i, law in enumerate(laws):
        numbers = (f"{i}{n}0.25 mJ" for n in range(4))
        grid.add_row(
            "" if i else "slow-press", law, *numbers, "what gets worse without this part of it"
        )
    output.show(grid)
    shown = capsys.readouterr().out
    lines = [line for line in shown.splitlines() if any(law in line for law in laws)]
    assert max(map(len, shown.splitlines())) <= width
    assert all(
        sum(f"{i}{n}0.25 mJ" in line for line in lines) == 1 for i in (0, 1) for n in range(4)
    )
    assert width == 200 or all("slow-press" in line for line in lines)
    assert len(lines) == len(laws) * (1 if width == 200 else shown.count("condition"))


def test_gaps_are_narrow_before_a_table_is_printed_in_parts(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def lines(width: int) -> list[str]:
        monkeypatch.setenv("COLUMNS", str(width))
        grid = output.table(["law", *(f"number-{i}" for i in range(6))], numbers=range(1, 7))
        grid.add_row("ebac", *(f"0.12345{i}" for i in range(6)))
        output.show(grid)
        return [line.strip() for line in capsys.readouterr().out.splitlines() if "ebac" in line]

    cells = ["ebac", *(f"0.12345{i}" for i in range(6))]
    assert lines(66) == ["  ".join(cells)]
    assert lines(65) == lines(60) == [" ".join(cells)]
    assert len(lines(59)) == 2


def test_the_runs_that_resume_needs_are_listed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("sweep-ebac", "sweep-tca"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "sweep.json").touch()
    output.list_files(tmp_path, ["map.json"])
    shown = " ".join(capsys.readouterr().out.split())
    assert "sweep-ebac/, sweep-tca/: every run, from which --resume continues" in shown
    output.list_files(tmp_path / "sweep-tca", ["a"])
    assert "--resume" not in capsys.readouterr().out


WRITES = """
import sys, time
from ebac._util.atomic_folder import filled
with filled("results") as draft:
    (draft / "half").write_text("half")
    print(draft.name, flush=True)
    time.sleep(60)
"""


def test_the_draft_of_a_killed_command_is_removed_and_that_of_a_running_one_is_not(
    tmp_path: Path,
) -> None:
    out = tmp_path / "results"
    both = [
        subprocess.Popen([sys.executable, "-c", WRITES], cwd=tmp_path, stdout=subprocess.PIPE, text=True)
        for _ in range(2)
    ]  # fmt: skip
    try:
        killed, running = (process.stdout.readline().strip() for process in both if process.stdout)
        assert sorted(file.name for file in out.iterdir()) == sorted([killed, running])
        both[0].kill()
        both[0].wait()
        with filled(out) as draft:
            (draft / "whole").write_text("whole")
        assert sorted(file.name for file in out.iterdir()) == [running, "whole"]
        (out / "whole").unlink()
        with pytest.raises(typer.Exit):
            free_folder(out, force=False)
    finally:
        for process in both:
            process.kill()
            process.communicate()
    with claims():
        assert free_folder(out, force=False) == out  # what was killed has left nothing to keep
        with filled(out):
            pass
    assert not out.exists()


def test_two_commands_at_once_write_to_folders_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both chose a name while neither had written: the one that ended last was all that was left."""
    monkeypatch.chdir(tmp_path)
    Path("ebac-wall").mkdir()
    with claims(), claimed(Path("ebac-wall-2")):
        for _ in range(2):  # a command may ask again
            assert own_folder("ebac-wall") == Path("ebac-wall")
        with pytest.raises(typer.Exit):
            free_folder(Path("ebac-wall-2"), force=False)
        with filled("ebac-wall") as draft:
            (draft / "a").touch()
    assert [path.name for path in tmp_path.iterdir()] == ["ebac-wall"]
    assert [path.name for path in Path("ebac-wall").iterdir()] == ["a"]


# --- files that are written whole or not at all ---

SCENARIO = ebac.Scenario(seconds=0.05)
TRACE = ebac.simulate(SCENARIO, "eba")
STUDY = studies.study(Operators.sample(2), "direct", ["d1K10"])
#: What writes a file, by the file's name.
WRITERS: dict[str, Callable[[Path], Any]] = {
    "scenario.toml": SCENARIO.save,
    "trace.csv": TRACE.to_csv,
    "trace.npz": TRACE.to_npz,
    "saved.csv": TRACE.save,
    "saved.npz": TRACE.save,
    "log.mcap": TRACE.save,
    "bag.mcap": lambda path: TRACE.save(path, profile="ros2"),
    "study.json": STUDY.save,
    "study.csv": STUDY.save,
    "hands.csv": STUDY.operators.to_csv,
    "runs.csv": STUDY.result().to_csv,
    "live.html": lambda path: live.page(path, wasm=b""),
    "joystick.toml": lambda path: datasets.write("joystick", path.parent, force=True),
    "figure.svg": lambda path: ebac.plot.save(Figure(), path),
    "picture.svg": lambda path: new_figure(1, 1).savefig(path),
}
if importlib.util.find_spec("pyarrow"):
    WRITERS |= {"saved.parquet": TRACE.save, "runs.parquet": STUDY.result().to_parquet}
if importlib.util.find_spec("h5py"):
    WRITERS["saved.h5"] = TRACE.save
if importlib.util.find_spec("scipy"):
    WRITERS["saved.mat"] = TRACE.save


@contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """Let no file grow beyond a size [bytes], as on a disk that is full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("name", WRITERS)
def test_on_a_full_disk_the_old_file_stays_and_half_a_new_one_does_not(
    name: str, tmp_path: Path
) -> None:
    path = tmp_path / name
    WRITERS[name](path)
    whole = path.read_bytes()
    path.write_text("old")
    with files_of_at_most(len(whole) // 2), pytest.raises(OSError, match=name) as caught:
        WRITERS[name](path)
    assert caught.value.filename == str(path)
    assert path.read_text() == "old"
    path.unlink()
    with files_of_at_most(len(whole) // 2), pytest.raises(OSError, match=name):
        WRITERS[name](path)
    assert list(tmp_path.iterdir()) == []


@given(old=st.binary(max_size=20) | st.none(), new=st.text(max_size=20), room=st.integers(0, 100))
def test_a_file_is_the_old_or_the_new_one_whatever_room_there_is(
    old: bytes | None, new: str, room: int
) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "file"
        if old is not None:
            path.write_bytes(old)
        fits = len(new.encode()) <= room
        try:
            with files_of_at_most(room):
                write_text(path, new)
        except OSError:
            assert not fits
            assert (path.read_bytes() if path.exists() else None) == old
        else:
            assert fits
            assert path.read_bytes() == new.encode()
        assert set(Path(folder).iterdir()) <= {path}


def test_a_file_that_is_being_written_and_one_that_was_interrupted_is_the_old_one(
    tmp_path: Path,
) -> None:
    path = tmp_path / "trace.csv"
    path.write_text("old")

    def interrupt(done: int, total: int) -> None:
        assert path.read_text() == "old"  # so a kill leaves it, too
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        TRACE.to_csv(path, progress=interrupt)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_keeps_its_permissions_and_a_new_one_has_the_usual_ones(tmp_path: Path) -> None:
    path, usual = tmp_path / "scenario.toml", tmp_path / "usual"
    usual.touch()
    SCENARIO.save(path)
    assert path.stat().st_mode == usual.stat().st_mode
    for mode in (0o600, 0o664, 0o755):
        path.chmod(mode)
        SCENARIO.save(path)
        assert stat.S_IMODE(path.stat().st_mode) == mode


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is write-protected for root")
def test_a_write_protected_file_stays(tmp_path: Path) -> None:
    path = tmp_path / "scenario.toml"
    path.write_text("old")
    path.chmod(0o444)
    with pytest.raises(PermissionError, match=r"scenario\.toml"):
        SCENARIO.save(path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_through_a_link_the_file_behind_it_is_written(tmp_path: Path) -> None:
    there, link, chain = tmp_path / "there", tmp_path / "link.toml", tmp_path / "chain.toml"
    there.mkdir()
    link.symlink_to(Path("there", "scenario.toml"))  # of a file that is not there yet
    chain.symlink_to(link)
    for path in (link, chain):
        SCENARIO.save(path)
        assert path.is_symlink()
        assert ebac.Scenario.load(there / "scenario.toml") == SCENARIO
        (there / "scenario.toml").write_text("old")
    assert {one.name for one in there.iterdir()} == {"scenario.toml"}
    chain.unlink()
    link.unlink()
    link.symlink_to(chain)
    chain.symlink_to(link)
    with pytest.raises(OSError, match=r"levels of symbolic links: .*link\.toml"):
        SCENARIO.save(link)


def test_a_pipe_and_an_open_file_are_written_themselves(tmp_path: Path) -> None:
    pipe, read = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = Thread(target=lambda: read.append(pipe.read_text()))
    reader.start()
    STUDY.operators.to_csv(pipe)
    reader.join()
    with (tmp_path / "redirected").open("w") as out:  # as /dev/stdout behind `> redirected`
        STUDY.operators.to_csv(f"/dev/fd/{out.fileno()}")
        out.seek(0, os.SEEK_END)
        out.write("more")
    assert (tmp_path / "redirected").read_text() == read[0] + "more"
    assert {one.name for one in tmp_path.iterdir()} == {"pipe", "redirected"}


def test_a_name_may_be_as_long_as_a_name_can_be(tmp_path: Path) -> None:
    path = tmp_path / ("é" * 125 + ".toml")
    SCENARIO.save(path)
    assert ebac.Scenario.load(path) == SCENARIO
