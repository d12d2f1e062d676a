"""What held the current of a run back is said in words, in JSON and of a log."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import ebac
from ebac._core import Limited
from ebac.cli import app
from ebac.datasets import joystick_text
from ebac.hardware import Configuration, under_the_law
from ebac.metrics import current_limits

WEAK = joystick_text("joystick").replace("thermal_time", "#").replace(
    "[limits]", "[limits]\nthermal_time = 0.5\ncontinuous_current = 0.3\npeak_current = 1.0"
)  # fmt: skip


def weak() -> Configuration:
    return Configuration.from_toml(WEAK, name="weak").replace(seconds=3.0)


def test_a_warm_motor_is_named_with_its_share_and_its_beginning() -> None:
    trace = under_the_law(weak().simulate(bus_time=False))
    found = current_limits(trace)
    assert found is not None
    hot = (trace["limited"] & int(Limited.THERMAL)) != 0
    assert found.shares["thermal"] == hot.mean() > 0.1
    assert found.first_s["thermal"] == trace["t"][hot][0] > 0.1
    assert f"the heat of the motor in {100 * hot.mean():.3g} % of the ticks, from " in str(found)
    assert set(found.shares) <= {"peak", "thermal", "slew", "edge", "not_finite"}


def test_where_nothing_is_limited_there_is_none() -> None:
    assert current_limits(ebac.simulate(ebac.Scenario(seconds=0.1), "ebac")) is None
    strong = Configuration.from_toml(joystick_text("joystick"), name="joystick").replace(
        seconds=0.3
    )
    assert current_limits(strong.simulate(bus_time=False)) is None
    with pytest.raises(TypeError, match=r"ebac\.metrics\.current_limits takes a trace"):
        current_limits(None)  # type: ignore[arg-type]


def test_a_run_and_its_log_say_so(tmp_path: Path) -> None:
    file = tmp_path / "weak.toml"
    file.write_text(WEAK)
    words = ["run", str(file), "--virtual", "--seconds", "3", "--out", str(tmp_path / "out")]
    shown = " ".join(CliRunner().invoke(app, words).stdout.split())
    assert "The current was held back by" in shown
    assert "the heat of the motor in" in shown
    log = next((tmp_path / "out").glob("*.mcap"))
    told = json.loads(CliRunner().invoke(app, ["log", "info", str(log), "--json"]).stdout)
    run = json.loads(log.with_suffix(".json").read_text())
    assert told["current_limited"] == run["current_limited"]
    assert "thermal" in run["current_limited"]["shares"]
    assert "by the heat of the motor" in " ".join(
        CliRunner().invoke(app, ["log", "info", str(log)]).stdout.split()
    )
