"""The observer on hardware runs: how it is chosen, what a run says of it, and what its log replays to."""

import json
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.hardware import Configuration, ConfigurationError, OpenDevice, Run, under_the_law
from ebac.sensor import EmulatorTrouble, SimulatedSensor

EXAMPLE = Path(__file__).parents[2] / "examples" / "joystick.toml"
Opened: TypeAlias = Callable[
    [Configuration], AbstractContextManager[tuple[OpenDevice, SimulatedSensor]]
]
AtTick: TypeAlias = Callable[[int, Callable[[], None]], Callable[[Run], None]]
SENSOR = "[sensor]\nhost = '10.0.0.1'\n"


def patient(**changes: Any) -> Configuration:
    """The example with its observer, patient with a busy machine."""
    known = Configuration.load(EXAMPLE)
    limits = known.limits.replace(
        overruns=100_000, pause=100, jump=1.0, speed=100.0, force_age=10.0
    )
    return known.replace(silent=1000, limits=limits, observer=True, **changes)


# --- choosing it ---


UNFITTED = EXAMPLE.read_text().replace(
    "[device.kinematics]", "[device.sensor]\nfitted = false\n[device.kinematics]", 1
)


def test_an_observer_is_refused_where_the_device_denies_the_sensor_of_the_file() -> None:
    """[sensor] and `fitted = false` contradict each other: the observer would be ignored."""
    known = Configuration.from_toml(UNFITTED)
    said = r"there is a table \[sensor\], but \[device.sensor\] says fitted = false: take that line out"
    with pytest.raises(ValueError, match=said):
        known.replace(observer=True)
    with pytest.raises(ValueError, match=said):
        Configuration.from_toml(f"{UNFITTED}\n[observer]\n")


def test_the_command_refuses_it_and_does_not_recommend_it(tmp_path: Path) -> None:
    file = tmp_path / "unfitted.toml"
    file.write_text(UNFITTED)
    command = ["run", str(file), "--virtual", "--seconds", "0.5", "--no-files"]
    refused = CliRunner().invoke(app, [*command, "--observer"])
    assert refused.exit_code == 2
    assert "fitted = false" in refused.output
    ran = CliRunner().invoke(app, command)
    assert ran.exit_code == 0
    assert "--observer" not in ran.output


def test_a_table_turns_it_on_with_the_design_of_the_device() -> None:
    known = Configuration.from_toml(f"{SENSOR}[observer]\n[timing]\ndelay = 2\n")
    assert known.observer is True
    designed = ebac.Observer.of(known.device, known.timing)
    assert known.scenario().designed_observer() == designed
    assert designed.delay == 2
    changed = Configuration.from_toml(f"{SENSOR}[observer]\nforce_noise = 0.1\n")
    expected = ebac.Observer.of(known.device, ebac.Timing()).replace(force_noise=0.1)
    assert changed.observer == expected
    assert Configuration.from_toml(SENSOR).observer is False


def test_the_page_has_a_row_for_each_key() -> None:
    page = EXAMPLE.parents[1] / "docs" / "reference" / "configuration.md"
    table = page.read_text(encoding="utf-8").partition("<!-- table: keys-observer -->\n")[2]
    rows = table.partition("\n<!-- end -->")[0].splitlines()[2:]
    named = [row.split("`")[1] for row in rows]
    assert named == [one.name for one in ebac.Observer.fields()]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[observer]\n", "line 1: observer: estimates the state from a measured force"),
        (f"{SENSOR}[observer]\nmas = 1.0\n", "line 4: observer.mas: no such name"),
        (f"{SENSOR}[observer]\nmass = -1.0\n", "line 4: observer.mass = -1 kg: must lie in"),
    ],
)
def test_what_cannot_be_is_refused_with_its_line(text: str, words: str) -> None:
    with pytest.raises(ConfigurationError) as refused:
        Configuration.from_toml(text)
    assert words in str(refused.value)


def test_without_a_sensor_it_is_refused() -> None:
    with pytest.raises(ValueError, match=r"observer: .* add a table \[sensor\]"):
        patient(sensor=None)


# --- what a run says of it ---


def test_a_run_names_its_share_and_what_it_fell_back_to() -> None:
    trace = ebac.simulate(ebac.Scenario(seconds=0.1, observer=True))
    assert ebac.observer_use(trace) == ebac.ObserverUse(trusted=1.0, fallback={})
    weight, code = np.ones(len(trace)), np.zeros(len(trace), int)
    weight[50:], code[50:75] = 0.5, int(ebac.Fallback.FORCE_STALE)
    use = ebac.observer_use(
        trace.with_column("est.weight", weight).with_column("est.fallback", code)
    )
    assert use is not None
    assert use.trusted == 50 / 101
    assert use.fallback == {"force_stale": 25 / 101}
    assert str(use) == "trusted in 49.5 % of the ticks; encoder alone: force stale in 24.8 %"
    assert ebac.observer_use(ebac.simulate(ebac.Scenario(seconds=0.1, observer=False))) is None
    plain = ebac.observer_use(ebac.simulate(ebac.Scenario(seconds=0.1, observer=True), "tca"))
    assert plain == ebac.ObserverUse(trusted=0.0, fallback={"off": 1.0})


def test_the_command_turns_it_on_reports_it_and_logs_it(tmp_path: Path) -> None:
    run = ["run", str(EXAMPLE), "--virtual", "--seconds", "1.5"]
    done = CliRunner().invoke(app, [*run, "--observer", "--json", "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    assert told["observer"] == {"trusted": 1.0, "fallback": {}}
    assert told["scenario"]["observer"] is True
    (log,) = tmp_path.glob("*.mcap")
    trace = ebac.load(log)
    assert (trace["est.weight"] == 1).all()
    assert np.abs(trace["est.x"] - trace["x"]).max() <= Configuration.load(EXAMPLE).device.count
    info = CliRunner().invoke(app, ["log", "info", str(log), "--json"])
    assert json.loads(info.stdout)["observer"] == told["observer"]
    shown = CliRunner().invoke(app, [*run, "--observer", "--no-files"]).stdout
    assert "Observer: trusted in 100 % of the ticks." in shown
    without = CliRunner().invoke(app, [*run, "--no-observer", "--json"])
    assert json.loads(without.stdout)["observer"] is None


# --- in real time ---


@pytest.mark.real_time
@pytest.mark.slow
def test_the_same_press_has_the_same_verdict_on_either_clock_and_as_a_scenario(
    open_with_sensor: Opened,
) -> None:
    known = patient(seconds=4.0)
    with open_with_sensor(known) as (device, _):
        real = under_the_law(device.run())
    virtual, scenario = known.simulate(), ebac.simulate(known.scenario(), known.design())
    contacts = [ebac.contact(trace, truth=False) for trace in (real, virtual, scenario)]
    assert [one.verdict for one in contacts[1:]] == ["exact and quiet"] * 2
    # While ticks are skipped the handle moves on; a late tick is a step of the force; with a late force the law goes to
    # the encoder.
    late = real[1.0:]
    whole = not late["skipped"].any()
    assert (contacts[0].exact and contacts[0].still) or not whole
    for one in contacts if whole else contacts[1:]:
        assert contacts[2].rest_m == pytest.approx(one.rest_m, abs=2 * known.device.count)
    prompt = late["lateness"].max() < 3e-4 and late["est.weight"].min() == 1  # s
    assert contacts[0].quiet or not prompt
    for one in contacts if prompt else contacts[1:]:
        assert one.settled_s is not None
        assert contacts[2].settled_s == pytest.approx(one.settled_s, abs=0.2)
    acts_on_the_estimate_where_the_force_is_young(real)


def acts_on_the_estimate_where_the_force_is_young(trace: ebac.Trace) -> None:
    """How often that is, is up to the machine; a quiet one has no force that is stale, and skips no ticks.

    Behind skipped ticks the readings contradict the model for a while.
    """
    oldest, unbroken, fade = ebac.Observer().force_age, 0.1, 0.02  # s
    t, skipped = trace["t"], trace["skipped"] > 0

    def since(broken: Any) -> Any:
        return t - np.maximum.accumulate(np.where(broken, t, -np.inf))  # s

    young = (since(trace["ft.age"].max(axis=1) > oldest) > unbroken + fade + 2e-3) & (
        since(skipped) > 0.5
    )
    assert (trace["est.weight"][young] == 1).all()
    assert (trace["est.fallback"][young] == int(ebac.Fallback.NONE)).all()
    reasons = set(np.unique(trace["est.fallback"]))
    allowed = {ebac.Fallback.NONE, ebac.Fallback.FORCE_STALE}
    assert reasons <= {
        int(one) for one in (allowed | {ebac.Fallback.MODEL} if skipped.any() else allowed)
    }


@pytest.mark.real_time
@pytest.mark.slow
def test_a_sensor_that_falls_silent_fades_it_out_and_in_and_the_wall_holds(
    open_with_sensor: Opened, at_tick: AtTick, tmp_path: Path
) -> None:
    """During a contact. The log replays to the bit: ages of force and counts, and the arming, included."""
    known = patient(seconds=4.0)
    with open_with_sensor(known) as (device, sensor):

        def silent() -> None:
            sensor.inject(EmulatorTrouble(silent=True))
            time.sleep(0.3)
            sensor.inject(EmulatorTrouble())

        trace = device.run(log=tmp_path / "run.mcap", look=at_tick(2500, silent))
    part = under_the_law(trace)
    gone = part["est.fallback"][:, 0] == int(ebac.Fallback.FORCE_STALE)
    assert gone.mean() * 4 > 0.1
    assert (part["est.weight"][gone][40:] < 1).all()
    silent_at = part["t"][gone].min()
    # Back again. A machine that is busy may delay the force once more later, so not in the last tick.
    assert part["est.weight"][part["t"] > silent_at + 0.4].max() == 1
    pressed = part[2.0:]
    # Where ticks are late, the force of the tick before moves the handle until the wall has brought it back: 0.3 mm,
    # ten counts, on a machine busy with other things; else one or two counts.
    shallow, deep = np.percentile(pressed["x"][:, 0], [5, 95])
    assert deep - shallow < ebac.metrics.STILL_SWING
    if pressed["lateness"].max() < 3e-4:  # s
        assert np.ptp(pressed["x"][:, 0]) < ebac.metrics.STILL_SWING
    again = ebac.replay(tmp_path / "run.mcap", known.design())
    for name in ("est.x", "est.v_act", "est.weight", "est.fallback", "f_env", "f_cmd"):
        np.testing.assert_array_equal(again[name][: len(part)], part[name], err_msg=name)
