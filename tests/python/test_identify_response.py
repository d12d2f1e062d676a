"""Spectra: as SciPy's, true to the hand, and honest about what a log excites."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import ebac
from ebac.cli import app
from ebac.identify import LogCheck, Recording, Target, check_log, excitation, frequency_response
from ebac.identify.response import guess_by_response, spectra


@pytest.fixture(scope="module")
def trace() -> ebac.Trace:
    t, x = excitation.multisine(0.02, low=0.3, high=8, seconds=8)
    hand = ebac.Hand(mass=0.3, damping=7, stiffness=400, path=excitation.path(t, x))
    device = ebac.Device(sensor=ebac.ForceSensor(noise=0.03, quantum=0.01))
    scenario = ebac.Scenario(
        hand=hand, device=device, environment=ebac.Wall(stiffness=3e3), seconds=8.0
    )
    return ebac.simulate(scenario, "ebac")


@pytest.fixture(scope="module")
def recording(trace: ebac.Trace) -> Recording:
    return Recording.from_trace(trace)


@settings(max_examples=15, deadline=None)
@given(segment=st.integers(8, 200).map(lambda n: 2 * n), seed=st.integers(0, 99))
def test_spectra_are_those_of_scipy(segment: int, seed: int) -> None:
    signal = pytest.importorskip("scipy.signal")
    x = np.random.Generator(np.random.PCG64(seed)).standard_normal((2, 1000))
    f, density, count = spectra(x, 2e-3, segment)
    options = {"fs": 500.0, "nperseg": segment, "noverlap": segment - segment // 2}
    f_other, other = signal.csd(x[0], x[1], **options)
    assert np.allclose(f, f_other)
    assert np.allclose(density[0, 1], other)
    _, coherence = signal.coherence(x[0], x[1], **options)
    ours = np.abs(density[0, 1]) ** 2 / (density[0, 0] * density[1, 1]).real
    assert np.allclose(ours, coherence)
    assert count >= 2


def test_the_hand_shows_in_its_response(trace: ebac.Trace, recording: Recording) -> None:
    target = Target.of(trace.scenario.hand, recording.t)
    z = frequency_response(recording, target, np.zeros(1), 400.0)
    told = (z.frequency > 0.4) & (z.frequency < 8)
    assert z.coherence[told].min() > 0.9
    model = z.model(0.3, 7, 400)
    assert np.median(np.abs(z.stiffness - model)[told] / np.abs(model[told])) < 0.1
    assert z.by_target is not None
    assert np.median(np.abs(z.by_target - model)[told] / np.abs(model[told])) < 0.1


def test_a_first_guess_from_spectra(trace: ebac.Trace, recording: Recording) -> None:
    found = guess_by_response(recording, Target.of(trace.scenario.hand, recording.t), np.zeros(1))
    assert found is not None
    assert found == pytest.approx([0.3, 7, 400], rel=0.1)


def test_unrelated_signals_have_no_coherence() -> None:
    draw = np.random.Generator(np.random.PCG64(3))
    t = np.arange(20000) / 1000
    r = Recording(
        name="noise", t=t, x=draw.standard_normal(20000), force=draw.standard_normal(20000)
    )
    z = frequency_response(r)
    assert (z.coherence < z.significant).mean() > 0.85
    assert z.by_target is None


def test_too_short_or_without_force_is_refused() -> None:
    t = np.arange(60) / 1000
    x = np.sin(30 * t)
    with pytest.raises(ValueError, match="has no force of the hand"):
        frequency_response(Recording(name="log", t=t, x=x))


# --- does a log excite what is asked of it ---


def test_a_rich_log_determines_all(trace: ebac.Trace, recording: Recording) -> None:
    found = check_log(recording, Target.of(trace.scenario.hand, recording.t))
    assert all(row["told"] for row in found.rows())
    low, high = found.bands[0][0], found.bands[-1][1]
    assert low <= 1.0
    assert high >= 6


def test_a_hand_that_meets_nothing_determines_nothing() -> None:
    scenario = ebac.Scenario(environment=ebac.Free(), seconds=3.0)
    found = check_log(Recording.from_trace(ebac.simulate(scenario, "direct")))
    assert not any(row["told"] for row in found.rows())
    assert not found.outside
    assert all(row["remedy"] for row in found.rows())


def perturbed(mass: float = 0.3, damping: float = 7.0, stiffness: float = 400.0) -> Recording:
    """Return the log of a hand that rests while a device shakes it: eq. (4) line by line."""
    t, x = excitation.multisine(0.01, low=0.5, high=8, seconds=8)
    t, x = t[:-1], x[:-1]
    s = 2j * np.pi * np.fft.rfftfreq(len(t), 1e-3)
    force = -np.fft.irfft((mass * s**2 + damping * s + stiffness) * np.fft.rfft(x), len(t))
    draw = np.random.Generator(np.random.PCG64(1))
    return Recording(name="perturbed", t=t, x=x, force=force + 0.03 * draw.standard_normal(len(t)))


def test_a_perturbation_reports_a_hand_that_rests() -> None:
    found = check_log(perturbed())
    assert all(row["told"] for row in found.rows())
    assert max(found.deviation.values()) < 0.05
    assert found.outside


@pytest.mark.parametrize("stiffness", [400.0, 2.0])
def test_a_perturbation_shows_what_it_reaches(stiffness: float) -> None:
    """Beside 0.3 kg and 7 N s/m, 2 N/m are lost in noise of a third of their force at 1 cm."""
    found = check_log(perturbed(stiffness=stiffness))
    assert found.determines("M0")
    assert found.determines("B0")
    assert found.determines("K0") == (stiffness == 400.0)


def test_an_unknown_parameter_is_refused(recording: Recording) -> None:
    with pytest.raises(ValueError, match="parameter X: no such name; there are: M0, B0, K0"):
        check_log(recording, ask=("X",))


def test_the_command_says_so_and_ends_with_1(tmp_path: Path, trace: ebac.Trace) -> None:
    scenario = ebac.Scenario(environment=ebac.Free(), seconds=3.0)
    ebac.simulate(scenario, "direct").to_npz(tmp_path / "free.npz")
    run = CliRunner().invoke(app, ["identify", "log", str(tmp_path / "free.npz"), "--json"])
    assert run.exit_code == 1
    document = json.loads(run.stdout)
    assert [row["told"] for row in document["rows"]] == [False] * 3
    target = np.interp(trace["t"], trace.scenario.hand.path[0].t, trace.scenario.hand.path[0].x)
    rows = np.array([trace["t"], trace["x"], trace["f_meas"], target]).T
    np.savetxt(tmp_path / "rich.csv", rows, delimiter=",", header="t,x,force,target", comments="")
    run = CliRunner().invoke(app, ["identify", "log", str(tmp_path / "rich.csv"), "--lag", "8e-4"])
    assert run.exit_code == 0, run.output
    assert "excites" in run.stdout
    for column in ("t", "x", "force", "target"):
        assert f"rich.csv: {column}: guessed to be column '{column}'" in " ".join(
            run.stdout.split()
        )


def test_the_many_lines_of_a_tap_are_told_in_few_words() -> None:
    bands = tuple((3.0 * k + 1, 3.0 * k + 2) for k in range(20))
    names = ("M0", "B0", "K0")
    one = LogCheck(
        name="tap", asked=names, bands=bands, deviation=dict.fromkeys(names, 0.01), outside=True
    )
    assert one.bands_in_words() == "1 to 2 Hz, 4 to 5 Hz, 7 to 8 Hz, ..., 58 to 59 Hz (20 bands)"
    few = LogCheck(name="tap", asked=names, bands=bands[:2], deviation=one.deviation, outside=True)
    assert few.bands_in_words() == "1 to 2 Hz, 4 to 5 Hz"
