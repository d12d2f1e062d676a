"""Fits: several recordings, several starts, outliers, other rates, coarse encoders; logs of every kind."""

from pathlib import Path

import numpy as np
import pytest

import ebac
from ebac.identify import Recording, Target, excitation, fit_arm, load
from ebac.identify.cases import draw
from ebac.identify.check import run_case

TRUTH = {"M0": 0.3, "B0": 7.0, "K0": 400.0}


def tracked(seconds: float = 5.0, **changes: object) -> ebac.Scenario:
    t, x = excitation.multisine(0.02, low=0.2, high=3, seconds=seconds)
    hand = ebac.Hand(mass=0.3, damping=7, stiffness=400, path=excitation.path(t, x))
    device = ebac.Device(sensor=ebac.ForceSensor(noise=0.03, quantum=0.01))
    values = {"hand": hand, "device": device, "environment": ebac.Wall(stiffness=3e3)}
    return ebac.Scenario(**{**values, "seconds": seconds, **changes})


@pytest.fixture(scope="module")
def trace() -> ebac.Trace:
    return ebac.simulate(tracked(), "ebac")


def target_of(trace: ebac.Trace, r: Recording) -> Target:
    return Target.of(trace.scenario.hand, r.t)


def near(result, truth: dict[str, float], times: float = 2.0) -> None:
    for name, value in truth.items():
        e = result[name]
        assert abs(e.value - value) <= times * 0.5 * (e.high - e.low), e


# --- several recordings ---


def test_shared_and_own_parameters() -> None:
    """One hand that grips harder the second time: M0 and B0 shared, K0 of each its own."""
    scenario = tracked()
    harder = scenario.replace(hand=scenario.hand.replace(stiffness=600), seed=2)
    recordings = [
        Recording.from_trace(ebac.simulate(s, "ebac"), name=n)
        for n, s in (("soft", scenario), ("hard", harder))
    ]
    targets = [Target.of(s.hand, r.t) for s, r in zip((scenario, harder), recordings, strict=True)]
    result = fit_arm(recordings, targets, own=("K0",))
    near(result, {"M0": 0.3, "B0": 7.0, "K0@1": 400.0, "K0@2": 600.0}, 2.5)
    assert "K0" not in result.estimates
    together = fit_arm(recordings, targets)
    assert any(not t.white for t in together.tests.values()) or (
        together.errors @ together.errors > 1.05 * (result.errors @ result.errors)
    )


def test_two_recordings_are_surer_than_one() -> None:
    recordings = [
        Recording.from_trace(ebac.simulate(tracked(seed=s), "ebac"), name=f"run {s}")
        for s in (1, 2)
    ]
    target = Target.of(tracked().hand, recordings[0].t)
    one, both = fit_arm(recordings[0], target), fit_arm(recordings, [target, target])
    for name in TRUTH:
        width = both[name].high - both[name].low
        assert width < 0.95 * (one[name].high - one[name].low), name


def test_a_held_out_recording_is_foretold(trace: ebac.Trace) -> None:
    r = Recording.from_trace(trace)
    result = fit_arm(r, target_of(trace, r))
    other = ebac.simulate(tracked(seed=7), "eba")
    q = Recording.from_trace(other, name="other")
    fitted, held = result.predictions([(q, target_of(other, q))])
    assert not fitted.held_out
    assert held.held_out
    assert held.vaf > 0.99
    assert held.nrmse < 0.05


# --- the search ---


def test_every_start_ends_at_the_same_place(trace: ebac.Trace) -> None:
    r = Recording.from_trace(trace)
    once, often = (fit_arm(r, target_of(trace, r), starts=n, seed=5) for n in (1, 4))
    for name in TRUTH:
        half = 0.5 * (once[name].high - once[name].low)
        assert abs(once[name].value - often[name].value) < 0.05 * half


def test_outliers_count_less_with_a_robust_loss(trace: ebac.Trace) -> None:
    r = Recording.from_trace(trace)
    x = r.x.copy()
    draw_rows = np.random.Generator(np.random.PCG64(1)).choice(len(x), 10, replace=False)
    x[draw_rows] += 40 * r.count  # lost counts that come back
    spoilt = Recording(
        name="spoilt", t=r.t, x=x, force=r.force, motor=r.motor, count=r.count, lag=r.lag
    )
    target = target_of(trace, r)
    plain, robust = fit_arm(spoilt, target), fit_arm(spoilt, target, robust=1.345)
    off = {
        kind: max(abs(result[n].value / v - 1) for n, v in TRUTH.items())
        for kind, result in (("plain", plain), ("robust", robust))
    }
    assert off["robust"] < 0.6 * off["plain"]
    assert off["robust"] < 0.1


def test_the_state_a_log_begins_in_is_free(trace: ebac.Trace) -> None:
    """A log cut from the middle, where the hand moves, tells the same hand."""
    whole = Recording.from_trace(trace)
    part = whole.between(1.237, 4.9)
    speed = (part.x[5] - part.x[0]) / (part.t[5] - part.t[0])
    assert abs(speed) > 0.01
    path = np.interp(part.t, trace.scenario.hand.path[0].t, trace.scenario.hand.path[0].x)
    near(fit_arm(part, Target.following(path)), TRUTH, 2.5)


def test_profile_and_local_intervals_agree(trace: ebac.Trace) -> None:
    r = Recording.from_trace(trace)
    result = fit_arm(r, target_of(trace, r))
    low, high = result.profile("K0")
    e = result["K0"]
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    assert half == pytest.approx(0.5 * (e.high - e.low), rel=0.25)
    assert abs(centre - e.value) < half


def test_a_delay_of_the_force_is_found_and_costs_damping_if_ignored() -> None:
    trace = ebac.simulate(tracked(), "ebac")
    r = Recording.from_trace(trace)
    late = Recording(
        name="late", t=r.t, x=r.x, force=np.concatenate([np.full(3, r.force[0]), r.force[:-3]]),
        count=r.count, lag=r.lag,
    )  # fmt: skip
    target = target_of(trace, r)
    found = fit_arm(late, target, free=("delay",))
    assert found["delay"].value == pytest.approx(3e-3, abs=3e-4)
    near(found, TRUTH, 3)
    ignored = fit_arm(late, target)
    assert abs(ignored["B0"].value / 7 - 1) > 3 * abs(found["B0"].value / 7 - 1)


@pytest.mark.parametrize("number", [0, 2, 3])
def test_noise_of_the_force_does_not_make_a_hand_heavier(number: int) -> None:
    """Without the correction light hands come out 1 % too heavy, five deviations."""
    case = draw(number, 1, 6.0)
    for o in run_case(case):
        if o.parameter == "M0" and o.determined:
            deviation = (o.high - o.low) / 3.92
            assert abs(o.value - o.truth) < 3.5 * deviation, o


# --- other people's logs ---


@pytest.mark.parametrize(("every", "count"), [(4, 0.0), (4, 2e-4), (2, 1e-3)])
def test_other_rates_and_coarse_encoders(
    trace: ebac.Trace, every: int, count: float, tmp_path: Path
) -> None:
    """250 or 500 Hz, millimetres, counts up to 1 mm, newtons in the heading, no motor: honest or not determined."""
    long = ebac.simulate(tracked(10.0), "ebac")
    path = np.interp(long["t"], long.scenario.hand.path[0].t, long.scenario.hand.path[0].x)
    x = long["true.x"].ravel()[::every]
    x = count * np.floor(x / count) if count else x
    rows = np.array(
        [1e3 * long["t"][::every], 1e3 * x, 1e3 * long["f_meas"][::every], 1e3 * path[::every]]
    ).T
    heading = "time [ms];pos [mm];F [mN];target [mm]"
    np.savetxt(tmp_path / "a.csv", rows, delimiter=";", header=heading, comments="", fmt="%.9g")
    r = load(tmp_path / "a.csv", lag=8e-4)
    assert r.dt == pytest.approx(every * 1e-3)
    if count:
        assert r.count == pytest.approx(count, rel=0.01)
    assert r.motor is None
    result = fit_arm(r, Target.following(r.target))
    for name, truth in TRUTH.items():
        e = result[name]
        half = 0.5 * (e.high - e.low)
        assert not e.determined or abs(e.value - truth) <= 2 * half, e
        assert abs(e.value / truth - 1) < 0.25, e


def test_a_log_in_mcap_is_read_as_the_run_itself(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "run.mcap")
    r = load(tmp_path / "run.mcap")
    same = Recording.from_trace(trace)
    assert np.array_equal(r.x, same.x)
    assert np.array_equal(r.force, same.force)
    assert r.lag == same.lag
    assert r.count == same.count


def test_a_cut_log_is_read_and_said_to_be_cut(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "run.mcap")
    data = (tmp_path / "run.mcap").read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) * 2 // 3])
    r = load(tmp_path / "cut.mcap")
    assert 0.3 * len(trace) < len(r.t) < len(trace)
    assert any("not whole" in text for text in r.remarks)


def test_an_axis_that_does_not_exist_is_refused(trace: ebac.Trace, tmp_path: Path) -> None:
    trace.save(tmp_path / "run.mcap")
    with pytest.raises(ValueError, match=r"axis = 2: must lie in \[0, 0\]"):
        load(tmp_path / "run.mcap", axis=2)


def test_millimetres_taken_for_metres_are_refused(trace: ebac.Trace, tmp_path: Path) -> None:
    rows = np.array([trace["t"], 1e3 * trace["x"], trace["f_meas"]]).T
    np.savetxt(tmp_path / "a.csv", rows, delimiter=",", header="t,x,force", comments="")
    with pytest.raises(ValueError, match=r"x spans .* m, a hand 2.5 m at most: .* --unit x=mm"):
        load(tmp_path / "a.csv")


def test_a_hand_filmed_by_others_is_refused_with_the_reason(tmp_path: Path) -> None:
    """As the GunPoint series: 30 Hz, a place in standard deviations, no force."""
    t = np.arange(150) / 30
    x = np.where((t > 1) & (t < 3.5), 1.6, -0.65) + 0.01 * np.sin(9 * t)
    np.savetxt(tmp_path / "gun.csv", np.array([t, x]).T, delimiter=",", header="t,x", comments="")
    r = load(tmp_path / "gun.csv")
    with pytest.raises(ValueError, match="has no force of the hand"):
        fit_arm(r)
