"""What commands say of files: what is missing, and what was written."""

from pathlib import Path

import pytest
import typer

from ebac.cli import output


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
