"""Intervals: what an encoder leaves open, readings that are not ahead, logs that repeat themselves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ebac.identify import Recording, Target
from ebac.identify.arm import half_width
from ebac.identify.informativeness import undetermined
from ebac.identify.intervals import covariance, newey_west
from ebac.identify.parameters import lay_out
from ebac.identify.signals import by_place, by_target, folded, kernels, readings

COUNT = 3e-5  # m


def recording(x: np.ndarray, dt: float = 1e-3) -> Recording:
    t = dt * np.arange(len(x))
    return Recording(name="log", t=t, x=COUNT * np.round(x / COUNT), count=COUNT)


# --- what a count leaves open ---


@settings(max_examples=20, deadline=None)
@given(deviation=st.floats(0.01, 3.0), seed=st.integers(0, 1000))
def test_the_width_of_a_normal_and_a_uniform_error_holds_95_of_100(
    deviation: float, seed: int
) -> None:
    draw = np.random.default_rng(seed)
    off = deviation * draw.standard_normal(40000) + draw.uniform(-0.5, 0.5, 40000)
    inside = np.mean(np.abs(off) <= half_width(deviation, 1.0))
    assert inside == pytest.approx(0.95, abs=0.006)


@pytest.mark.parametrize("count", [0.0, 1e-5, 1.0])
def test_the_width_grows_with_the_deviation_and_never_jumps(count: float) -> None:
    deviations = np.geomspace(1e-9, 1e4, 200)
    widths = np.array([half_width(float(d), count) for d in deviations])
    assert (np.diff(widths) >= -1e-12).all()
    assert (widths >= 1.9599 * deviations).all()
    assert (widths <= 1.96 * deviations + 0.5 * count + 1e-15).all()


def test_no_count_and_no_deviation_leave_nothing_open() -> None:
    assert half_width(0.0, 0.0) == 0
    assert half_width(0.0, 1.0) == pytest.approx(0.475)


# --- readings ---


@pytest.mark.parametrize("speed", [0.3, 0.7, 0.95, 1.05, 1.3, 1.6, 1.9, 2.4])
def test_readings_lie_neither_ahead_of_the_handle_nor_behind(speed: float) -> None:
    """Between one and two counts a tick, rows that crossed two edges used to lie ahead by up to half a count."""
    ahead = []
    for phase in np.linspace(0, 1, 40, endpoint=False):
        steps = np.arange(400)
        x = COUNT * (speed * (1 + 0.1 * np.sin(steps / 50)) * steps + phase)
        told = readings(recording(x))
        true = np.interp(1e-3 * steps - told.early, 1e-3 * steps, x)
        use = np.isfinite(told.variance) & (steps > 60) & (steps < 340)
        ahead.append((told.x - true)[use] / COUNT)
    assert abs(np.mean(np.concatenate(ahead))) < 0.01


def test_readings_are_as_sure_as_they_say() -> None:
    draw = np.random.default_rng(3)
    steps = np.arange(20000)
    x = 0.02 * np.sin(steps / 300 + 0.5 * np.sin(steps / 1700)) + COUNT * draw.random()
    told = readings(recording(x))
    true = np.interp(1e-3 * steps - told.early, 1e-3 * steps, x)
    use = np.isfinite(told.variance)
    assert 0.7 < np.mean((told.x - true)[use] ** 2 / told.variance[use]) < 1.1


# --- folds ---


def test_a_log_that_taps_is_folded_on_its_periods() -> None:
    r = recording(np.linspace(0, 0.02, 2000))
    fold = by_target(r, Target.tapping(2.0, 1.999))
    assert fold is not None
    assert np.array_equal(fold[:250], np.arange(250))  # level 0, from its begin on
    assert np.array_equal(fold[500:750], fold[:250])
    assert np.array_equal(fold[250:500], fold[750:1000])
    assert not set(fold[:250]) & set(fold[250:500])


@pytest.mark.parametrize("target", [Target.held(), Target.steps(0.5), Target.steps(0.5, 1.0)])
def test_a_target_that_never_comes_again_is_not_folded(target: Target) -> None:
    assert by_target(recording(np.linspace(0, 0.02, 2000)), target) is None


def test_ways_up_and_down_are_different_places() -> None:
    x = np.concatenate([np.linspace(0, 0.01, 500), np.linspace(0.01, 0, 500)])
    plain = Recording(name="log", t=1e-3 * np.arange(1000), x=x)
    for one in (recording(x), plain):  # with counts, and without
        fold = by_place(one, np.gradient(x))
        assert not set(fold[:490]) & set(fold[510:])


def test_nothing_is_lost_in_a_fold() -> None:
    draw = np.random.default_rng(1)
    scores, fold = draw.standard_normal((3, 1000)), draw.integers(0, 70, 1000)
    assert folded(scores, fold).sum(axis=1) == pytest.approx(scores.sum(axis=1))


def test_errors_that_repeat_count_once_and_not_in_every_period() -> None:
    """Twenty periods of the same errors know the slope no better than one of them."""
    draw = np.random.default_rng(2)
    column, error = draw.standard_normal(500), draw.standard_normal(500)
    jacobian, errors = np.tile(column, 20)[None, :], np.tile(error, 20)
    fold = np.tile(np.arange(500), 20)
    blind = covariance(jacobian, errors, [10000])[0, 0]
    seen = covariance(jacobian, errors, [10000], folds=[fold])[0, 0]
    one = float(error @ error) / 500 / float(column @ column)
    assert blind == pytest.approx(one / 20, rel=0.5)
    assert seen == pytest.approx(one, rel=0.5)


def test_errors_that_do_not_repeat_lose_little_by_a_fold() -> None:
    draw = np.random.default_rng(4)
    jacobian, errors = draw.standard_normal((1, 20000)), draw.standard_normal(20000)
    fold = np.tile(np.arange(1000), 20)
    plain = covariance(jacobian, errors, [20000])[0, 0]
    assert covariance(jacobian, errors, [20000], folds=[fold])[0, 0] < 2 * plain


def test_what_noise_alone_pretends_to_tell_is_loose_and_no_nan() -> None:
    draw = np.random.default_rng(5)
    jacobian, errors = draw.standard_normal((2, 200)), draw.standard_normal(200)
    found = covariance(jacobian, errors, [200], pretended=jacobian * np.array([[0.0], [0.8]]))
    assert np.isfinite(found).all()
    assert found[1, 1] > 1e6


def test_a_reach_of_none_is_the_plain_sum() -> None:
    scores = np.random.default_rng(6).standard_normal((2, 300))
    assert newey_west(scores, reach=0) == pytest.approx(scores @ scores.T)


# --- the kernel ---


@pytest.mark.parametrize("hertz", [5.0, 10.0, 20.0])
def test_the_second_derivative_is_that_of_the_same_kernel(hertz: float) -> None:
    """A kernel cut at four widths was off by a thousandth at 5 Hz, and M0 with it."""
    h = kernels(1e-3)
    half = h.shape[1] // 2
    w = 2 * np.pi * hertz
    wave = np.cos(w * 1e-3 * np.arange(-half, half + 1))
    assert h[2] @ wave == pytest.approx(-(w**2) * (h[0] @ wave), rel=2e-4)


# --- the verdict on a hand that answers within two rows ---


@pytest.mark.parametrize(
    ("mass", "together", "lost"),
    [(5e-3, 0.9, True), (5e-3, 0.5, False), (1e-3, 0.5, True), (0.2, 0.9, False)],
)
def test_a_hand_faster_than_rows_is_believed_only_when_distinguished(
    mass: float, together: float, lost: bool
) -> None:
    """A finger that taps is; one at the least mass there is, or whose mass and damping move together, is not."""
    p = lay_out([1], fixed={}, bounds={}, free=(), own=())
    values = np.zeros(len(p.names))
    values[p.free] = [mass, 6.0, 300.0, 0.02]
    correlation = np.eye(4)
    correlation[0, 1] = correlation[1, 0] = together
    said = undetermined(p, values, 0.01 * values, correlation, 0.04, 1e-3)
    assert ({"M0", "B0", "K0"} <= set(said)) is lost


def test_of_a_model_that_runs_away_nothing_is_known() -> None:
    endless = np.full((2, 50), 1e200)
    assert (np.diag(covariance(endless, np.ones(50), [50])) == np.inf).all()
