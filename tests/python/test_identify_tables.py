"""Tables of `ebac identify`: no empty columns, and names that are explained."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from ebac import datasets
from ebac.cli import app, output


def shown(*words: str) -> str:
    return CliRunner().invoke(app, ["identify", *words]).output


@pytest.fixture(autouse=True)
def logs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    for name in ("arm", "tapping"):
        datasets.write(name)


def test_a_column_that_is_empty_in_every_row_is_left_out() -> None:
    grid = output.table(["", "value", "profile", "", "unit"], numbers=(1, 2))
    grid.add_row("M0", "1", "-", "", "kg")
    grid.add_row("B0", "2", "-", "", "-")
    assert [c.header for c in output.filled(grid).columns] == ["", "value", "unit"]
    assert [c.justify for c in output.filled(grid).columns] == ["left", "right", "left"]


def test_profile_is_a_column_only_where_it_was_asked_for() -> None:
    assert "profile" not in shown("arm", "arm.csv")
    assert "profile" in shown("arm", "arm.csv", "--profile")


@pytest.mark.slow
def test_levels_of_a_target_are_explained_where_they_occur() -> None:
    assert "X0/1, X0/2: where the hand wants to be" in shown("arm", "tapping.mcap")
    assert "X0/1" not in shown("arm", "arm.csv")
    assert "NAME@2: of the second log" not in shown("arm", "arm.csv")
    lines = Path("arm.csv").read_text().splitlines(keepends=True)
    Path("again.csv").write_text("".join(lines[:-1]))  # no copy
    assert "NAME@2: of the second log" in shown("arm", "arm.csv", "again.csv")
