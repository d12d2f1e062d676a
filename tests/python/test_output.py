"""What commands say of files: what is missing, and what was written."""

import subprocess
import sys
from pathlib import Path

import pytest
import typer

from ebac._util.atomic_folder import claimed, filled
from ebac.cli import output
from ebac.cli.files import claims, free_folder, own_folder


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
