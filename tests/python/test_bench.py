"""`ebac bench --peers`: what it compares and tells. How fast anything is, no test asserts."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.peers import own
from ebac.peers.row import Plant

PLANT = Plant.of(ebac.Scenario())


def test_the_closed_form_solves_the_equation_of_motion() -> None:
    t = np.linspace(0, 1, 10_001)
    x = PLANT.free(t)
    v, a = np.gradient(x, t), np.gradient(np.gradient(x, t), t)
    pull = PLANT.stiffness * (PLANT.target - x) - PLANT.damping * v
    assert np.abs(PLANT.mass * a - pull)[5:-5].max() < 2e-3  # N, of 12
    assert x[0] == pytest.approx(0, abs=1e-15)


def test_ebac_moves_like_the_closed_form() -> None:
    places = own.free_run(ebac.Scenario())
    t = PLANT.step * np.arange(1, len(places) + 1)
    assert np.abs(places - PLANT.free(t)).max() < 1e-9


def test_memory_is_that_of_the_rows() -> None:
    row, peak = own.memory(100_000)
    assert row == ebac.simulate(ebac.Scenario(seconds=0.1), "ebac")["t"].strides[0]
    assert 0.9 < peak / (100_000 * row) < 1.5


def test_what_is_missing_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    result = CliRunner().invoke(app, ["bench", "--peers", "--json"])
    assert result.exit_code == 2
    assert "needs mujoco: pip install 'ebac[peers]'" in " ".join(result.output.split())


@pytest.mark.slow
def test_the_comparison(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("mujoco")
    pytest.importorskip("scipy")
    from ebac.peers import mujoco_peer, scipy_peer

    monkeypatch.setattr(mujoco_peer, "STEPS", 1500)
    monkeypatch.setattr(scipy_peer, "COUNT", 20)
    monkeypatch.setattr(own, "memory", lambda: (1, 1))
    result = CliRunner().invoke(
        app, ["bench", "--peers", "--json", "--repeats", "1", "--side", "3"]
    )
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)["rows"]
    assert {tuple(row) for row in rows} == {
        ("subject", "program", "value", "unit", "times_ebac", "target", "note")
    }
    rates = {(row["subject"], row["program"]): row for row in rows if row["times_ebac"]}
    assert len(rates) == 8
    assert all(row["note"] for row in rates.values())
    rest = {row["program"]: row["value"] for row in rows if row["subject"] == "rest in contact"}
    assert rest["MuJoCo"] == pytest.approx(0.001165, rel=0.01)
    errors = {row["program"]: row["value"] for row in rows if "error" in row["subject"]}
    assert errors["ebac"] < 1e-9


@pytest.mark.parametrize(
    "option",
    ["--law=ebac", "--no-observer", "--observer-every-law", "--observer-learns", "--seconds=1"],
)
def test_a_comparison_refuses_options_of_a_scenario(option: str) -> None:
    """None is left out in silence, a switch that is off by default neither."""
    refused = CliRunner().invoke(app, ["bench", "--peers", option])
    assert refused.exit_code == 2
    assert "leave these options out" in refused.stderr


@pytest.mark.parametrize("given", [["ebac"], ["tca,ebac", "{own}"], ["{own}"]])
def test_laws_that_are_named_are_timed_a_law_of_ones_own_too(
    given: list[str], tmp_path: Path
) -> None:
    file = tmp_path / "mine.py"
    file.write_text(
        "class Half:\n    def step(self, port):\n        return 0.5 * port.f_env\n    def reset(self):\n        pass\n"
    )
    words = [word.format(own=f"{file}:Half") for word in given]
    options = [part for word in words for part in ("--law", word)]
    result = CliRunner().invoke(
        app, ["bench", *options, "--repeats", "1", "--seconds", "0.1", "--json"]
    )
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)["rows"]
    names = [name for word in given for name in word.replace("{own}", "Half").split(",")]
    assert [row["law"] for row in rows] == names
    assert all(row["tick_ns"] > 0 for row in rows)
    assert [row["step_ns"] is None for row in rows] == [name == "Half" for name in names]
