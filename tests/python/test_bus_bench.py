"""`ebac bench --can`: what it compares and tells. How fast anything is, no test asserts."""

import json

import pytest
from typer.testing import CliRunner

from ebac.cli import app
from ebac.peers import bus, exchange, sdo


@pytest.fixture(autouse=True)
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("FRAMES", "PYTHON_FRAMES", "ANSWERS"):
        monkeypatch.setattr(bus, name, 200)
    monkeypatch.setattr(exchange, "TICKS", 100)
    monkeypatch.setattr(sdo, "READS", 100)


def test_the_rows() -> None:
    result = CliRunner().invoke(app, ["bench", "--can", "--json", "--repeats", "1"])
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)["rows"]
    assert {tuple(row) for row in rows} == {
        ("subject", "program", "value", "unit", "times_ebac", "target", "note")
    }
    measured = {(row["subject"], row["program"]) for row in rows}
    assert {(bus.ONE, "C++"), (bus.TWO, "C++")} <= measured
    programs = {row["program"] for row in rows if row["subject"] == exchange.EXCHANGE}
    assert programs == {"ebac, LoopbackBus", "ebac, the loop's side"}
    for subject in (bus.ONE, bus.TWO, bus.MEDIAN, bus.SLOW):
        assert {(subject, "ebac"), (subject, "virtual")} <= measured
    for subject in (sdo.MEDIAN, sdo.SLOW):
        assert {(subject, program) for program in sdo.NOTES} <= measured
    assert len(rows) == 16
    assert all(row["value"] > 0 and row["note"] for row in rows)
    assert {row["times_ebac"] for row in rows if row["program"] == "ebac"} == {1.0}
    assert {row["unit"] for row in rows} == {"1/s", "s"}


def test_the_table() -> None:
    result = CliRunner().invoke(app, ["bench", "--can", "--repeats", "1"])
    assert result.exit_code == 0, result.output
    assert "frames/s" in result.stdout
    assert "µs" in result.stdout


def test_steps_are_as_many_as_were_asked_for() -> None:
    told: list[str] = []
    bus.compare_buses(repeats=1, step=told.append)
    assert len(told) == bus.STEPS
    sdo.compare_reads(step=told.append)
    assert len(told) == bus.STEPS + sdo.STEPS


def test_one_comparison_at_a_time() -> None:
    result = CliRunner().invoke(app, ["bench", "--can", "--peers"])
    assert result.exit_code == 2
    assert "give one of them" in result.output
