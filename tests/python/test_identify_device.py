"""The device from a log: mass, damping, friction, weight come back, by either force; what does not slide is refused."""

import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.identify import Recording, excitation, fit_device
from ebac.identify.cases import draw_device
from ebac.identify.check import check, run_device_case
from ebac.identify.device_problem import driven, jumps
from ebac.identify.signals import ripple, stair


def moved(seconds: float = 5.0, **mechanics: float) -> ebac.Trace:
    t, x = excitation.multisine(0.03, low=0.2, high=4, seconds=seconds)
    device = ebac.Device(
        mechanics=ebac.Mechanics(**{"damping": 3, "coulomb": 0.4, **mechanics}),
        sensor=ebac.ForceSensor(noise=0.02),
    )
    hand = ebac.Hand(mass=0.1, damping=10, stiffness=900, path=excitation.path(t, x))
    scenario = ebac.Scenario(
        device=device, hand=hand, environment=ebac.Wall(stiffness=500), seconds=seconds
    )
    return ebac.simulate(scenario, "direct")


@pytest.fixture(scope="module")
def trace() -> ebac.Trace:
    return moved(gravity=2.0)


def holds(e, truth: float, more: float = 1.0) -> bool:
    half = 0.5 * (e.high - e.low) * (1 + more)
    return abs(e.value - truth) <= half


def test_everything_comes_back(trace: ebac.Trace) -> None:
    device = trace.scenario.device
    found = fit_device(Recording.from_trace(trace))
    e = found.estimates
    assert e["M_h"].value == pytest.approx(device.mass, rel=0.01)
    assert holds(e["M_h"], device.mass)
    assert holds(e["B_h"], 3.0)
    assert holds(e["coulomb"], 0.4)
    assert holds(e["weight"], 2.0 * device.mechanics.handle_mass)
    assert found.undetermined == ()
    assert 0.3 < found.compensation.friction <= 0.42
    assert found.stribeck_speed is None


@pytest.mark.parametrize("gravity", [2.0, -4.0])
def test_weight_either_way_is_carried(gravity: float) -> None:
    """It once said gravity_mass = 0 beside a weight along +x, which a handle carries as well."""
    found = fit_device(Recording.from_trace(moved(gravity=gravity)))
    weight = abs(gravity) * ebac.Mechanics().handle_mass
    assert 0.9 * weight < found.compensation.gravity_mass * 9.80665 <= 1.01 * weight
    assert found.gravity == math.copysign(9.80665, gravity)
    still = ebac.Device(
        mechanics=ebac.Mechanics(gravity=found.gravity, handle_mass=weight / 9.80665),
        compensation=found.compensation.replace(friction=0.0),
    )
    nobody = ebac.Hand(mass=0, damping=0, stiffness=0)
    drift = ebac.Scenario(device=still, hand=nobody, environment=ebac.Free(), seconds=0.5)
    speed = abs(ebac.simulate(drift, "direct")["true.v"][-1])
    assert speed < 0.1 * weight / 2.0  # of what the weight alone comes to against 2 N s/m


def test_the_hand_alone_determines_where_no_motor_acts(trace: ebac.Trace) -> None:
    scenario = trace.scenario.replace(environment=ebac.Free())
    r = Recording.from_trace(ebac.simulate(scenario, "direct"))
    found = fit_device(Recording(name="log", t=r.t, x=r.x, force=r.force, count=r.count, lag=r.lag))
    assert found.estimates["M_h"].value == pytest.approx(scenario.device.mass, rel=0.02)


def test_a_force_of_the_other_sign_is_named_and_never_turned_silently(
    tmp_path: Path, trace: ebac.Trace
) -> None:
    log = Recording.from_trace(trace)
    wrong = fit_device(log.flipped())
    assert wrong.explained < 0.8 < wrong.other_signs["force"]
    assert "--flip-force" in wrong.misses[0]
    assert wrong.misses[0] in repr(wrong)
    assert fit_device(log).misses == ()
    rows = np.column_stack([log.t, log.x, -log.force, log.motor])
    file = tmp_path / "device.csv"
    np.savetxt(file, rows, fmt="%.9g", delimiter=",", header="t,x,force,motor", comments="")
    run = CliRunner().invoke(app, ["identify", "device", str(file)])
    assert run.exit_code == 1
    assert "--flip-force" in run.output
    run = CliRunner().invoke(app, ["identify", "device", str(file), "--flip-force"])
    assert "seems to hold" not in run.output


def test_a_figure_says_whether_the_log_is_simulated(tmp_path: Path, trace: ebac.Trace) -> None:
    pytest.importorskip("matplotlib")
    from ebac.identify import load
    from ebac.identify.figures import plot_device

    trace.save(tmp_path / "run.npz")
    trace.save(tmp_path / "run.csv")
    ebac.datasets.write("device", tmp_path)
    text = (tmp_path / "device.csv").read_text(encoding="utf-8")
    (tmp_path / "plain.csv").write_text(text.partition("\n")[2], encoding="utf-8")
    for name in ("run.npz", "run.csv", "device.csv"):
        assert load(tmp_path / name).origin == "simulated"
    recorded = load(tmp_path / "plain.csv")
    assert recorded.origin == "recorded"
    figure = plot_device(fit_device(recorded))
    assert "plain.csv (recorded)" in figure.get_suptitle()
    assert "recorded, smoothed" in [text.get_text() for text in figure.axes[1].get_legend().texts]


def test_a_friction_that_falls_with_speed_is_reported() -> None:
    found = fit_device(Recording.from_trace(moved(breakaway=0.9, stribeck_speed=0.02)))
    assert found.stribeck_speed is not None
    assert found.estimates["stribeck"].value == pytest.approx(0.5, rel=0.4)
    assert found.estimates["coulomb"].value == pytest.approx(0.4, rel=0.15)


@pytest.mark.parametrize(
    ("x", "message"),
    [
        (np.where(np.arange(800) % 2 == 0, 0.0, 1e-5), "slides in 0 rows only"),
        (np.linspace(0, 0.5, 800), "moves one way only"),
    ],
)
def test_what_does_not_slide_both_ways_is_refused(x: np.ndarray, message: str) -> None:
    t = np.arange(800) / 1000
    with pytest.raises(ValueError, match=message):
        fit_device(Recording(name="log", t=t, x=x, force=np.ones(800)))


def test_rows_that_do_not_slide_are_left_out(trace: ebac.Trace) -> None:
    drive = driven(Recording.from_trace(trace), 3e-4)
    v = np.abs(trace["true.v"].ravel())
    assert drive.slides.mean() > 0.3
    assert v[drive.slides].min() > 0
    assert (np.sign(trace["true.v"].ravel())[drive.slides] == drive.sign[drive.slides]).all()


# --- the motor's stair ---


@settings(max_examples=20, deadline=None)
@given(
    current_lag=st.floats(1e-5, 2e-3),
    lag=st.floats(1e-5, 3e-3),
    seed=st.integers(0, 99),
)
def test_a_stair_behind_two_lags_is_exact(current_lag: float, lag: float, seed: int) -> None:
    """Against the matrix exponential of the two differential equations, and of the integral of the second."""
    linalg = pytest.importorskip("scipy.linalg")
    assume(abs(current_lag / lag - 1) > 0.05)
    levels = np.random.Generator(np.random.PCG64(seed)).standard_normal(120)
    levels[:60] = levels[0]  # both lags have settled where the log begins
    here, beyond = stair(levels, 1e-3, current_lag, lag)
    a = np.zeros((4, 4))  # motor, sensor, integral of the sensor, level
    a[0, 0], a[0, 3] = -1 / current_lag, 1 / current_lag
    a[1, 0], a[1, 1] = 1 / lag, -1 / lag
    a[2, 1] = 1
    tick = linalg.expm(1e-3 * a)
    z = np.array([levels[0], levels[0], 0.0, levels[0]])
    rows, means = [], []
    for level in levels[1:]:
        rows.append(z[1])
        z[2], z[3] = 0.0, level
        z = tick @ z
        means.append(z[2] / 1e-3)
    assert np.abs(here[:-1] - rows).max() < 1e-6
    sharp = here - np.diff(here, 2, prepend=here[0], append=here[-1]) / 12
    assert (
        np.abs((beyond + 0.5 * (sharp + np.append(sharp[1:], sharp[-1])))[:-2] - means[:-1]).max()
        < 1e-9
    )


def test_no_motor_no_ripple(trace: ebac.Trace) -> None:
    r = Recording.from_trace(trace)
    assert not ripple(Recording(name="log", t=r.t, x=r.x, force=r.force)).any()
    assert np.abs(ripple(r)).max() > 0


def test_ripple_of_a_force_that_holds_still_is_none() -> None:
    here, beyond = stair(np.full(100, 3.0), 1e-3, 3e-4, 8e-4)
    assert np.abs(here - 3).max() < 1e-9
    assert np.abs(beyond).max() < 1e-9


def test_a_jump_of_the_hand_is_seen(trace: ebac.Trace) -> None:
    r = Recording.from_trace(trace)
    force = r.force.copy()
    force[1000:] += 5.0
    doubt = jumps(Recording(name="log", t=r.t, x=r.x, force=force))
    assert doubt[996:1004].min() > 1.0
    assert np.median(doubt) == 0


# --- how honest ---


def test_a_case_of_the_check() -> None:
    outcomes = run_device_case(draw_device(2, 1, 4.0))
    mass = next(o for o in outcomes if o.parameter == "M_h")
    assert mass.determined
    assert abs(mass.error) < 0.02


def test_a_press_that_sticks_is_called_so() -> None:
    case = next(c for c in (draw_device(i, 1, 2.0) for i in range(40)) if c.task == "press")
    assert not any(o.determined for o in run_device_case(case) if o.parameter == "B_h")


def test_bad_wishes_of_a_check_are_refused() -> None:
    with pytest.raises(ValueError, match="what = 'wall': must be arm, device or scale"):
        check(1, what="wall")
    with pytest.raises(ValueError, match="arms = 0: must be at least 1"):
        check(0)


@pytest.mark.slow
def test_the_command_writes_a_report_and_json(tmp_path: Path, trace: ebac.Trace) -> None:
    trace.to_npz(tmp_path / "log.npz")
    out = tmp_path / "report"
    run = CliRunner().invoke(
        app, ["identify", "device", str(tmp_path / "log.npz"), "--json", "--out", str(out)]
    )
    assert run.exit_code == 0, run.output
    document = json.loads(run.stdout)
    assert {row["name"] for row in document["rows"]} >= {"M_h", "B_h", "coulomb", "weight"}
    assert document["compensation"]["friction"] > 0.3
    assert (out / "device.html").read_text().count("data:image/png") == 1


def test_the_command_prints_what_a_device_file_takes(tmp_path: Path, trace: ebac.Trace) -> None:
    """It printed a compensation in Python, and nothing to paste."""
    trace.to_npz(tmp_path / "log.npz")
    file = tmp_path / "mine.toml"
    file.write_text("[device.motor]\nrotor_inertia = 1e-6\n", encoding="utf-8")
    assert trace.scenario is not None
    device = trace.scenario.device
    lighter = ebac.Scenario.load(file).device.reflected_mass
    for more, rotor in ([], device.reflected_mass), (["--scenario", str(file)], lighter):
        words = ["identify", "device", str(tmp_path / "log.npz"), *more]
        shown = CliRunner().invoke(app, words, env={"COLUMNS": "200"}).stdout
        _, _, table = shown.partition("In the file of the device:\n")
        found = tomllib.loads(table)["device"]["mechanics"]
        assert found["handle_mass"] == pytest.approx(device.mass - rotor, rel=0.03)
        assert found["damping"] == pytest.approx(device.mechanics.damping, rel=0.05)
        assert found["coulomb"] == pytest.approx(device.mechanics.coulomb, rel=0.05)
        assert "Compensation" not in table


def test_the_check_command(tmp_path: Path) -> None:
    run = CliRunner().invoke(
        app,
        [
            "identify",
            "check",
            "device",
            "--logs",
            "2",
            "--seconds",
            "3",
            "--workers",
            "1",
            "--json",
        ],
    )
    assert run.exit_code == 0, run.output
    document = json.loads(run.stdout)
    assert document["what"] == "device"
    assert {row["parameter"] for row in document["rows"]} >= {"M_h", "B_h", "coulomb", "weight"}


def test_a_force_of_mostly_noise_is_named_and_no_interval_is_nan() -> None:
    """The intervals were "nan to nan", beside a warning of NumPy, and nothing said why."""
    loud = ebac.Device(mechanics=ebac.Mechanics(coulomb=0.3), sensor=ebac.ForceSensor(noise=0.7))
    hand = ebac.Hand(path=ebac.Sine(amplitude=0.02, frequency=1.0))
    scenario = ebac.Scenario(device=loud, hand=hand, environment=ebac.Free(), seconds=10.0)
    found = fit_device(Recording.from_trace(ebac.simulate(scenario, "direct")))
    assert found.impossible
    assert any("has a noise of 0.7" in sentence for sentence in found.misses)
    assert not np.isnan([(e.low, e.high) for e in found.estimates.values()]).any()
