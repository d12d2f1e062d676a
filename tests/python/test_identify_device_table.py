"""What `ebac identify device` proposes for the file of the device: what is surely there, with its own rotor."""

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac import identify
from ebac.cli import app
from ebac.identify import Recording, excitation, fit_device

#: A configuration of `ebac run`; its table [limits] says so.
CONFIGURATION = """
[device]
preset = "reference"
[device.motor]
rotor_inertia = 2e-6
[device.kinematics]
type = "Linear"
axes = 2
[limits]
speed = 1.0
"""


def moved(device: ebac.Device, law: str = "direct") -> ebac.Trace:
    """Return a hand that moves a device to and fro in free air."""
    t, x = excitation.multisine(0.03, low=0.2, high=4, seconds=5)
    hand = ebac.Hand(mass=0.1, damping=10, stiffness=900, path=excitation.path(t, x))
    scenario = ebac.Scenario(device=device, hand=hand, environment=ebac.Free(), seconds=5)
    return ebac.simulate(scenario, law)


@pytest.fixture(scope="module")
def trace() -> ebac.Trace:
    return moved(
        ebac.Device(
            mechanics=ebac.Mechanics(damping=3, coulomb=0.4, handle_mass=0.02),
            motor=ebac.Motor(rotor_inertia=1e-6),
        )
    )


def shown(*words: str) -> str:
    run = CliRunner().invoke(app, ["identify", "device", *words], env={"COLUMNS": "80"})
    assert run.exit_code == 0, run.output
    return run.stdout


def proposed(*words: str) -> dict[str, Any]:
    return tomllib.loads(table_of(*words))["device"]["mechanics"]


def table_of(*words: str) -> str:
    return shown(*words).partition("In the file of the device:\n")[2]


def test_damping_and_friction_are_those_that_are_surely_there(
    tmp_path: Path, trace: ebac.Trace
) -> None:
    """They were the estimates, and the page calls damping a lower bound."""
    trace.to_npz(tmp_path / "log.npz")
    found = fit_device(identify.load(tmp_path / "log.npz")).estimates
    table = proposed(str(tmp_path / "log.npz"))
    assert table["damping"] == pytest.approx(found["B_h"].low, rel=1e-3)
    assert table["coulomb"] == pytest.approx(found["coulomb"].low, rel=1e-3)
    assert table["damping"] < found["B_h"].value


def test_a_friction_that_may_be_twice_as_large_is_not_determined() -> None:
    """0.06 N, -0.05 to 0.18 N, passed for a result, since it was compared with the force of the hand alone."""
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.02, gravity=0.0))
    r = Recording.from_trace(moved(device))
    rough = r.force + 0.5 * np.random.Generator(np.random.PCG64(1)).standard_normal(len(r.t))
    found = fit_device(Recording(name="log", t=r.t, x=r.x, force=rough, count=r.count, lag=r.lag))
    coulomb = found.estimates["coulomb"]
    assert coulomb.high > 1.5 * coulomb.value
    assert not coulomb.determined


def test_no_weight_and_no_friction_are_determined() -> None:
    """They have no quarter of their value."""
    device = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.0, gravity=0.0))
    assert fit_device(Recording.from_trace(moved(device))).undetermined == ()


def test_the_rotor_is_that_of_the_device_in_the_log(tmp_path: Path, trace: ebac.Trace) -> None:
    """It was that of the reference device, which is heavier than this one as a whole."""
    trace.to_npz(tmp_path / "log.npz")
    assert proposed(str(tmp_path / "log.npz"))["handle_mass"] == pytest.approx(0.02, rel=0.05)
    assert "the rotor of the device in the log" in shown(str(tmp_path / "log.npz"))


def test_the_rotor_may_be_that_of_a_configuration(tmp_path: Path, trace: ebac.Trace) -> None:
    """Only `ebac specs` read both kinds of file."""
    trace.to_npz(tmp_path / "log.npz")
    file = tmp_path / "run.toml"
    file.write_text(CONFIGURATION.replace("2e-6", "0.5e-6"), encoding="utf-8")
    table = proposed(str(tmp_path / "log.npz"), "--scenario", str(file))
    assert table["handle_mass"] == pytest.approx(0.04, rel=0.05)


def test_laws_are_designed_for_the_device_of_a_configuration(tmp_path: Path) -> None:
    file = tmp_path / "run.toml"
    file.write_text(CONFIGURATION + "[timing]\ndt = 0.0005\n", encoding="utf-8")
    run = CliRunner().invoke(app, ["laws", "eba", "--scenario", str(file)], env={"COLUMNS": "200"})
    assert run.exit_code == 0, run.output
    assert "run.toml at 2 kHz" in run.stdout


@pytest.mark.slow
def test_a_lag_that_a_csv_file_does_not_say_is_named(tmp_path: Path) -> None:
    """The log of a run that was exported determined less, without a hint."""
    trace = moved(ebac.Device(mechanics=ebac.Mechanics(coulomb=0.4)))
    file = tmp_path / "log.csv"
    trace.save(file)
    text = " ".join(shown(str(file)).split())
    assert "seems to pass a filter with a lag of 0.8" in text
    assert "--lag 0.0008" in text
    document = json.loads(shown(str(file), "--json"))
    assert document["lag_seems_s"] == pytest.approx(trace.scenario.device.sensor.lag, rel=0.1)
    for lag in ("0.0008", "0"):  # declared, be it right or not
        assert json.loads(shown(str(file), "--lag", lag, "--json"))["lag_seems_s"] is None


def test_no_lag_is_named_where_there_is_none(tmp_path: Path) -> None:
    ebac.datasets.write("device", tmp_path)
    assert json.loads(shown(str(tmp_path / "device.csv"), "--json"))["lag_seems_s"] is None


@pytest.mark.parametrize("gravity", [9.81, -2.0, 0.0])
def test_the_file_carries_the_weight_that_was_found(gravity: float, tmp_path: Path) -> None:
    mechanics = ebac.Mechanics(damping=3, coulomb=0.4, handle_mass=0.1, gravity=gravity)
    moved(ebac.Device(mechanics=mechanics)).save(tmp_path / "log.npz")
    table = table_of(str(tmp_path / "log.npz"))
    assert ebac.Scenario.from_toml(table).device.compensation == ebac.Compensation()
    begun = table.replace("# [device.comp", "[device.comp")
    begun = begun.replace("# friction", "friction").replace("# gravity_mass", "gravity_mass")
    device = ebac.Scenario.from_toml(begun).device
    weight = device.mechanics.handle_mass * device.mechanics.gravity
    carried = device.compensation.gravity_mass * device.mechanics.gravity
    assert weight == pytest.approx(0.1 * gravity, rel=0.02, abs=0.003)
    assert 0.9 * abs(weight) <= abs(carried) <= abs(weight)
    assert carried * gravity >= 0
    assert 0.3 < device.compensation.friction <= 0.4
