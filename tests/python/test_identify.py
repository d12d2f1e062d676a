"""Identification: what was simulated comes back, what cannot be known is called so, bad logs are refused."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.identify import Recording, Target, excitation, fit_arm, fit_device, load
from ebac.identify.beside_scipy import compare_with_scipy
from ebac.identify.cases import Case, draw
from ebac.identify.check import Check, run_case
from ebac.identify.quantisation import count_of
from ebac.identify.unbiased import second_opinion
from ebac.identify.validation import TooFewReadings


def tracked(**changes: object) -> ebac.Scenario:
    t, x = excitation.multisine(0.02, low=0.2, high=3, seconds=5)
    hand = ebac.Hand(mass=0.3, damping=7, stiffness=400, path=excitation.path(t, x))
    device = ebac.Device(
        mechanics=ebac.Mechanics(coulomb=0.05), sensor=ebac.ForceSensor(noise=0.03, quantum=0.01)
    )
    values = {
        "hand": hand,
        "device": device,
        "environment": ebac.Wall(stiffness=3e3),
        "seconds": 5.0,
    }
    return ebac.Scenario(**{**values, **changes})


@pytest.fixture(scope="module")
def scenario() -> ebac.Scenario:
    return tracked()


@pytest.fixture(scope="module")
def trace(scenario: ebac.Scenario) -> ebac.Trace:
    return ebac.simulate(scenario, "ebac")


@pytest.fixture(scope="module")
def fitted(scenario: ebac.Scenario, trace: ebac.Trace):
    recording = Recording.from_trace(trace)
    return fit_arm(recording, Target.of(scenario.hand, recording.t))


def test_the_arm_comes_back(scenario: ebac.Scenario, fitted) -> None:
    for name, truth in (("M0", 0.3), ("B0", 7.0), ("K0", 400.0)):
        e = fitted[name]
        assert abs(e.value / truth - 1) < 0.01, e
        assert e.low - (e.high - e.low) <= truth <= e.high + (e.high - e.low), e
        assert e.determined
    assert fitted.undetermined == ()
    assert fitted.converged
    assert fitted.predictions()[0].vaf > 0.99


def test_the_hand_runs_in_a_scenario(scenario: ebac.Scenario, trace: ebac.Trace, fitted) -> None:
    again = ebac.simulate(scenario.replace(hand=fitted.hand), "ebac")
    assert np.abs(again["true.x"] - trace["true.x"]).max() < 1e-3


def test_scipy_finds_the_same_optimum(fitted) -> None:
    pytest.importorskip("scipy")
    assert compare_with_scipy(fitted).apart < 0.05


def test_instruments_agree_where_nothing_disturbs(fitted) -> None:
    for o in second_opinion(fitted):
        assert abs(o.unbiased / o.direct - 1) < 0.05, o


def test_a_fixed_value_stays_and_a_bound_holds(trace: ebac.Trace, scenario: ebac.Scenario) -> None:
    recording = Recording.from_trace(trace)
    target = Target.of(scenario.hand, recording.t)
    result = fit_arm(recording, target, fixed={"M0": 0.25}, bounds={"K0": (420.0, 800.0)})
    assert result["M0"].value == 0.25
    assert result["M0"].fixed
    assert result["K0"].value >= 420
    assert "K0" in result.undetermined or result["K0"].value > 420.001


def test_two_recordings_share_the_hand_and_keep_their_targets(scenario: ebac.Scenario) -> None:
    parts = [
        Recording.from_trace(ebac.simulate(scenario.replace(seed=s), "eba"), name=f"run {s}")
        for s in (1, 2)
    ]
    targets = [Target.of(scenario.hand, r.t) for r in parts]
    both = fit_arm(parts, targets)
    one = fit_arm(parts[0], targets[0])
    assert set(both.estimates) >= {"M0", "B0", "K0", "X0@1", "X0@2"}
    for name in ("M0", "B0", "K0"):
        assert abs(both[name].value - one[name].value) < 5 * (one[name].high - one[name].low)


def test_a_hand_that_meets_nothing_is_not_identified() -> None:
    cases = [c for c in (draw(i, 1, 4.0) for i in range(60)) if c.task == "free"][:3]
    assert len(cases) == 3
    for case in cases:
        assert any(not o.determined for o in run_case(case) if o.parameter in ("M0", "B0", "K0")), (
            case
        )


def hardly_moving() -> Case:
    """Return a hand in free air whose target is 0.2 mm away: the encoder count changes a few times in the log."""
    case = draw(0, 1, 2.0)
    hand = case.scenario.hand.replace(path=ebac.Step(target=2e-4))
    scenario = case.scenario.replace(hand=hand, environment=ebac.Free())
    return replace(case, task="free", law="direct", scenario=scenario)


def test_a_log_with_too_few_readings_to_test_its_fit_is_refused(tmp_path: Path) -> None:
    case = hardly_moving()
    trace = ebac.simulate(case.scenario, case.law)
    recording = Recording.from_trace(trace, name="still")
    with pytest.raises(TooFewReadings, match=r"^still: \d+ informative readings, at least 13"):
        fit_arm(recording, Target.of(case.scenario.hand, recording.t))
    trace.to_npz(tmp_path / "still.npz")
    run = CliRunner().invoke(app, ["identify", "arm", str(tmp_path / "still.npz")])
    assert run.exit_code == 2
    assert "does not determine the hand" in " ".join(run.stderr.split())


def test_a_check_counts_a_refused_log_as_one_that_determines_nothing() -> None:
    found = Check(outcomes=tuple(run_case(hardly_moving())))
    rows = {row["parameter"]: row for row in found.rows()}
    assert rows.keys() == {"M0", "B0", "K0", "X0"}
    assert all((row["cases"], row["determined"]) == (1, 0) for row in rows.values())
    verdict = found.unidentifiable()
    assert verdict["silent_cases"] + verdict["telling_cases"] == 1
    assert verdict["silent_called"] + verdict["telling_called"] == 1
    assert verdict["determined_and_wrong_by_half"] == 0


@pytest.mark.parametrize("informative", [True, False])
@pytest.mark.parametrize("determined", [True, False])
def test_a_check_compares_the_verdict_of_the_fit_with_the_truth(
    informative: bool, determined: bool
) -> None:
    one = replace(run_case(hardly_moving())[0], informative=informative, determined=determined)
    verdict = Check(outcomes=(one,)).unidentifiable()
    assert verdict["silent_cases"] == (not informative)
    assert verdict["silent_called"] == (not informative and not determined)
    assert verdict["telling_cases"] == informative
    assert verdict["telling_called"] == (informative and not determined)


def test_a_case_is_the_same_every_time() -> None:
    first, second = draw(7, 3, 2.0), draw(7, 3, 2.0)
    assert isinstance(first, Case)
    assert first == second
    assert draw(8, 3, 2.0) != first


def test_no_hand_from_a_log_that_does_not_tell() -> None:
    scenario = ebac.Scenario(
        environment=ebac.Free(),
        seconds=2.0,
        device=ebac.Device(sensor=ebac.ForceSensor(noise=0.05)),
    )
    result = fit_arm(Recording.from_trace(ebac.simulate(scenario, "direct")))
    assert result.undetermined
    with pytest.raises(ValueError, match="not determined by this log"):
        _ = result.hand


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"fixed": {"mass": 1.0}}, "parameter mass: no such name; there are: M0, B0, K0, delay"),
        ({"fixed": {"M0": -1.0}}, r"M0 = -1 kg: must lie in \[0.001, 10\] kg"),
        ({"bounds": {"B0": (5.0, 2.0)}}, "the lower one first"),
        ({"starts": 0}, "starts = 0: must be at least 1"),
        ({"robust": -1.0}, "robust = -1.0: must be positive"),
    ],
)
def test_bad_wishes_are_refused(trace: ebac.Trace, change: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        fit_arm(Recording.from_trace(trace), **change)


@pytest.mark.parametrize(
    ("target", "message"),
    [
        (Target.steps(99.0), r"changes at 99 s: must lie in \(0, 5\) s"),
        (Target.tapping(300, 4.9), "must hold for 10 rows"),
    ],
)
def test_a_target_outside_the_log_is_refused(
    trace: ebac.Trace, target: Target, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        fit_arm(Recording.from_trace(trace), target)


# --- device ---


def test_the_device_comes_back() -> None:
    t, x = excitation.multisine(0.04, low=0.2, high=4, seconds=8)
    device = ebac.Device(
        mechanics=ebac.Mechanics(damping=3, coulomb=0.4), sensor=ebac.ForceSensor(noise=0.02)
    )
    hand = ebac.Hand(mass=0.1, damping=10, stiffness=900, path=excitation.path(t, x))
    scenario = ebac.Scenario(
        device=device, hand=hand, environment=ebac.Wall(stiffness=500), seconds=8.0
    )
    found = fit_device(Recording.from_trace(ebac.simulate(scenario, "direct")))
    assert found.estimates["M_h"].value == pytest.approx(device.mass, rel=0.03)
    assert found.estimates["B_h"].value == pytest.approx(3, rel=0.1)
    assert found.estimates["coulomb"].value == pytest.approx(0.4, rel=0.15)
    assert 0.2 < found.compensation.friction <= 0.45
    assert found.explained > 0.98


def test_a_device_without_any_force_is_refused(trace: ebac.Trace) -> None:
    r = Recording.from_trace(trace)
    with pytest.raises(ValueError, match="neither the motor's force nor the hand's"):
        fit_device(Recording(name="log", t=r.t, x=r.x))


# --- excitation ---


@settings(max_examples=20, deadline=None)
@given(amplitude=st.floats(1e-3, 1), high=st.floats(2, 20), seed=st.integers(0, 99))
def test_a_multisine_is_flat_and_within_its_amplitude(
    amplitude: float, high: float, seed: int
) -> None:
    _, x = excitation.multisine(amplitude, high=high, seconds=4, dt=4e-3, seed=seed, tries=10)
    assert np.abs(x).max() == pytest.approx(amplitude)
    assert excitation.crest(x) < 2.3


def test_a_chirp_ends_at_its_upper_frequency() -> None:
    t, x = excitation.chirp(1.0, low=1, high=20, seconds=10)
    crossings = np.flatnonzero(np.diff(np.sign(x[t > 9.5])))
    assert len(crossings) == pytest.approx(2 * 0.5 * 18.6, abs=2)


def test_excitation_beyond_nyquist_is_refused() -> None:
    with pytest.raises(ValueError, match=r"must lie in \(0, 500\) Hz"):
        excitation.chirp(1.0, high=600)


# --- reading ---


def csv(path: Path, trace: ebac.Trace, heading: str = "time [ms],pos [mm],Fx [N]") -> Path:
    rows = np.array([1e3 * trace["t"], 1e3 * trace["x"], trace["f_meas"]]).T
    np.savetxt(path, rows, delimiter=",", header=heading, comments="", fmt="%.9g")
    return path


def test_units_of_the_heading_are_taken_and_guesses_said(tmp_path: Path, trace: ebac.Trace) -> None:
    r = load(csv(tmp_path / "a.csv", trace), lag=8e-4)
    assert r.dt == pytest.approx(1e-3)
    assert np.abs(r.x - trace["x"]).max() < 1e-9
    assert r.count == pytest.approx(trace.scenario.device.facts.count, rel=1e-3)
    assert any("'Fx [N]'" in text for text in r.remarks)


def test_a_trace_round_trips_through_npz(tmp_path: Path, trace: ebac.Trace) -> None:
    trace.to_npz(tmp_path / "a.npz")
    r = load(tmp_path / "a.npz")
    assert np.array_equal(r.x, trace["x"])
    assert r.lag == 8e-4


def test_mat_is_read(tmp_path: Path, trace: ebac.Trace) -> None:
    io = pytest.importorskip("scipy.io")
    io.savemat(tmp_path / "a.mat", {"t": trace["t"], "x": 1e3 * trace["x"], "Fz": trace["f_meas"]})
    r = load(tmp_path / "a.mat", columns={"force": "Fz"}, units={"x": "mm"})
    assert np.abs(r.x - trace["x"]).max() < 1e-12
    assert r.force is not None


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,y\n" + "0,1\n" * 60, "found no position and no force of the hand among t, y"),
        ("t,x\n0,1\n1,2\n2,3\n", "3 rows; needs at least 50"),
        ("t,x\n" + "".join(f"{i},5\n" for i in range(60)), "x is constant at 5 m"),
        (
            "t,x\n" + "".join(f"{i},{'nan' if i == 7 else i}\n" for i in range(60)),
            "x is no number in 1 of 60 rows, first in row 8",
        ),
        ("t,x [furlong]\n" + "".join(f"{i},{i}\n" for i in range(60)), "must be one of m, mm, cm"),
        (
            "t,x\n" + "".join(f"{i % 9},{i}\n" for i in range(60)),
            "t goes back in row 10; sort the log",
        ),
        ("t,x\n0,1\n1\n", "row 2 below the heading has 1 cell"),
        ("t,x\n0,one\n1,2\n", "'one' in row 1, column 'x', is no number"),
        ("1,2\n3,4\n", "has no heading"),
        ("", "the file is empty"),
    ],
)
def test_bad_files_get_a_clear_error(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "bad.csv").write_text(text)
    with pytest.raises(ValueError, match=message):
        load(tmp_path / "bad.csv")


@given(count=st.floats(1e-6, 1e-3), seed=st.integers(0, 9))
@settings(max_examples=20)
def test_the_encoder_step_is_found(count: float, seed: int) -> None:
    t = np.linspace(0, 1, 2000)
    x = count * np.round(300 * np.sin(2 * np.pi * t) + seed)
    assert count_of(x) == pytest.approx(count, rel=1e-6)


# --- command line ---


@pytest.mark.slow
def test_the_command_writes_a_report_and_json(tmp_path: Path, trace: ebac.Trace) -> None:
    trace.to_npz(tmp_path / "log.npz")
    out = tmp_path / "report"
    run = CliRunner().invoke(
        app, ["identify", "arm", str(tmp_path / "log.npz"), "--json", "--out", str(out)]
    )
    assert run.exit_code == 0, run.output
    document = json.loads(run.stdout)
    assert document["command"] == "identify arm"
    assert {row["name"] for row in document["rows"]} >= {"M0", "B0", "K0", "X0"}
    assert (out / "arm.html").read_text().count("data:image/png") == 1
    assert (out / "arm.png").stat().st_size > 10_000


def test_the_command_refuses_a_log_without_force(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(
        "t,x\n" + "".join(f"{i / 1000},{i % 13 / 1000}\n" for i in range(99))
    )
    run = CliRunner().invoke(app, ["identify", "arm", str(tmp_path / "a.csv")])
    assert run.exit_code == 2
    assert "has no force of the hand" in " ".join(run.stderr.split())
