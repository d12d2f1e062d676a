"""A device without a force sensor: no law feeds back a force, and none acts on an observer."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.datasets import joystick_text
from ebac.hardware import Configuration
from ebac.identify import Target, fit_gains, fit_loop, load
from ebac.laws import LAWS, design
from ebac.laws.making import FORCE_GAINS
from ebac.live import Session

BARE = ebac.Device(sensor=None)
SHORT = ebac.Scenario(seconds=0.4)


def test_none_is_a_sensor_that_is_not_fitted() -> None:
    assert ebac.Device(sensor=ebac.ForceSensor(fitted=False)) == BARE
    assert ebac.Device().replace(sensor=None) == BARE
    scenario = ebac.Scenario(device=BARE)
    assert ebac.Scenario.from_toml(scenario.to_toml()) == scenario
    assert "no force sensor" in ebac.simulate(SHORT.replace(device=BARE), "direct").summary()


@pytest.mark.parametrize("name", LAWS)
def test_a_law_runs_on_the_encoder_alone_without_its_force_loop(name: str) -> None:
    law: Any = design(name, BARE, SHORT.timing)
    assert not any(getattr(law, gain, 0) for gain in FORCE_GAINS)
    without = ebac.simulate(SHORT.replace(device=BARE), name)
    assert not without["f_meas"].any()
    assert without.scenario is not None
    assert without.scenario.designed_observer() is None
    if name != "iss":  # the size of a measured force bounds what it gives out
        blind = ebac.simulate(SHORT.replace(observer=False), law)
        assert blind["x"].tobytes() == without["x"].tobytes()


def test_studies_and_searches_design_laws_for_it_too() -> None:
    few = ebac.Operators.sample(3, 5)
    without = ebac.study(few, "ebac", ["d1K10"], base=SHORT.replace(device=BARE))
    bare = ebac.Variant("ebac", {"observer": False, "kp": 0})
    blind = ebac.study(few, bare, ["d1K10"], base=SHORT)
    for column in ("rest_m", "least_energy_J", "peak_m"):
        assert np.array_equal(without.columns[column], blind.columns[column])
    assert "kp=0.0" in without.trace(0).law_repr
    worst = ebac.worst("ebac", family=["impact"], evaluations=40, base=SHORT.replace(device=BARE))
    assert worst.made.kp == 0


@pytest.mark.parametrize(
    ("law", "changes"),
    [
        ("tca", {"kp": 0.3}),
        (ebac.Variant("tca-damped", {"kd": 1e-3}), {}),
        (design("tca", ebac.Device(), ebac.Timing()), {}),
        (ebac.TCA, {"kp": 0.3}),
    ],
    ids=["name", "variant", "finished", "class"],
)
def test_a_force_loop_is_refused(law: Any, changes: dict[str, float]) -> None:
    with pytest.raises(
        ValueError, match=r"k[pd] = .*: feeds back a measured force, but the device"
    ):
        ebac.simulate(SHORT.replace(device=BARE), law, **changes)


def test_gains_of_a_force_loop_need_a_force_sensor(tmp_path: Path) -> None:
    """It blamed a kp that nobody had given, the one of the design."""
    ebac.datasets.write("press", tmp_path)
    file = tmp_path / "bare.toml"
    file.write_text("device.sensor.fitted = false\n", encoding="utf-8")
    words = ["identify", "gains", str(tmp_path / "press.csv"), "--switch", "1.0"]
    run = CliRunner().invoke(app, [*words, "--scenario", str(file)])
    assert run.exit_code == 2
    said = " ".join(run.output.split())
    assert "the device has no force sensor, which a force loop needs" in said
    assert "Leave out fitted = false" in said
    assert "tca-damped.kp" not in said
    loop = fit_loop(load(tmp_path / "press.csv"), Target.steps(1.0), device=BARE)
    with pytest.raises(ValueError, match=r"^device\.sensor\.fitted = False: the device has no"):
        fit_gains(loop, "tca-damped")


@pytest.mark.parametrize(
    "observer",
    ["every-law", "learns-scale", ebac.Observer.of(ebac.Device(), ebac.Timing())],
    ids=["every law", "learns", "own"],
)
def test_an_observer_that_is_asked_for_is_refused(observer: Any) -> None:
    with pytest.raises(ValueError, match=r"Scenario\.observer: .* the device has no force sensor"):
        ebac.Scenario(device=BARE, observer=observer)
    with pytest.raises(
        ValueError,
        match=r"which needs a force sensor, and the device has none; use tca-damped-tuned$",
    ):
        ebac.simulate(SHORT.replace(device=BARE), "tca-damped-tuned-observer")


def test_the_option_takes_the_sensor_away() -> None:
    words = "wall --no-device-sensor --seconds 0.6 --law tca-damped,ebac --json"
    answer = json.loads(CliRunner().invoke(app, words.split()).stdout)
    assert answer["scenario"]["device"]["sensor"]["fitted"] is False
    bare = SHORT.replace(device=BARE, seconds=0.6)
    rests = [ebac.contact(ebac.simulate(bare, law)).rest_m for law in ("tca-damped", "ebac")]
    assert np.allclose([row["rest_m"] for row in answer["rows"]], rests, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("words", "answer"),
    [
        ("--device-noise 0.03", "--device-noise: the device has no force sensor that could have noise"),
        ("--device-lag 0.003", "--device-lag: the device has no force sensor that could have lag; leave it out"),
        ("--observer", "--observer: the observer needs a force sensor, and the device has none"),
        ("--observer-every-law", "--observer-every-law: the observer needs a force sensor, and the device has none"),
        ("--observer-learns", "--observer-learns: the observer needs a force sensor, and"),
    ],
)  # fmt: skip
def test_an_option_of_the_sensor_is_refused_without_one(words: str, answer: str) -> None:
    result = CliRunner().invoke(app, f"wall --no-device-sensor --seconds 0.1 {words}".split())
    assert result.exit_code == 2
    assert answer in " ".join(result.output.split())


def test_a_noise_that_is_refused_is_not_noted_too(tmp_path: Path) -> None:
    """A note said of the same option what the error says."""
    file = tmp_path / "bare.toml"
    file.write_text("device.sensor.fitted = false\n", encoding="utf-8")
    words = ["wall", "--scenario", str(file), "--device-noise", "0.03"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 2
    assert "Note" not in result.output
    assert result.output.count("no force sensor") == 1


def test_another_value_than_a_table_names_the_way_to_leave_it_out() -> None:
    with pytest.raises(
        ValueError, match=r"must be a table; a device without a sensor has .*fitted"
    ):
        ebac.Scenario.from_toml("[device]\nsensor = false\n")


def test_a_search_knows_the_reserve_of_a_law_that_has_no_observer() -> None:
    base = SHORT.replace(device=BARE)
    found = ebac.worst("ebac", family=["impact"], evaluations=40, base=base)
    trace = ebac.simulate(base, "ebac")
    assert found.reserve == trace["law.energy"][0] == pytest.approx(0.010)  # J


def without_sensor(law: str, *, fitted: bool) -> Configuration:
    """Return the joystick without the table [sensor], which says or does not say that its device has none."""
    text = joystick_text("joystick")
    first = text.index("[sensor]")
    text = text[:first] + text[text.index("[recording]") :]
    if not fitted:
        text = text.replace(
            "[device.kinematics]", "[device.sensor]\nfitted = false\n\n[device.kinematics]"
        )
    return Configuration.from_toml(text.replace('name = "ebac"', f'name = "{law}"'))


@pytest.mark.parametrize("law", ["ebac", "tca-damped", "lag-compensator"])
@pytest.mark.parametrize("fitted", [True, False])
def test_a_configuration_without_a_sensor_runs_on_the_virtual_clock(law: str, fitted: bool) -> None:
    trace = without_sensor(law, fitted=fitted).simulate(seconds=2.0)  # it meets the wall after 1 s
    assert trace["f_applied"].max() > 5  # N
    assert not trace["f_meas"].any()
    assert not trace["fault"].any()


def test_with_a_sensor_motion_is_watched_on_the_virtual_clock() -> None:
    known = Configuration.from_toml(joystick_text("joystick"))
    assert known.scenario().device.sensor.fitted
    numb = known.device.sensor.replace(scale=0.1)  # it hardly shows the hand
    with pytest.raises(ebac.LoopFault, match=r"fault 2[456]"):
        known.replace(device=known.device.replace(sensor=numb)).simulate(seconds=2.0)


def test_a_picture_shows_no_force_that_nothing_measured() -> None:
    for device, shown in ((ebac.Device(), True), (BARE, False)):
        axes = ebac.simulate(SHORT.replace(device=device), "direct").plot().axes
        labels = [line.get_label() for ax in axes for line in ax.lines]
        assert any("measured" in str(label) for label in labels) == shown


def test_a_session_refuses_an_observer_without_a_force_and_keeps_what_it_had(
    tmp_path: Path,
) -> None:
    bare = ebac.Scenario(device=BARE)
    with pytest.raises(ValueError, match="no force sensor is configured"):
        Session(bare, observer=True, virtual=True, folder=tmp_path)
    with Session(bare, virtual=True, paced=False, folder=tmp_path) as session:
        assert session.choices.observer is False
        session.start()
        session.advance(0.1)
        with pytest.raises(ValueError, match="no force sensor is configured"):
            session.change(observer=True)
        assert session.choices.observer is False
        assert session.running


def test_switching_a_noisy_sensor_off_is_no_doubt(tmp_path: Path) -> None:
    """It printed a note about the opposite option, --device-sensor."""
    file = tmp_path / "mine.toml"
    file.write_text("[device.sensor]\nnoise = 0.05\n", encoding="utf-8")
    words = ["wall", "--scenario", str(file), "--law", "direct", "--seconds", "0.1", "--no-files"]
    ran = CliRunner().invoke(app, [*words, "--no-device-sensor"])
    assert ran.exit_code == 0
    assert "Note" not in ran.output
    file.write_text("[device.sensor]\nnoise = 0.05\nfitted = false\n", encoding="utf-8")
    ran = CliRunner().invoke(app, words)
    assert "fitted = false, but noise = 0.05 N" in ran.output  # in a file it is doubtful
