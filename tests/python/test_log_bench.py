"""`ebac bench --logs`: what it compares and tells. How fast anything is, no test asserts."""

import json

import pytest
from typer.testing import CliRunner

from ebac.cli import app
from ebac.peers import logs


@pytest.mark.slow
def test_the_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    compare = logs.compare_logs
    monkeypatch.setattr(logs, "compare_logs", lambda **more: compare(rows=5000, **more))
    result = CliRunner().invoke(app, ["bench", "--logs", "--json"])
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)["rows"]
    assert [(row["subject"], row["program"]) for row in rows] == [
        (subject, program)
        for kind in ("recorded", "saved")
        for subject, program in (
            (f"read a log as {kind}", "ebac"),
            (f"read a log as {kind}", "mcap"),
            (f"write a log as {kind}", "ebac"),
        )
    ]
    assert all(row["value"] > 0 and row["unit"] == "1/s" for row in rows)
    shown = CliRunner().invoke(app, ["bench", "--logs"]).output
    assert "rows/s" in shown
    assert "1,000,000" in shown


def test_one_comparison_at_a_time() -> None:
    result = CliRunner().invoke(app, ["bench", "--logs", "--can"])
    assert result.exit_code == 2
    assert "give one of them" in " ".join(result.output.split())
