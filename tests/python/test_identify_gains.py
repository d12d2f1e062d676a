"""Gains from a log: what is chosen keeps its constraints, costs no more than the default, and runs in a scenario."""

import json
import re
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac import identify
from ebac.cli import app, by_option
from ebac.cli.by_option import columns_in_options
from ebac.cli.identify.gains import _note_other_device, _notes, _parts, _table_of_law
from ebac.hardware import Configuration
from ebac.identify import Limits, Recording, Target, fit_gains, fit_loop
from ebac.identify.figures import plot_gains
from ebac.identify.gains.check import MEASURES, check_gains
from ebac.identify.gains.press_trials import arms_around, force_loop_laws, noise_gain, run_presses
from ebac.identify.gains.search import blocked_step, by_rule, by_tangent
from ebac.identify.gains.table import HOW, compare, gains_rows, side_by_side
from ebac.identify.gains.trial import ALIKE, allowances, cost, spare


@pytest.fixture(scope="module")
def trace() -> ebac.Trace:
    hand = ebac.Hand(
        mass=0.2,
        damping=5,
        stiffness=300,
        path=ebac.Tapping(target=0.03, rest=-0.01, frequency=1.5),
    )
    scenario = ebac.Scenario(
        hand=hand,
        device=ebac.Device(sensor=ebac.ForceSensor(noise=0.03, quantum=0.01)),
        environment=ebac.Wall(stiffness=3e3),
        seconds=4.0,
    )
    return ebac.simulate(scenario, "ebac")


@pytest.fixture(scope="module")
def loop(trace: ebac.Trace):
    recording = Recording.from_trace(trace)
    return fit_loop(recording, Target.of(trace.scenario.hand, recording.t))


def test_columns_that_are_not_used_are_named_since_one_may_be_the_desired_force(trace) -> None:
    """A column F_wall was ignored without a remark, and the wall was one of 10 kN/m."""
    recording = Recording.from_trace(trace)
    lacks = replace(recording, motor=None, desired=None, unread=("Temp", "F_wall"))
    said = fit_loop(lacks, Target.of(trace.scenario.hand, recording.t)).remarks
    begin = "not used: Temp, F_wall (columns="
    for signal in ("motor", "desired"):
        hint = f"name its column as the signal {signal}, if it is one that is {begin}{{'{signal}': 'F_wall'}})"
        assert sum(text.endswith(hint) for text in said) == 1
    assert columns_in_options(said[1]).endswith("F_wall (--column desired=F_wall)")
    whole = fit_loop(replace(recording, unread=("Temp",)), wall=ebac.Wall()).remarks
    assert not any("not used" in text for text in whole)


@pytest.fixture
def few_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    """A ninth of the first looks, where it does not matter how good the choice is."""
    monkeypatch.setattr("ebac.identify.gains.search.LOOKS", (0.0, 0.25))


@pytest.fixture(scope="module")
def chosen(loop):
    return fit_gains(loop, "tca", evaluations=15)


def test_the_loop_is_that_of_the_log(loop) -> None:
    assert loop.wall.stiffness == pytest.approx(3e3, rel=0.01)
    assert loop.device.mass == pytest.approx(0.25, rel=0.02)
    assert loop.arm["K0"].value == pytest.approx(300, rel=0.01)
    assert loop.scenario.hand.mass == pytest.approx(0.2, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("file", ["log.csv", "log.npz", "late.mcap"])
def test_the_wall_of_an_observed_loop_is_where_it_was_met(trace, file: str, tmp_path) -> None:
    """The observer asks the world ahead of the reading: against x the wall would be 7 % too soft."""
    path = tmp_path / file
    if file.startswith("late"):  # rows that are not equally spaced
        t = trace["t"].copy()
        t[1::2] += 2e-5
        trace = trace.with_column("t", t)
    trace.to_csv(path) if path.suffix == ".csv" else trace.save(path)
    loop = fit_loop(identify.load(path), Target.of(trace.scenario.hand, trace["t"]))
    assert loop.wall.stiffness == pytest.approx(3e3, rel=0.02)


@pytest.mark.slow
def test_the_choice_keeps_all_and_costs_less(chosen) -> None:
    assert chosen.chosen.broken == ()
    assert chosen.chosen.cost < 0.8  # of the default, which shakes
    assert chosen.default.cost == pytest.approx(1.0)
    assert chosen.chosen.cost == min(c.cost for c in chosen.tried if not c.broken)
    numbers, before = chosen.chosen.presses.numbers(), chosen.default.presses.numbers()
    assert numbers["swing_worst_m"] < before["swing_worst_m"]
    assert numbers["least_energy_J"] >= -chosen.limits.energy


@pytest.mark.parametrize("law", ["ebac", "tca-damped"])
@pytest.mark.usefixtures("few_looks")
def test_nothing_of_a_sound_default_is_given_back(loop, law: str) -> None:
    """Of defaults that keep all constraints: settling, swing and noise are each no worse."""
    found = fit_gains(loop, law, limits=Limits(energy=0.2), evaluations=6)
    assert found.turned_down is None
    assert found.default.broken == ()
    assert not found.default.close
    alike = allowances(found.default.presses, loop.scenario)
    assert all(found.chosen.ratios[name] <= 1 + a for name, a in alike.items())
    assert found.chosen.cost <= found.default.cost == pytest.approx(1.0)
    assert set(found.default.ratios.values()) == {1.0}


@pytest.mark.slow
@pytest.mark.usefixtures("few_looks")
def test_a_default_that_breaks_a_constraint_is_turned_down(loop) -> None:
    """The choice costs no more than what is left of it."""
    found = fit_gains(loop, "tca-damped", evaluations=6)
    less = found.turned_down
    assert found.default.broken == ("energy",)
    assert less is not None
    assert not less.broken
    assert not less.close
    assert 0 < less.kp < found.default.kp
    assert found.chosen.cost <= less.cost
    assert found.chosen.broken == ()


def test_other_hands_find_something_to_spare(chosen) -> None:
    c = chosen.chosen
    assert not c.close
    numbers, limits = c.presses.numbers(), chosen.limits
    assert numbers["overshoot_worst_m"] <= 0.9 * limits.overshoot * (1 + 1e-6)
    assert numbers["least_energy_J"] >= -0.9 * limits.energy * (1 + 1e-6)
    none = Limits(energy=0.0)  # of nothing, nothing can be spared
    assert spare(c.presses, 0.1, none)["energy"] == pytest.approx(-numbers["least_energy_J"] / 1e-6)


def test_of_several_axes_the_one_that_presses_is_drawn(loop, chosen) -> None:
    two = replace(loop, device=loop.device.replace(kinematics=ebac.Linear(axes=2)))
    motion, *_ = plot_gains(replace(chosen, loop=two)).axes
    assert len(motion.get_legend_handles_labels()[1]) == 3  # default, rule, choice


def test_the_law_runs_in_a_scenario(chosen) -> None:
    contact = ebac.contact(ebac.simulate(chosen.scenario, chosen.law))
    assert contact.settled_s is not None
    assert contact.swing_m < 0.25e-3


@pytest.mark.usefixtures("few_looks")
def test_a_tighter_constraint_holds(loop) -> None:
    found = fit_gains(loop, "ebac", limits=Limits(noise_gain=0.05), vary=0.0, evaluations=10)
    assert found.chosen.noise_gain <= 0.05
    assert found.chosen.kp <= 0.05


@pytest.mark.usefixtures("few_looks")
def test_what_no_gains_keep_is_refused(loop) -> None:
    with pytest.raises(
        ValueError, match=r"no pair of gains keeps the constraints: broken are .*force"
    ) as refused:
        fit_gains(loop, "ebac", limits=Limits(force=0.1), vary=0.0, evaluations=2)
    said = str(refused.value)
    assert re.search(
        r"; loosen them by limits=Limits\(.*force=\.\.\..*\), or choose another law$", said
    )


def test_the_command_names_the_options_that_loosen_constraints(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    options = {"noise_gain": "--noise-gain", "energy": "--energy", "max_force": "--max-force"}
    monkeypatch.setattr(by_option, "current", options)
    said = (
        "loosen them by limits=Limits(noise_gain=..., energy=..., force=...), or choose another law"
    )
    assert by_option.in_options(said) == (
        "loosen them by --noise-gain and --energy and --max-force, or choose another law"
    )


def test_where_the_force_loop_buys_nothing_the_gains_to_copy_are_zero(chosen) -> None:
    """A kp of 7.8e-07 was printed to copy."""
    zero = next(one for one in chosen.tried if one.kp == one.kd == 0)
    zero = replace(zero, broken=(), close=False)
    tiny = replace(zero, kp=7.798e-7, name="chosen")
    idle = replace(chosen, chosen=tiny, tried=(zero, tiny, chosen.default))
    assert _table_of_law(idle) == '[law]\nname = "tca"\nkp = 0 # 1\nkd = 0 # s'
    notes = _notes(idle, None)
    assert notes[0].startswith("The force loop buys nothing here: kp = 0.")
    assert notes[-1].endswith('("tca", {"kp": 0, "kd": 0})')
    used = replace(tiny, kp=2e-3)
    assert _table_of_law(replace(idle, chosen=used)) == _table_of_law(idle)
    better = replace(used, ratios={**tiny.ratios, "noise": tiny.ratios["noise"] - 2 * ALIKE})
    for other in (
        replace(idle, chosen=better),
        replace(idle, chosen=used, tried=(replace(zero, broken=("energy",)), chosen.default)),
        replace(idle, chosen=used, tried=(replace(zero, close=True), chosen.default)),
    ):
        assert "kp = 0.002 # 1" in _table_of_law(other)
        assert not any("The force loop buys nothing" in text for text in _notes(other, None))
    by_kd = replace(idle, chosen=replace(better, kp=7.798e-7, kd=1e-3))
    assert _table_of_law(by_kd).endswith("kp = 0 # 1\nkd = 0.001 # s")
    assert _notes(by_kd, None)[0].startswith(
        "kp buys nothing here: kp = 0. The force loop acts by kd"
    )
    both = replace(idle, chosen=replace(better, kd=1e-3))
    assert _table_of_law(both).endswith("kp = 0.002 # 1\nkd = 0.001 # s")
    assert not any("buys nothing" in text for text in _notes(both, None))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"law": "eba"}, "law 'eba': has no force loop of eq. "),
        ({"vary": -1.0}, r"vary = -1: must lie in \[0, 3\]"),
        ({"evaluations": 0}, "evaluations = 0: must lie in"),
        ({"threads": 0}, r"threads = 0: must lie in \[1, 1024\]"),
    ],
)
def test_bad_wishes_are_refused(loop, change: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        fit_gains(loop, **change)


def test_axes_that_are_not_straight_are_refused_with_what_to_give_instead(loop) -> None:
    joystick = ebac.presets.device("joystick")
    with pytest.raises(ValueError, match=r"device = a Gimbal: .*Linear\(radius=0.1\)"):
        fit_gains(replace(loop, device=joystick))
    straight = joystick.replace(kinematics=ebac.Linear(radius=joystick.radius))
    assert (straight.axes, straight.count) == (1, joystick.count)


@pytest.mark.parametrize("name", ["overshoot", "force", "current", "noise_gain", "energy"])
def test_a_limit_below_zero_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match=f"Limits.{name} = -1.*must be (positive|at least 0)"):
        Limits(**{name: -1.0})


def test_a_hand_that_is_not_told_has_no_gains() -> None:
    scenario = ebac.Scenario(environment=ebac.Free(), seconds=2.0)
    loop = fit_loop(Recording.from_trace(ebac.simulate(scenario, "direct")))
    with pytest.raises(
        ValueError, match=r"not determined by this log.*held in one place.*--switch"
    ):
        fit_gains(loop)


@pytest.mark.slow
def test_a_wrong_time_of_the_switch_is_doubted() -> None:
    loop = fit_loop(Recording.from_trace(ebac.datasets.press()), Target.steps(2.5))
    with pytest.raises(ValueError, match=r"change at 2\.5 s .* first moves at 1\.0\d? s"):
        fit_gains(loop)


@pytest.mark.slow
def test_a_force_of_the_other_sign_is_named() -> None:
    log = Recording.from_trace(ebac.datasets.press()).flipped()
    loop = fit_loop(log, Target.steps(1.0))
    with pytest.raises(ValueError, match=r"no hand to simulate.*--flip-force turns the sign"):
        fit_gains(loop)


# --- pieces ---

RATIOS = st.dictionaries(
    st.sampled_from(["settling", "swing", "noise"]), st.floats(0.01, 5), min_size=3, max_size=3
)


@given(over=RATIOS, name=st.sampled_from(["settling", "swing", "noise"]), less=st.floats(0.1, 0.99))
def test_a_cost_pays_no_loss_with_a_gain(over: dict, name: str, less: float) -> None:
    alike = {"settling": 0.005, "swing": ALIKE, "noise": ALIKE}
    assert cost(dict.fromkeys(alike, 1.0), alike) == pytest.approx(1.0)
    found = cost(over, alike)
    assert found > 0
    lost = any(over[n] >= 1 + a for n, a in alike.items())
    assert lost == (found >= cost({n: 1 + a for n, a in alike.items()}, alike))
    assert cost({**over, name: less * over[name]}, alike) <= found
    assert cost({**over, name: float("nan")}, alike) > 100


def test_the_laws_with_a_force_loop() -> None:
    assert {"tca", "tca-damped", "ebac"} <= set(force_loop_laws())
    assert "eba" not in force_loop_laws()


@settings(max_examples=25, deadline=None)
@given(
    kp=st.floats(0, 2),
    kd=st.floats(0, 5e-3),
    filter_s=st.floats(1e-3, 2e-2),
)
def test_the_noise_gain_is_what_the_law_does_to_noise(
    kp: float, kd: float, filter_s: float
) -> None:
    """The answer of eq. (2) to one reading, by the law itself."""
    law = ebac.TCA(kp=kp, kd=kd, filter=filter_s, peak_force=1e4)
    answer = []
    for k in range(400):
        port = ebac.Port(dt=1e-3, f_meas=1.0 if k == 1 else 0.0)
        answer.append(law.step(port))
    assert noise_gain(kp, kd, filter_s, 1e-3) == pytest.approx(
        float(np.linalg.norm(answer)), rel=1e-6, abs=1e-9
    )


def test_hands_around_hold_the_interval(loop) -> None:
    hands = arms_around(loop.arm, 0.3)
    assert len(hands) == 15
    assert hands[0] == loop.arm.hand
    lightest, heaviest = min(h.mass for h in hands), max(h.mass for h in hands)
    assert lightest == pytest.approx(hands[0].mass / 1.3)
    assert heaviest == pytest.approx(hands[0].mass * 1.3)
    narrow = arms_around(loop.arm, 0.0)
    e = loop.arm["K0"]
    assert max(h.stiffness for h in narrow) <= e.high + 0.2 * (e.high - e.low)


def test_presses_are_the_runs_of_a_simulation(loop) -> None:
    scenario = loop.scenario
    found = run_presses([scenario], "ebac", {"kp": 0.2})
    trace = ebac.simulate(scenario, ebac.laws.Variant("ebac", {"kp": 0.2}))
    contact = ebac.contact(trace)
    assert found.columns["rest"][0] == pytest.approx(contact.rest_m, abs=1e-12)
    assert found.columns["most_force"][0] == pytest.approx(np.abs(trace["f_applied"]).max())
    assert found.overshoot[0] == pytest.approx(contact.peak_m - contact.ideal_m, abs=1e-9)


@settings(deadline=None)
@given(dead=st.floats(1e-4, 1e-2), rise=st.floats(1e-4, 1e-2))
def test_a_tangent_finds_a_dead_time(dead: float, rise: float) -> None:
    t = np.linspace(0, dead + 12 * rise, 20001)
    y = np.where(t > dead, 1 - np.exp(-(t - dead) / rise), 0.0)
    read = by_tangent(t, y)
    assert read.gain == pytest.approx(1, rel=1e-3)
    assert read.dead_time == pytest.approx(dead, abs=0.02 * (dead + rise))
    assert read.rise_time == pytest.approx(rise, rel=0.05)


def test_the_rule_and_its_step_response() -> None:
    device, timing = ebac.Device(), ebac.Timing()
    t, y = blocked_step(device, timing)
    assert y[t <= 1e-3].max() == 0
    assert y[-1] == pytest.approx(1, abs=1e-4)
    kp, kd = by_rule("step-response", device, timing)
    assert 0.1 < kp < 1
    assert 0 < kd < 1e-3
    slower = by_rule("step-response", device, ebac.Timing(delay=3))
    assert slower[0] < kp  # more dead time, less gain
    with pytest.raises(ValueError, match="rule 'magic': no such name; there are: step-response"):
        by_rule("magic", device, timing)
    with pytest.raises(ValueError, match="does not rise"):
        by_tangent(t, -y)


# --- on hands that were not in the log ---


@pytest.mark.slow
def test_chosen_gains_beat_the_default_on_held_out_hands() -> None:
    rows = gains_rows(check_gains(2, seed=1, laws=("tca",), evaluations=6))
    default, chosen = (row for row in rows if row["over"] == "all")
    assert chosen["settled"] > default["settled"]
    assert chosen["swing_worst_m"] < default["swing_worst_m"]
    assert chosen["noise_median_N"] < default["noise_median_N"]
    assert chosen["logs_with_broken_constraint"] == 0
    for name in MEASURES:
        assert chosen[f"{name}_better"] > chosen[f"{name}_worse"]
        assert sum(chosen[f"{name}_{how}"] for how in HOW) == chosen["presses"]
    sides = [r for r in rows if r["over"] in ("default keeps", "default breaks")]
    assert sum(r["presses"] for r in sides) == default["presses"] + chosen["presses"]
    with pytest.raises(ValueError, match="logs = 0: must be at least 1"):
        check_gains(0)
    heading, *lines = side_by_side(json.loads(json.dumps(rows)))
    assert {len(line) for line in lines} == {len(heading)}


def test_equal_is_what_noise_changes_and_never_is_never() -> None:
    inf = np.inf
    default = np.array([1.0, 1.0, 1.0, 1.0, inf, inf, 1.0])
    chosen = np.array([0.9, 1.1, 1.02, 0.999, inf, 1.0, inf])
    scatter = np.array([0.0, 0.05, 0.05, 0.0, np.nan, np.nan, np.nan])
    assert compare(chosen, default, scatter, 1e-3) == {"better": 2, "equal": 3, "worse": 2}


@pytest.mark.slow
@pytest.mark.usefixtures("few_looks")
def test_the_command_writes_a_report_and_json(
    tmp_path: Path, trace: ebac.Trace, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(identify, "fit_gains", partial(fit_gains, evaluations=3))
    trace.to_npz(tmp_path / "log.npz")
    out = tmp_path / "report"
    run = CliRunner().invoke(
        app,
        ["identify", "gains", str(tmp_path / "log.npz"), "--tapping", "1.5", "--law", "tca-damped",
         "--json", "--out", str(out)],
    )  # fmt: skip
    assert run.exit_code == 0, run.output
    document = json.loads(run.stdout)
    assert [row["gains"] for row in document["rows"]] == ["default", "step-response", "chosen"]
    assert document["rows"][-1]["broken"] == []
    assert (out / "gains.html").read_text().count("data:image/png") == 1
    assert (out / "gains.png").stat().st_size > 10_000


def test_device_wall_and_delay_may_be_those_of_a_configuration(tmp_path: Path) -> None:
    file = tmp_path / "joystick.toml"
    file.write_text(ebac.datasets.joystick_text(), encoding="utf-8")
    device, wall, delay = _parts(file)
    known = Configuration.load(file)
    assert device is not None
    assert device.mass == known.device.mass
    assert (wall, delay) == (known.environment, known.timing.delay)


def test_a_log_of_another_device_than_that_of_the_file_is_noted(
    loop, capsys: pytest.CaptureFixture[str]
) -> None:
    file, device = Path("mine.toml"), loop.device
    heavy = device.mechanics.replace(handle_mass=device.mechanics.handle_mass + 0.35)
    _note_other_device(file, device.replace(mechanics=heavy), loop)
    said = " ".join(capsys.readouterr().err.split())
    found = loop.found.estimates["M_h"]
    assert (
        f"mine.toml: mass at the handle = {found.value + 0.35:.4g} kg, but the log shows M_h"
        in said
    )
    _note_other_device(file, device, loop)
    assert capsys.readouterr().err == ""


@pytest.mark.slow
@pytest.mark.usefixtures("few_looks")
def test_the_command_takes_device_wall_and_delay_of_a_file(
    tmp_path: Path, trace: ebac.Trace, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It chose gains for the reference device and a wall of 10 kN/m, and nothing could change that."""
    monkeypatch.setattr(identify, "fit_gains", partial(fit_gains, evaluations=3))
    trace.to_npz(tmp_path / "log.npz")
    file = tmp_path / "device.toml"
    file.write_text(
        "[device.drive]\npeak_ratio = 2.0\n[environment]\nstiffness = 4e3\n[timing]\ndelay = 2\n"
    )
    seen = []
    monkeypatch.setattr(
        identify, "fit_loop", lambda *a, **k: (seen.append(k), fit_loop(*a, **k))[1]
    )
    words = [
        "identify",
        "gains",
        str(tmp_path / "log.npz"),
        "--tapping",
        "1.5",
        "--law",
        "tca-damped",
    ]
    run = CliRunner().invoke(app, [*words, "--scenario", str(file)])
    assert run.exit_code == 0, run.output
    (given,) = seen
    assert given["device"].drive.peak_ratio == 2.0
    assert given["wall"].stiffness == 4e3
    assert given["timing"].delay == 2
    assert 'name = "tca-damped"' in run.stdout
    assert "# s" in run.stdout
    file.write_text("[environment]\ntype = 'Free'\n")
    refused = CliRunner().invoke(app, [*words, "--scenario", str(file)])
    assert refused.exit_code == 2
    assert "environment is a Free: gains are chosen at a wall" in " ".join(refused.output.split())


@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.usefixtures("few_looks")
def test_the_command_prints_what_it_guessed_of_the_log(
    tmp_path: Path, trace: ebac.Trace, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(identify, "fit_gains", partial(fit_gains, evaluations=3))
    names = {"t": "t", "x": "x", "force": "f_meas", "motor": "f_applied", "desired": "f_env"}
    rows = np.array([trace[column] for column in names.values()]).T
    log = tmp_path / "log.csv"
    np.savetxt(log, rows, delimiter=",", header=",".join(names), comments="")
    run = CliRunner().invoke(
        app, ["identify", "gains", str(log), "--tapping", "1.5", "--law", "tca-damped"]
    )
    assert run.exit_code == 0, run.output
    said = " ".join(run.stdout.split())
    for column in names:
        assert f"log.csv: {column}: guessed to be column '{column}'" in said
    assert "log.csv: target of the hand: taps at 1.5 Hz" in said


@pytest.mark.slow
@pytest.mark.usefixtures("few_looks")
def test_the_command_says_where_no_gains_change_anything(
    tmp_path: Path, trace: ebac.Trace, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(identify, "fit_gains", partial(fit_gains, evaluations=3))
    trace.to_npz(tmp_path / "log.npz")
    words = ["identify", "gains", str(tmp_path / "log.npz"), "--tapping", "1.5", "--law"]
    said = {law: CliRunner().invoke(app, [*words, law]).stdout for law in ("ebac", "tca-damped")}
    told = {law: "No pair of gains changes anything" in text for law, text in said.items()}
    assert told == {"ebac": True, "tca-damped": False}


def test_the_command_refuses_a_law_without_force_loop(tmp_path: Path, trace: ebac.Trace) -> None:
    trace.to_npz(tmp_path / "log.npz")
    run = CliRunner().invoke(
        app, ["identify", "gains", str(tmp_path / "log.npz"), "--tapping", "1.5", "--law", "eba"]
    )
    assert run.exit_code == 2
    assert "has no force loop" in " ".join(run.stderr.split())


@pytest.mark.slow
@pytest.mark.weekly
@pytest.mark.usefixtures("few_looks")
def test_the_check_shows_units_and_gives_plain_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = check_gains(1, seed=4, evaluations=3)
    monkeypatch.setattr("ebac.identify.gains.check.check_gains", lambda *_, **__: cases)
    monkeypatch.setenv("COLUMNS", "110")
    run = CliRunner().invoke(app, ["identify", "check", "gains", "--logs", "1", "--seed", "4"])
    assert run.exit_code == 0, run.output
    for unit in (
        "settling, median [ms]",
        "swing, median [um]",
        "[mJ]",
        "worse [1]",
        "noise, median [mN]",
    ):
        assert unit in run.stdout
    run = CliRunner().invoke(app, ["identify", "check", "gains", "--json"])
    rows = json.loads(run.stdout)["rows"]
    assert {r["law"] for r in rows} == {"tca", "tca-damped", "ebac"}
    assert all(("settled_worse" in r) == (r["gains"] == "chosen") for r in rows)
